"""Differences between two programs that are on purpose."""

from typing import NamedTuple


class Expected(NamedTuple):
    command: str  # a line of commands.txt
    what: tuple   # of "status", "stdout", "stderr" and names of files: all that may differ
    reason: str


BATCH_FORGOT = "batch left --noise, --sigmas and --no-recipe behind it out of its pictures' recipes"
NOISE_NOTE = "the note on noise that is no sensor's says \"transfer function\": libraries name no option"

EXPECTED = [
    Expected("nutik-cl encode noisy.mkv out.tik --noise auto", ("stderr",), NOISE_NOTE),
    Expected("nutik-cl -m mask.pgm -k regions.fn noisy.mkv picture.png --noise auto --sigmas 4", ("stderr",), NOISE_NOTE),
    Expected("nutik-cl noise still.mkv -o camera.noise", ("stderr",), NOISE_NOTE),
    Expected("nutik-cl batch list.txt noisy.mkv --noise flat.noise --sigmas 2",
             ("plain.png", "two words.tif", "soft.ppm"), BATCH_FORGOT),
    Expected("nutik-cl batch list.txt noisy.mkv --noise auto -q && nutik-cl again plain.png",
             ("stdout", "plain.png", "two words.tif", "soft.ppm"), BATCH_FORGOT),
    Expected("nutik-cl batch list.txt clip.tik --no-recipe", ("plain.png", "two words.tif", "soft.ppm"), BATCH_FORGOT),
]
