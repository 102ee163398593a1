#!/usr/bin/env python3
"""Holds FnPlotter.py to the shared corpus of function files, and its plots to what they must show.

    check_fnplotter.py --plotter tools/FnPlotter.py --corpus tests/corpus/functions --work FOLDER

Plots are left in FOLDER. Without Matplotlib only the parser is checked, and the other tests are skipped.
"""

import argparse
import importlib.util
import io
import json
import os
import re
import subprocess
import sys
import unittest
import zlib
from fractions import Fraction
from itertools import combinations
from pathlib import Path

PLOTTER = CORPUS = WORK = None  # set by main()

FIGURES = ("figure04", "figure07", "figure14", "figure14-restored", "figure16")
FIGURES_WITH_NEGATIVE_PARTS = ("figure04", "figure14", "figure14-restored")
CAPTURE_NS = 3_000_000_000

# Over 3 s, worked out by hand: file, mask value, integral of g in ns, D in ns.
FIGURE_SUMMARIES = (
    ("figure04", 0, Fraction("20833500.75"), 83331001),
    ("figure07", 128, Fraction("40000003.5"), 40000007),
    ("figure14", 0, Fraction("-10949999987"), 1010000001),
    ("figure14-restored", 0, Fraction("750000013"), 1010000001),
    ("figure14-restored", 64, Fraction("10000000.5"), 10000001),
    ("figure14-restored", 128, Fraction("10000001"), 10000002),
    ("figure16", 0, Fraction("200000001"), 200000001),
)

# Of the lines, as pages.py has them.
BLUE, ORANGE = (0x00, 0x60, 0xA8), (0xC8, 0x50, 0x00)
BLUE_AREA = (0x9E, 0xCA, 0xE9)
PDF_BLUE, PDF_ORANGE = r" 0 0\.376\d* 0\.658\d* RG ", r" 0\.784\d* 0\.313\d* 0 RG "

needs_matplotlib = unittest.skipUnless(importlib.util.find_spec("matplotlib"), "Matplotlib is missing")


def run(*arguments, **environment):
    """FnPlotter.py with arguments, as a user would run it, without a display."""
    displays = ("DISPLAY", "WAYLAND_DISPLAY")
    variables = {name: value for name, value in os.environ.items() if name not in displays}
    variables |= {"MPLCONFIGDIR": str(WORK / "matplotlib"), "PYTHONIOENCODING": "utf-8"} | environment
    command = [sys.executable, str(PLOTTER), *map(str, arguments)]
    how = {"capture_output": True, "encoding": "utf-8", "timeout": 300, "check": False}
    return subprocess.run(command, env=variables, **how)


def write(name, content):
    """A file in the work folder."""
    path = WORK / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


def many_functions(count):
    return "".join(f"M{tag} [0:0], [{tag + 1}:{tag}], [1000:0]\n" for tag in range(count))


def expectations():
    return json.loads((CORPUS / "expected.json").read_text(encoding="utf-8"))


def parsed(name):
    from fnplot.function_file import parse_functions

    return parse_functions((CORPUS / name).read_bytes())


def findings(diagnostics):
    return [[diagnostic.line, diagnostic.column, diagnostic.message] for diagnostic in diagnostics]


class Parser(unittest.TestCase):
    """The plotter's parser agrees with expected.json on every file."""

    def test_every_file_has_its_expectations(self):
        self.assertEqual({path.name for path in CORPUS.glob("*.fn")}, set(expectations()))

    def test_valid_files_give_their_functions_and_warnings(self):
        for name, expected in expectations().items():
            if expected["valid"]:
                with self.subTest(name, shows=expected["shows"]):
                    file = parsed(name)
                    points = {str(tag): list(map(list, f.points)) for tag, f in file.functions.items()}
                    self.assertEqual([diagnostic.text(name) for diagnostic in file.errors], [])
                    self.assertEqual(points, expected["functions"])
                    self.assertEqual(findings(file.warnings), expected["warnings"])

    def test_invalid_files_report_every_error_at_its_place_in_the_expected_words(self):
        for name, expected in expectations().items():
            if not expected["valid"]:
                with self.subTest(name, shows=expected["shows"]):
                    self.assertEqual(findings(parsed(name).errors), expected["errors"])

    def test_messages_can_be_read_whatever_the_file_is_made_of(self):
        for name in expectations():
            with self.subTest(name):
                for diagnostic in parsed(name).diagnostics:
                    self.assertTrue(diagnostic.message.isprintable(), diagnostic.message)

    def test_long_numbers_are_read_to_their_last_digit(self):
        from fnplot.function_file import parse_functions

        zeros = "0" * 10_000
        file = parse_functions(f"M{zeros}7 [-{zeros}5:1], [{zeros}5:0.5{zeros}]".encode())
        self.assertEqual((file.errors, file.functions[7].points), ([], ((-5, 1.0), (5, 0.5))))


class Figures(unittest.TestCase):
    """D, integral and still gain of the paper's functions are what they are by hand."""

    def test_summaries(self):
        for name, tag, integral_ns, support_ns in FIGURE_SUMMARIES:
            with self.subTest(name, tag=tag):
                summary = parsed(f"{name}.fn").functions[tag].summary(0, CAPTURE_NS)
                self.assertEqual(summary.integral_ns, integral_ns)
                self.assertEqual(summary.support_ns, support_ns)
                self.assertEqual(summary.still_gain, integral_ns / support_ns)

    def test_nothing_outside_the_interval_counts(self):
        from fnplot.gain_function import GainFunction

        function = GainFunction(((-10, 0.0), (10, 2.0), (30, 2.0)))
        summary = function.summary(0, 20)  # a ramp from 1 to 2 over 10 ns, then 2 for 10 ns
        self.assertEqual((summary.integral_ns, summary.support_ns), (35, 20))
        self.assertEqual(function.summary(30, 40).integral_ns, 20)  # held


class Times(unittest.TestCase):
    """Times are read exactly, and shown in the unit that fits."""

    def test_durations(self):
        from fnplot.times import parse_time

        seconds = {"3s": 3 * 10**9, "0.4s": 4 * 10**8, "1/3s": 333333333, "2/3s": 666666667}
        parts = {"10ms": 10**7, "250us": 250000, ".5us": 500, "7ns": 7, "-1ms": -(10**6)}
        for text, time_ns in (seconds | parts).items():
            self.assertEqual(parse_time(text, "duration"), time_ns)

    def test_axes(self):
        from fnplot.times import TimeAxis

        self.assertEqual(TimeAxis(0, 100).label, "time (ns)")
        self.assertEqual(TimeAxis(0, 5_000).label, "time (us)")
        self.assertEqual(TimeAxis(0, 1_010_000_001).label, "time (ms)")
        self.assertEqual(TimeAxis(0, CAPTURE_NS).label, "time (s)")
        narrow = TimeAxis(399_999_995, 400_000_004)
        self.assertEqual((narrow.label, narrow.coordinate(400_000_001)), ("time from 400 ms (ns)", 1.0))


def colour_count(path, colour):
    """How many pixels of a picture have a colour."""
    import numpy as np
    from PIL import Image

    with Image.open(path) as picture:
        return int(np.all(np.asarray(picture.convert("RGB")) == colour, axis=-1).sum())


def pdf_contents(path):
    """The number of pages, and what they draw with."""
    data = path.read_bytes()
    streams = re.findall(rb"stream\r?\n(.*?)\r?\nendstream", data, re.DOTALL)
    drawing = b""
    for stream in streams:
        try:
            drawing += zlib.decompress(stream)
        except zlib.error:
            pass  # a stream that is not compressed
    return len(re.findall(rb"/Type /Page\b", data)), " ".join(drawing.decode("latin-1").split())


@needs_matplotlib
class Plots(unittest.TestCase):
    """Plots are written, and show something."""

    def plot(self, source, output, *options):
        path = WORK / output
        for old in WORK.glob(f"{path.stem}*{path.suffix}"):
            old.unlink()
        result = run(source, "-o", path, *options)
        self.assertEqual((result.returncode, result.stdout), (0, ""), result.stderr)
        return path

    def test_figures_as_png(self):
        for name in FIGURES:
            with self.subTest(name):
                path = self.plot(CORPUS / f"{name}.fn", f"{name}.png", "--duration", "3s")
                self.assertGreater(colour_count(path, BLUE), 50)
                has_negative_parts = name in FIGURES_WITH_NEGATIVE_PARTS
                self.assertEqual(colour_count(path, ORANGE) > 50, has_negative_parts)

    def test_figures_as_svg(self):
        for name in FIGURES:
            with self.subTest(name):
                path = self.plot(CORPUS / f"{name}.fn", f"{name}.svg", "--duration", "3s")
                text = path.read_text(encoding="utf-8")
                self.assertIn("stroke: #0060a8", text)
                self.assertEqual("stroke: #c85000" in text, name in FIGURES_WITH_NEGATIVE_PARTS)
                self.assertIn("<!-- time (s) -->", text)
                for tag in parsed(f"{name}.fn").functions:
                    self.assertIn(f"<!-- M{tag} -->", text)

    def test_figures_as_pdf(self):
        for name in FIGURES:
            with self.subTest(name):
                path = self.plot(CORPUS / f"{name}.fn", f"{name}.pdf", "--duration", "3s")
                pages, drawing = pdf_contents(path)
                self.assertEqual(pages, 1)
                self.assertTrue(re.search(PDF_BLUE, drawing))
                self.assertEqual(bool(re.search(PDF_ORANGE, drawing)), name in FIGURES_WITH_NEGATIVE_PARTS)

    def test_corner_has_the_figures(self):
        path = self.plot(CORPUS / "figure04.fn", "corner.svg", "--duration", "3s")
        text = path.read_text(encoding="utf-8")
        self.assertIn("<!-- D 83.331001 ms    ∫g 20.83350075 ms    still gain 0.250009 -->", text)

    def test_without_a_duration_the_span_of_the_control_points_counts(self):
        source = write("held.fn", "M5 [0:1], [10:1]\n")
        text = self.plot(source, "held.svg").read_text(encoding="utf-8")
        self.assertIn("<!-- D 10 ns    ∫g 10 ns    still gain 1 -->", text)
        self.assertIn("<!-- held at 1 after its last point -->", text)
        text = self.plot(source, "held.svg", "--duration", "25ns").read_text(encoding="utf-8")
        self.assertIn("<!-- D 25 ns    ∫g 25 ns    still gain 1 -->", text)

    def test_256_functions_give_32_pages_of_pdf(self):
        pages, _ = pdf_contents(self.plot(CORPUS / "valid-256-functions.fn", "many.pdf"))
        self.assertEqual(pages, 32)

    def test_pages_are_numbered_files(self):
        source = write("seventeen.fn", many_functions(17))
        for suffix in ("png", "svg"):
            self.plot(source, f"seventeen.{suffix}")
            names = sorted(path.name for path in WORK.glob(f"seventeen*.{suffix}"))
            self.assertEqual(names, [f"seventeen-{page}.{suffix}" for page in (1, 2, 3)])

    def test_eight_functions_are_one_page(self):
        self.plot(write("eight.fn", many_functions(8)), "eight.png")
        self.assertEqual([path.name for path in WORK.glob("eight*.png")], ["eight.png"])

    def test_zoom_draws_a_stretch_and_counts_the_same(self):
        zoom = ("--zoom", "399999995ns..400000004ns", "--duration", "3s")
        path = self.plot(CORPUS / "figure07.fn", "zoom.svg", *zoom)
        text = path.read_text(encoding="utf-8")
        self.assertIn("<!-- time from 400 ms (ns) -->", text)
        self.assertIn("<!-- D 40.000007 ms    ∫g 40.0000035 ms    still gain 1 -->", text)

    def test_extreme_functions_can_be_drawn(self):
        from fnplot import pages
        from matplotlib.figure import Figure

        wanted = re.compile(r"valid-(gain|time|negative|single|thousand|all-zero)")
        for name in filter(wanted.match, expectations()):
            for duration_ns in (None, 5):
                with self.subTest(name, duration_ns=duration_ns):
                    functions = parsed(name).functions
                    graphs = [pages.Graph(tag, function) for tag, function in functions.items()]
                    view = pages.make_view(functions.values(), duration_ns)
                    figure = Figure()
                    pages.draw_page(figure, graphs, 1.0, view, name, [pages.outside_capture])
                    figure.savefig(io.BytesIO(), format="png")

    def test_only_what_counts_is_tinted(self):
        source = write("constant.fn", "M0 [0:1], [100:1]\n")
        whole, half = (
            colour_count(self.plot(source, f"tint-{duration}.png", "--duration", duration), BLUE_AREA)
            for duration in ("100ns", "50ns")
        )
        self.assertAlmostEqual(half / whole, 0.5, delta=0.02)

    def test_texts_cover_neither_each_other_nor_graphs(self):
        for count in (1, 2, 5, 8):
            for page_height in (8.5, 10.0):
                with self.subTest(graphs=count, page_height=page_height):
                    figure = awkward_page(count, page_height)
                    boxes = text_boxes(figure)
                    self.assertLessEqual({"gain", "time (s)", "0", "M255"}, {text for text, _ in boxes})
                    pairs = combinations(boxes, 2)
                    self.assertEqual([(a, b) for (a, box), (b, other) in pairs if box.overlaps(other)], [])
                    graphs = [axes.get_window_extent() for axes in figure.axes]
                    self.assertEqual([text for text, box in boxes if box.count_overlaps(graphs)], [])
                    page = figure.bbox
                    inside = [page.contains(*box.min) and page.contains(*box.max) for _, box in boxes]
                    self.assertTrue(all(inside), list(zip(boxes, inside)))


def awkward_page(count, page_height):
    """A page of so many functions with long numbers, drawn."""
    from fnplot import pages
    from fnplot.gain_function import GainFunction
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    awkward = [
        GainFunction(((123456789, -1234567.89), (2345678901, 0.000123456))),
        GainFunction(((0, 1.0), (999999999, 1.0), (1000000000, -25.0))),
        GainFunction(((5, 1.25e-7), (2999999999, -3.5e-7))),
        GainFunction(((1, 1.7e308), (3, -1.7e308))),
    ]
    graphs = [pages.Graph(255 - i, awkward[i % len(awkward)], 0.123456) for i in range(count)]
    view = pages.make_view([graph.function for graph in graphs], CAPTURE_NS)
    figure = Figure()
    FigureCanvasAgg(figure)
    height = pages.graph_height(count, page_height)
    pages.draw_page(figure, graphs, height, view, "a-file-with-a-long-name.fn, page 31 of 32", [])
    figure.canvas.draw()
    return figure


def text_boxes(figure):
    """All texts of a page, and the pixels they cover."""
    texts = figure.texts + [text for axes in figure.axes for text in texts_of(axes)]
    return [(text.get_text(), text.get_window_extent()) for text in texts if text.get_text()]


def texts_of(axes):
    """The texts that are drawn for one graph: not the labels of ticks beyond its ends."""
    texts = list(axes.texts)
    for axis in (axes.xaxis, axes.yaxis):
        low, high = axis.get_view_interval()
        ticks = [tick for tick in axis.get_major_ticks() if low <= tick.get_loc() <= high]
        texts += [axis.label] + [tick.label1 for tick in ticks if tick.label1.get_visible()]
    return texts


@needs_matplotlib
class Windows(unittest.TestCase):
    """Without -o a window opens for each page."""

    def test_one_figure_per_page(self):
        write("counting_windows.py", COUNTING_WINDOWS)
        source = write("nine.fn", many_functions(9))
        result = run(source, MPLBACKEND="module://counting_windows", PYTHONPATH=str(WORK))
        self.assertEqual((result.returncode, result.stdout), (0, "2 windows\n"), result.stderr)

    def test_no_display(self):
        result = run(CORPUS / "figure04.fn", MPLBACKEND="agg")
        self.assertEqual(result.returncode, 5)
        words = "there is no display to open a window on; write a file: -o plot.png\n"
        self.assertEqual(result.stderr, words)


# A Matplotlib backend whose windows are only counted.
COUNTING_WINDOWS = """\
from matplotlib.backends.backend_agg import FigureCanvasAgg as FigureCanvas
from matplotlib.backend_bases import FigureManagerBase as FigureManager
from matplotlib import pyplot

def show(*_, **__):
    print(len(pyplot.get_fignums()), "windows")
"""


@needs_matplotlib
class Masks(unittest.TestCase):
    """With a mask only the functions in use are drawn."""

    PIXELS = bytes([0] * 6 + [128] * 2 + [7, 8, 9, 200])

    def check_plot(self, mask):
        output = WORK / "masked.svg"
        result = run(CORPUS / "figure14.fn", "--mask", mask, "-o", output)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn(f"{mask}: mask values without a function: 7…9, 200 (4 pixels)\n", result.stderr)
        self.assertIn(f"{mask}: functions that it does not use: 64, 196, 255\n", result.stderr)
        text = output.read_text(encoding="utf-8")
        tags = re.findall(r"<!-- (M\d+) -->", text)
        self.assertEqual(tags, ["M0", "M128"])
        self.assertIn("<!-- 50 % of the mask -->", text)

    def test_raw_pgm(self):
        self.check_plot(write("raw.pgm", b"P5\n# ball\n4 3\n255\n" + self.PIXELS))

    def test_plain_pgm(self):
        numbers = " ".join(map(str, self.PIXELS))
        self.check_plot(write("plain.pgm", f"P2 # ball\n4 3 # size\n255\n{numbers} # end\n"))

    def test_small_maximum_is_not_scaled(self):
        self.check_plot(write("small.pgm", b"P5 4 3 200\n" + self.PIXELS))

    def test_png(self):
        from PIL import Image

        path = WORK / "mask.png"
        Image.frombytes("L", (4, 3), self.PIXELS).save(path)
        self.check_plot(path)

    def check_refused(self, mask, status, words):
        result = run(CORPUS / "figure14.fn", "--mask", mask, "-o", WORK / "refused.svg")
        self.assertEqual(result.returncode, status)
        self.assertIn(words, result.stderr)
        self.assertNotIn("Traceback", result.stderr)

    def test_damaged_masks(self):
        short = write("short.pgm", b"P5 4 3 255\n" + self.PIXELS[:5])
        self.check_refused(short, 3, "cut off: 5 of 4 x 3 pixels")
        self.check_refused(write("header.pgm", b"P5 4 "), 3, "its header is cut off")
        self.check_refused(write("deep.pgm", b"P5 4 3 65535\n" + bytes(24)), 3, "maximum 65535")
        self.check_refused(write("word.pgm", "P2 2 1 255 1 x"), 3, "'x' is no mask value")
        self.check_refused(write("colour.ppm", b"P6 1 1 255\n" + bytes(3)), 3, "neither a PGM nor a PNG")
        self.check_refused(WORK / "none.pgm", 3, "No such file")

    def test_mask_that_uses_no_function(self):
        mask = write("other.pgm", b"P5 2 1 255\n" + bytes([1, 2]))
        self.check_refused(mask, 3, "uses no function of")


class Mistakes(unittest.TestCase):
    """Exit statuses and messages."""

    def check(self, arguments, status, words, **environment):
        result = run(*arguments, **environment)
        self.assertEqual(result.returncode, status, result.stderr)
        self.assertIn(words, result.stderr)
        self.assertNotIn("Traceback", result.stderr)
        return result

    def test_all_mistakes_of_a_file_are_reported(self):
        name = "invalid-several-functions.fn"
        path = CORPUS / name
        result = self.check([path], 3, "a comma is missing")
        lines = [f"{path}:{line}:{column}: {words}" for line, column, words in expectations()[name]["errors"]]
        self.assertEqual(result.stderr.splitlines(), lines)

    def test_messages_name_place_limit_and_way_out(self):
        source = write("order.fn", "M0 [0:1], [2000000:1],\nM1 [2000000:0], [1000000:1]\n")
        result = self.check([source], 3, "")
        self.assertEqual(
            result.stderr,
            f"{source}:1:22: a comma with no control point after it; "
            "to go on over several lines write M0{ … }\n"
            f"{source}:2:18: time 1000000 is not after 2000000; control points must be in time order\n",
        )

    @needs_matplotlib
    def test_names_of_any_kind(self):
        for name in ("$x^$.fn", "ö ∫.fn", "a" * 200 + ".fn"):
            with self.subTest(name):
                self.check([write(name, "M0 [0:1], [5:0]\n"), "-o", WORK / "named.png"], 0, "")

    @needs_matplotlib
    def test_warnings_do_not_stop_a_plot(self):
        source = write("warning.fn", "m1 [0:1]\nM0 [0:1], [5:0]\n")
        words = f"{source}:1:1: warning: taken as a comment: a function starts with a capital M\n"
        self.check([source, "-o", WORK / "warning.png"], 0, words)

    def test_usage(self):
        figure = CORPUS / "figure04.fn"
        self.check([], 2, "FILE.fn")
        self.check([figure, "--colour"], 2, "--colour")
        self.check([figure, "-o", "plot.jpg"], 2, "'plot.jpg' is no .png, .svg or .pdf")
        self.check([figure, "--duration", "3"], 2, "duration '3' is no time; write a number and a unit")
        self.check([figure, "--duration", "0s"], 2, "not longer than nothing")
        self.check([figure, "--zoom", "3s"], 2, "no stretch of time")
        self.check([figure, "--zoom", "3s..1s"], 2, "ends before it starts")

    def test_output_over_the_input(self):
        mask = write("both.png", b"a mask")
        self.check([CORPUS / "figure04.fn", "--mask", mask, "-o", mask], 2, "is the input")
        self.assertEqual(mask.read_bytes(), b"a mask")

    def test_missing_file(self):
        self.check([WORK / "none.fn", "-o", WORK / "none.png"], 3, "none.fn: No such file")

    @needs_matplotlib
    def test_missing_folder(self):
        for suffix in ("png", "svg", "pdf"):
            output = WORK / "no-such-folder" / f"plot.{suffix}"
            self.check([CORPUS / "figure04.fn", "-o", output], 5, f"{output}: No such file")

    def test_missing_matplotlib(self):
        folder = WORK / "without-matplotlib"
        folder.mkdir(exist_ok=True)
        (folder / "matplotlib.py").write_text("raise ImportError('it is not here')\n", encoding="utf-8")
        words = "Matplotlib cannot be loaded (it is not here); on Debian: apt install python3-matplotlib"
        self.check([CORPUS / "figure04.fn", "-o", WORK / "none.png"], 5, words, PYTHONPATH=str(folder))

    def test_help_has_examples(self):
        result = run("--help")
        self.assertEqual(result.returncode, 0)
        for words in ("--duration 3s", "-o ball.pdf", "--mask ball.pgm", "exit status"):
            self.assertIn(words, result.stdout)


def main():
    global PLOTTER, CORPUS, WORK
    raw = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=raw)
    parser.add_argument("--plotter", type=Path, required=True)
    parser.add_argument("--corpus", type=Path, required=True)
    parser.add_argument("--work", type=Path, required=True)
    options, rest = parser.parse_known_args()
    PLOTTER, CORPUS, WORK = (path.resolve() for path in (options.plotter, options.corpus, options.work))
    WORK.mkdir(parents=True, exist_ok=True)
    os.environ.setdefault("MPLCONFIGDIR", str(WORK / "matplotlib"))
    sys.path.insert(0, str(PLOTTER.parent))
    unittest.main(argv=[sys.argv[0], *rest], verbosity=1)


if __name__ == "__main__":
    main()
