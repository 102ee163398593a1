#!/usr/bin/python3
"""Draws the picture of docs/reference/python.md, by the Python package, from the demo's clip: a motion study, and how the
light of one of its pixels came about.

    PYTHONPATH=build/python tools/python_picture.py --demo demo --output docs/images/python.png

--demo is the folder that tools/demo makes.
"""

import argparse
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import nutik

PIXEL = 260, 186


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--demo", type=Path, default="demo")
    parser.add_argument("--output", type=Path, default="docs/images/python.png")
    options = parser.parse_args()
    if not (options.demo / "clip.tik").exists():
        sys.exit(f"{options.demo}/clip.tik is not there; tools/demo makes it")

    capture = nutik.open(options.demo / "clip.tik")
    functions, mask = options.demo / "motion-study.fn", options.demo / "regions.pgm"
    picture = capture.render(functions, mask, codes=True)
    (trace,) = capture.trace(*PIXEL, functions=functions, mask=mask)

    figure = plt.figure(figsize=(12, 3.9), layout="constrained")
    left, right = figure.subfigures(1, 2, width_ratios=(1.15, 1))
    axes = left.subplots()
    axes.imshow(picture)
    axes.plot(*PIXEL, "o", markersize=9, markerfacecolor="none", markeredgecolor="white", markeredgewidth=2)
    axes.set_axis_off()

    seconds = trace.times_ns.ravel() / 1e9
    exposed = np.repeat(trace.sum_ns[:, 0], 2)[:-1] / trace.support_ns
    curves = (("light (red)", trace.light[..., 0].ravel(), "tab:red"), ("gain", trace.gain.ravel(), "tab:blue"),
              ("exposed", np.concatenate([[0.0], exposed]), "tab:green"))
    panels = right.subplots(3, 1, sharex=True)
    for panel, (name, values, colour) in zip(panels, curves):
        panel.plot(seconds, values, color=colour)
        panel.set_ylabel(name)
    right.align_ylabels(panels)
    panels[-1].set_xlabel("seconds, at the ring's pixel")
    figure.savefig(options.output, dpi=90)


if __name__ == "__main__":
    main()
