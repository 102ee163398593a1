"""Reads what is drawn of a capture: its end, its samples' exposures, and how much changes at each.

The file's footer (docs/reference/tik-format.md) says how long the capture is. All else is asked of nutik-cl:
`nutik-cl activity --csv - clip.tik` prints a line of CSV for each sample, with the columns below.
"""

import csv
import struct
from dataclasses import dataclass

import numpy as np

from fnplot.errors import InputError
from fnplot.gain_function import LARGEST_TIME_NS
from fnplot.program import failure_of, run_program

FOOTER = struct.Struct("<4Qq80x8s")  # samples, blocks, two offsets, end of the capture in ns; magic
FOOTER_MAGIC = b"TIKend 0"
COLUMNS = ("start_ns", "end_ns", "changed_share")


@dataclass(frozen=True)
class Capture:
    """The samples of a capture, in time order, as arrays."""

    duration_ns: int  # T_end, where the domain ends
    starts_ns: np.ndarray  # of the exposures
    ends_ns: np.ndarray
    changed: np.ndarray  # share of the pixels that change at each sample, 0 … 1

    def __len__(self):
        return len(self.starts_ns)


def read_capture(path, program):
    """A .tik capture; `program` is nutik-cl."""
    sample_count, duration_ns = read_footer(path)
    table = read_table(path, run_activity(path, program))
    if len(table) != sample_count:
        raise InputError(f"{path} has {sample_count} samples, but {program} lists {len(table)}")
    starts_ns, ends_ns, changed = zip(*table)
    return Capture(
        duration_ns, np.array(starts_ns, np.int64), np.array(ends_ns, np.int64), np.array(changed)
    )


def read_footer(path):
    """The number of samples and the end of the capture."""
    try:
        with open(path, "rb") as file:
            front = file.read(2)
            size = file.seek(0, 2)
            file.seek(max(0, size - FOOTER.size))
            footer = file.read()
    except OSError as error:
        raise InputError(f"{path}: {error.strerror}") from None
    if front not in (b"P5", b"P6"):
        raise InputError(f"{path} is no .tik capture; make one: nutik-cl encode clip.mp4 clip.tik")
    if len(footer) < FOOTER.size or not footer.endswith(FOOTER_MAGIC):
        way_out = "nutik-cl recover saves what is whole of a capture that was cut off"
        raise InputError(f"{path} does not end as a .tik capture of version 0 does; {way_out}")
    sample_count, _, _, _, duration_ns, _ = FOOTER.unpack(footer)
    if sample_count == 0 or not 0 < duration_ns <= LARGEST_TIME_NS:
        raise InputError(f"{path}: its footer is damaged ({sample_count} samples in {duration_ns} ns)")
    return sample_count, duration_ns


def run_activity(path, program):
    """What the program prints of a capture."""
    run = run_program(program, "activity", "--csv", "-", str(path))
    if run.returncode != 0:
        raise failure_of(run, f"{program} activity {path}")
    return run.stdout


def read_table(path, text):
    """(start, end, share that changes) of every sample."""
    table = []
    try:
        for row in csv.DictReader(text.splitlines()):
            start_ns, end_ns, changed = (row[name] for name in COLUMNS)
            table.append((int(start_ns), int(end_ns), float(changed)))
            if not 0 <= table[-1][2] <= 1:
                raise ValueError(f"a share of {changed}")
    except (KeyError, TypeError, ValueError) as error:
        columns = ", ".join(COLUMNS)
        what = f"what nutik-cl says of sample {len(table)} cannot be understood ({error})"
        raise InputError(f"{path}: {what}; a table with the columns {columns} was expected") from None
    return table
