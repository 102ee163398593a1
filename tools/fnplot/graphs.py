"""Draws one function: its graph, and above it what it comes to."""

import math
from dataclasses import dataclass

import numpy as np
from matplotlib import colors
from matplotlib.ticker import FuncFormatter, MaxNLocator

from fnplot.curve import by_sign, line_of, split_at_zero
from fnplot.gain_function import GainFunction
from fnplot.gain_summary import summarize
from fnplot.palette import (
    AREA_OPACITY,
    HATCHES,
    HELD_DASHES,
    LINE_COLOURS,
    LIVE_COLOUR,
    NOTE_COLOUR,
    ZERO_COLOUR,
)
from fnplot.times import exact_text, length_text, number_text

LARGEST_POINT_COUNT_WITH_DOTS = 100
LIVE_WIDTH = 3.5  # points

# Offsets from the graph's top, in points: two rows of text.
UPPER_ROW, LOWER_ROW = 18, 5
NOTE_LEFT = 42  # behind the widest tag, M255


@dataclass(frozen=True)
class Graph:
    """One function to draw."""

    tag: int
    function: GainFunction
    mask_share: float | None = None  # of the mask's pixels, where there is a mask


class GainAxis:
    """Turns gains into coordinates. Gains near the limits of doubles are divided by a power of ten."""

    def __init__(self, function, view):
        times_ns = np.frombuffer(function.times_ns, dtype=np.int64)
        inside = slice(*np.searchsorted(times_ns, (view.begin_ns, view.end_ns)))
        ends = 0.0, float(function.at(view.begin_ns)), float(function.at(view.end_ns))
        gains = np.concatenate((ends, np.frombuffer(function.gains)[inside]))
        lowest, highest = float(gains.min()), float(gains.max())
        largest = max(-lowest, highest)
        digits = math.floor(math.log10(largest)) if largest else 0
        self.exponent = digits if abs(digits) > 99 else 0
        self.lowest, self.highest = self.coordinate(lowest), self.coordinate(highest)
        if self.lowest == self.highest:
            self.highest = 1.0

    def coordinate(self, gain):
        """Of a gain, or of an array of them."""
        half = self.exponent // 2  # a double cannot hold 1e-324
        return gain / 10.0**half / 10.0 ** (self.exponent - half)

    @property
    def limits(self):
        margin = 0.1 * (self.highest - self.lowest)
        return self.lowest - margin, self.highest + margin

    @property
    def label(self):
        return f"gain (1e{self.exponent})" if self.exponent else "gain"


def draw_areas(axes, function, view, gain_axis):
    """Tints what counts: the area between function and zero, by its sign."""
    begin_ns = max(view.begin_ns, view.counted_begin_ns)
    end_ns = min(view.end_ns, view.counted_end_ns)
    if begin_ns >= end_ns:
        return
    x, y = split_at_zero(*line_of(function, begin_ns, end_ns, view.axis, gain_axis))
    for sign, hatch in HATCHES.items():
        if np.any(y * sign > 0):
            tint = colors.to_rgba(LINE_COLOURS[sign], AREA_OPACITY)
            strokes = colors.to_rgba(LINE_COLOURS[sign], 2 * AREA_OPACITY)
            area = np.clip(y, *((0, None) if sign > 0 else (None, 0)))
            axes.fill_between(x, 0, area, facecolor=tint, edgecolor=strokes, hatch=hatch, lw=0, zorder=2)


def draw_line(axes, function, view, gain_axis):
    """The function: solid between its control points, dashed where it is held."""
    stretches = (
        (view.begin_ns, min(function.first_ns, view.end_ns), HELD_DASHES),
        (max(function.first_ns, view.begin_ns), min(function.last_ns, view.end_ns), "solid"),
        (max(function.last_ns, view.begin_ns), view.end_ns, HELD_DASHES),
    )
    for begin_ns, end_ns, style in stretches:
        if begin_ns < end_ns:
            line = split_at_zero(*line_of(function, begin_ns, end_ns, view.axis, gain_axis))
            for sign, (x, y) in by_sign(*line).items():
                look = {"color": LINE_COLOURS[sign], "ls": style, "lw": 1.3, "zorder": 4}
                axes.plot(x, y, solid_joinstyle="miter", solid_capstyle="butt", **look)


def draw_dots(axes, function, view, gain_axis):
    """The control points, where they are few enough to be told apart."""
    times_ns = np.frombuffer(function.times_ns, dtype=np.int64)
    inside = slice(np.searchsorted(times_ns, view.begin_ns), np.searchsorted(times_ns, view.end_ns, "right"))
    gains = np.frombuffer(function.gains)[inside]
    if len(gains) > LARGEST_POINT_COUNT_WITH_DOTS:
        return
    x, y = view.axis.coordinates(times_ns[inside]), gain_axis.coordinate(gains)
    for sign, colour in LINE_COLOURS.items():
        of_sign = np.sign(gains) == sign
        axes.plot(x[of_sign], y[of_sign], "o", color=colour, ms=3, zorder=5)


def draw_live(axes, live_ns, view):
    """A bar along the top of the graph over the live interval."""
    begin_ns, end_ns = max(live_ns[0], view.begin_ns), min(live_ns[1], view.end_ns)
    if begin_ns < end_ns:
        ends = [view.axis.coordinate(begin_ns), view.axis.coordinate(end_ns)]
        look = {"color": LIVE_COLOUR, "lw": LIVE_WIDTH, "solid_capstyle": "butt", "clip_on": False}
        axes.plot(ends, [1, 1], transform=axes.get_xaxis_transform(), zorder=6, **look)


def heading_note(graph, view):
    """What stands beside the tag: how much of the mask it has, and held ends that expose."""
    function = graph.function
    notes = []
    if graph.mask_share is not None:
        notes.append(f"{100 * graph.mask_share:.3g} % of the mask")
    if function.gains[0] != 0 and function.first_ns > 0:
        notes.append(f"held at {function.gains[0]:.6g} before its first point")
    if function.gains[-1] != 0 and (view.duration_ns is None or function.last_ns < view.duration_ns):
        notes.append(f"held at {function.gains[-1]:.6g} after its last point")
    return ", ".join(notes)


def summary_text(summary, view):
    """`D 83.331001 ms    ∫g 20.83350075 ms    still gain 0.250009    over the capture (3 s)`"""
    return (
        f"D {length_text(summary.support_ns)}    ∫g {length_text(summary.integral_ns)}    "
        f"still gain {number_text(summary.still_gain, 6)}    {view.counted_text}"
    )


def live_text(live_ns):
    return f"live {exact_text(live_ns[0])} to {exact_text(live_ns[1])}" if live_ns else "never live"


def draw_heading(axes, graph, view, summary):
    """Above the graph, where it covers nothing: tag and notes on the left, figures on the right."""
    above = {"xycoords": "axes fraction", "textcoords": "offset points", "annotation_clip": False}
    axes.annotate(f"M{graph.tag}", (0, 1), (0, UPPER_ROW), weight="bold", fontsize=10, **above)
    note = heading_note(graph, view)
    axes.annotate(note, (0, 1), (NOTE_LEFT, UPPER_ROW), fontsize=8, color=NOTE_COLOUR, **above)
    right = {"fontsize": 8, "ha": "right"} | above
    if summary is None:
        axes.annotate("D and ∫g need --duration or --capture", (1, 1), (0, LOWER_ROW), **right)
        return
    axes.annotate(live_text(summary.live_ns), (1, 1), (0, UPPER_ROW), color=NOTE_COLOUR, **right)
    axes.annotate(summary_text(summary, view), (1, 1), (0, LOWER_ROW), **right)


def draw_graph(axes, graph, view, backdrops):
    """One function with all that belongs to it."""
    gain_axis = GainAxis(graph.function, view)
    axes.set_xlim(view.axis.coordinate(view.begin_ns), view.axis.coordinate(view.end_ns))
    axes.set_ylim(*gain_axis.limits)
    axes.set_title("", y=1.0)  # else each drawing searches for room for it: a fifth of the time
    axes.set_ylabel(gain_axis.label, fontsize=8)
    axes.tick_params(labelsize=8)
    axes.yaxis.set_major_locator(MaxNLocator(nbins=4, steps=[1, 2, 2.5, 5, 10]))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:.12g}"))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:.6g}"))
    for backdrop in backdrops:
        backdrop.draw(axes, view)
    axes.axhline(0, color=ZERO_COLOUR, lw=0.8, zorder=3)
    draw_areas(axes, graph.function, view, gain_axis)
    draw_line(axes, graph.function, view, gain_axis)
    draw_dots(axes, graph.function, view, gain_axis)
    summary = None
    if view.counts:
        summary = summarize(graph.function, view.counted_begin_ns, view.counted_end_ns)
        if summary.live_ns:
            draw_live(axes, summary.live_ns, view)
    draw_heading(axes, graph, view, summary)
