"""Gain functions: piecewise linear in time, held constant outside their control points.

Times are whole nanoseconds, gains have no unit. Integrals are exact: sums of fractions, rounded once.
"""

from dataclasses import dataclass
from fractions import Fraction

# No time lies further from the start of a capture (126 years).
LARGEST_TIME_NS = 4_000_000_000_000_000_000


@dataclass(frozen=True)
class Piece:
    """A stretch on which a function is a straight line; gains are fractions."""

    begin_ns: int
    end_ns: int
    begin_gain: Fraction
    end_gain: Fraction

    @property
    def is_zero(self):
        return self.begin_gain == 0 and self.end_gain == 0

    @property
    def length_ns(self):
        return self.end_ns - self.begin_ns

    def at(self, time_ns):
        """The gain at a time within the piece."""
        slope = (self.end_gain - self.begin_gain) / self.length_ns
        return self.begin_gain + slope * (time_ns - self.begin_ns)

    def clipped(self, begin_ns, end_ns):
        """The part of the piece within [begin_ns, end_ns]; None where there is none."""
        if begin_ns <= self.begin_ns and self.end_ns <= end_ns:
            return self
        begin = max(self.begin_ns, begin_ns)
        end = min(self.end_ns, end_ns)
        return Piece(begin, end, self.at(begin), self.at(end)) if begin < end else None


@dataclass(frozen=True)
class GainSummary:
    """What a function amounts to over an interval."""

    integral_ns: Fraction  # ∫g
    support_ns: int  # D: length of { t : g(t) ≠ 0 }

    @property
    def still_gain(self):
        """∫g / D, what a still scene is multiplied by; 0 where D is 0."""
        return self.integral_ns / self.support_ns if self.support_ns else Fraction(0)


@dataclass(frozen=True)
class GainFunction:
    """Control points (time in ns, gain), in time order, at least one."""

    points: tuple[tuple[int, float], ...]

    @property
    def first_ns(self):
        return self.points[0][0]

    @property
    def last_ns(self):
        return self.points[-1][0]

    def pieces(self, begin_ns, end_ns):
        """The function on [begin_ns, end_ns], piece by piece, without gaps."""
        gains = [Fraction(gain) for _, gain in self.points]
        whole = []
        if begin_ns < self.first_ns:
            whole.append(Piece(begin_ns, self.first_ns, gains[0], gains[0]))
        for i, (left, right) in enumerate(zip(self.points, self.points[1:])):
            whole.append(Piece(left[0], right[0], gains[i], gains[i + 1]))
        if self.last_ns < end_ns:
            whole.append(Piece(self.last_ns, end_ns, gains[-1], gains[-1]))
        clipped = (piece.clipped(begin_ns, end_ns) for piece in whole)
        return [piece for piece in clipped if piece]

    def summary(self, begin_ns, end_ns):
        """Integral, D and still gain over [begin_ns, end_ns]."""
        integral_ns = Fraction(0)
        support_ns = 0
        for piece in self.pieces(begin_ns, end_ns):
            if not piece.is_zero:
                integral_ns += (piece.begin_gain + piece.end_gain) * piece.length_ns / 2
                support_ns += piece.length_ns
        return GainSummary(integral_ns, support_ns)
