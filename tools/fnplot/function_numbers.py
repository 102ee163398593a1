"""The numbers of a function file.

in:      a whole word and its offset in the file
out:     the number; a word that is none raises a Mistake that says what would be right
"""

import math
import re

from fnplot.gain_function import LARGEST_TIME_NS
from fnplot.source_text import as_utf_8, shown

WHOLE = re.compile(r"[+-]?[0-9]+")
DECIMAL = re.compile(r"([+-]?)(?=\.?[0-9])([0-9]*)(?:\.([0-9]*))?(?:[eE]([+-]?[0-9]+))?")
INFINITE_OR_NAN = re.compile(r"[+-]?(?:inf(?:inity)?|nan(?:\(.*)?)", re.IGNORECASE)

LARGEST_TAG = 255
LONGEST_EXPONENT = 10**12  # beyond what any word can make up for with its digits
UNITS = {"": 0, "ns": 0, "us": 3, "\u00b5s": 3, "\u03bcs": 3, "ms": 6, "s": 9}  # powers of ten, in ns


class Mistake(Exception):
    """A mistake of form at offset `at`: the rest of the function cannot be read."""

    def __init__(self, at, message):
        super().__init__(message)
        self.at = at
        self.message = message


def parse_tag(word, at):
    """The mask value that a word (the characters behind M) stands for."""
    if not word.isascii() or not word.isdigit():
        raise Mistake(at, f"'M{shown(word)}' is no mask value; write M and a whole number 0 … 255")
    # Python refuses to convert thousands of digits.
    digits = word.lstrip("0") or "0"
    if len(digits) > 3 or int(digits) > LARGEST_TAG:
        raise Mistake(at, f"mask value {shown(word)} is above 255, the largest an 8-bit mask has")
    return int(digits)


def whole_number(decimal, power):
    """A match of DECIMAL times 10^power, where that is a whole number that a time may be; else None."""
    sign, whole, fraction, exponent = decimal.group(1), decimal[2], decimal[3] or "", decimal[4] or "0"
    digits = (whole + fraction).lstrip("0")
    if not digits:
        return 0
    exponent_digits = exponent.lstrip("+-").lstrip("0")
    size = int(exponent_digits or "0") if len(exponent_digits) <= 12 else LONGEST_EXPONENT
    power += (-size if exponent.startswith("-") else size) - len(fraction)
    kept = digits.rstrip("0") if power < 0 else digits
    if len(digits) - len(kept) > -power and power < 0:
        kept = digits[:power]
    power += len(digits) - len(kept)
    if power < 0 or power > 18 or len(kept) > 19:
        return None
    value = int(kept) * 10**power
    if value > LARGEST_TIME_NS:
        return None
    return -value if sign == "-" else value


def time_way_out(word):
    """What to write for a time that is written in another way, as far as it can be guessed."""
    decimal = DECIMAL.match(word)
    if decimal:
        unit = as_utf_8(word[decimal.end() :])
        value = whole_number(decimal, UNITS[unit]) if unit in UNITS else None
        if value is not None:
            return f"write {value}"
        # Few people think in fractions of a nanosecond.
        seconds = None if unit else whole_number(decimal, UNITS["s"])
        if seconds is not None:
            return f"{shown(word)} s are {seconds}"
    return "10 ms are 10000000"


def parse_time(word, at):
    """A time in whole nanoseconds."""
    if not WHOLE.fullmatch(word):
        what = f"'{shown(word)}' is no time; times are whole nanoseconds written as digits"
        raise Mistake(at, f"{what}: {time_way_out(word)}")
    time_ns = whole_number(DECIMAL.match(word), 0)
    if time_ns is None:
        limit = f"further than {LARGEST_TIME_NS} ns from the start (126 years)"
        raise Mistake(at, f"time {shown(word)} is {limit}")
    return time_ns


def parse_gain(word, at):
    """A gain: the double nearest to a decimal number."""
    if not DECIMAL.fullmatch(word) and not INFINITE_OR_NAN.fullmatch(word):
        has_other_minus = as_utf_8(word).startswith(("\u2212", "\u2013"))
        number = "a number such as 1, -0.5 or 2e-3"
        right = "the minus as the - of the keyboard" if has_other_minus else number
        raise Mistake(at, f"'{shown(word)}' is no gain; write {right}")
    if INFINITE_OR_NAN.fullmatch(word) or not math.isfinite(float(word)):
        raise Mistake(at, f"gain {shown(word)} is not finite; gains are numbers up to 1.79e308")
    return float(word)
