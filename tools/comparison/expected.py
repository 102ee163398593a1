"""Differences between two programs that are on purpose."""

from typing import NamedTuple


class Expected(NamedTuple):
    command: str  # a line of commands.txt
    what: tuple   # of "status", "stdout", "stderr" and names of files: all that may differ
    reason: str


# None against the last program whose lines were compared; a change that means to differ says here why.
EXPECTED: list[Expected] = []
