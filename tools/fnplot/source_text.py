"""The text of a function file as people are shown it.

in:      pieces of the file, decoded as Latin-1: a character is a byte
out:     one line of printable text, short and whole characters, whatever bytes the file is made of
"""

import re
from itertools import islice

# Controls, blanks that look like a space but are none, and what terminals do not show or obey.
INVISIBLE = re.compile(
    "[\0-\x1f\x7f-\xa0\xad\u061c\u180e\u2000-\u200f\u2028-\u202f\u205f-\u206f\u3000\ufe00-\ufe0f"
    "\ufeff\ufff0-\ufffb\ufffe\uffff\U000e0000-\U000e0fff]"
)
INVISIBLE_OR_BLANK = re.compile(f"(?:{INVISIBLE.pattern}| )*")

LONGEST_PIECE = 40  # characters of the file in a message


def as_utf_8(text):
    """The characters of a piece of the file; bytes that are no UTF-8 as lone surrogates."""
    return text.encode("latin-1").decode("utf-8", errors="surrogateescape")


def readable(text):
    """The characters of a piece of the file for a message, whatever bytes it is made of."""
    for character in as_utf_8(text):
        code = ord(character)
        if 0xDC80 <= code <= 0xDCFF:
            yield f"\\x{code - 0xDC00:02x}"
        elif not INVISIBLE.match(character):
            yield character
        elif character in "\t\r":
            yield ascii(character)[1:-1]
        elif code < 0x80:
            yield f"\\x{code:02x}"
        else:
            yield f"\\u{code:04x}" if code <= 0xFFFF else f"\\U{code:08x}"


def shown(text):
    characters = list(islice(readable(text), LONGEST_PIECE + 1))
    return "".join(characters[:LONGEST_PIECE]) + ("…" if len(characters) > LONGEST_PIECE else "")
