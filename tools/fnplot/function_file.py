"""Reads function files. docs/functions.md has the format.

in:      the bytes of a file
out:     its gain functions by mask value, and a diagnostic for every mistake
always:  places are counted from 1, columns in bytes; a function with a mistake is left out; diagnostics
         are what nutik-cl says of the file, word for word, each one line of printable text

A function's extent (its line, or everything up to its closing brace) is found before its control points
are read. So a mistake in it never reaches the lines behind it.
"""

import math
import re
from bisect import bisect_right
from dataclasses import dataclass, field

from fnplot.function_numbers import DECIMAL, Mistake, parse_gain, parse_tag, parse_time
from fnplot.gain_function import LARGEST_TIME_NS, GainFunction
from fnplot.source_text import INVISIBLE_OR_BLANK, as_utf_8, shown

# The text is decoded as Latin-1, so that a character is a byte whatever the encoding of the comments.
BLANK = r"[ \t\v\f]"
BLANKS = re.compile(BLANK + "*")
BLANKS_LINES_COMMENTS = re.compile(rf"(?:{BLANK}|\n|#[^\n]*)*")
COMMENT = re.compile(r"#[^\n]*")
WORD = re.compile(r"[^ \t\v\f\n,:\[\]{}#]*")
FUNCTION_START = re.compile(BLANK + r"*M[0-9]")
NO_FUNCTION_START = re.compile(BLANK + r"*M")
SMALL_FUNCTION_START = re.compile(BLANK + r"*m[0-9]")
STRAY_POINT_START = re.compile(BLANK + r"*\[")
STRAY_MARK_START = re.compile(rf"{BLANK}*[,{{]{BLANK}*\[")
BYTE_ORDER_MARKS = re.compile("^(?:\xef\xbb\xbf)+", re.MULTILINE)
NO_FUNCTION = "no function in this file; a function is a line like M0 [0:1], [10000000:1], [10000001:0]"
OLD_LINE_ENDS = "; its lines end in carriage returns: save it with line ends of Unix or Windows"
LONE_CARRIAGE_RETURN = (
    "a carriage return without a line feed; save the file with line ends of Unix or Windows"
)
ANOTHER_FUNCTION = "another function starts on a line of its own"
WRITE_BRACES = "to go on over several lines write M0{ … }"


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


class FunctionReader:
    """Reads one function: text[begin:end] is its extent, from the M to a line end."""

    def __init__(self, text, begin, end, line_of):
        self.text = text
        self.line_of = line_of  # of an offset
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
            comment = "only a comment that starts with # may follow"
            way_out = ANOTHER_FUNCTION if self.at_function_start() else comment
            raise self.other("after the end of a function", f"; {way_out}")

    def read_points(self):
        """The control points up to, not including, the closing brace or the end of the line."""
        self.skip_to_mark()
        if self.at_list_end():
            raise self.without_points()
        while True:
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
        self.check_order(time_ns, time_at)
        self.points.append((time_ns, gain))

    def check_order(self, time_ns, time_at):
        if not self.points or time_ns > self.points[-1][0]:
            return
        before_ns = self.points[-1][0]
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


class FileReader:
    """Reads a whole file, line by line and function by function."""

    def __init__(self, data):
        text = data.decode("latin-1").replace("\r\n", "\n").removesuffix("\r")
        # Files that were put one behind the other have byte-order marks in their middle, too.
        self.text = BYTE_ORDER_MARKS.sub("", text)
        self.line_starts = [0] + [match.end() for match in re.finditer("\n", self.text)]
        self.line = 0  # index into line_starts
        self.first_lines = {}  # mask value → line, also of functions with mistakes
        self.file = FunctionFile()

    def read(self):
        if "\0" in self.text:
            message = "a zero byte: this is no text file, or one in UTF-16; save it as UTF-8 or plain ASCII"
            self.report(self.text.index("\0"), message)
            return self.file
        while self.line < len(self.line_starts):
            self.read_line()
        if not self.first_lines and not self.file.errors:
            is_one_line = "\n" not in self.text.removesuffix("\n") and "\r" in self.text
            self.report(0, NO_FUNCTION + (OLD_LINE_ENDS if is_one_line else ""))
        self.file.diagnostics.sort(key=lambda diagnostic: (diagnostic.line, diagnostic.column))
        return self.file

    def read_line(self):
        """One line outside braces, or a whole function."""
        start = self.line_starts[self.line]
        if FUNCTION_START.match(self.text, start):
            self.read_function(BLANKS.match(self.text, start).end())
            return
        if match := STRAY_POINT_START.match(self.text, start):
            message = f"a line of control points outside braces; {WRITE_BRACES}"
            self.report(match.end() - 1, message)
        elif warning := self.comment_warning(start):
            message = f"taken as a comment: {warning}"
            self.report(BLANKS.match(self.text, start).end(), message, is_warning=True)
        self.line += 1

    def comment_warning(self, start):
        """What may be wrong with a comment line; None where it looks like any other."""
        if NO_FUNCTION_START.match(self.text, start):
            return "M is not followed by a mask value, as in M128"
        if SMALL_FUNCTION_START.match(self.text, start):
            return "a function starts with a capital M"
        if STRAY_MARK_START.match(self.text, start):
            return f"control points outside braces; {WRITE_BRACES}"
        # No-break spaces and byte-order marks are not seen in an editor.
        line = as_utf_8(self.text[BLANKS.match(self.text, start).end() : self.line_end(self.line)])
        invisible = INVISIBLE_OR_BLANK.match(line)[0]
        if invisible and FUNCTION_START.match(line, len(invisible)):
            name = shown(invisible.encode("utf-8").decode("latin-1"))
            return f"'{name}' stands before the M of a function"
        return None

    def read_function(self, start):
        first_line = self.line + 1
        self.line = self.line_after(start)
        reader = FunctionReader(self.text, start, self.line_end(self.line - 1), self.line_of)
        mistakes = []
        try:
            reader.read()
        except Mistake as mistake:
            mistakes.append((mistake.at, mistake.message))
        mistakes = reader.order_mistakes + mistakes
        if reader.tag is not None:
            earlier = self.first_lines.setdefault(reader.tag, first_line)
            if earlier != first_line:
                has_one = f"M{reader.tag} has a function already, on line {earlier}"
                message = f"{has_one}; each mask value has one"
                mistakes.insert(0, (start, message))
        for at, message in mistakes:
            self.report(at, message)
        if not mistakes:
            self.file.functions[reader.tag] = GainFunction(tuple(reader.points))

    def line_after(self, start):
        """Index of the line behind the function that starts at `start`."""
        name_end = WORD.match(self.text, start).end()
        # A brace that has slipped to a later line is a mistake, but still says where the function ends.
        brace_at = BLANKS_LINES_COMMENTS.match(self.text, name_end).end()
        if not self.text.startswith("{", brace_at):
            return self.line + 1
        line = self.line_of(brace_at) - 1
        from_at = brace_at
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

    def line_of(self, at):
        return bisect_right(self.line_starts, at)

    def report(self, at, message, is_warning=False):
        line = self.line_of(at)
        column = at - self.line_starts[line - 1] + 1
        self.file.diagnostics.append(Diagnostic(line, column, message, is_warning))


def parse_functions(data):
    """Reads the bytes of a function file. All its mistakes are found; see FunctionFile."""
    return FileReader(data).read()
