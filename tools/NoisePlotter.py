#!/usr/bin/python3
"""Draws a camera's noise: measured points and the curve that is used. docs/reference/noise-files.md has the format."""

import argparse
import sys
from functools import partial
from pathlib import Path

# Installed, the parts lie in share/nutik beside bin; in the source tree beside this file, where Python looks first.
sys.path.append(str(Path(__file__).resolve().parent.parent / "share" / "nutik"))

from fnplot.errors import status_of  # noqa: E402
from fnplot.input import title_of  # noqa: E402
from fnplot.output import add_output, check_format, put_out  # noqa: E402
from noiseplot.noise_file import read_noise  # noqa: E402
from noiseplot.page import draw  # noqa: E402

DESCRIPTION = """\
Draws a noise file, one graph for each channel: the standard deviation of a code over the code. Dots are
what was measured, larger where there were more pixels; the line is the curve that is used, sensor or
points; the sensor's curve is thin and dashed where it is not."""

EXAMPLES = """\
examples:
  NoisePlotter.py camera.noise                  open a window
  NoisePlotter.py camera.noise -o camera.png    write a picture (.png, .svg or .pdf)

exit status: 0 drawn, 2 wrong usage, 3 mistakes in the file or no such file, 5 the plot cannot be drawn
or written (Matplotlib is missing, there is no display, the folder does not exist)"""


def command_line():
    parser = argparse.ArgumentParser(prog="NoisePlotter.py", description=DESCRIPTION, epilog=EXAMPLES,
                                     formatter_class=argparse.RawDescriptionHelpFormatter, allow_abbrev=False)
    parser.add_argument("file", metavar="FILE.noise", help="the noise file; - is standard input")
    add_output(parser)
    return parser


def plot(options):
    check_format(options.output)
    title = Path(title_of(options.file)).name
    put_out([partial(draw, noise=read_noise(options.file), title=title)], options, (options.file,))


if __name__ == "__main__":
    sys.exit(status_of("NoisePlotter.py", plot, command_line().parse_args()))
