"""The studio on a screen that nobody sees (Xvfb): its pictures are taken there as they are without a screen."""

import argparse
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import cv2
import numpy as np

SKIPPED = 77
SIZES = {"empty": (1280, 800), "studio": (1280, 800), "light": (1280, 800), "light-large": (2560, 1600),
         "large": (2560, 1600)}
CANVAS = np.s_[60:420, 20:940]  # rows and columns of the small window in which the picture lies


def write_clip(program, folder):
    """A bright square on a dark ground: to the right, then at rest."""
    noise = np.random.default_rng(5)
    for k in range(20):
        picture = noise.integers(58, 63, (48, 96), dtype=np.uint8)
        left = 4 + 2 * min(k, 12)
        picture[20:28, left:left + 8] += 140
        cv2.imwrite(str(folder / f"{k:02d}.png"), picture)
    subprocess.run([program, "encode", "--quiet", "-f", "100", str(folder / "%02d.png"), str(folder / "clip.tik")],
                   check=True)
    return folder / "clip.tik"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", required=True)
    parser.add_argument("--screenshots", required=True)
    arguments = parser.parse_args()
    if shutil.which("xvfb-run") is None:
        print("skipped: no xvfb-run (Debian: xvfb, xauth)")
        return SKIPPED
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        clip = write_clip(arguments.program, folder)
        subprocess.run(["xvfb-run", "-a", "-s", "-screen 0 2560x1600x24", "env", "QT_QPA_PLATFORM=xcb",
                        arguments.screenshots, str(clip), name], check=True)
        pictures = {name: cv2.imread(str(folder / f"{name}.png")) for name in SIZES}
        for name, (width, height) in SIZES.items():
            assert pictures[name].shape == (height, width, 3), f"{name}.png is {pictures[name].shape}"
        assert np.ptp(pictures["studio"][CANVAS]) > 100, "the picture is on the canvas"
        assert pictures["light"].mean() > pictures["studio"].mean() + 50, "light is lighter than dark"
        frames = [cv2.imread(str(path)) for path in sorted((folder / "drag").glob("*.png"))]
        assert len(frames) == 40 and any((frame != frames[0]).any() for frame in frames[1:]), "a point is dragged"
    return 0


if __name__ == "__main__":
    sys.exit(main())
