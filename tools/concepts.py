#!/usr/bin/python3
"""Draws the pictures of docs/explanation/concepts.md from the demo's clip, and those of other pages that explain.

    tools/concepts.py --program build/nutik-cl --demo demo --output docs/images/concepts
    tools/concepts.py --only tiles               one of flow, pixel, rates, tiles, negative, tolerance

--demo is the folder that tools/demo makes.
"""

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

import cv2
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from fnplot.function_file import parse_functions
from scenes.camera import srgb_codes, srgb_light

BLUE, ORANGE, GREEN, GREY = "#0072b2", "#d55e00", "#009e73", "#606060"
RATES = {30: 32, 120: 8, 240: 4, 960: 1}  # pictures a second: every how many of the clip's


def picture_of(program, *words, option="-o"):
    """What a command writes."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "picture.png"
        subprocess.run([program, "-q", *words, option, path], check=True, stdout=subprocess.DEVNULL)
        return cv2.imread(str(path))[..., ::-1]


def save(figure, path):
    figure.savefig(path, dpi=90, facecolor="white")
    plt.close(figure)
    # Few colours take a third of the space, and nobody sees it.
    subprocess.run(["ffmpeg", "-v", "error", "-y", "-i", path, "-vf", "split[a][b];[a]palettegen[p];[b][p]paletteuse",
                    path.with_suffix(".small.png")], check=True)
    path.with_suffix(".small.png").replace(path)


def show(axes, picture, title, below):
    axes.imshow(picture)
    axes.set_title(title, fontsize=12, fontweight="bold")
    axes.text(0.5, -0.06, below, transform=axes.transAxes, ha="center", va="top", fontsize=9.5, linespacing=1.4)
    axes.set_xticks([])
    axes.set_yticks([])


def draw_curves(axes, functions):
    axes.set_title("functions", fontsize=12, fontweight="bold")
    for row, (tag, function) in enumerate(sorted(functions.items())):
        times = [time_ns / 1e9 for time_ns, _ in function.points] + [1.2]
        gains = np.array([float(gain) for _, gain in function.points])
        gains = np.append(gains, gains[-1])
        axes.plot(times, 0.75 * gains / gains.max() - row, color=BLUE, linewidth=1.5)
        axes.text(-0.04, -row + 0.05, f"M{tag}", ha="right", fontsize=9)
    axes.set_xlim(-0.32, 1.25)
    axes.set_xticks([])
    axes.set_yticks([])
    axes.text(0.5, -0.06, "when each region sees light\npicture.fn  (shutter)", transform=axes.transAxes, ha="center", va="top", fontsize=9.5,
              linespacing=1.4)


def draw_flow(program, demo, output):
    """Clip, capture, mask and functions, picture."""
    capture, mask = demo / "clip.tik", demo / "regions.pgm"
    functions = parse_functions((demo / "one-blur.fn").read_bytes()).functions
    moment = picture_of(program, "--start", "0.8s", "--exposure", "1f", capture)
    changes = picture_of(program, "info", capture, option="--activity")
    result = picture_of(program, "-m", mask, "-k", demo / "one-blur.fn", capture)
    figure, axes = plt.subplots(1, 5, figsize=(15, 2.5))
    figure.subplots_adjust(left=0.01, right=0.99, top=0.9, bottom=0.2, wspace=0.22)
    show(axes[0], moment, "clip", "pictures, one after another\nclip.mp4")
    show(axes[1], changes, "capture", "when each pixel changed\nclip.tik  (encode)")
    show(axes[2], cv2.imread(str(mask)), "mask", "a number for each pixel\nregions.pgm  (mask)")
    draw_curves(axes[3], functions)
    axes[3].set_box_aspect(360 / 640)
    show(axes[4], result, "picture", "light × gain, added up\npicture.png  (expose)")
    for axis, mark in zip(axes, ("→", "+", "+", "→")):
        axis.text(1.11, 0.5, mark, transform=axis.transAxes, fontsize=24, ha="center", va="center", color=ORANGE)
    save(figure, output / "flow.png")


def draw_pixel(_program, _demo, output):
    """One pixel: its light, times the gain, is what adds up."""
    ends_ms = np.array([0, 10, 20, 30, 40, 50])
    light = np.array([0.2, 0.2, 0.8, 0.5, 0.2])
    gain_times, gain = np.array([0, 10, 10, 30, 30, 50]), np.array([0, 0, 0.4, 1.2, 0, 0])
    fine = np.linspace(0, 50, 5001)
    values = light[np.minimum((fine / 10).astype(int), 4)]
    gains = np.where((fine >= 10) & (fine < 30), 0.4 + (fine - 10) / 20 * 0.8, 0)
    figure, axes = plt.subplots(3, 1, figsize=(7.6, 5), sharex=True, layout="constrained")
    axes[0].step(ends_ms, np.append(light, light[-1]), where="post", color=BLUE, linewidth=2)
    axes[0].fill_between(fine, values, color=BLUE, alpha=0.15)
    for end, value in zip(ends_ms, light):
        axes[0].text(end + 5, value + 0.05, f"{value:g}", ha="center", fontsize=10)
    axes[0].set_ylabel("light")
    axes[1].plot(gain_times, gain, color=GREEN, linewidth=2)
    axes[1].set_ylabel("gain")
    axes[1].text(15, 0.2, "mean 0.6", ha="center", fontsize=10)
    axes[1].text(25, 0.2, "mean 1.0", ha="center", fontsize=10)
    axes[2].fill_between(fine, values * gains, color=ORANGE, alpha=0.35)
    axes[2].plot(fine, values * gains, color=ORANGE, linewidth=1.5)
    axes[2].set_ylabel("light × gain")
    axes[2].text(15, 0.25, "0.12 × 10 ms", ha="center", fontsize=10)
    axes[2].text(25, 0.25, "0.80 × 10 ms", ha="center", fontsize=10)
    axes[2].text(31, 0.55, "sum 9.2 ms ÷ 20 ms with a gain\n= 0.46, the picture's light", fontsize=11, va="center")
    axes[2].set_xlabel("time in ms; five pictures of 10 ms")
    for axis in axes:
        axis.set_ylim(0, 1.35)
        axis.set_xlim(0, 50)
        axis.spines[["top", "right"]].set_visible(False)
    save(figure, output / "pixel.png")


def draw_rates(_program, demo, output):
    """The same fifth of a second at four rates, each picture as short as the clip's."""
    clip = cv2.VideoCapture(str(demo / "clip.mkv"), cv2.CAP_FFMPEG)
    frames = []
    for _ in range(768):
        frames.append(clip.read()[1][60:260, 190:450, ::-1])
    light = srgb_light(np.array(frames[576:], dtype=np.float64))
    figure, axes = plt.subplots(1, 4, figsize=(12, 2.75))
    figure.subplots_adjust(left=0.005, right=0.995, top=0.88, bottom=0.01, wspace=0.02)
    for axis, (rate, step) in zip(axes, RATES.items()):
        axis.imshow(np.round(srgb_codes(light[::step].mean(axis=0))).astype(np.uint8))
        axis.set_title(f"{rate} pictures a second", fontsize=12)
        axis.set_axis_off()
    save(figure, output / "rates.png")


def draw_tiles(_program, _demo, output):
    """What each kind of tile stores: eight of its 64 pixels over sixteen samples."""
    rng = np.random.default_rng(4)
    samples, pixels = 16, 8

    def changes(share):
        """Samples at which each pixel changes; all have a value at the first."""
        changed = rng.random((pixels, samples)) < share
        changed[:, 0] = True
        return changed

    still, busy, calm, ragged = changes(0), changes(0.85), np.zeros((pixels, samples), bool), changes(0.1)
    calm[:, [0, 5, 6, 11]] = rng.random((pixels, 4)) < 0.7
    calm[:, 0] = True
    stored = {"still": (still, still), "rows": (calm, calm | calm.any(axis=0)),
              "dense": (busy, np.ones_like(busy)), "records": (ragged, ragged)}
    said = {"still": "one row of codes", "rows": "a row at each sample\nat which any pixel changed",
            "dense": "a row at every sample", "records": "for each pixel\nits own changes"}
    figure, axes = plt.subplots(1, 4, figsize=(13, 3.1))
    figure.subplots_adjust(left=0.045, right=0.995, top=0.88, bottom=0.3, wspace=0.1)
    for axis, (kind, (changed, kept)) in zip(axes, stored.items()):
        for pixel in range(pixels):
            for sample in range(samples):
                color = ORANGE if changed[pixel, sample] else BLUE if kept[pixel, sample] else "#f0f0f0"
                axis.add_patch(plt.Rectangle((sample + 0.06, pixel + 0.06), 0.88, 0.88, color=color,
                                             alpha=0.45 if color == BLUE else 1))
        axis.set(xlim=(0, samples), ylim=(pixels, 0), yticks=[])
        axis.set_xticks([0.5, samples - 0.5], ["sample 0", str(samples - 1)], fontsize=9)
        axis.tick_params(length=0)
        axis.set_title(kind, fontsize=12, fontweight="bold")
        axis.text(0.5, -0.16, said[kind], transform=axis.transAxes, ha="center", va="top", fontsize=10, linespacing=1.3)
        axis.spines[:].set_visible(False)
    axes[0].set_ylabel("pixels of the tile", fontsize=10)
    figure.text(0.99, 0.025, "orange: changed, stored   blue: not changed, stored   grey: held, not stored", ha="right",
                fontsize=9, color=GREY)
    save(figure, output / "tiles.png")


def draw_negative(program, demo, output):
    """A difference of two exposures, with each way to show light below 0 in codes."""
    with tempfile.TemporaryDirectory() as folder:
        functions = Path(folder) / "difference.fn"
        functions.write_text("M0 [399999999:0], [400000000:-1], [410000000:-1], [410000001:0], [799999999:0], "
                             "[800000000:1], [810000000:1], [810000001:0]\n")
        figure, axes = plt.subplots(1, 3, figsize=(13, 2.85))
        figure.subplots_adjust(left=0.005, right=0.995, top=0.88, bottom=0.1, wspace=0.03)
        for axis, (way, below) in zip(axes, {"saturate": "light below 0 is black", "offset": "light 0 is mid-grey",
                                             "abs": "−x is as bright as +x"}.items()):
            show(axis, picture_of(program, "-k", functions, "--negative", way, demo / "clip.tik"), way, below)
    save(figure, output / "negative.png")


def draw_tolerance(program, demo, output):
    """How large the capture is with four tolerances, a part of the same moment, and what it lost."""
    tolerances, times = (0, 2, 8, 24), 8
    figure, axes = plt.subplots(2, len(tolerances), figsize=(13, 4.6))
    figure.subplots_adjust(left=0.03, right=0.995, top=0.92, bottom=0.01, wspace=0.03, hspace=0.14)
    lossless = None
    with tempfile.TemporaryDirectory() as folder:
        for tolerance, (above, below) in zip(tolerances, axes.T):
            capture = Path(folder) / f"{tolerance}.tik"
            subprocess.run([program, "-q", "--tolerance", str(tolerance), demo / "clip.mkv", capture], check=True)
            picture = picture_of(program, "--start", "0.8s", "--exposure", "1f", capture)[100:250, 290:540].astype(int)
            lossless = picture if lossless is None else lossless
            show(above, picture, f"--tolerance {tolerance}", f"{capture.stat().st_size / 1e6:.0f} MB")
            show(below, np.minimum(np.abs(picture - lossless) * times, 255), "", "")
            capture.unlink()
    axes[0, 0].set_ylabel("picture")
    axes[1, 0].set_ylabel(f"what it lost, × {times}")
    save(figure, output / "tolerance.png")


DRAWINGS = {"flow": draw_flow, "pixel": draw_pixel, "rates": draw_rates, "tiles": draw_tiles, "negative": draw_negative,
            "tolerance": draw_tolerance}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=Path, default="build/nutik-cl")
    parser.add_argument("--demo", type=Path, default="demo")
    parser.add_argument("--output", type=Path, default="docs/images/concepts")
    parser.add_argument("--only", choices=DRAWINGS)
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    for name in [options.only] if options.only else DRAWINGS:
        if name not in ("pixel", "tiles") and not (options.demo / "clip.tik").exists():
            sys.exit(f"{options.demo}/clip.tik is not there; tools/demo makes it")
        DRAWINGS[name](options.program, options.demo, options.output)


if __name__ == "__main__":
    main()
