"""Draws noise on a page: a graph for each channel, standard deviation over code, all on one scale."""

import math

# Dark enough to be read on white, and apart in grey.
COLOURS = {"grey": "#303030", "red": "#c02020", "green": "#107030", "blue": "#1040b0"}
GRID_COLOUR = "#d8d8d8"
WIDTH, GRAPH_HEIGHT, MARGIN = 8.5, 2.9, 0.9  # inches
LINE_POINTS = 600
HEADROOM = 1.15
SMALLEST_DOT, LARGEST_DOT = 6.0, 60.0  # square points


def _dot_sizes(points):
    """By the logarithm of the pixels: a point of 100 and one of a million are both to be seen."""
    most = math.log(max(max(pixels for _, _, pixels in points), 2))
    return [SMALLEST_DOT + (LARGEST_DOT - SMALLEST_DOT) * math.log(max(pixels, 1)) / most
            for _, _, pixels in points]


def _draw_channel(axes, noise, channel):
    colour = COLOURS[channel.name]
    codes = [noise.white * i / (LINE_POINTS - 1) for i in range(LINE_POINTS)]
    sensor = [noise.sensor_sd(channel, code) for code in codes]
    label = f"read {channel.read:.3g}, shot {channel.shot:.3g}"
    if channel.curve == "sensor":
        axes.plot(codes, sensor, color=colour, lw=1.8, label=f"sensor, used: {label}")
    else:
        axes.plot(codes, [noise.points_sd(channel, code) for code in codes], color=colour, lw=1.8,
                  label="points, used")
        axes.plot(codes, sensor, color=colour, lw=0.9, ls="--", alpha=0.7, label=f"sensor, not used: {label}")
    if channel.points:
        x, y, _ = zip(*channel.points)
        points = "1 point" if len(x) == 1 else f"{len(x)} points"
        axes.scatter(x, y, s=_dot_sizes(channel.points), color=colour, alpha=0.55, lw=0, zorder=3, clip_on=False,
                     label=f"{points}, measured")
    axes.set_title(channel.name, loc="left", fontsize=10, weight="bold", color=colour)
    axes.set_ylabel("sd (codes)", fontsize=9)
    axes.grid(color=GRID_COLOUR, lw=0.6)
    axes.set_axisbelow(True)
    axes.tick_params(labelsize=8)
    axes.legend(fontsize=8, frameon=False, loc="best")


def draw(figure, noise, title):
    """All channels, on a figure that is made to fit them."""
    count = len(noise.channels)
    figure.set_size_inches(WIDTH, MARGIN + count * GRAPH_HEIGHT)
    figure.set_layout_engine("constrained")
    graphs = figure.subplots(count, 1, sharex=True, sharey=True, squeeze=False)[:, 0]
    for axes, channel in zip(graphs, noise.channels):
        _draw_channel(axes, noise, channel)
    graphs[-1].set_xlim(0, noise.white)
    # A flat curve would lie under the frame.
    graphs[-1].set_ylim(0, HEADROOM * graphs[-1].dataLim.y1)
    graphs[-1].set_xlabel(f"code (white {noise.white}, {noise.transfer})", fontsize=9)
    figure.suptitle(title, fontsize=11, parse_math=False)
