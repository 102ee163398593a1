"""Writes pages to files, or shows them in windows.

A page is given as a function that draws it on a figure. Files appear whole or not at all: they are written
in a folder of their own and moved to their places when all are there.
"""

import os
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from fnplot.errors import OutputError, UsageError

FORMATS = (".png", ".svg", ".pdf")
PNG_DOTS_PER_INCH = 120
BACKENDS_WITHOUT_WINDOWS = {"agg", "cairo", "pdf", "pgf", "ps", "svg", "template"}


def add_output(parser):
    """The options that say where pages go; check_format() and put_out() look at them."""
    parser.add_argument("-o", "--output", metavar="FILE", type=Path, help="write a .png, .svg or .pdf, open no window")
    parser.add_argument("--overwrite", action="store_true", help="replace files that are there already")


def check_format(output):
    if output and output.suffix.lower() not in FORMATS:
        raise UsageError(f"'{output}' is no .png, .svg or .pdf; these can be written")


def check_places(outputs, inputs, overwrite):
    """Refuses the name of an input (those that are None are not there), and of what is there already, unless asked."""
    for output in filter(os.path.lexists, outputs):
        if any(name and output.exists() and Path(name).exists() and output.samefile(name) for name in inputs):
            raise UsageError(f"'{output}' is the input; write the plot to another file")
        if not overwrite:
            raise UsageError(f"{output} is there already and is not replaced; choose another name, or replace it with "
                             "--overwrite")


def missing_matplotlib(error):
    """The error to raise where drawing cannot be imported."""
    return OutputError(f"Matplotlib cannot be loaded by {sys.executable} ({error}); "
                       "Debian has it for /usr/bin/python3: apt install python3-matplotlib")


def put_out(drawings, options, inputs):
    """Writes pages to a file, which is none of these inputs, or shows them where none is named."""
    if options.output:
        names = page_names(options.output, len(drawings))
        check_places(names, inputs, options.overwrite)
        write_pages(drawings, options.output, names)
    else:
        show_pages(drawings)


def page_names(output, count):
    """plot.png, or plot-01.png, plot-02.png … where there are several pages; a PDF holds all."""
    if count == 1 or output.suffix.lower() == ".pdf":
        return [output]
    digits = len(str(count))
    pages = range(1, count + 1)
    return [output.with_name(f"{output.stem}-{page:0{digits}}{output.suffix}") for page in pages]


def write_pages(drawings, output, names):
    """A file of these names for each page, or one PDF of them all."""
    try:
        from matplotlib.backends.backend_pdf import PdfPages
        from matplotlib.figure import Figure
    except ImportError as error:
        raise missing_matplotlib(error) from None

    def drawn(drawing):
        figure = Figure()
        drawing(figure)
        return figure

    kind = output.suffix.lower()
    try:
        with TemporaryDirectory(prefix=".", dir=output.parent) as folder:
            written = [Path(folder) / f"{page}{kind}" for page in range(len(names))]
            if kind == ".pdf":
                with PdfPages(written[0]) as document:
                    for drawing in drawings:
                        document.savefig(drawn(drawing))
            else:
                for drawing, page in zip(drawings, written):
                    drawn(drawing).savefig(page, dpi=PNG_DOTS_PER_INCH)
            for page, name in zip(written, names):
                os.replace(page, name)
    except OSError as error:
        raise OutputError(f"{output} cannot be written: {error.strerror or error}") from None


def show_pages(drawings):
    """One window for each page, until all are closed."""
    try:
        import matplotlib
        from matplotlib import pyplot
    except ImportError as error:
        raise missing_matplotlib(error) from None

    matplotlib.rcParams["figure.max_open_warning"] = 0
    for drawing in drawings:
        drawing(pyplot.figure())
    if matplotlib.get_backend().lower() in BACKENDS_WITHOUT_WINDOWS:
        raise OutputError("there is no display to open a window on; write a file: -o plot.png")
    pyplot.show()
