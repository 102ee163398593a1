"""Reads one function of a function file. docs/reference/functions.md has the format.

in:      the text of a file, and the extent of a function in it
out:     its mask value, its control points and its mistakes

Control points are read in runs where they are written as most are, and one by one where they are not: what
is read either way is the same, and only the second finds words for mistakes.
"""

import math
import re
from array import array
from operator import lt

from fnplot.function_numbers import DECIMAL, Mistake, parse_gain, parse_tag, parse_time
from fnplot.gain_function import LARGEST_TIME_NS
from fnplot.source_text import shown

# The text is decoded as Latin-1, so that a character is a byte whatever the encoding of the comments.
BLANK = r"[ \t\v\f]"
BLANKS = re.compile(BLANK + "*")
BLANKS_LINES_COMMENTS = re.compile(rf"(?:{BLANK}|\n|#[^\n]*)*")
COMMENT = re.compile(r"#[^\n]*")
WORD = re.compile(r"[^ \t\v\f\n,:\[\]{}#]*")
FUNCTION_START = re.compile(BLANK + r"*M[0-9]")

# Control points as most are written, each with the comma behind it and so short that its numbers fit.
PLAIN_TIME = r"[+-]?[0-9]{1,18}"
PLAIN_GAIN = r"[+-]?[0-9]{1,20}(?:\.[0-9]{0,20})?(?:[eE][+-]?[0-9]{1,2})?"
PLAIN_COMMA = rf"{BLANK}*,{BLANK}*(?:\n{BLANK}*)?"
PLAIN_NUMBERS = rf"{BLANK}*({PLAIN_TIME}){BLANK}*:{BLANK}*({PLAIN_GAIN}){BLANK}*"
PLAIN_POINT = re.compile(rf"\[{PLAIN_NUMBERS}\]{PLAIN_COMMA}")
RUN = re.compile(rf"(?:{PLAIN_POINT.pattern}){{1,4096}}(?=\[)")

LONE_CARRIAGE_RETURN = (
    "a carriage return without a line feed; save the file with line ends of Unix or Windows"
)
ANOTHER_FUNCTION = "another function starts on a line of its own"
WRITE_BRACES = "to go on over several lines write M0{ … }"


class FunctionReader:
    """Reads one function: text[begin:end] is its extent, from the M to a line end."""

    def __init__(self, text, begin, end, line_of):
        self.text = text
        self.line_of = line_of  # of an offset
        self.at = begin + 1  # behind the M
        self.end = end
        self.tag = None
        self.times_ns = array("q")
        self.gains = array("d")
        self.order_mistakes = []  # after these the function can be read on

    def read(self):
        """Fills tag, times_ns, gains and order_mistakes; raises the first mistake of form."""
        tag_at = self.at
        self.tag = parse_tag(self.word(), tag_at)
        self.skip(BLANKS)
        self.brace_at = self.at if self.peek() == "{" else None
        if self.brace_at is not None:
            self.at += 1
        self.read_points()
        if self.brace_at is not None:
            self.at += 1  # the closing brace
        self.skip(BLANKS)
        self.skip(COMMENT)
        if self.at < self.end:
            comment = "only a comment that starts with # may follow"
            way_out = ANOTHER_FUNCTION if self.at_function_start() else comment
            raise self.other("after the end of a function", f"; {way_out}")

    def read_points(self):
        """The control points up to, not including, the closing brace or the end of the line."""
        self.skip_to_mark()
        if self.at_list_end():
            raise self.without_points()
        while True:
            self.read_run()
            self.expect_point_start()
            self.read_point()
            self.skip_to_mark()
            if self.at_list_end():
                return
            if self.peek() == "[":
                raise Mistake(self.at, "a comma is missing between two control points")
            if self.peek() != ",":
                raise self.other_after_point()
            comma_at = self.at
            self.at += 1
            self.skip_to_mark()
            if self.at_list_end():
                hint = "" if self.brace_at is not None else f"; {WRITE_BRACES}"
                raise Mistake(comma_at, f"a comma with no control point after it{hint}")

    def read_run(self):
        """Control points in bulk, up to one that is written in another way or has no other behind it."""
        while run := RUN.match(self.text, self.at, self.end):
            pairs = PLAIN_POINT.findall(run[0])
            times_ns = [int(time) for time, _ in pairs]
            before_ns = [self.times_ns[-1] if self.times_ns else times_ns[0] - 1, *times_ns]
            if not all(map(lt, before_ns, times_ns)):
                places = PLAIN_POINT.finditer(self.text, self.at, run.end())
                for before, time, place in zip(before_ns, times_ns, places):
                    self.check_order(before, time, place.start(1))
            self.times_ns.extend(times_ns)
            self.gains.extend(float(gain) for _, gain in pairs)
            self.at = run.end()

    def read_point(self):
        """`[time:gain]`, on one line."""
        bracket_at = self.at
        self.at += 1
        self.skip(BLANKS)
        time_at = self.at
        time_ns = parse_time(self.number_word("time", "whole nanoseconds"), time_at)
        self.skip(BLANKS)
        if self.peek() != ":":
            is_split = self.more_of_a_number()[1] == ":"
            way_out = "; a time is one run of digits, without a unit" if is_split else ""
            raise self.other("where the ':' between time and gain should stand", way_out)
        self.at += 1
        self.skip(BLANKS)
        gain_at = self.at
        gain_word = self.number_word("gain", "a number")
        gain = parse_gain(gain_word, gain_at)
        self.skip(BLANKS)
        if self.peek() in ("", "\n"):
            raise Mistake(bracket_at, "a bracket that is not closed on its line; ']' ends a control point")
        if self.peek() != "]":
            way_out = self.split_gain_way_out(gain_word)
            raise self.other("where ']' should end the control point", way_out)
        self.at += 1
        if self.times_ns:
            self.check_order(self.times_ns[-1], time_ns, time_at)
        self.times_ns.append(time_ns)
        self.gains.append(gain)

    def check_order(self, before_ns, time_ns, time_at):
        if time_ns > before_ns:
            return
        if time_ns == before_ns:
            is_last = time_ns == LARGEST_TIME_NS
            way_out = f"{time_ns - 1} for the first" if is_last else f"{time_ns + 1} for the second"
            message = f"time {time_ns} stands twice; a jump takes 1 ns: write {way_out}"
        else:
            message = f"time {time_ns} is not after {before_ns}; control points must be in time order"
        self.order_mistakes.append((time_at, message))

    def expect_point_start(self):
        if self.peek() != "[":
            is_letter = self.peek().isascii() and self.peek().isalpha() or self.peek() >= "\x80"
            way_out = "; a comment starts with #" if is_letter else ""
            raise self.other("where a control point [time:gain] should start", way_out)

    def at_list_end(self):
        """Whether the list ends here. In braces the extent must not end first."""
        if self.brace_at is None:
            return self.peek() in ("", "#", "\n")
        if self.at >= self.end:
            what = "a brace that is never closed"
            if self.end + 1 < len(self.text):
                next_line = self.line_of(self.end + 1)
                what = f"a brace that is not closed before the function on line {next_line}"
            raise Mistake(self.brace_at, f"{what}; '}}' ends the function")
        return self.peek() == "}"

    def skip_to_mark(self):
        self.skip(BLANKS if self.brace_at is None else BLANKS_LINES_COMMENTS)

    def skip(self, pattern):
        match = pattern.match(self.text, self.at, self.end)
        if match:
            self.at = match.end()

    def word(self):
        start = self.at
        self.skip(WORD)
        return self.text[start : self.at]

    def peek(self):
        """The next character; empty at the end of the extent."""
        return self.text[self.at] if self.at < self.end else ""

    def at_function_start(self):
        return FUNCTION_START.match(self.text, self.at, self.end) and self.peek() == "M"

    def number_word(self, name, what):
        """The word of a time or gain."""
        word = self.word()
        if word:
            return word
        way_out = f"; write {what}, as in [10000000:1]"
        if self.peek() in ("", "\n", "]") or (self.peek() == ":" and name == "time"):
            raise Mistake(self.at, f"a {name} is missing{way_out}")
        raise self.other(f"where a {name} should stand", way_out)

    def more_of_a_number(self):
        """What is left of a number that blanks or a comma split: its word, and the mark behind it."""
        begin = self.at + 1 if self.peek() == "," else self.at
        begin = BLANKS.match(self.text, begin, self.end).end()
        word = WORD.match(self.text, begin, self.end)[0]
        mark_at = BLANKS.match(self.text, begin + len(word), self.end).end()
        return (word, self.text[mark_at : min(mark_at + 1, self.end)]) if word else ("", "")

    def split_gain_way_out(self, gain_word):
        """For a gain that is not followed by its bracket but by more of a number."""
        word, mark = self.more_of_a_number()
        if mark != "]":
            return ""
        if self.peek() != ",":
            return "; a gain is one number, without blanks or a unit"
        with_point = f"{gain_word}.{word}"
        is_number = DECIMAL.fullmatch(with_point) and math.isfinite(float(with_point))
        if not "0" <= word[0] <= "9" or not is_number:
            return ""
        return f"; the decimal mark is a point: write {shown(with_point)}"

    def without_points(self):
        what = "a function without control points"
        brace_at = BLANKS_LINES_COMMENTS.match(self.text, self.at, self.end).end()
        if self.brace_at is not None or not self.text.startswith("{", brace_at, self.end):
            return Mistake(self.at, f"{what}; write at least one, as in [0:1]")
        way_out = f"the '{{' of line {self.line_of(brace_at)} belongs on the line of the M, as in M0{{ … }}"
        return Mistake(self.at, f"{what}; {way_out}")

    def other_after_point(self):
        where = "after a control point"
        if self.at_function_start():
            return self.other(where, f"; {ANOTHER_FUNCTION}")
        if self.peek() == "}":
            return self.other(where, "; no brace is open before it, as in M0{ … }")
        end = "the line's end" if self.brace_at is None else "'}'"
        return self.other(where, f"; a comma or {end} should follow, and a comment starts with #")

    def other(self, where, way_out):
        """A mistake: a word or mark that should not stand where it does."""
        if self.peek() == "\r":
            return Mistake(self.at, LONE_CARRIAGE_RETURN)
        word = WORD.match(self.text, self.at, self.end)[0] or self.peek()
        what = f"'{shown(word)}'" if word not in ("", "\n") else "the end of the line"
        return Mistake(self.at, f"{what} {where}{way_out}")
