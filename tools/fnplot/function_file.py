"""Reads function files. docs/functions.md has the format.

in:      the bytes of a file
out:     its gain functions by mask value, and a diagnostic for every mistake
always:  places are counted from 1, columns in bytes; a function with a mistake is left out

A function's extent (its line, or everything up to its closing brace) is found before its control points
are read. So a mistake in it never reaches the lines behind it.
"""

import math
import re
from bisect import bisect_right
from dataclasses import dataclass, field

from fnplot.gain_function import LARGEST_TIME_NS, GainFunction

# The text is decoded as Latin-1, so that a character is a byte whatever the encoding of the comments.
BLANK = r"[ \t\v\f]"
BLANKS = re.compile(BLANK + "*")
BLANKS_LINES_COMMENTS = re.compile(rf"(?:{BLANK}|\n|#[^\n]*)*")
COMMENT = re.compile(r"#[^\n]*")
WORD = re.compile(r"[^ \t\v\f\n,:\[\]{}#]*")
FUNCTION_START = re.compile(BLANK + r"*M[0-9]")
NO_FUNCTION_START = re.compile(BLANK + r"*M[^\n]")
SMALL_FUNCTION_START = re.compile(BLANK + r"*m[0-9]")
STRAY_POINT_START = re.compile(BLANK + r"*\[")
WHOLE = re.compile(r"[+-]?[0-9]+")
DECIMAL = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
INFINITE_OR_NAN = re.compile(r"[+-]?(?:inf(?:inity)?|nan(?:\(.*)?)", re.IGNORECASE)

LARGEST_TAG = 255
EXAMPLE = "M0 [0:1], [10000000:1], [10000001:0]"


@dataclass(frozen=True)
class Diagnostic:
    """A mistake (or, with `is_warning`, a line that looks like one) and its place in the file."""

    line: int
    column: int
    message: str
    is_warning: bool = False

    def text(self, file_name):
        """`motion.fn:3:14: time 5 is not after 9; …`"""
        kind = "warning: " if self.is_warning else ""
        return f"{file_name}:{self.line}:{self.column}: {kind}{self.message}"


@dataclass
class FunctionFile:
    """What a function file holds."""

    functions: dict[int, GainFunction] = field(default_factory=dict)  # by mask value
    diagnostics: list[Diagnostic] = field(default_factory=list)  # in the order of the text

    @property
    def errors(self):
        return [diagnostic for diagnostic in self.diagnostics if not diagnostic.is_warning]

    @property
    def warnings(self):
        return [diagnostic for diagnostic in self.diagnostics if diagnostic.is_warning]


class Mistake(Exception):
    """A mistake of form at offset `at`: the rest of the function cannot be read."""

    def __init__(self, at, message):
        super().__init__(message)
        self.at = at
        self.message = message


def readable(text):
    """The characters of a piece of the file for a message, whatever bytes it is made of."""
    for character in text.encode("latin-1").decode("utf-8", errors="surrogateescape"):
        if character.isprintable():
            yield character
        elif 0xDC80 <= ord(character) <= 0xDCFF:  # a byte that is no UTF-8
            yield f"\\x{ord(character) - 0xDC00:02x}"
        else:
            yield ascii(character)[1:-1]


def shown(text):
    return "".join(readable(text))


def number_without_sign(word):
    return word.lstrip("+-").lstrip("0")


def parse_tag(word, at):
    """The mask value that a word (the characters behind M) stands for."""
    if not word.isascii() or not word.isdigit():
        raise Mistake(at, f"'M{shown(word)}' is no mask value; write M and a whole number 0 … 255")
    if len(number_without_sign(word)) > 3 or int(word) > LARGEST_TAG:
        raise Mistake(at, f"mask value {word} is above 255, the largest an 8-bit mask has")
    return int(word)


def parse_time(word, at):
    """A time in whole nanoseconds."""
    if not word:
        raise Mistake(at, "a time is missing; write whole nanoseconds, as in [10000000:1]")
    if not WHOLE.fullmatch(word):
        what = f"time {word}" if DECIMAL.fullmatch(word) else f"'{shown(word)}'"
        raise Mistake(at, f"{what} is not written as whole nanoseconds; 10 ms are 10000000")
    # Python refuses to convert thousands of digits, so they are counted first.
    if len(number_without_sign(word)) > 19 or abs(int(word)) > LARGEST_TIME_NS:
        raise Mistake(at, f"time {word} is further than {LARGEST_TIME_NS} ns from the start (126 years)")
    return int(word)


def parse_gain(word, at):
    """A gain: the double nearest to a decimal number."""
    if not word:
        raise Mistake(at, "a gain is missing; write a number, as in [10000000:1]")
    if not DECIMAL.fullmatch(word) and not INFINITE_OR_NAN.fullmatch(word):
        raise Mistake(at, f"'{shown(word)}' is no gain; write a number such as 1, -0.5 or 2e-3")
    if INFINITE_OR_NAN.fullmatch(word) or not math.isfinite(float(word)):
        raise Mistake(at, f"gain {shown(word)} is not finite; gains are numbers up to 1.79e308")
    return float(word)


class FunctionReader:
    """Reads one function: text[begin:end] is its extent, from the M to a line end."""

    def __init__(self, text, begin, end):
        self.text = text
        self.at = begin + 1  # behind the M
        self.end = end
        self.tag = None
        self.points = []
        self.order_mistakes = []  # after these the function can be read on

    def read(self):
        """Fills tag, points and order_mistakes; raises the first mistake of form."""
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
            next_function = "a function starts on a line of its own"
            way_out = next_function if self.peek() == "M" else "a comment starts with #"
            raise Mistake(self.at, f"'{self.character()}' after the end of a function; {way_out}")

    def read_points(self):
        """The control points up to, not including, the closing brace or the end of the line."""
        self.skip_to_mark()
        if self.at_list_end():
            raise Mistake(self.at, "a function without control points; write at least one, as in [0:1]")
        while True:
            self.expect_point_start()
            self.read_point()
            self.skip_to_mark()
            if self.at_list_end():
                return
            if self.peek() == "[":
                raise Mistake(self.at, "a comma is missing between two control points")
            if self.peek() != ",":
                what = f"'{self.character()}' after a control point"
                raise Mistake(self.at, f"{what}; a comma or the end should follow")
            comma_at = self.at
            self.at += 1
            self.skip_to_mark()
            if self.at_list_end():
                hint = "" if self.brace_at is not None else "; to go on over several lines write M0{ … }"
                raise Mistake(comma_at, f"a comma with no control point after it{hint}")

    def read_point(self):
        """`[time:gain]`, on one line."""
        bracket_at = self.at
        self.at += 1
        self.skip(BLANKS)
        time_at = self.at
        time_ns = parse_time(self.word(), time_at)
        self.skip(BLANKS)
        if self.peek() != ":":
            raise Mistake(self.at, f"'{self.character()}' where the ':' between time and gain should stand")
        self.at += 1
        self.skip(BLANKS)
        gain_at = self.at
        gain = parse_gain(self.word(), gain_at)
        self.skip(BLANKS)
        if self.peek() in ("", "\n"):
            raise Mistake(bracket_at, "a bracket that is not closed on its line; ']' ends a control point")
        if self.peek() != "]":
            raise Mistake(self.at, f"'{self.character()}' where ']' should end the control point")
        self.at += 1
        self.check_order(time_ns, time_at)
        self.points.append((time_ns, gain))

    def check_order(self, time_ns, time_at):
        if not self.points or time_ns > self.points[-1][0]:
            return
        before_ns = self.points[-1][0]
        if time_ns == before_ns:
            message = f"time {time_ns} stands twice; a jump takes 1 ns: write {time_ns + 1} for the second"
        else:
            message = f"time {time_ns} is not after {before_ns}; control points must be in time order"
        self.order_mistakes.append((time_at, message))

    def expect_point_start(self):
        if self.peek() != "[":
            raise Mistake(self.at, f"'{self.character()}' where a control point [time:gain] should start")

    def at_list_end(self):
        """Whether the list ends here. In braces the extent must not end first."""
        if self.brace_at is None:
            return self.peek() in ("", "#")
        if self.at >= self.end:
            raise Mistake(self.brace_at, "a brace that is never closed; '}' ends the function")
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

    def character(self):
        """The next character for a message: whole, where it takes several bytes."""
        if self.peek() in ("", "\n"):
            return "end of line"
        word = WORD.match(self.text, self.at, self.end)[0]
        return next(readable(word or self.peek()))


class FileReader:
    """Reads a whole file, line by line and function by function."""

    def __init__(self, data):
        text = data.decode("latin-1").removeprefix("\xef\xbb\xbf")
        self.text = text.replace("\r\n", "\n").removesuffix("\r")
        self.line_starts = [0] + [match.end() for match in re.finditer("\n", self.text)]
        self.line = 0  # index into line_starts
        self.first_lines = {}  # mask value → line, also of functions with mistakes
        self.file = FunctionFile()

    def read(self):
        if "\0" in self.text:
            self.report(self.text.index("\0"), "a zero byte: this is no text file (UTF-16? save it as UTF-8)")
            return self.file
        while self.line < len(self.line_starts):
            self.read_line()
        if not self.first_lines and not self.file.errors:
            self.report(0, f"no function in this file; a function is a line like {EXAMPLE}")
        self.file.diagnostics.sort(key=lambda diagnostic: diagnostic.line)
        return self.file

    def read_line(self):
        """One line outside braces, or a whole function."""
        start = self.line_starts[self.line]
        if FUNCTION_START.match(self.text, start):
            self.read_function(BLANKS.match(self.text, start).end())
            return
        if match := STRAY_POINT_START.match(self.text, start):
            message = "a line of control points outside braces; to go on over several lines write M0{ … }"
            self.report(match.end() - 1, message)
        elif match := NO_FUNCTION_START.match(self.text, start):
            message = "taken as a comment: M is not followed by a mask value, as in M128"
            self.report(match.end() - 2, message, is_warning=True)
        elif match := SMALL_FUNCTION_START.match(self.text, start):
            message = "taken as a comment: a function starts with a capital M"
            self.report(match.end() - 2, message, is_warning=True)
        self.line += 1

    def read_function(self, start):
        first_line = self.line + 1
        self.line = self.line_after(start)
        reader = FunctionReader(self.text, start, self.line_end(self.line - 1))
        mistakes = []
        try:
            reader.read()
        except Mistake as mistake:
            mistakes.append((mistake.at, mistake.message))
        mistakes = reader.order_mistakes + mistakes
        if reader.tag is not None:
            earlier = self.first_lines.setdefault(reader.tag, first_line)
            if earlier != first_line:
                message = f"M{reader.tag} stands a second time; the first is on line {earlier}"
                mistakes.insert(0, (start, message))
        for at, message in mistakes:
            self.report(at, message)
        if not mistakes:
            self.file.functions[reader.tag] = GainFunction(tuple(reader.points))

    def line_after(self, start):
        """Index of the line behind the function that starts at `start`."""
        name_end = WORD.match(self.text, start).end()
        mark_at = BLANKS.match(self.text, name_end).end()
        line = self.line
        if not self.text.startswith("{", mark_at):
            return line + 1
        from_at = mark_at
        while "}" not in COMMENT.sub("", self.text[from_at : self.line_end(line)]):
            line += 1
            if line == len(self.line_starts) or FUNCTION_START.match(self.text, self.line_starts[line]):
                return line
            from_at = self.line_starts[line]
        return line + 1

    def line_end(self, line):
        """Offset of the end of a line, without its newline."""
        last = line + 1 == len(self.line_starts)
        return len(self.text) if last else self.line_starts[line + 1] - 1

    def report(self, at, message, is_warning=False):
        line = bisect_right(self.line_starts, at) - 1
        column = at - self.line_starts[line] + 1
        self.file.diagnostics.append(Diagnostic(line + 1, column, message, is_warning))


def parse_functions(data):
    """Reads the bytes of a function file. All its mistakes are found; see FunctionFile."""
    return FileReader(data).read()
