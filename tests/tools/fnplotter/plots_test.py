"""Plots are written, and show what they must."""

import io
import re
import unittest

from fnplotter.setting import colour_count, draw, expectations, functions_of, many_functions, needs_matplotlib, paths
from fnplotter.setting import pdf_contents, run, write

FIGURES = ("figure04", "figure07", "figure14", "figure14-restored", "figure16")
FIGURES_WITH_NEGATIVE_PARTS = ("figure04", "figure14", "figure14-restored")

# As palette.py has them.
BLUE, ORANGE, GREEN = (0x00, 0x72, 0xB2), (0xD5, 0x5E, 0x00), (0x00, 0x9E, 0x73)
BLUE_AREA = (166, 205, 228)  # blue with opacity 0.35 on white
PDF_BLUE, PDF_ORANGE = r" 0 0\.447\d* 0\.698\d* RG ", r" 0\.835\d* 0\.368\d* 0 RG "


def colours_in_the_middle(path):
    """How many colours a small square of the graph's middle has."""
    from PIL import Image

    with Image.open(path) as picture:
        x, y = picture.width // 2 + 20, picture.height // 2
        return len(set(picture.convert("RGB").crop((x, y, x + 30, y + 30)).getdata()))


@needs_matplotlib
class Plots(unittest.TestCase):
    """Plots are written, and show something."""

    def plot(self, source, output, *options):
        path = paths.work / output
        for old in paths.work.glob(f"{path.stem}*{path.suffix}"):
            old.unlink()
        result = draw(source, "-o", path, *options)
        self.assertEqual((result.returncode, result.stdout), (0, ""), result.stderr)
        return path

    def test_figures_as_png(self):
        for name in FIGURES:
            with self.subTest(name):
                path = self.plot(paths.corpus / f"{name}.fn", f"{name}.png", "--duration", "3s")
                self.assertGreater(colour_count(path, BLUE), 50)
                has_negative_parts = name in FIGURES_WITH_NEGATIVE_PARTS
                self.assertEqual(colour_count(path, ORANGE) > 50, has_negative_parts)

    def test_figures_as_svg(self):
        for name in FIGURES:
            with self.subTest(name):
                path = self.plot(paths.corpus / f"{name}.fn", f"{name}.svg", "--duration", "3s")
                text = path.read_text(encoding="utf-8")
                self.assertIn("stroke: #0072b2", text)
                self.assertEqual("stroke: #d55e00" in text, name in FIGURES_WITH_NEGATIVE_PARTS)
                self.assertIn("<!-- time (s) -->", text)
                for tag in functions_of(f"{name}.fn"):
                    self.assertIn(f"<!-- M{tag} -->", text)

    def test_figures_as_pdf(self):
        for name in ("figure07", "figure14"):
            with self.subTest(name):
                path = self.plot(paths.corpus / f"{name}.fn", f"{name}.pdf", "--duration", "3s")
                pages, drawing = pdf_contents(path)
                self.assertEqual(pages, 1)
                self.assertTrue(re.search(PDF_BLUE, drawing))
                self.assertEqual(bool(re.search(PDF_ORANGE, drawing)), name in FIGURES_WITH_NEGATIVE_PARTS)

    def test_corner_has_the_figures(self):
        path = self.plot(paths.corpus / "figure04.fn", "corner.svg", "--duration", "3s")
        text = path.read_text(encoding="utf-8")
        figures = "D 83.331001 ms    ∫g 20.83350075 ms    still gain 0.250009    over the capture (3 s)"
        self.assertIn(f"<!-- {figures} -->", text)
        self.assertIn("<!-- live 1.5 s to 1.583331001 s -->", text)

    def test_without_a_duration_the_span_of_the_control_points_counts(self):
        source = write("held.fn", "M5 [0:1], [10:1]\n")
        text = self.plot(source, "held.svg").read_text(encoding="utf-8")
        figures = "D 10 ns    ∫g 10 ns    still gain 1    over the control points (0 s to 10 ns)"
        self.assertIn(f"<!-- {figures} -->", text)
        self.assertIn("<!-- held at 1 after its last point -->", text)
        text = self.plot(source, "held.svg", "--duration", "25ns").read_text(encoding="utf-8")
        self.assertIn("<!-- D 25 ns    ∫g 25 ns    still gain 1    over the capture (25 ns) -->", text)
        self.assertIn("<!-- live 0 s to 25 ns -->", text)

    def test_pages_are_numbered_files_that_sort(self):
        source = write("seventeen.fn", many_functions(17))
        names = {
            "8": ["seventeen-1.png", "seventeen-2.png", "seventeen-3.png"],
            "1": [f"seventeen-{page:02}.png" for page in range(1, 18)],
            "17": ["seventeen.png"],
        }
        for per_page, expected in names.items():
            self.plot(source, "seventeen.png", "--per-page", per_page)
            self.assertEqual(sorted(path.name for path in paths.work.glob("seventeen*.png")), expected)
        self.assertEqual(pdf_contents(self.plot(source, "seventeen.pdf"))[0], 3)
        self.plot(write("eight.fn", many_functions(8)), "eight.png")
        self.assertEqual([path.name for path in paths.work.glob("eight*.png")], ["eight.png"])

    def test_the_live_interval_is_a_bar_as_long_as_it_is(self):
        source = write("live.fn", "M0 [0:0], [25:1], [50:0], [100:0]\n")
        half = colour_count(self.plot(source, "live.png", "--duration", "100ns"), GREEN)
        source = write("live.fn", "M0 [0:0], [25:1], [100:0]\n")
        whole = colour_count(self.plot(source, "live.png", "--duration", "100ns"), GREEN)
        in_legend = colour_count(self.plot(write("live.fn", "M0 [0:0], [100:0]\n"), "live.png"), GREEN)
        self.assertAlmostEqual((half - in_legend) / (whole - in_legend), 0.5, delta=0.02)

    def test_what_takes_light_away_is_hatched(self):
        for gain, is_hatched in ((1, False), (-1, True)):
            source = write("hatch.fn", f"M0 [0:{gain}], [100:{gain}]\n")
            picture = self.plot(source, "hatch.png", "--duration", "100ns")
            # An area of one colour, or of many where strokes cross it.
            self.assertEqual(colours_in_the_middle(picture) > 2, is_hatched)

    def test_zoom_draws_a_stretch_and_counts_the_same(self):
        zoom = ("--zoom", "399999995ns..400000004ns", "--duration", "3s")
        path = self.plot(paths.corpus / "figure07.fn", "zoom.svg", *zoom)
        text = path.read_text(encoding="utf-8")
        self.assertIn("<!-- time from 400 ms (ns) -->", text)
        figures = "D 40.000007 ms    ∫g 40.0000035 ms    still gain 1    over the capture (3 s)"
        self.assertIn(f"<!-- {figures} -->", text)

    def test_extreme_functions_can_be_drawn(self):
        from fnplot import graphs, pages
        from fnplot.backdrops import OutsideCapture
        from fnplot.view import make_view
        from matplotlib.figure import Figure

        wanted = re.compile(r"valid-(gain|time|negative|single|thousand|all-zero)")
        for name in filter(wanted.match, expectations()):
            for duration_ns in (None, 5):
                with self.subTest(name, duration_ns=duration_ns):
                    functions = functions_of(name)
                    drawn = [graphs.Graph(tag, function) for tag, function in functions.items()]
                    view = make_view(functions.values(), duration_ns)
                    figure = Figure()
                    pages.draw_page(figure, drawn, 1.0, view, name, [OutsideCapture()])
                    figure.savefig(io.BytesIO(), format="png")

    def test_only_what_counts_is_tinted(self):
        source = write("constant.fn", "M0 [0:1], [100:1]\n")
        whole, half = (
            colour_count(self.plot(source, f"tint-{duration}.png", "--duration", duration), BLUE_AREA)
            for duration in ("100ns", "50ns")
        )
        self.assertAlmostEqual(half / whole, 0.5, delta=0.02)


@needs_matplotlib
class LongFunctions(unittest.TestCase):
    """Functions of any number of points can be drawn, and look as they are."""

    def test_what_is_thinned_keeps_its_extremes(self):
        import numpy as np
        from fnplot.curve import COLUMNS, thinned

        width = 100  # of a column, in points
        count = COLUMNS * width + 1
        x = np.arange(count, dtype=float)
        y = np.sin(x)
        y[[12_345, 54_321]] = 7, -7
        thin_x, thin_y = thinned(x, y)
        self.assertLessEqual(len(thin_x), 4 * COLUMNS)
        self.assertTrue(np.all(np.diff(thin_x) > 0))
        for points, gain in zip(thin_x.astype(int), thin_y):
            self.assertEqual(gain, y[points])
        for column in range(COLUMNS):
            inside = (x >= column * width) & (x < (column + 1) * width)
            kept = (thin_x >= column * width) & (thin_x < (column + 1) * width)
            self.assertEqual(y[inside].max(), thin_y[kept].max())
            self.assertEqual(y[inside].min(), thin_y[kept].min())

    def test_parts_by_sign_join_to_the_line(self):
        import numpy as np
        from fnplot.curve import by_sign, split_at_zero

        x, y = split_at_zero(np.array([0.0, 1, 2, 4, 5, 6]), np.array([1.0, -1, 0, 0, 2, -2]))
        nan = float("nan")
        expected = {
            1: ([0, 0.5, nan, 4, 5, 5.5], [1, 0, nan, 0, 2, 0]),
            0: ([2, 4], [0, 0]),
            -1: ([0.5, 1, 2, nan, 5.5, 6], [0, -1, 0, nan, 0, -2]),
        }
        lines = by_sign(x, y)
        self.assertEqual(lines.keys(), expected.keys())
        for sign, line in lines.items():
            np.testing.assert_array_equal(line, expected[sign])

    def test_a_quarter_of_a_million_points(self):
        count = 250_000
        points = ",\n".join(f"[{10 * i}:{(i * 7919 % 2001 - 1000) / 1000}]" for i in range(count))
        source = write("long.fn", f"M0{{{points}}}\n")
        for suffix in ("png", "svg", "pdf"):
            output = paths.work / f"long.{suffix}"
            result = draw(source, "-o", output)
            self.assertEqual((result.returncode, result.stderr), (0, ""))
            self.assertLess(output.stat().st_size, 4_000_000)  # the points alone are 4.3 MB
        # Every column of pixels has points near 1 and -1: both colours fill their halves of the graph.
        blue, orange = (colour_count(paths.work / "long.png", colour) for colour in (BLUE, ORANGE))
        self.assertGreater(min(blue, orange), 150_000)  # of 1164 x 384 pixels


@needs_matplotlib
class Windows(unittest.TestCase):
    """Without -o a window opens for each page."""

    def test_one_figure_per_page(self):
        write("counting_windows.py", COUNTING_WINDOWS)
        source = write("nine.fn", many_functions(9))
        result = run(source, MPLBACKEND="module://counting_windows", PYTHONPATH=str(paths.work))
        self.assertEqual((result.returncode, result.stdout), (0, "2 windows\n"), result.stderr)

    def test_no_display(self):
        result = run(paths.corpus / "figure04.fn", MPLBACKEND="agg")
        self.assertEqual(result.returncode, 5)
        words = "FnPlotter.py: there is no display to open a window on; write a file: -o plot.png\n"
        self.assertEqual(result.stderr, words)


# A Matplotlib backend whose windows are only counted.
COUNTING_WINDOWS = """\
from matplotlib.backends.backend_agg import FigureCanvasAgg as FigureCanvas
from matplotlib.backend_bases import FigureManagerBase as FigureManager
from matplotlib import pyplot

def show(*_, **__):
    print(len(pyplot.get_fignums()), "windows")
"""
