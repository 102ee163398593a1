#!/usr/bin/python3
"""Draws the picture of docs/how-to/video.md: three films whose functions, speed and mask change, seven frames of each.

    tools/film_strip.py --program build/nutik-cl --demo demo --output docs/images/film.jpg

--demo is the folder that tools/demo makes.
"""

import argparse
import subprocess
import tempfile
from pathlib import Path

import cv2
import numpy as np

FRAMES, WIDTH, GAP = 7, 240, 4


def boxcar(name, start_ns, end_ns, gain=1):
    return f"{name} [{start_ns - 1}:0], [{start_ns}:{gain}], [{end_ns}:{gain}], [{end_ns + 1}:0]\n"


def strip(program, capture, folder, *words):
    subprocess.run([program, "video", "-q", "--out-fps", "10", *words, capture, folder / "%d.png"], check=True)
    frames = [cv2.imread(str(folder / f"{k}.png")) for k in range(FRAMES)]
    height = frames[0].shape[0] * WIDTH // frames[0].shape[1]
    small = [cv2.resize(frame, (WIDTH, height), interpolation=cv2.INTER_AREA) for frame in frames]
    gap = np.full((height, GAP, 3), 255, np.uint8)
    return np.hstack([part for frame in small for part in (frame, gap)][:-1])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=Path, default="build/nutik-cl")
    parser.add_argument("--demo", type=Path, default="demo")
    parser.add_argument("--output", type=Path, default="docs/images/film.jpg")
    options = parser.parse_args()
    capture = options.demo / "clip.tik"
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "still.csv").write_text("0s,0s\n0.7s,0s\n")
        (folder / "sharp.fn").write_text(boxcar("M0", 0, 10_000_000))
        (folder / "trail.fn").write_text(boxcar("M0", 0, 900_000_000))
        trail = strip(options.program, capture, folder, "--curve", folder / "still.csv",
                      "--key", "0f", folder / "sharp.fn", "--key", "6f", folder / "trail.fn")
        (folder / "back.csv").write_text("0f,0.2s\n3f,0.8s\n4f,0.8s\n7f,0.2s\n")
        back = strip(options.program, capture, folder, "--curve", folder / "back.csv")
        height, width = cv2.imread(str(options.demo / "regions.pgm"), cv2.IMREAD_GRAYSCALE).shape
        for name, edge in (("left", 0.05), ("right", 0.95)):
            mask = np.zeros((height, width), np.uint8)
            # An edge that leans, and stands up again while it moves.
            corners = [(0, 0), (edge * width, 0), ((edge + (0.04 if name == "left" else -0.3)) * width, height), (0, height)]
            cv2.fillPoly(mask, [np.array(corners, np.int32)], 255)
            cv2.imwrite(str(folder / f"{name}.pgm"), mask)
        (folder / "two.fn").write_text(boxcar("M0", 0, 10_000_000) + boxcar("M255", 0, 400_000_000))
        (folder / "go.csv").write_text("0f,0s\n7f,0.7s\n")
        wipe = strip(options.program, capture, folder, "--curve", folder / "go.csv", "-k", folder / "two.fn", "--feather",
                     "3px", "--mask-key", "0f", folder / "left.pgm", "--mask-key", "6f", folder / "right.pgm")
    gap = np.full((2 * GAP, trail.shape[1], 3), 255, np.uint8)
    cv2.imwrite(str(options.output), np.vstack([trail, gap, back, gap, wipe]), [cv2.IMWRITE_JPEG_QUALITY, 88])


if __name__ == "__main__":
    main()
