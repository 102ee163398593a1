"""Draws functions on pages: one graph each, stacked on a common time axis, at most eight to a page.

What lies behind the functions is a list of backdrops, each called as backdrop(axes, view) before a
function is drawn: now what lies outside the capture. Whatever else is known of a capture (its sample
grid, how much of the scene changes) can join that list without a change to the graphs.
"""

import math
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.ticker import FuncFormatter, MaxNLocator

from fnplot.gain_function import GainFunction
from fnplot.shape import sign_runs
from fnplot.times import TimeAxis, length_text, number_text

GRAPHS_PER_PAGE = 8

# Blue and orange stay apart for every kind of colour vision, and in grey.
LINE_COLOURS = {1: "#0060a8", -1: "#c85000", 0: "#505050"}
AREA_COLOURS = {1: "#9ecae9", -1: "#fdc086"}
OUTSIDE_COLOUR = "#ebebeb"
GRID_COLOUR = "#d4d4d4"
ZERO_COLOUR = "#b4b4b4"
NOTE_COLOUR = "#505050"
HELD_DASHES = (0, (4, 2.5))

# All in inches.
PAGE_WIDTH = 11.0
LEFT, RIGHT = 1.0, 0.3
TOP, BOTTOM = 0.42, 0.52
HEADING = 0.34  # above each graph
GAIN_LABEL = 0.66  # left of each graph
LEAST_GRAPH, LARGEST_GRAPH = 0.6, 3.2

LARGEST_POINT_COUNT_WITH_DOTS = 100


@dataclass(frozen=True)
class View:
    """What of time is drawn, and what of it counts in D and ∫g. All in nanoseconds."""

    begin_ns: int
    end_ns: int
    counted_begin_ns: int
    counted_end_ns: int
    duration_ns: int | None  # of the capture, where it is known

    @cached_property
    def axis(self):
        return TimeAxis(self.begin_ns, self.end_ns)

    @property
    def note(self):
        """Over what D, ∫g and still gain are meant."""
        of = "the capture" if self.duration_ns is not None else "the span of the control points"
        return f"over {of}, {length_text(self.counted_begin_ns)} to {length_text(self.counted_end_ns)}"


@dataclass(frozen=True)
class Graph:
    """One function to draw."""

    tag: int
    function: GainFunction
    mask_share: float | None = None  # of the mask's pixels, where there is a mask


def make_view(functions, duration_ns=None, zoom_ns=None):
    """A view of all control points, and of the whole capture, with margins for the held ends.

    zoom_ns: (begin, end) to draw instead. It does not change what counts.
    """
    first_ns = min(function.first_ns for function in functions)
    last_ns = max(function.last_ns for function in functions)
    counted = (0, duration_ns) if duration_ns is not None else (max(first_ns, 0), max(last_ns, 0))
    if zoom_ns:
        return View(*zoom_ns, *counted, duration_ns)
    # A single time has no width; it is shown with the way to the capture's start, or 1 us.
    from_start = duration_ns is not None or first_ns == last_ns
    begin_ns = min(first_ns, 0) if from_start else first_ns
    end_ns = max(last_ns, duration_ns or 0)
    if begin_ns == end_ns:
        end_ns += 1000
    margin_ns = -(-(end_ns - begin_ns) // 25)
    return View(begin_ns - margin_ns, end_ns + margin_ns, *counted, duration_ns)


def outside_capture(axes, view):
    """Backdrop: grey where there is no capture, before 0 and (where that is known) after its end."""
    ends = [(view.begin_ns, 0)]
    if view.duration_ns is not None:
        ends.append((view.duration_ns, view.end_ns))
    for begin_ns, end_ns in ends:
        begin_ns, end_ns = max(begin_ns, view.begin_ns), min(end_ns, view.end_ns)
        if begin_ns < end_ns:
            begin, end = view.axis.coordinate(begin_ns), view.axis.coordinate(end_ns)
            axes.axvspan(begin, end, color=OUTSIDE_COLOUR, lw=0)


class GainAxis:
    """Turns gains into coordinates. Gains near the limits of doubles are divided by a power of ten."""

    def __init__(self, gains):
        largest = max(abs(gain) for gain in gains)
        digits = math.floor(math.log10(largest.numerator) - math.log10(largest.denominator)) if largest else 0
        self.exponent = digits if abs(digits) > 99 else 0
        self.lowest = self.coordinate(min(0, *gains))
        self.highest = self.coordinate(max(0, *gains))
        if self.lowest == self.highest:
            self.highest = 1.0

    def coordinate(self, gain):
        return float(Fraction(gain) / Fraction(10) ** self.exponent if self.exponent else gain)

    @property
    def limits(self):
        margin = 0.1 * (self.highest - self.lowest)
        return self.lowest - margin, self.highest + margin

    @property
    def label(self):
        return f"gain (1e{self.exponent})" if self.exponent else "gain"


def lines_by_sign(function, begin_ns, end_ns, view, gain_axis):
    """The function on a stretch of time, in coordinates: lists of lines by sign, in {sign: [line, …]}."""
    lines = {}
    for run in sign_runs(function.pieces(begin_ns, end_ns)):
        line = [(view.axis.coordinate(time_ns), gain_axis.coordinate(gain)) for time_ns, gain in run.vertices]
        lines.setdefault(run.sign, []).append(line)
    return lines


def draw_areas(axes, function, view, gain_axis):
    """Tints what counts: the area between function and zero, by its sign."""
    begin_ns = max(view.begin_ns, view.counted_begin_ns)
    end_ns = min(view.end_ns, view.counted_end_ns)
    for sign, lines in lines_by_sign(function, begin_ns, end_ns, view, gain_axis).items():
        if sign != 0:
            areas = [[(line[0][0], 0), *line, (line[-1][0], 0)] for line in lines]
            axes.add_collection(PolyCollection(areas, color=AREA_COLOURS[sign], lw=0, zorder=2))


def draw_line(axes, function, view, gain_axis):
    """The function: solid between its control points, dashed where it is held."""
    stretches = (
        (view.begin_ns, min(function.first_ns, view.end_ns), HELD_DASHES),
        (max(function.first_ns, view.begin_ns), min(function.last_ns, view.end_ns), "solid"),
        (max(function.last_ns, view.begin_ns), view.end_ns, HELD_DASHES),
    )
    for begin_ns, end_ns, style in stretches:
        for sign, lines in lines_by_sign(function, begin_ns, end_ns, view, gain_axis).items():
            drawn = LineCollection(lines, colors=LINE_COLOURS[sign], linestyles=[style], lw=1.3, zorder=4)
            drawn.set_joinstyle("miter")
            axes.add_collection(drawn)


def draw_dots(axes, function, view, gain_axis):
    """The control points, where they are few enough to be told apart."""
    points = [point for point in function.points if view.begin_ns <= point[0] <= view.end_ns]
    if len(points) > LARGEST_POINT_COUNT_WITH_DOTS:
        return
    for sign, colour in LINE_COLOURS.items():
        times = [view.axis.coordinate(time_ns) for time_ns, gain in points if (gain > 0) - (gain < 0) == sign]
        gains = [gain_axis.coordinate(gain) for _, gain in points if (gain > 0) - (gain < 0) == sign]
        axes.plot(times, gains, "o", color=colour, ms=3, zorder=5)


def heading_note(graph, view):
    """What stands beside the tag: how much of the mask it has, and held ends that expose."""
    function = graph.function
    notes = []
    if graph.mask_share is not None:
        notes.append(f"{100 * graph.mask_share:.3g} % of the mask")
    if function.points[0][1] != 0 and function.first_ns > 0:
        notes.append(f"held at {function.points[0][1]:.6g} before its first point")
    if function.points[-1][1] != 0 and (view.duration_ns is None or function.last_ns < view.duration_ns):
        notes.append(f"held at {function.points[-1][1]:.6g} after its last point")
    return ", ".join(notes)


def summary_text(function, view):
    """`D 83.331001 ms   ∫g 20.83350075 ms   still gain 0.250009`"""
    if view.counted_begin_ns >= view.counted_end_ns:
        return "D and ∫g need --duration"
    summary = function.summary(view.counted_begin_ns, view.counted_end_ns)
    return (
        f"D {length_text(summary.support_ns)}    ∫g {length_text(summary.integral_ns)}    "
        f"still gain {number_text(summary.still_gain, 6)}"
    )


def draw_heading(axes, graph, view):
    """Above the graph, where it covers nothing: tag and notes on the left, figures on the right."""
    above = {"xycoords": "axes fraction", "textcoords": "offset points", "annotation_clip": False}
    axes.annotate(f"M{graph.tag}", (0, 1), (0, 5), weight="bold", fontsize=10, **above)
    axes.annotate(heading_note(graph, view), (0, 1), (42, 5), fontsize=8, color=NOTE_COLOUR, **above)
    axes.annotate(summary_text(graph.function, view), (1, 1), (0, 5), fontsize=8, ha="right", **above)


def draw_graph(axes, graph, view, backdrops):
    """One function with all that belongs to it."""
    pieces = graph.function.pieces(view.begin_ns, view.end_ns)
    gain_axis = GainAxis([gain for piece in pieces for gain in (piece.begin_gain, piece.end_gain)])
    axes.set_xlim(view.axis.coordinate(view.begin_ns), view.axis.coordinate(view.end_ns))
    axes.set_ylim(*gain_axis.limits)
    axes.set_ylabel(gain_axis.label, fontsize=8)
    axes.tick_params(labelsize=8)
    axes.yaxis.set_major_locator(MaxNLocator(nbins=4, steps=[1, 2, 2.5, 5, 10]))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:.12g}"))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:.6g}"))
    axes.yaxis.set_label_coords(-GAIN_LABEL / (PAGE_WIDTH - LEFT - RIGHT), 0.5)
    axes.grid(axis="x", color=GRID_COLOUR, lw=0.6)
    axes.set_axisbelow(True)
    for backdrop in backdrops:
        backdrop(axes, view)
    axes.axhline(0, color=ZERO_COLOUR, lw=0.8, zorder=3)
    draw_areas(axes, graph.function, view, gain_axis)
    draw_line(axes, graph.function, view, gain_axis)
    draw_dots(axes, graph.function, view, gain_axis)
    draw_heading(axes, graph, view)


def paginate(graphs):
    """Graphs in pages of at most GRAPHS_PER_PAGE."""
    return [graphs[i : i + GRAPHS_PER_PAGE] for i in range(0, len(graphs), GRAPHS_PER_PAGE)]


def graph_height(graph_count, page_height):
    """How high graphs are drawn where so many share a page of about page_height, in inches."""
    height = (page_height - TOP - BOTTOM) / graph_count - HEADING
    return min(max(height, LEAST_GRAPH), LARGEST_GRAPH)


def draw_page(figure, graphs, height, view, title, backdrops):
    """Graphs of a height (inches) one below the other, on a figure that is made to fit them."""
    page_height = TOP + BOTTOM + len(graphs) * (HEADING + height)
    figure.set_size_inches(PAGE_WIDTH, page_height)
    left, right, title_height = LEFT / PAGE_WIDTH, 1 - RIGHT / PAGE_WIDTH, 1 - 0.3 / page_height
    figure.text(left, title_height, title, fontsize=11, parse_math=False)
    figure.text(right, title_height, view.note, fontsize=8, ha="right", color=NOTE_COLOUR)
    first_axes = None
    for i, graph in enumerate(graphs):
        bottom = page_height - TOP - (i + 1) * (HEADING + height)
        box = (left, bottom / page_height, right - left, height / page_height)
        axes = figure.add_axes(box, sharex=first_axes)
        first_axes = first_axes or axes
        draw_graph(axes, graph, view, backdrops)
        axes.tick_params(labelbottom=graph is graphs[-1])
    axes.set_xlabel(view.axis.label, fontsize=9)
