"""Reads function files. docs/reference/functions.md has the format.

in:      the bytes of a file
out:     its gain functions by mask value, and a diagnostic for every mistake
always:  places are counted from 1, columns in bytes; a function with a mistake is left out; diagnostics
         are what nutik-cl says of the file, word for word, each one line of printable text

A function's extent (its line, or everything up to its closing brace) is found before its control points
are read. So a mistake in it never reaches the lines behind it.
"""

import re
from bisect import bisect_right
from dataclasses import dataclass, field
from functools import partial

from fnplot.diagnostics import Diagnostics
from fnplot.function_numbers import Mistake
from fnplot.function_reader import (
    BLANK,
    BLANKS,
    BLANKS_LINES_COMMENTS,
    FUNCTION_START,
    WORD,
    WRITE_BRACES,
    FunctionReader,
)
from fnplot.gain_function import GainFunction
from fnplot.source_text import INVISIBLE_OR_BLANK, as_utf_8, excerpt, shown

NO_FUNCTION_START = re.compile(BLANK + r"*M")
SMALL_FUNCTION_START = re.compile(BLANK + r"*m[0-9]")
STRAY_POINT_START = re.compile(BLANK + r"*\[")
STRAY_MARK_START = re.compile(rf"{BLANK}*[,{{]{BLANK}*\[")
# The end of a function in braces: its closing brace, or the next function. Comments hide a brace.
BRACES_END = re.compile(rf"#[^\n]*|\}}|\n{BLANK}*M[0-9]")
BYTE_ORDER_MARKS = re.compile("^(?:\xef\xbb\xbf)+", re.MULTILINE)
NO_FUNCTION = "no function in this file; a function is a line like M0 [0:1], [10000000:1], [10000001:0]"
OLD_LINE_ENDS = "; its lines end in carriage returns: save it with line ends of Unix or Windows"


@dataclass
class FunctionFile:
    """What a function file holds."""

    functions: dict[int, GainFunction] = field(default_factory=dict)  # by mask value
    diagnostics: Diagnostics = field(default_factory=Diagnostics)

    @property
    def has_errors(self):
        return self.diagnostics.counts["mistake"] > 0


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
        if not self.first_lines and not self.file.has_errors:
            is_one_line = "\n" not in self.text.removesuffix("\n") and "\r" in self.text
            self.report(0, NO_FUNCTION + (OLD_LINE_ENDS if is_one_line else ""))
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
            self.file.functions[reader.tag] = GainFunction(reader.times_ns, reader.gains)

    def line_after(self, start):
        """Index of the line behind the function that starts at `start`."""
        name_end = WORD.match(self.text, start).end()
        # A brace that has slipped to a later line is a mistake, but still says where the function ends.
        brace_at = BLANKS_LINES_COMMENTS.match(self.text, name_end).end()
        if not self.text.startswith("{", brace_at):
            return self.line + 1
        for match in BRACES_END.finditer(self.text, brace_at):
            if match[0].startswith("\n"):
                return self.line_of(match.end()) - 1
            if match[0] == "}":
                return self.line_of(match.start())
        return len(self.line_starts)

    def line_end(self, line):
        """Offset of the end of a line, without its newline."""
        last = line + 1 == len(self.line_starts)
        return len(self.text) if last else self.line_starts[line + 1] - 1

    def line_of(self, at):
        return bisect_right(self.line_starts, at)

    def report(self, at, message, is_warning=False):
        line = self.line_of(at)
        line_start = self.line_starts[line - 1]
        place = line, at - line_start + 1
        excerpt_of_place = partial(excerpt, self.text, line_start, at)
        self.file.diagnostics.add(place, message, is_warning, excerpt_of_place)


def parse_functions(data):
    """Reads the bytes of a function file. All its mistakes are found; see FunctionFile."""
    return FileReader(data).read()
