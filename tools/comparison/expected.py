"""Differences between two programs that are on purpose."""

from typing import NamedTuple


class Expected(NamedTuple):
    command: str  # a line of commands.txt
    what: tuple   # of "status", "stdout", "stderr" and names of files: all that may differ
    reason: str


NOISE_NOTE = "the note on noise that is no sensor's says \"transfer function\": libraries name no option"
BATCH = "recipes of batch's pictures left out --noise and --sigmas, and --no-recipe was not heard"
OPTIONS = "libraries say what helps, and the program adds what it calls that: (--fps)"
BOUNDS = "bounds count fewer roundings: a block's first sum has none"
SELF_TEST = "devices tells how drivers did in their self-test"
BLOCKS = "a block ends with what changes, not with the samples' size; the manual knows NUTIK_SELF_TEST"
PICTURES_OF_LIST = ("plain.png", "soft.ppm", "two words.tif")

EXPECTED = [
    Expected("nutik-cl batch list.txt noisy.mkv --noise flat.noise --sigmas 2", PICTURES_OF_LIST, BATCH),
    Expected("nutik-cl batch list.txt noisy.mkv --noise auto -q && nutik-cl again plain.png",
             ("stdout", "stderr", *PICTURES_OF_LIST), BATCH),
    Expected("nutik-cl batch list.txt clip.tik --no-recipe", PICTURES_OF_LIST, BATCH),
    Expected("nutik-cl encode noisy.mkv out.tik --noise auto", ("stderr",), NOISE_NOTE),
    Expected("nutik-cl -m mask.pgm -k regions.fn noisy.mkv picture.png --noise auto --sigmas 4", ("stderr",), NOISE_NOTE),
    Expected("nutik-cl noise still.mkv -o camera.noise", ("stderr",), NOISE_NOTE),
    Expected("for shell in bash zsh fish; do nutik-cl completion $shell; done", ("stdout",),
             "the scripts ask the program"),
    Expected("nutik-cl --start 10ms --exposure 40ms none.tik picture.png -v", ("stdout",), BOUNDS),
    Expected("nutik-cl --exposure 9ms --every 10ms --shutter triangle deep.tik -o soft-%d.tif -v", ("stdout",), BOUNDS),
    Expected("nutik-cl video deep.tik out.mkv --depth 16 -v", ("stdout",), BOUNDS),
    Expected("nutik-cl check -m speck.pgm -k suspicious.fn clip.tik", ("stdout",), OPTIONS),
    Expected("nutik-cl check --json -m turned.pgm -k wrong.fn clip.mkv", ("stdout",), OPTIONS),
    Expected("nutik-cl validate --runs 1 --start 0s --exposure 0.2s clip.tik", ("stdout",), BOUNDS),
    Expected("nutik-cl validate --runs 1 --json -m mask.pgm -k regions.fn --depth 16 grey.tik", ("stdout",), BOUNDS),
    Expected("nutik-cl validate --runs 1 --start 0s --exposure 0.2s --source clip.mkv clip.tik", ("stdout",), BOUNDS),
    Expected("nutik-cl validate --runs 1 --start 0s --exposure 0.2s --source lossy.mp4 near.tik --json", ("stdout",), BOUNDS),
    Expected("nutik-cl devices", ("stdout",), SELF_TEST),
    Expected("nutik-cl devices --json", ("stdout",), SELF_TEST),
    Expected("nutik-cl expose -m speck.pgm -k regions.fn clip.tik picture.png", ("stderr",), OPTIONS),
    Expected("nutik-cl expose -k one.fn one.fn picture.png", ("stderr",), OPTIONS),
    Expected("nutik-cl encode stills out.tik", ("stderr",), OPTIONS),
    Expected("nutik-cl encode table.csv out.tik --white 100", ("stderr",), OPTIONS),
    Expected("nutik-cl encode deep.mkv out.tik --noise flat.noise", ("stderr",), OPTIONS),
    Expected("for command in encode info recover noise expose batch video again; do nutik-cl $command --help; done", ("stdout",), BLOCKS),
    Expected("for command in check trace validate mask contact activity sweep shutter devices; do nutik-cl $command --help; done", ("stdout",), BLOCKS),
    Expected("nutik-cl man", ("stdout",), BLOCKS),
]
