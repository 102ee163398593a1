"""Texts cover neither each other nor graphs."""

import unittest
from itertools import combinations

from fnplot.gain_function import GainFunction

from fnplotter.setting import CAPTURE_NS, needs_matplotlib

AWKWARD = tuple(
    GainFunction.from_points(points)
    for points in (
        ((123456789, -1234567.89), (2345678901, 0.000123456)),
        ((0, 1.0), (999999999, 1.0), (1000000000, -25.0)),
        ((5, 1.25e-7), (2999999999, -3.5e-7)),
        ((1, 1.7e308), (3, -1.7e308)),
    )
)


@needs_matplotlib
class Layout(unittest.TestCase):
    def check(self, figure):
        boxes = text_boxes(figure)
        self.assertLessEqual({"gain", "time (s)", "0", "M255", "live interval"}, {text for text, _ in boxes})
        pairs = combinations(boxes, 2)
        self.assertEqual([(a, b) for (a, box), (b, other) in pairs if box.overlaps(other)], [])
        graphs = [axes.get_window_extent() for axes in figure.axes]
        self.assertEqual([text for text, box in boxes if box.count_overlaps(graphs)], [])
        page = figure.bbox
        inside = [page.contains(*box.min) and page.contains(*box.max) for _, box in boxes]
        self.assertTrue(all(inside), list(zip(boxes, inside)))

    def test_functions(self):
        pages = ((1, 11.5), (2, 8.5), (5, 11.5), (8, 8.5), (8, 11.5), (32, 11.5))
        for number, (count, page_height) in enumerate(pages):
            duration_ns = CAPTURE_NS if number % 2 == 0 else None
            with self.subTest(graphs=count, page_height=page_height, duration_ns=duration_ns):
                self.check(awkward_page(count, page_height, duration_ns))

    def test_functions_before_a_capture(self):
        for samples in (1, 7, 123_456):
            with self.subTest(samples=samples):
                self.check(awkward_page(5, 11.5, CAPTURE_NS, samples))


def awkward_page(count, page_height, duration_ns, samples=None):
    """A page of so many functions with long numbers, drawn; before a capture of so many samples."""
    import numpy as np
    from fnplot import backdrops, graphs, pages
    from fnplot.capture import Capture
    from fnplot.view import make_view
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    drawn = [graphs.Graph(255 - i, AWKWARD[i % len(AWKWARD)], 0.123456) for i in range(count)]
    view = make_view([graph.function for graph in drawn], duration_ns)
    behind = [backdrops.OutsideCapture()]
    if samples:
        starts_ns = np.arange(samples) * CAPTURE_NS // samples
        clip = Capture(CAPTURE_NS, starts_ns, starts_ns + 1000, np.full(samples, 0.000123456))
        behind += [backdrops.SampleGrid(clip, view), backdrops.Activity(clip, view)]
    figure = Figure()
    FigureCanvasAgg(figure)
    height = pages.Layout.fitting(count, count, page_height).graph_height
    pages.draw_page(figure, drawn, height, view, "a-file-with-a-long-name.fn, page 31 of 32", behind)
    figure.canvas.draw()
    return figure


def text_boxes(figure):
    """All texts of a page, and the pixels they cover."""
    texts = figure.texts + figure.legends[0].get_texts()
    texts += [text for axes in figure.axes for text in texts_of(axes)]
    return [(text.get_text(), text.get_window_extent()) for text in texts if text.get_text()]


def texts_of(axes):
    """The texts that are drawn for one graph: not the labels of ticks beyond its ends."""
    texts = list(axes.texts)
    for axis in (axes.xaxis, axes.yaxis):
        low, high = axis.get_view_interval()
        ticks = [tick for tick in axis.get_major_ticks() if low <= tick.get_loc() <= high]
        labels = [label for tick in ticks for label in (tick.label1, tick.label2)]
        texts += [axis.label] + [label for label in labels if label.get_visible()]
    return texts
