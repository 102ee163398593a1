"""Times as people write and read them. All times are in nanoseconds."""

import math
import re
from decimal import Decimal
from fractions import Fraction

from fnplot.errors import UsageError
from fnplot.gain_function import LARGEST_TIME_NS

UNITS = (("s", 1_000_000_000), ("ms", 1_000_000), ("µs", 1_000), ("ns", 1))
NS_PER_UNIT = dict(UNITS) | {"us": 1_000, "min": 60_000_000_000, "h": 3_600_000_000_000}
LENGTH_DIGITS = 10
TIME_TEXT = re.compile(r"(-?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:/[0-9]+)?)([a-zµ]+)")


def parse_time(text, what):
    """`3s`, `0.4s`, `10ms`, `1/100s` in whole nanoseconds, rounded half up; `what` names it in messages."""
    match = TIME_TEXT.fullmatch(text)
    if not match or match[2] not in NS_PER_UNIT or ("." in match[1] and "/" in match[1]):
        way_out = "write a number and a unit: 3s, 0.4s, 10ms, 250us, 1/100s"
        raise UsageError(f"{what} '{text}' is no time; {way_out}")
    try:
        time_ns = math.floor(Fraction(match[1]) * NS_PER_UNIT[match[2]] + Fraction(1, 2))
    except ZeroDivisionError:
        raise UsageError(f"{what} '{text}' divides by 0") from None
    if abs(time_ns) > LARGEST_TIME_NS:
        raise UsageError(f"{what} '{text}' is longer than 126 years")
    return time_ns


def unit_for(length_ns):
    """The largest unit (name, ns) that a length, positive or negative, has at least 1 of; ns below that."""
    return next((unit for unit in UNITS if abs(length_ns) >= unit[1]), UNITS[-1])


def number_text(number, digits):
    """A fraction in decimals, also where it is too large for a double."""
    try:
        return f"{float(number):.{digits}g}"
    except OverflowError:
        return f"{Decimal(number.numerator) / number.denominator:.5e}"


def length_text(length_ns):
    """`83.331001 ms`, `1.01 s`, `0 s`: a length in the unit that fits, to LENGTH_DIGITS."""
    if length_ns == 0:
        return "0 s"
    # What is rounded to 1000 ms is 1 s.
    name, unit_ns = unit_for(length_ns * (1 + Fraction(1, 2 * 10**LENGTH_DIGITS)))
    return f"{number_text(Fraction(length_ns) / unit_ns, LENGTH_DIGITS)} {name}"


def exact_text(time_ns):
    """A time with all its digits, in the unit that fits: `1.000000001 s`."""
    name, unit_ns = unit_for(time_ns or UNITS[0][1])
    whole, rest = divmod(abs(time_ns), unit_ns)
    decimals = str(rest).zfill(len(str(unit_ns)) - 1).rstrip("0") if rest else ""
    return f"{'-' if time_ns < 0 else ''}{whole}{'.' if decimals else ''}{decimals} {name}"


def roundest_time(begin_ns, end_ns):
    """The time within [begin_ns, end_ns] that ends in the most zeros."""
    step_ns = 10 ** len(str(max(abs(begin_ns), abs(end_ns))))
    while -(-begin_ns // step_ns) * step_ns > end_ns:
        step_ns //= 10
    return -(-begin_ns // step_ns) * step_ns


class TimeAxis:
    """Turns nanoseconds into coordinates: a unit that fits the window, counted from an origin.

    The origin is 0, except for windows that are narrow against their distance from it: there the
    nanoseconds would drown in digits, so time is counted from a round time in the window.
    """

    def __init__(self, begin_ns, end_ns):
        width_ns = end_ns - begin_ns
        # Twice the unit before it is used: 1.5 s are easier to read as 1500 ms.
        self.unit, self.unit_ns = unit_for(width_ns // 2)
        self.origin_ns = 0
        if min(abs(begin_ns), abs(end_ns)) > 1000 * width_ns:
            self.origin_ns = roundest_time(begin_ns, end_ns)

    def coordinate(self, time_ns):
        """The coordinate of a time."""
        return float((time_ns - self.origin_ns) / self.unit_ns)

    def coordinates(self, times_ns):
        """The coordinates of an array of 64-bit times."""
        return (times_ns - self.origin_ns) / self.unit_ns

    @property
    def label(self):
        if self.origin_ns == 0:
            return f"time ({self.unit})"
        return f"time from {exact_text(self.origin_ns)} ({self.unit})"
