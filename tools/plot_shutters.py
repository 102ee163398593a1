#!/usr/bin/python3
"""Draws the shutter shapes that nutik-cl prints: the picture of docs/reference/shutters.md."""

import argparse
import subprocess
import sys

import matplotlib

matplotlib.use("agg")
from matplotlib import pyplot

from fnplot.function_file import parse_functions

SHAPES = ["box", "trapezoid:0.25", "triangle", "gaussian", "hann", "strobe:4", "spline:0=0,0.1=1,0.4=0.35,1=0",
          "spline:0=-.2,.3=-.2,.5=1,.7=-.2,1=-.2"]
LINE, POINT = "#0060a8", "#c85000"
AREAS = {1: "#9ecae9", -1: "#fdc086"}  # what adds light, what takes it away
EXPOSURE_MS = 10


def control_points(program, shape):
    """Times in milliseconds and gains, as the program prints them for an exposure of 10 ms from 10 ms on."""
    command = [program, "shutter", shape, "--start", f"{EXPOSURE_MS}ms", "--exposure", f"{EXPOSURE_MS}ms"]
    text = subprocess.run(command, check=True, capture_output=True).stdout
    (function,) = parse_functions(text).functions.values()
    times = [time_ns / 1e6 - EXPOSURE_MS for time_ns, _ in function.points]
    return times, [float(gain) for _, gain in function.points]


def draw(program, output):
    figure, grid = pyplot.subplots(2, 4, figsize=(11, 4.6), sharex=True, sharey=True, layout="constrained")
    for axes, shape in zip(grid.flat, SHAPES):
        times, gains = control_points(program, shape)
        for sign, colour in AREAS.items():
            part = [max(gain, 0) if sign > 0 else min(gain, 0) for gain in gains]
            axes.fill_between(times, part, color=colour, linewidth=0)
        axes.plot(times, gains, color=LINE, linewidth=1.2)
        axes.plot(times, gains, ".", color=POINT, markersize=4)
        axes.axhline(0, color="#b4b4b4", linewidth=0.6, zorder=0)
        axes.set_title(f"{shape}\n{len(times)} points", fontsize=7.5)
        axes.set_xlim(-0.5, EXPOSURE_MS + 0.5)
        axes.set_ylim(-0.35, 1.1)
    for axes in grid[-1]:
        axes.set_xlabel("ms from the start", fontsize=8)
    for axes in grid[:, 0]:
        axes.set_ylabel("gain", fontsize=8)
    for axes in grid.flat:
        axes.tick_params(labelsize=7)
    figure.savefig(output, dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", default="build/nutik-cl", help="nutik-cl (default: build/nutik-cl)")
    parser.add_argument("-o", "--output", default="docs/images/shutters.png")
    arguments = parser.parse_args()
    try:
        draw(arguments.program, arguments.output)
    except (OSError, subprocess.CalledProcessError) as error:
        sys.exit(f"plot_shutters.py: {error}")


if __name__ == "__main__":
    main()
