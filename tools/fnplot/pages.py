"""Lays graphs out on pages: stacked on a common time axis, so many to a page, under a title and a legend."""

from dataclasses import dataclass

from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from fnplot.graphs import LIVE_WIDTH, draw_graph
from fnplot.palette import AREA_OPACITY, GRID_COLOUR, HATCHES, HELD_DASHES, LINE_COLOURS, LIVE_COLOUR

# All in inches.
PAGE_WIDTH = 11.0
LEFT, RIGHT = 1.0, 0.3
TOP, BOTTOM = 0.62, 0.52
TITLE, LEGEND = 0.3, 0.56  # below the page's top
HEADING = 0.52  # above each graph
GAIN_LABEL = 0.66  # left of each graph
MIN_GRAPH, LARGEST_GRAPH = 0.6, 3.2

SIGN_NAMES = {1: "adds light", -1: "takes light away"}


@dataclass(frozen=True)
class Layout:
    """How pages are filled."""

    graphs_per_page: int
    graph_height: float  # inches

    @classmethod
    def fitting(cls, graph_count, graphs_per_page, page_height):
        """Graphs as high as fit a full page of about page_height, in inches."""
        height = (page_height - TOP - BOTTOM) / min(graph_count, graphs_per_page) - HEADING
        return cls(graphs_per_page, min(max(height, MIN_GRAPH), LARGEST_GRAPH))

    def paginate(self, graphs):
        step = self.graphs_per_page
        return [graphs[i : i + step] for i in range(0, len(graphs), step)]


def legend_entries(graphs, backdrops):
    """What the colours of a page mean, as far as they are used."""
    entries = []
    for sign, name in SIGN_NAMES.items():
        if not any(has_sign(graph.function, sign) for graph in graphs):
            continue
        hatch = 2 * HATCHES[sign] if HATCHES[sign] else None  # denser: the patch is small
        entries.append(Patch(color=LINE_COLOURS[sign], alpha=AREA_OPACITY + 0.1, hatch=hatch, label=name))
    entries.append(Line2D([], [], color=LINE_COLOURS[0], ls=HELD_DASHES, lw=1.3, label="held"))
    entries.append(Line2D([], [], color=LIVE_COLOUR, lw=LIVE_WIDTH, label="live interval"))
    return entries + [entry for backdrop in backdrops for entry in backdrop.legend]


def has_sign(function, sign):
    return max(sign * gain for gain in (min(function.gains), max(function.gains))) > 0


def draw_page(figure, graphs, height, view, title, backdrops):
    """Graphs of a height (inches) one below the other, on a figure that is made to fit them."""
    page_height = TOP + BOTTOM + len(graphs) * (HEADING + height)
    figure.set_size_inches(PAGE_WIDTH, page_height)
    left = LEFT / PAGE_WIDTH
    width = 1 - left - (RIGHT + sum(backdrop.right for backdrop in backdrops)) / PAGE_WIDTH
    figure.text(left, 1 - TITLE / page_height, title, fontsize=11, parse_math=False)
    entries = legend_entries(graphs, backdrops)
    place = {"loc": "lower left", "bbox_to_anchor": (left, 1 - LEGEND / page_height)}
    gaps = {"borderpad": 0, "borderaxespad": 0, "handletextpad": 0.5, "columnspacing": 1.5}
    figure.legend(handles=entries, ncol=len(entries), fontsize=8, frameon=False, **place, **gaps)
    has_samples = any(backdrop.shows_samples for backdrop in backdrops)
    first_axes = None
    for i, graph in enumerate(graphs):
        bottom = page_height - TOP - (i + 1) * (HEADING + height)
        box = (left, bottom / page_height, width, height / page_height)
        axes = figure.add_axes(box, sharex=first_axes)
        first_axes = first_axes or axes
        if not has_samples:  # whose lines would be taken for each other
            axes.grid(axis="x", color=GRID_COLOUR, lw=0.6)
            axes.set_axisbelow(True)
        draw_graph(axes, graph, view, backdrops)
        axes.yaxis.set_label_coords(-GAIN_LABEL / (PAGE_WIDTH * width), 0.5)
        axes.tick_params(labelbottom=graph is graphs[-1])
    axes.set_xlabel(view.axis.label, fontsize=9)
