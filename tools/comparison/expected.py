"""Differences between two programs that are on purpose."""

from typing import NamedTuple


class Expected(NamedTuple):
    command: str  # a line of commands.txt
    what: tuple   # of "status", "stdout", "stderr" and names of files: all that may differ
    reason: str


PICTURES_OF_THE_LIST = ("plain.png", "soft.ppm", "two words.tif")
NOISE_NOTE = "the note on noise that is no sensor's says \"transfer function\": libraries name no option"

BATCH = "recipes of batch's pictures left out --noise and --sigmas, and --no-recipe was not heard"
PICTURES_OF_LIST = ("plain.png", "soft.ppm", "two words.tif")

EXPECTED = [
    Expected("nutik-cl batch list.txt noisy.mkv --noise flat.noise --sigmas 2", PICTURES_OF_LIST, BATCH),
    Expected("nutik-cl batch list.txt noisy.mkv --noise auto -q && nutik-cl again plain.png",
             ("stdout",) + PICTURES_OF_LIST, BATCH),
    Expected("nutik-cl batch list.txt clip.tik --no-recipe", PICTURES_OF_LIST, BATCH),
    Expected("nutik-cl encode noisy.mkv out.tik --noise auto", ("stderr",), NOISE_NOTE),
    Expected("nutik-cl -m mask.pgm -k regions.fn noisy.mkv picture.png --noise auto --sigmas 4", ("stderr",), NOISE_NOTE),
    Expected("nutik-cl noise still.mkv -o camera.noise", ("stderr",), NOISE_NOTE),
    Expected("nutik-cl batch list.txt noisy.mkv --noise flat.noise --sigmas 2", PICTURES_OF_THE_LIST,
             "their recipes left out --noise and --sigmas, and did not make them"),
    Expected("nutik-cl batch list.txt noisy.mkv --noise auto -q && nutik-cl again plain.png",
             ("stdout", "stderr", *PICTURES_OF_THE_LIST), "their recipes left out --noise, and did not make them"),
    Expected("nutik-cl batch list.txt clip.tik --no-recipe", PICTURES_OF_THE_LIST,
             "they carried recipes although none were wanted"),
    Expected("for shell in bash zsh fish; do nutik-cl completion $shell; done", ("stdout",),
             "the scripts ask the program"),
]
