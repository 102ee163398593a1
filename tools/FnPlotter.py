#!/usr/bin/python3
"""Draws the gain functions of a function file, to see what they do. docs/reference/functions.md has the format."""

import argparse
import os
import shutil
import sys
from functools import partial
from pathlib import Path

# Installed, the parts lie in share/nutik beside bin; in the source tree beside this file, where Python looks first.
sys.path.append(str(Path(__file__).resolve().parent.parent / "share" / "nutik"))

from fnplot.errors import InputError, UsageError, status_of  # noqa: E402
from fnplot.input import STANDARD_INPUT, title_of  # noqa: E402
from fnplot.mask import ranges_text, read_mask  # noqa: E402
from fnplot.output import add_output, check_format, missing_matplotlib, put_out  # noqa: E402
from fnplot.program import read_functions  # noqa: E402
from fnplot.times import parse_time  # noqa: E402

LONGEST_TITLE = 50  # characters
FILE_PAGE_HEIGHT, WINDOW_PAGE_HEIGHT = 11.5, 8.5  # inches
GRAPHS_PER_PAGE, MAX_GRAPHS_PER_PAGE = 8, 32

DESCRIPTION = """\
Draws every function of a function file, one below the other on a common time axis: areas that add
light in blue, areas that take it away hatched in orange, held ends dashed, the live interval as a bar.
In each graph's corner stands what the function comes to: D (how long it is not zero), its integral, and
its still gain (what a still scene is multiplied by). Mistakes in the file are all reported, as
file:line:column: message."""

EXAMPLES = """\
examples:
  FnPlotter.py ball.fn                          open a window
  FnPlotter.py ball.fn --capture clip.tik       with the capture's samples, and how much changes at each
  FnPlotter.py ball.fn --duration 3s            count what counts in a capture of 3 s
  FnPlotter.py ball.fn -o ball.png              write a picture (ball-1.png, ball-2.png ... where
                                                there are more than 8 functions)
  FnPlotter.py ball.fn -o ball.pdf              write a document, 8 functions to a page
  FnPlotter.py ball.fn --mask ball.pgm          only the functions that the mask uses
  FnPlotter.py ball.fn --zoom 399ms..411ms      look at 12 ms of it
  nutik-cl shutter hann --exposure 10ms | FnPlotter.py -

exit status: 0 drawn, 2 wrong usage, 3 mistakes in a file or no such file, 5 the plot cannot be drawn
or written (Matplotlib or nutik-cl is missing, there is no display, the folder does not exist)"""


def command_line():
    parser = argparse.ArgumentParser(
        prog="FnPlotter.py",
        description=DESCRIPTION,
        epilog=EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    parser.add_argument("file", metavar="FILE.fn", help="the function file; - is standard input")
    add_output(parser)
    parser.add_argument("--duration", metavar="TIME", help="the capture's duration: 3s, 250ms, 1/100s")
    capture_help = "a capture: draw its samples and how much changes, count what counts in it"
    parser.add_argument("--capture", metavar="CLIP.tik", help=capture_help)
    program_help = "nutik-cl, which reads files (default: the one beside this, in PATH, else in build/)"
    parser.add_argument("--program", metavar="PATH", help=program_help)
    parser.add_argument("--mask", metavar="MASK", help="a mask (PGM or PNG): draw only the functions it uses")
    parser.add_argument("--zoom", metavar="FROM..TO", help="the time to draw; before 0: --zoom=-1ms..5ms")
    per_page_help = f"functions to a page, 1 to {MAX_GRAPHS_PER_PAGE} (default: {GRAPHS_PER_PAGE})"
    parser.add_argument("--per-page", metavar="N", default=str(GRAPHS_PER_PAGE), help=per_page_help)
    return parser


def parse_duration(text):
    duration_ns = parse_time(text, "duration")
    if duration_ns <= 0:
        raise UsageError(f"duration '{text}' is not longer than nothing")
    return duration_ns


def parse_zoom(text):
    begin, dots, end = text.partition("..")
    if not dots:
        raise UsageError(f"zoom '{text}' is no stretch of time; write two times: 399ms..411ms")
    zoom_ns = parse_time(begin, "zoom"), parse_time(end, "zoom")
    if zoom_ns[0] >= zoom_ns[1]:
        raise UsageError(f"zoom '{text}' ends before it starts")
    return zoom_ns


def parse_per_page(text):
    if not text.isascii() or not text.isdigit() or not 1 <= int(text[:9]) <= MAX_GRAPHS_PER_PAGE:
        raise UsageError(f"--per-page '{text}' is no whole number 1 … {MAX_GRAPHS_PER_PAGE}")
    return int(text)


def find_program():
    """nutik-cl where a user has it: beside this file, in PATH, or built beside these tools."""
    here = Path(__file__).resolve().parent
    places = (here / "nutik-cl", shutil.which("nutik-cl"), here.parent / "build" / "nutik-cl")
    return str(next((path for path in places if path and Path(path).exists()), "nutik-cl"))


def warn(message):
    print(f"warning: {message}", file=sys.stderr)


def functions_in_use(functions, pixels, file_name, mask_name):
    """The functions that a mask (pixels by mask value) uses; says what is without its counterpart."""
    used = {tag: function for tag, function in functions.items() if tag in pixels}
    unmapped = [tag for tag in pixels if tag not in functions]
    unused = [tag for tag in functions if tag not in pixels]
    if unmapped:
        count = sum(pixels[tag] for tag in unmapped)
        values = ranges_text(unmapped)
        warn(f"{mask_name}: mask values without a function: {values} ({count} pixels)")
    if not used:
        raise InputError(
            f"{mask_name} uses no function of {file_name}, which has functions for {ranges_text(functions)}"
        )
    if unused:
        warn(f"{mask_name}: functions that it does not use: {ranges_text(unused)}")
    return used


def heading_of(file_name):
    """The file's own name, shortened in its middle where it is too long for a page."""
    name = os.fsencode(Path(title_of(file_name)).name).decode("utf-8", errors="replace")
    half = LONGEST_TITLE // 2
    return name if len(name) <= LONGEST_TITLE else f"{name[:half]}…{name[-half:]}"


def page_drawings(functions, pixels, options):
    """What draws each page, called with the figure to draw on."""
    try:
        from fnplot import backdrops, graphs, pages
        from fnplot.capture import read_capture
        from fnplot.view import make_view
    except ImportError as error:
        raise missing_matplotlib(error) from None

    used = functions_in_use(functions, pixels, title_of(options.file), options.mask) if pixels else functions
    share = {tag: count / sum(pixels.values()) for tag, count in pixels.items()} if pixels else {}
    capture = read_capture(options.capture, options.program) if options.capture else None
    duration_ns = capture.duration_ns if capture else options.duration
    view = make_view(functions.values(), duration_ns, options.zoom)
    behind = [backdrops.OutsideCapture()]
    if capture:
        behind += [backdrops.SampleGrid(capture, view), backdrops.Activity(capture, view)]
    page_height = FILE_PAGE_HEIGHT if options.output else WINDOW_PAGE_HEIGHT
    layout = pages.Layout.fitting(len(used), options.per_page, page_height)
    sheets = layout.paginate([graphs.Graph(tag, used[tag], share.get(tag)) for tag in sorted(used)])
    name = heading_of(options.file)
    drawings = []
    for number, sheet in enumerate(sheets, start=1):
        title = f"{name}, page {number} of {len(sheets)}" if len(sheets) > 1 else name
        page = {"graphs": sheet, "height": layout.graph_height, "title": title}
        drawings.append(partial(pages.draw_page, view=view, backdrops=behind, **page))
    return drawings


def plot(options):
    if options.duration and options.capture:
        raise UsageError("--duration and --capture both say how long the capture is; use one")
    options.duration = parse_duration(options.duration) if options.duration else None
    options.zoom = parse_zoom(options.zoom) if options.zoom else None
    options.per_page = parse_per_page(options.per_page)
    check_format(options.output)
    if STANDARD_INPUT in (options.mask, options.capture):
        raise UsageError("only the function file is read from standard input; name a file")
    options.program = options.program or find_program()
    functions, warnings = read_functions(options.file, options.program)
    if warnings:
        print(warnings, file=sys.stderr)
    pixels = read_mask(options.mask) if options.mask else None
    put_out(page_drawings(functions, pixels, options), options, (options.file, options.mask, options.capture))


if __name__ == "__main__":
    sys.exit(status_of("FnPlotter.py", plot, command_line().parse_args()))
