#!/usr/bin/python3
"""Draws docs/images/linear-capture.png: a scene filmed by a linear camera of 12 bits, as each command shows it.

    tools/linear_capture.py --program build/nutik-cl --output docs/images/linear-capture.png
"""

import argparse
import os
import subprocess
import tempfile
from pathlib import Path

import cv2
import numpy as np

from scenes import SCENES, camera

SIZE, FRAMES, WHITE = (320, 180), 48, 4095


def film(folder):
    """The scene as 12-bit codes in proportion to its light, in 16-bit PNGs."""
    scene = next(iter(SCENES.values()))(*SIZE)
    step = scene.frame_count // FRAMES
    for k in range(FRAMES):
        codes = camera.picture(scene, 1, k * step)[:, :, ::-1] / 255.0  # as OpenCV writes colours
        light = np.where(codes <= 0.04045, codes / 12.92, ((codes + 0.055) / 1.055) ** 2.4)
        cv2.imwrite(str(folder / f"{k:03}.png"), np.rint(light * WHITE).astype(np.uint16))


def as_shown(path):
    """A picture as a viewer shows it: the high eight bits of sixteen."""
    picture = cv2.imread(str(path), cv2.IMREAD_UNCHANGED)
    return (picture >> 8).astype(np.uint8) if picture.dtype == np.uint16 else picture


def titled(picture, title):
    band = np.full((28, picture.shape[1], 3), 255, np.uint8)
    cv2.putText(band, title, (2, 20), cv2.FONT_HERSHEY_SIMPLEX, 0.5, (30, 30, 30), 1, cv2.LINE_AA)
    return np.vstack([band, picture])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", required=True, type=os.path.abspath)
    parser.add_argument("--output", required=True, type=os.path.abspath)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "frames").mkdir()
        film(folder / "frames")

        def run(*words):
            subprocess.run([given.program, "-q", *words], cwd=folder, check=True)

        run("-f", "48", "--white", str(WHITE), "frames", "linear.tik")
        moment = ["--start", "24f", "--exposure", "1f", "linear.tik"]
        run(*moment, "picture.png")
        run(*moment, "codes.png", "--out-transfer", "source")
        run("contact", "--start", "24f", "--every", "1f", "--columns", "6", "--width", str(6 * SIZE[0] + 64), "linear.tik",
            "sheet.png")
        run("video", "--from", "24f", "--out-fps", "48", "--out-angle", "360", "linear.tik", "video.mkv")
        sheet = as_shown(folder / "sheet.png")[38:38 + SIZE[1], 12:12 + SIZE[0]]  # its first picture
        frame = cv2.VideoCapture(str(folder / "video.mkv")).read()[1]
        panels = [titled(as_shown(folder / "picture.png"), "its picture"), titled(sheet, "on its contact sheet"),
                  titled(frame, "in its video"), titled(as_shown(folder / "codes.png"), "its own codes: --out-transfer source")]
        gap = np.full((panels[0].shape[0], 8, 3), 255, np.uint8)
        rows = [np.hstack([panels[0], gap, panels[1]]), np.hstack([panels[2], gap, panels[3]])]
        cv2.imwrite(given.output, np.vstack(rows), [cv2.IMWRITE_PNG_COMPRESSION, 9])


if __name__ == "__main__":
    main()
