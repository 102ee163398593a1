#!/usr/bin/env python3
"""Draws a camera's noise: measured points and the curve that is used. docs/noise.md has the format."""

import argparse
import sys
from pathlib import Path

from fnplot.errors import InputError, OutputError, PlotterError, UsageError
from noiseplot.noise_file import read_noise

FORMATS = (".png", ".svg", ".pdf")
PNG_DOTS_PER_INCH = 120

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


def check_output(output, file):
    if output.suffix.lower() not in FORMATS:
        raise UsageError(f"'{output}' is no .png, .svg or .pdf; these can be written")
    if output.exists() and Path(file).exists() and output.samefile(file):
        raise UsageError(f"'{output}' is the input; write the plot to another file")


def load_pages():
    try:
        from noiseplot import page
    except ImportError as error:
        way_out = "on Debian: apt install python3-matplotlib"
        raise OutputError(f"Matplotlib cannot be loaded ({error}); {way_out}") from None
    return page


def plot(options):
    output = Path(options.output) if options.output else None
    if output:
        check_output(output, options.file)
    noise = read_noise(options.file)
    page = load_pages()
    title = Path(options.file).name
    if output is None:
        page.show(noise, title)
        return
    try:
        page.draw(noise, title).savefig(output, dpi=PNG_DOTS_PER_INCH)
    except OSError as error:
        raise OutputError(f"{error.filename or output}: {error.strerror or error}") from None


def main():
    options = command_line().parse_args()
    try:
        plot(options)
    except PlotterError as error:
        print(error, file=sys.stderr)
        return error.status
    return 0


if __name__ == "__main__":
    sys.exit(main())
