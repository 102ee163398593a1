#!/usr/bin/python3
"""Films a scene whose every value is known, with masks and gain functions for it: for the demo and the tests."""

import argparse
import json
import sys
from pathlib import Path

import numpy as np

from scenes import SCENES, camera

PREVIEW_TIMES_S = (0.0, 0.4, 0.8, 1.0)


def parse_arguments():
    names = "\n".join(f"  {name}: {scene.summary}" for name, scene in SCENES.items())
    parser = argparse.ArgumentParser(description=__doc__, epilog=f"scenes:\n{names}",
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, help="where to write; made if it is missing")
    parser.add_argument("--scene", choices=SCENES, default=next(iter(SCENES)))
    parser.add_argument("--size", metavar="WxH", type=parse_size, default=(640, 360),
                        help="in pixels (default: 640x360)")
    parser.add_argument("--seed", type=int, default=1, help="of the sensor's noise (default: 1)")
    parser.add_argument("--preview", action="store_true", help="write only preview.png: the scene at four times")
    return parser.parse_args()


def parse_size(text):
    """'640x360' -> (640, 360)."""
    try:
        width, height = (int(part) for part in text.lower().split("x"))
    except ValueError:
        raise argparse.ArgumentTypeError(f"'{text}' is not WIDTHxHEIGHT, such as 640x360") from None
    if not (160 <= width <= 4096 and width // 2 <= height <= width):
        raise argparse.ArgumentTypeError(f"{text}: 160 to 4096 pixels wide, and half as high to as high as wide")
    return width, height


def write_preview(scene, seed, path):
    """Pictures of the scene, two by two."""
    shown = [camera.picture(scene, seed, round(seconds * scene.fps)) for seconds in PREVIEW_TIMES_S]
    sheet = np.vstack([np.hstack(shown[:2]), np.hstack(shown[2:])])
    camera.write_picture(path, sheet)


def write_truth(scene, seed, folder):
    """truth.json, and background.npy: [height, width, 3] light, RGB, float32."""
    truth = {"scene": scene.name, "seed": seed, "fps": scene.fps, "frames": scene.frame_count,
             "background": "background.npy", "noise_sigma_light": {
                 "formula": "sqrt(read + shot * light)", "read": camera.READ_VARIANCE, "shot": camera.SHOT_VARIANCE}}
    truth.update(scene.truth())
    np.save(folder / "background.npy", scene.background)
    (folder / "truth.json").write_text(json.dumps(truth) + "\n")


def main():
    options = parse_arguments()
    options.folder.mkdir(parents=True, exist_ok=True)
    scene = SCENES[options.scene](*options.size)
    if options.preview:
        write_preview(scene, options.seed, options.folder / "preview.png")
        return
    for name, mask in scene.masks().items():
        camera.write_picture(options.folder / f"{name}.pgm", mask)
    for name, text in scene.functions().items():
        (options.folder / f"{name}.fn").write_text(text)
    write_truth(scene, options.seed, options.folder)
    camera.film(scene, options.seed, options.folder / "clip.mkv")


if __name__ == "__main__":
    try:
        main()
    except OSError as error:
        sys.exit(f"scene.py: {error}")
