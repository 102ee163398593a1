"""What is wrong with a function file, shown as nutik-cl shows it.

always:  in the order of the text; of each severity at most MAX_SHOWN are kept, the first in the file, and
         the others are counted
"""

from bisect import insort_right
from dataclasses import dataclass

from fnplot.source_text import Excerpt

MAX_SHOWN = 20


@dataclass(frozen=True)
class Diagnostic:
    """A mistake (or, with `is_warning`, a line that looks like one) and its place in the file."""

    line: int
    column: int
    message: str
    is_warning: bool
    excerpt: Excerpt

    @property
    def place(self):
        return self.line, self.column

    def text(self, file_name):
        """`motion.fn:3:14: time 5 is not after 9; …`, the line, and a mark under the place."""
        kind = "warning: " if self.is_warning else ""
        first = f"{file_name}:{self.line}:{self.column}: {kind}{self.message}"
        if not self.excerpt.text or "\\x00" in self.excerpt.text:
            return first  # an empty line shows nothing
        return f"{first}\n    {self.excerpt.text}\n    {self.excerpt.indent}^"


class Diagnostics:
    """Errors and warnings of one file."""

    def __init__(self):
        self.shown = []
        self.counts = {"mistake": 0, "warning": 0}  # all of them, also those that are not shown

    def add(self, place, message, is_warning, excerpt_of_place):
        """Of several at one place the first added is first; excerpts are only made of what is kept."""
        kind = "warning" if is_warning else "mistake"
        self.counts[kind] += 1
        if self.counts[kind] > MAX_SHOWN:
            # A mistake may be found after those behind it: an open brace at the end of the file.
            last = max(i for i, other in enumerate(self.shown) if other.is_warning == is_warning)
            if place >= self.shown[last].place:
                return
            del self.shown[last]
        diagnostic = Diagnostic(*place, message, is_warning, excerpt_of_place())
        insort_right(self.shown, diagnostic, key=lambda other: other.place)

    def report(self, file_name):
        """Those that are shown, one below the other, and how many more there are; empty where none are."""
        texts = [diagnostic.text(file_name) for diagnostic in self.shown]
        for kind, count in self.counts.items():
            if count > MAX_SHOWN:
                plural = "" if count == MAX_SHOWN + 1 else "s"
                texts.append(f"{file_name}: and {count - MAX_SHOWN} more {kind}{plural}")
        return "\n".join(texts)
