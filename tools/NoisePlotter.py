#!/usr/bin/env python3
"""Draws a camera's noise: measured points and the curve that is used. docs/noise.md has the format."""

import argparse
import sys
from functools import partial
from pathlib import Path

from fnplot.errors import PlotterError
from fnplot.output import check_output, missing_matplotlib, put_out
from noiseplot.noise_file import read_noise

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
    parser.add_argument("file", metavar="FILE.noise", help="the noise file")
    parser.add_argument("-o", "--output", metavar="FILE", help="write a .png, .svg or .pdf, open no window")
    return parser


def page_drawing(noise, title):
    """What draws the page, called with the figure to draw on."""
    try:
        from noiseplot.page import draw
    except ImportError as error:
        raise missing_matplotlib(error) from None
    return partial(draw, noise=noise, title=title)


def plot(options):
    output = Path(options.output) if options.output else None
    if output:
        check_output(output, (options.file,))
    put_out([page_drawing(read_noise(options.file), Path(options.file).name)], output)


def main():
    options = command_line().parse_args()
    try:
        plot(options)
    except PlotterError as error:
        print(f"NoisePlotter.py: {error}", file=sys.stderr)
        return error.status
    return 0


if __name__ == "__main__":
    sys.exit(main())
