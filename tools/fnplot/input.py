"""Reads what a plotter draws: a file, or standard input where its name is `-`."""

import sys
from pathlib import Path

from fnplot.errors import InputError

STANDARD_INPUT = "-"


def title_of(name):
    """What messages and pages call an input."""
    return "standard input" if name == STANDARD_INPUT else name


def read_input(name):
    """Its bytes."""
    try:
        return sys.stdin.buffer.read() if name == STANDARD_INPUT else Path(name).read_bytes()
    except OSError as error:
        raise InputError(f"{title_of(name)}: {error.strerror}") from None
