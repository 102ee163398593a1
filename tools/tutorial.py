#!/usr/bin/python3
"""Runs a tutorial as its page prints it, and compares what is printed with what the page says.

    tools/tutorial.py first-picture --program build/nutik-cl --work FOLDER
    tools/tutorial.py first-picture --program build/nutik-cl --work FOLDER --publish docs/images/tutorial

Blocks of `sh` are run in FOLDER, one after another, beside the clip that the page is about. A block of `text` behind one
has lines that they print, whatever the numbers in them are. --publish writes the page's pictures; --size makes a smaller clip.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import cv2
import numpy as np

import gallery
from scenes import SCENES, camera

PAGES = Path(__file__).resolve().parents[1] / "docs" / "tutorial"
STRIP_HEIGHT = 270
JPEG = [cv2.IMWRITE_JPEG_QUALITY, 85]


def draw_ball(folder, size):
    """What tools/demo leaves in demo/."""
    camera.film(SCENES["rolling-ball"](*size), 1, folder / "clip.mkv")


def draw_phone_clip(folder, size):
    """A drawn scene as a phone keeps it: H.264 that plays eight times too slowly, and says so."""
    scene = SCENES["bouncing-ball"](*size)
    camera.film(scene, 1, folder / "drawn.mkv")
    subprocess.run(["ffmpeg", "-v", "error", "-y", "-r", "30", "-i", "drawn.mkv", "-c:v", "libx264", "-crf", "18",
                    "-pix_fmt", "yuv420p", "-movflags", "use_metadata_tags",
                    "-metadata", f"com.android.capture.fps={scene.fps}", "clip.mp4"], cwd=folder, check=True)
    (folder / "drawn.mkv").unlink()


# Page: its clip, and of its pictures (strips of those that it makes) which.
TUTORIALS = {
    "first-picture": (draw_ball, {"sheet": ["sheet"], "moments": ["moment", "blur"], "preview": ["preview"],
                                  "pictures": ["picture", "trail"]}),
    "phone-clip": (draw_phone_clip, {"styles": ["clip-study", "strobe", "empty"]}),
}


def steps(page):
    """Commands, and lines that they print, as far as the page shows them."""
    blocks = re.findall(r"^```sh\n(.*?)^```$(?:\n\n```text\n(.*?)^```$)?", page, re.DOTALL | re.MULTILINE)
    if not blocks:
        raise ValueError("the page has no commands")
    return blocks


def without_numbers(line):
    """A line of output, but for numbers, units of size, and the device that computed it."""
    line = re.sub(r"(?<= s) on .*", "", line)
    line = re.sub(r"\d[\d.]*", "0", line)
    return re.sub(r" +", " ", line.replace("0 kB", "0 MB")).strip()


def run(commands, expected, folder, environment):
    print("".join(f"$ {line}\n" for line in commands.splitlines()), end="", flush=True)
    done = subprocess.run(["bash", "-euo", "pipefail", "-c", commands], cwd=folder, env=environment, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    print(done.stdout, end="", flush=True)
    if done.returncode != 0:
        raise ValueError(f"exit status {done.returncode}")
    printed = {without_numbers(line) for line in done.stdout.splitlines()}
    for line in expected.splitlines():
        if without_numbers(line) not in printed:
            raise ValueError(f"the page says, and this was not printed:\n  {line}")


def publish(strips, folder, target):
    target.mkdir(parents=True, exist_ok=True)
    for name, pictures in strips.items():
        shown = []
        for picture in pictures:
            pixels = gallery.read(folder / f"{picture}.png")
            share = 1 if len(pictures) == 1 else STRIP_HEIGHT / pixels.shape[0]
            share = min(share, 900 / pixels.shape[1])
            shown += [cv2.resize(pixels, None, fx=share, fy=share, interpolation=cv2.INTER_AREA)]
            shown += [np.full((shown[0].shape[0], 6, 3), 255, np.uint8)]
        cv2.imwrite(str(target / f"{name}.jpg"), np.hstack(shown[:-1]), JPEG)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("page", choices=TUTORIALS)
    parser.add_argument("--program", type=Path, required=True)
    parser.add_argument("--work", type=Path, required=True)
    parser.add_argument("--size", default="640x360")
    parser.add_argument("--publish", type=Path, metavar="FOLDER")
    options = parser.parse_args()
    draw, strips = TUTORIALS[options.page]
    shutil.rmtree(options.work, ignore_errors=True)
    folder = options.work.resolve() / "clip"
    folder.mkdir(parents=True)
    draw(folder, tuple(int(part) for part in options.size.split("x")))
    environment = os.environ | {"PATH": gallery.commands_in_path(options.program.resolve(), folder.parent / "bin", True)}
    environment.setdefault("MPLCONFIGDIR", str(folder.parent / "matplotlib"))
    for commands, expected in steps((PAGES / f"{options.page}.md").read_text()):
        run(commands, expected, folder, environment)
    if options.publish:
        publish(strips, folder, options.publish)


if __name__ == "__main__":
    try:
        main()
    except (OSError, ValueError, subprocess.CalledProcessError) as error:
        sys.exit(f"tutorial.py: {error}")
