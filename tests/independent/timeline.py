"""The timeline of a capture and the weight of each of its samples, in exact arithmetic.

Times are whole nanoseconds (int). The weight of sample k is the integral of the gain against the
sample's own hat: 1 while it is exposed, ramping across the gaps beside it, held to the end of the
capture for the last one. No running sums are shared between samples, so that no error of one
weight can hide in the next.
"""

import math
from collections import namedtuple
from fractions import Fraction

from functions import Line, value_at

NANOSECONDS = 10**9

# starts[k], ends[k]: exposure of sample k, ns. end: end of the capture (T_end), ns.
Timeline = namedtuple("Timeline", "starts ends end")


def round_half_up(value):
    """Nearest integer to a Fraction, halves upwards."""
    return math.floor(value + Fraction(1, 2))


def constant_rate(count, rate, angle="360"):
    """Timeline of `count` samples at a rate (samples a second) with a shutter angle (degrees).

    Rate and angle are exact: text such as 30000/1001 or 29.97, or a Fraction.
    """
    period = NANOSECONDS / Fraction(rate)
    share = Fraction(angle) / 360
    starts = [round_half_up(k * period) for k in range(count)]
    ends = [round_half_up((k + share) * period) for k in range(count)]
    return checked(Timeline(starts, ends, round_half_up(count * period)))


def from_starts(starts, angle="360"):
    """Timeline of samples that start at the given times (ns), two at least."""
    starts = [start - starts[0] for start in starts]
    periods = [after - before for before, after in zip(starts, starts[1:])]
    periods.append(periods[-1])
    share = Fraction(angle) / 360
    ends = [round_half_up(start + share * period) for start, period in zip(starts, periods)]
    return checked(Timeline(starts, ends, starts[-1] + periods[-1]))


def from_exposures(exposures):
    """Timeline of samples with the given exposures [(start ns, end ns), …]."""
    origin = exposures[0][0]
    starts = [start - origin for start, _ in exposures]
    ends = [end - origin for _, end in exposures]
    return checked(Timeline(starts, ends, ends[-1]))


def checked(timeline):
    """The timeline, after seeing that s_k < e_k <= s_(k+1)."""
    following = timeline.starts[1:] + [timeline.end]
    for start, end, after in zip(timeline.starts, timeline.ends, following):
        if not start < end <= after:
            raise ValueError(f"exposure {start} … {end} ns, next {after} ns: empty or overlapping")
    return timeline


def hat(timeline, k):
    """Sample k's share in the light between samples, as a list of Line in time order."""
    lines = []
    last = len(timeline.starts) - 1
    if k > 0:
        lines.append((timeline.ends[k - 1], timeline.starts[k], 0, 1))
    lines.append((timeline.starts[k], timeline.ends[k], 1, 1))
    if k < last:
        lines.append((timeline.ends[k], timeline.starts[k + 1], 1, 0))
    else:
        lines.append((timeline.ends[k], timeline.end, 1, 1))
    return [Line(*map(Fraction, line)) for line in lines if line[0] < line[1]]


def line_product(gain, share):
    """Integral (ns) of a line of gain times a line of a hat, over the times that both cover."""
    start, end = max(gain.start, share.start), min(gain.end, share.end)
    if start >= end:
        return Fraction(0)

    def product(time):
        return value_at(gain, time) * value_at(share, time)

    # Simpson's rule is exact here: a product of two lines has degree 2.
    return (end - start) * (product(start) + 4 * product((start + end) / 2) + product(end)) / 6


def weights(timeline, function):
    """The integral (gain x ns, Fraction) of the gain against each sample's hat: {k: weight}.

    Samples of weight exactly 0 are left out.
    """
    found = {}
    live = [line for line in function.lines(timeline.end) if line.first or line.last]
    if not live:
        return found
    for k in range(len(timeline.starts)):
        shares = hat(timeline, k)
        if shares[-1].end <= live[0].start or shares[0].start >= live[-1].end:
            continue
        weight = sum(line_product(gain, share) for gain in live for share in shares)
        if weight:
            found[k] = weight
    return found
