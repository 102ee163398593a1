#!/usr/bin/python3
"""Draws the README's first picture: a frame of the demo's clip, gain curves over its mask, and what they expose to.

    tools/hero.py --program build/nutik-cl --demo demo --output docs/images/hero.jpg

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

# Of each region: its colour (Okabe and Ito's, which every kind of colour vision tells apart), and where its curve is
# drawn, in pixels of the picture: left, top, width, height.
REGIONS = {
    0: ("#ffffff", (250, 268, 180, 62)),
    64: ("#56b4e9", (22, 18, 96, 54)),
    128: ("#e69f00", (134, 32, 96, 54)),
    196: ("#009e73", (282, 84, 96, 54)),
    255: ("#cc79a7", (526, 118, 96, 54)),
}
LENGTH_S = 1.2


def picture_of(program, *words):
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "picture.png"
        subprocess.run([program, "-q", *words, path], check=True)
        return cv2.imread(str(path))[..., ::-1]


def show(axes, picture, title):
    axes.imshow(picture, interpolation="nearest")
    axes.set_title(title, loc="left", fontsize=14, pad=6)
    axes.set_axis_off()


def draw_curve(axes, function, colour, place):
    """The gain over the clip's time in a small dark panel."""
    left, top, width, height = place
    height_of_picture, width_of_picture = 360, 640
    panel = axes.inset_axes([left / width_of_picture, 1 - (top + height) / height_of_picture,
                             width / width_of_picture, height / height_of_picture])
    panel.set_facecolor("#101010")
    times = [time_ns / 1e9 for time_ns, _ in function.points] + [LENGTH_S]
    gains = [float(gain) for _, gain in function.points]
    gains.append(gains[-1])
    panel.axhline(0, color="#606060", linewidth=0.8)
    panel.plot(times, gains, color=colour, linewidth=1.8)
    panel.set_xlim(-0.03, LENGTH_S)
    panel.set_ylim(-0.15 * max(gains), 1.15 * max(gains))
    panel.set_xticks([])
    panel.set_yticks([])
    for spine in panel.spines.values():
        spine.set_color(colour)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=Path, default="build/nutik-cl")
    parser.add_argument("--demo", type=Path, default="demo")
    parser.add_argument("--output", type=Path, default="docs/images/hero.jpg")
    options = parser.parse_args()
    if not (options.demo / "clip.tik").exists():
        sys.exit(f"{options.demo}/clip.tik is not there; tools/demo makes it")
    capture, mask = options.demo / "clip.tik", options.demo / "regions.pgm"
    functions = parse_functions((options.demo / "one-blur.fn").read_bytes()).functions
    frame = picture_of(options.program, "--start", "0.8s", "--exposure", "1f", capture)
    result = picture_of(options.program, "-m", mask, "-k", options.demo / "one-blur.fn", capture)
    tags = cv2.imread(str(mask), cv2.IMREAD_UNCHANGED)
    under = np.repeat(frame.mean(axis=2, keepdims=True) * 0.3, 3, axis=2)
    for tag, (colour, _) in REGIONS.items():
        if tag != 0:
            rgb = np.array(matplotlib.colors.to_rgb(colour)) * 255
            under[tags == tag] = 0.25 * under[tags == tag] + 0.75 * rgb

    plt.rcParams["font.family"] = "DejaVu Sans"
    figure, panels = plt.subplots(1, 3, figsize=(15, 3.15), dpi=100)
    figure.subplots_adjust(left=0.003, right=0.997, bottom=0.01, top=0.9, wspace=0.015)
    show(panels[0], frame, "one of the clip's 1152 frames")
    show(panels[1], under.astype(np.uint8), "a gain curve over time for each region")
    show(panels[2], result, "the picture")
    for tag, (colour, place) in REGIONS.items():
        draw_curve(panels[1], functions[tag], colour, place)
    panels[1].text(250, 260, "all else", color=REGIONS[0][0], fontsize=11)
    figure.canvas.draw()
    pixels = np.asarray(figure.canvas.buffer_rgba())[..., :3]
    cv2.imwrite(str(options.output), pixels[..., ::-1], [cv2.IMWRITE_JPEG_QUALITY, 88])


if __name__ == "__main__":
    main()
