"""The text of a function file as people are shown it.

in:      pieces of the file, decoded as Latin-1: a character is a byte
out:     one line of printable text, short and whole characters, whatever bytes the file is made of
"""

import re
from dataclasses import dataclass
from itertools import islice

# Controls, blanks that look like a space but are none, and what terminals do not show or obey.
INVISIBLE = re.compile(
    "[\0-\x1f\x7f-\xa0\xad\u061c\u180e\u2000-\u200f\u2028-\u202f\u205f-\u206f\u3000\ufe00-\ufe0f"
    "\ufeff\ufff0-\ufffb\ufffe\uffff\U000e0000-\U000e0fff]"
)
INVISIBLE_OR_BLANK = re.compile(f"(?:{INVISIBLE.pattern}| )*")

LONGEST_PIECE = 40  # characters of the file in a message
LONGEST_EXCERPT = 100  # bytes of the file
LONGEST_CHARACTER = 4  # bytes of UTF-8
CONTINUATIONS = "".join(map(chr, range(0x80, 0xC0)))  # bytes within a character of UTF-8


@dataclass(frozen=True)
class Excerpt:
    """The part of a line round a place, and what puts a ^ under the place when printed below it."""

    text: str
    indent: str


def as_utf_8(text):
    """The characters of a piece of the file; bytes that are no UTF-8 as lone surrogates."""
    return text.encode("latin-1").decode("utf-8", errors="surrogateescape")


def printable(character):
    """A character as it is, or an escape for one that would not be seen."""
    code = ord(character)
    if 0xDC80 <= code <= 0xDCFF:
        return f"\\x{code - 0xDC00:02x}"
    if not INVISIBLE.match(character):
        return character
    if character in "\t\r":
        return ascii(character)[1:-1]
    if code < 0x80:
        return f"\\x{code:02x}"
    return f"\\u{code:04x}" if code <= 0xFFFF else f"\\U{code:08x}"


def shown(text):
    """A piece of the file for a message."""
    # What is cut off is never looked at: a word may be as long as the file.
    characters = as_utf_8(text[: LONGEST_CHARACTER * (LONGEST_PIECE + 1)])
    readable = list(islice(map(printable, characters), LONGEST_PIECE + 1))
    return "".join(readable[:LONGEST_PIECE]) + ("…" if len(readable) > LONGEST_PIECE else "")


def excerpt(text, line_start, at):
    """The part of the line round the offset `at`; takes the same time on a line of any length."""
    begin = line_start
    if at - line_start > LONGEST_EXCERPT // 2:
        begin = at - LONGEST_EXCERPT // 2
        while begin < at and text[begin] in CONTINUATIONS:
            begin += 1
    line = text[begin : begin + LONGEST_EXCERPT + LONGEST_CHARACTER].partition("\n")[0]
    cut = "… " if begin > line_start else ""
    parts, indent, next_at = [cut], " " * len(cut), begin
    for character in as_utf_8(line):
        if next_at >= begin + LONGEST_EXCERPT:
            parts.append(" …")
            break
        part = "\t" if character == "\t" else printable(character)
        parts.append(part)
        if next_at < at:
            indent += "\t" if character == "\t" else " " * len(part)
        next_at += len(character.encode("utf-8", errors="surrogateescape"))
    return Excerpt("".join(parts), indent)
