"""What a gain function comes to over an interval. Integrals are exact: whole sums, rounded once."""

from dataclasses import dataclass
from fractions import Fraction

import numpy as np

MANTISSA_BITS = 53  # of a double


@dataclass(frozen=True)
class GainSummary:
    """As docs/explanation/model.md defines it, over the interval in place of the domain."""

    integral_ns: Fraction  # ∫g
    support_ns: int  # D: length of { t : g(t) ≠ 0 }
    live_ns: tuple | None  # the live interval (begin, end); None where nothing is live

    @property
    def still_gain(self):
        """∫g / D, what a still scene is multiplied by; 0 where D is 0."""
        return self.integral_ns / self.support_ns if self.support_ns else Fraction(0)


def exact_sum(gains, weights):
    """Σ gain · weight of doubles and whole numbers, as a fraction."""
    mantissas, exponents = np.frexp(gains)
    whole = (mantissas * 2.0**MANTISSA_BITS).astype(np.int64)
    products = whole.astype(object) * weights.astype(object)  # of any size
    total = Fraction(0)
    order = np.argsort(exponents, kind="stable")
    values, starts = np.unique(exponents[order], return_index=True)
    for exponent, of_exponent in zip(values, np.split(products[order], starts[1:])):
        total += Fraction(int(of_exponent.sum())) * Fraction(2) ** (int(exponent) - MANTISSA_BITS)
    return total


def live_interval(function, begin_ns, end_ns):
    """From the control point before the first that is not zero to the one after the last."""
    live = np.flatnonzero(np.frombuffer(function.gains))
    if not live.size:
        return None
    first, last = int(live[0]), int(live[-1])
    live_begin_ns = function.times_ns[first - 1] if first > 0 else begin_ns
    live_end_ns = function.times_ns[last + 1] if last + 1 < len(function.gains) else end_ns
    clipped = max(live_begin_ns, begin_ns), min(live_end_ns, end_ns)
    return clipped if clipped[0] < clipped[1] else None


def summarize(function, begin_ns, end_ns):
    """A function over [begin_ns, end_ns], which is not empty."""
    times_ns = np.frombuffer(function.times_ns, dtype=np.int64)
    inside = slice(*np.searchsorted(times_ns, (begin_ns + 1, end_ns)))  # begin_ns < time < end_ns
    gains = np.frombuffer(function.gains)[inside]
    begin_gain, end_gain = function.at(begin_ns), function.at(end_ns)
    lengths_ns = np.diff(np.concatenate(([begin_ns], times_ns[inside], [end_ns])))
    # Twice the integral: each gain counts on both sides of its time.
    twice_ns = begin_gain * int(lengths_ns[0]) + end_gain * int(lengths_ns[-1])
    if gains.size:
        twice_ns += exact_sum(gains, lengths_ns[:-1] + lengths_ns[1:])
    is_zero = np.concatenate(([begin_gain == 0], gains == 0, [end_gain == 0]))
    support_ns = int(lengths_ns[~(is_zero[:-1] & is_zero[1:])].sum())
    return GainSummary(twice_ns / 2, support_ns, live_interval(function, begin_ns, end_ns))
