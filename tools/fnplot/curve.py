"""A function as it is drawn: lines in coordinates, thinned to what can be seen, apart by sign.

A line is two arrays, x not decreasing. What is thinned looks the same: of each of COLUMNS narrow columns the
first, lowest, highest and last point are kept.
"""

import numpy as np

COLUMNS = 2048  # of the width of a graph; more than its pixels


def line_of(function, begin_ns, end_ns, time_axis, gain_axis):
    """A function on [begin_ns, end_ns] as a line; only points that can be told apart."""
    times_ns = np.frombuffer(function.times_ns, dtype=np.int64)
    inside = slice(*np.searchsorted(times_ns, (begin_ns + 1, end_ns)))
    ends = float(function.at(begin_ns)), float(function.at(end_ns))
    gains = np.concatenate((ends[:1], np.frombuffer(function.gains)[inside], ends[1:]))
    times_ns = np.concatenate(([begin_ns], times_ns[inside], [end_ns]))
    return thinned(time_axis.coordinates(times_ns), gain_axis.coordinate(gains))


def thinned(x, y):
    """The points of a line that its picture needs: at most four a column."""
    if len(x) <= 4 * COLUMNS:
        return x, y
    columns = np.minimum((x - x[0]) * (COLUMNS / (x[-1] - x[0])), COLUMNS - 1).astype(np.int64)
    firsts = np.flatnonzero(np.diff(columns, prepend=-1))
    lasts = np.append(firsts[1:], len(x)) - 1
    by_height = np.lexsort((y, columns))  # within each column
    kept = np.unique(np.concatenate((firsts, lasts, by_height[firsts], by_height[lasts])))
    return x[kept], y[kept]


def split_at_zero(x, y):
    """The line with a point wherever it crosses zero."""
    before = np.flatnonzero(np.sign(y[:-1]) * np.sign(y[1:]) < 0)
    share = y[before] / (y[before] - y[before + 1])
    crossings = x[before] + share * (x[before + 1] - x[before])
    return np.insert(x, before + 1, crossings), np.insert(y, before + 1, 0.0)


def by_sign(x, y):
    """The parts of a line, split at zero, that are positive (1), negative (-1) and zero (0).

    out: {sign: line}, each with nan between its parts
    """
    signs = np.sign(np.sign(y[:-1]) + np.sign(y[1:]))  # of each stretch between two points
    lines = {}
    for sign in np.unique(signs):
        changes = np.diff(signs == sign, prepend=False, append=False)
        parts = np.flatnonzero(changes).reshape(-1, 2)  # first point and last point of each
        joined = [(x[begin : end + 1], y[begin : end + 1]) for begin, end in parts]
        gap = [np.nan]
        lines[int(sign)] = tuple(
            np.concatenate([piece for part in joined for piece in (part[axis], gap)][:-1]) for axis in (0, 1)
        )
    return lines
