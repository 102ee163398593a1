"""What lies behind the functions: what is not capture, the samples, and how much changes at each of them.

A backdrop draws itself behind a graph (`draw(axes, view)`) and has entries of the legend (`legend`). `right`
is the width that it needs right of the graphs, in inches; `shows_samples` says that its lines stand for
samples.
"""

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import FuncFormatter

from fnplot.palette import (
    ACTIVITY_COLOUR,
    ACTIVITY_OPACITY,
    ACTIVITY_TEXT_COLOUR,
    EXPOSURE_COLOUR,
    OUTSIDE_COLOUR,
    SAMPLE_COLOUR,
)

MIN_SAMPLE = 1 / 200  # of a graph's width: narrower samples are not drawn one by one
MAX_STEPS = 1024
HIGHEST_ACTIVITY = 0.15  # of a graph's height: it lies below functions, which are what a plot is about
MIN_SPACE = 1 / 100  # of a graph's width, between lines that stand for many samples


def samples_in(capture, view):
    """The samples that are drawn. Each lasts to the start of the next, the last to the capture's end."""
    first, behind = np.searchsorted(capture.starts_ns, (view.begin_ns, view.end_ns), side="right")
    return range(max(int(first) - 1, 0), int(behind))


class OutsideCapture:
    """Grey where there is no capture: before 0, and after its end where that is known."""

    right = 0.0
    shows_samples = False
    legend = (Patch(color=OUTSIDE_COLOUR, label="outside the capture"),)

    def draw(self, axes, view):
        ends = [(view.begin_ns, 0)]
        if view.duration_ns is not None:
            ends.append((view.duration_ns, view.end_ns))
        for begin_ns, end_ns in ends:
            begin_ns, end_ns = max(begin_ns, view.begin_ns), min(end_ns, view.end_ns)
            if begin_ns < end_ns:
                begin, end = view.axis.coordinate(begin_ns), view.axis.coordinate(end_ns)
                axes.axvspan(begin, end, color=OUTSIDE_COLOUR, lw=0)


class SampleGrid:
    """The exposures as bands with a line at each start; of many samples the starts of every n-th."""

    right = 0.0
    shows_samples = True

    def __init__(self, capture, view):
        self.capture = capture
        self.samples = samples_in(capture, view)
        self.step = self.step_of(view)
        self.legend = (self.legend_entry(),)

    def step_of(self, view):
        """1 where samples are wide enough to be drawn one by one, else 2, 5, 10, 20 …"""
        if len(self.samples) < 2:
            return 1
        spans_ns = np.diff(self.capture.starts_ns[self.samples.start : self.samples.stop])
        typical = float(np.mean(spans_ns)) / (view.end_ns - view.begin_ns)
        if typical >= MIN_SAMPLE:
            return 1
        steps = (digit * 10**power for power in range(19) for digit in (1, 2, 5))
        return next(step for step in steps if step * typical >= MIN_SPACE)

    def legend_entry(self):
        count = len(self.capture)
        if self.step == 1:
            label = "exposure of the one sample" if count == 1 else f"exposures of the {count} samples"
            return Patch(facecolor=EXPOSURE_COLOUR, edgecolor=SAMPLE_COLOUR, label=label)
        every = f"every {self.step}{'nd' if self.step == 2 else 'th'}" if self.step < count else "the first"
        return Line2D([], [], color=SAMPLE_COLOUR, lw=0.8, label=f"{every} of {count} samples")

    def draw(self, axes, view):
        across = axes.get_xaxis_transform()  # x in coordinates, y in heights of the graph
        drawn = [k for k in self.samples if k % self.step == 0]
        starts = view.axis.coordinates(self.capture.starts_ns[drawn])
        if self.step == 1:
            widths = view.axis.coordinates(self.capture.ends_ns[drawn]) - starts
            bands = list(zip(starts, widths))
            axes.broken_barh(bands, (0, 1), transform=across, color=EXPOSURE_COLOUR, lw=0, zorder=0.5)
        axes.vlines(starts, 0, 1, transform=across, color=SAMPLE_COLOUR, lw=0.6, zorder=0.6)


class Activity:
    """The share of pixels that change at each sample, as steps on an axis of its own at the right.

    Of many samples a step stands for several, and is as high as the highest of them.
    """

    right = 0.6
    shows_samples = False
    legend = (Patch(color=ACTIVITY_COLOUR, alpha=ACTIVITY_OPACITY, label="pixels that change"),)

    def __init__(self, capture, view):
        samples = samples_in(capture, view)
        step = max(1, -(-len(samples) // MAX_STEPS))
        edges_ns = np.append(capture.starts_ns, capture.duration_ns)
        edges_ns = np.append(edges_ns[samples.start : samples.stop : step], edges_ns[samples.stop])
        changed = capture.changed[samples.start : samples.stop]
        highest = np.maximum.reduceat(changed, np.arange(0, len(changed), step)) if samples else changed
        self.x = np.repeat(view.axis.coordinates(edges_ns), 2)[1:-1]
        self.y = np.repeat(100 * highest, 2)
        self.highest = float(np.max(self.y, initial=0.0)) or 1.0

    def draw(self, axes, view):
        top = self.highest / HIGHEST_ACTIVITY
        height = self.y / top
        across = axes.get_xaxis_transform()  # x in coordinates, y in heights of the graph
        look = {"color": ACTIVITY_COLOUR, "alpha": ACTIVITY_OPACITY, "lw": 0, "zorder": 0.7}
        axes.fill_between(self.x, 0, height, transform=across, **look)
        scale = axes.twinx()
        scale.set_ylim(0, top)
        scale.set_yticks([0, self.highest])
        scale.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:.3g} %"))
        scale.tick_params(axis="y", labelsize=7, colors=ACTIVITY_TEXT_COLOUR)
        scale.tick_params(axis="x", bottom=False, labelbottom=False)
        scale.spines[:].set_visible(False)
        scale.set_ylabel("change", loc="bottom", fontsize=7, color=ACTIVITY_TEXT_COLOUR)
