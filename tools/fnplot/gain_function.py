"""Gain functions: piecewise linear in time, held constant outside their control points.

Times are whole nanoseconds, gains have no unit.
"""

from array import array
from bisect import bisect_right
from dataclasses import dataclass
from fractions import Fraction

# No time lies further from the start of a capture (126 years).
LARGEST_TIME_NS = 4_000_000_000_000_000_000


@dataclass(frozen=True)
class GainFunction:
    """Control points in time order, at least one."""

    times_ns: array  # 64-bit whole numbers
    gains: array  # doubles

    @classmethod
    def from_points(cls, points):
        """From (time in ns, gain) pairs."""
        times_ns, gains = zip(*points)
        return cls(array("q", times_ns), array("d", gains))

    @property
    def points(self):
        return list(zip(self.times_ns, self.gains))

    @property
    def first_ns(self):
        return self.times_ns[0]

    @property
    def last_ns(self):
        return self.times_ns[-1]

    def at(self, time_ns):
        """The gain at a time, exactly."""
        right = bisect_right(self.times_ns, time_ns)
        if right == 0:
            return Fraction(self.gains[0])
        if right == len(self.times_ns):
            return Fraction(self.gains[-1])
        begin_ns, end_ns = self.times_ns[right - 1], self.times_ns[right]
        begin_gain, end_gain = Fraction(self.gains[right - 1]), Fraction(self.gains[right])
        return begin_gain + (end_gain - begin_gain) * (time_ns - begin_ns) / (end_ns - begin_ns)
