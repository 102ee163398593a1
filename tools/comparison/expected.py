"""Differences between two programs that are on purpose."""

from typing import NamedTuple


class Expected(NamedTuple):
    command: str  # a line of commands.txt
    what: tuple   # of "status", "stdout", "stderr" and names of files: all that may differ
    reason: str


SERIES = "a series says once, at its end, for how many pictures a warning holds, as sheets and videos do"
SHEETS = "sheets tell scripts what they were computed with, as pictures and videos do"

EXPECTED = [
    Expected("nutik-cl -m mask.pgm -k later.fn --every 2f --count 4 clip.tik -o motion-%d.ppm --json", ("stderr",), SERIES),
    Expected("nutik-cl -m mask.pgm -k later.fn --every 31ms grey.tik -o motion-%04d.pfm --precision double", ("stderr",), SERIES),
    Expected("nutik-cl contact --start 50ms --every 3f irregular.tik -o sheet.png --json", ("stdout",), SHEETS),
    Expected("nutik-cl sweep --start 0.1s --exposure 50ms --stretch 0.5..2/0.5 clip.mkv sheet.png --json --each each-%d.pfm",
             ("stdout",), SHEETS),
]
