"""Gain functions: the function-file format, and exact measures of a function over a domain.

Everything is a fractions.Fraction: times in nanoseconds, gains without unit. A function is kept as
what the file says, control points; `lines` turns it into straight lines over a domain [0, end].
Written from the mathematics alone; it shares nothing with the program that it checks.
"""

import re
from collections import namedtuple
from fractions import Fraction

# A straight line over [start, end] ns, from the value `first` to `last`. Two neighbouring lines of
# a gain need not meet: that is how an exact boxcar jumps.
Line = namedtuple("Line", "start end first last")

# What a function is over a domain. duration: length of the times with gain != 0 (D), ns.
# integral: of g; absolute: of |g|; both gain x ns.
Measures = namedtuple("Measures", "duration integral absolute")

_HEAD = re.compile(r"M\s*(\d+)\s*(.*)", re.DOTALL)
_POINT = re.compile(r"\[\s*([+-]?\d+)\s*:\s*([^\]\s]+)\s*\]")


class GainFunction:
    """A piecewise-linear gain through control points, its end gains held for ever."""

    def __init__(self, points):
        """points: list of (time ns, gain), times strictly increasing, gains exact."""
        self.points = [(Fraction(time), Fraction(gain)) for time, gain in points]
        if not self.points:
            raise ValueError("a function needs a control point")
        for (before, _), (after, _) in zip(self.points, self.points[1:]):
            if after <= before:
                raise ValueError(f"time {after} is not after {before}")

    def lines(self, end):
        """The function over [0, end] ns as a list of Line in time order, none of zero length."""
        time, gain = self.points[0]
        lines = [Line(min(Fraction(0), time), time, gain, gain)]
        for (start, first), (stop, last) in zip(self.points, self.points[1:]):
            lines.append(Line(start, stop, first, last))
        time, gain = self.points[-1]
        lines.append(Line(time, max(Fraction(end), time), gain, gain))
        return clipped(lines, end)


class Boxcar:
    """Gain 1 over [start, end] ns and 0 elsewhere, with jumps: a plain exposure."""

    def __init__(self, start, end):
        self.start, self.end = Fraction(start), Fraction(end)

    def lines(self, end):
        return clipped([Line(self.start, self.end, Fraction(1), Fraction(1))], end)


def value_at(line, time):
    """Value of a line at a time (ns) within it."""
    share = Fraction(time - line.start, line.end - line.start)
    return line.first + (line.last - line.first) * share


def clipped(lines, end):
    """The parts of the lines within the domain [0, end] ns; empty ones are left out."""
    parts = []
    for line in lines:
        start, stop = max(line.start, Fraction(0)), min(line.end, Fraction(end))
        if start < stop:
            parts.append(Line(start, stop, value_at(line, start), value_at(line, stop)))
    return parts


def measure(function, end):
    """Measures of a function over the domain [0, end] ns, exactly."""
    duration = integral = absolute = Fraction(0)
    for line in function.lines(end):
        length, first, last = line.end - line.start, line.first, line.last
        if first == 0 and last == 0:
            continue
        # A line that isn't zero all along is zero at one instant at most, which has no length.
        duration += length
        integral += length * (first + last) / 2
        if first * last < 0:  # two triangles, on either side of the crossing
            absolute += length * (first * first + last * last) / (2 * (abs(first) + abs(last)))
        else:
            absolute += length * (abs(first) + abs(last)) / 2
    return Measures(duration, integral, absolute)


def _points(text):
    """Control points of the text between the mask value and the function's end."""
    rest = _POINT.sub("", text)
    if rest.strip(" \t\r\n,"):
        raise ValueError(f"not control points: {rest.strip()!r}")
    return [(int(time), Fraction(gain)) for time, gain in _POINT.findall(text)]


def parse_functions(text):
    """A valid function file's text: {mask value: GainFunction}. Other lines are comments."""
    functions = {}
    lines = iter(text.removeprefix("\ufeff").splitlines())
    for line in lines:
        head = _HEAD.match(line.strip())
        if not head:
            continue
        mask_value, body = int(head[1]), head[2].strip()
        if not body.startswith(("{", "[")):
            raise ValueError(f"cannot read {line!r}")
        if body.startswith("{"):
            while "}" not in body:
                body += "\n" + next(lines)
            body = body[1:body.index("}")]
        if mask_value > 255 or mask_value in functions:
            raise ValueError(f"mask value {mask_value} is above 255 or given twice")
        functions[mask_value] = GainFunction(_points(body))
    return functions


def read_functions(path):
    """The function file at a path: {mask value: GainFunction}."""
    with open(path, encoding="utf-8", newline="") as file:
        return parse_functions(file.read())
