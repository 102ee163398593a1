#!/usr/bin/python3
"""Draws the gallery's scenes and runs its recipes, tools/gallery/*.sh, as docs/how-to/gallery.md prints them.

Each recipe runs in a folder of its own, where its scene's clip.mkv lies, with nutik-cl and FnPlotter.py in PATH. It
makes picture.png and plot.png. --publish FOLDER writes the pictures of the page there:
NAME.jpg, NAME-scene.jpg (the clip's picture at one moment), NAME-plot.png and strip.jpg. With --recordings FOLDER it
makes NAME-real.jpg instead, from real recordings that lie in that folder, and of all of them recordings.jpg, in which
each stands beside a picture of its clip.
"""

import argparse
import inspect
import os
import subprocess
import sys
from pathlib import Path

import cv2
import numpy as np

from scenes import SCENES

TOOLS = Path(__file__).resolve().parent
# Recipe: the scene that it is made from, and a moment of it, in seconds, as a camera would have taken it.
RECIPES = {
    "motion-study": ("bouncing-ball", 1.0),
    "rear-curtain": ("night-drive", 1.8),
    "frozen-subject": ("waterfall", 1.65),
    "empty-street": ("street", 2.0),
    "strobe": ("golfer", 0.58),
    "slit-scan": ("windmill", 0.5),
}
# What real recordings show, their files, the clip first, and a picture of it: tools/gallery/real/NAME.sh runs beside them.
REAL = {
    "motion-study": (("one-by-one-person-detection.mp4",), "1192f"),
    "empty-street": (("one-by-one-person-detection.mp4",), "430f"),
    "rear-curtain": (("one-by-one-person-detection.mp4",), "862f"),
    "falling-ball": (("ball_12bit.mraw", "ball_12bit.cihx"), "7f"),
    "droplets": (("cine_781.cine",), "7f"),
}
JPEG_QUALITY = 88
SCENE_SIZE = (512, 288)
STRIP_TILE = (384, 216)


def run(command, **how):
    print("$ " + " ".join(map(str, command)), flush=True)
    subprocess.run(list(map(str, command)), check=True, **how)


def film(recipe, folder, size):
    """The scene's clip in the recipe's folder, unless it is there and newer than what draws it."""
    clip = folder / "clip.mkv"
    own = inspect.getfile(SCENES[RECIPES[recipe][0]])
    sources = [TOOLS / "scene.py", TOOLS / "scenes" / "camera.py", TOOLS / "scenes" / "painting.py", Path(own)]
    if not clip.exists() or any(source.stat().st_mtime > clip.stat().st_mtime for source in sources):
        run([sys.executable, TOOLS / "scene.py", folder, "--scene", RECIPES[recipe][0], "--size", size])


def commands_in_path(program, folder, plots):
    """PATH with a folder in front that has the program and the plotter under the names that recipes use."""
    folder.mkdir(parents=True, exist_ok=True)
    plotter = f'#!/bin/sh\nexec "{sys.executable}" "{TOOLS / "FnPlotter.py"}" "$@"\n' if plots else "#!/bin/sh\n"
    for name, text in (("nutik-cl", f'#!/bin/sh\nexec "{program}" "$@"\n'), ("FnPlotter.py", plotter)):
        (folder / name).write_text(text)
        (folder / name).chmod(0o755)
    return f"{folder}{os.pathsep}{os.environ['PATH']}"


def make(recipe, program, work, size, plots=True):
    """Draws the scene and runs the recipe, with or without its plot; the folder that holds what it made."""
    folder = work / recipe
    folder.mkdir(parents=True, exist_ok=True)
    film(recipe, folder, size)
    # What the recipe made the last time goes: the program replaces nothing unasked.
    filmed = max((folder / name).stat().st_mtime for name in ("clip.mkv", "truth.json"))
    for made in folder.iterdir():
        if made.is_file() and made.stat().st_mtime > filmed:
            made.unlink()
    environment = os.environ | {"PATH": commands_in_path(program, work / "bin", plots)}
    environment.setdefault("MPLCONFIGDIR", str(work / "matplotlib"))
    run(["bash", "-euo", "pipefail", TOOLS / "gallery" / f"{recipe}.sh"], cwd=folder, env=environment)
    run([program, "-q", "--start", f"{RECIPES[recipe][1]}s", "--exposure", "1f", "clip.tik", "scene.png"], cwd=folder)
    return folder


def make_real(recipe, program, work, recordings):
    """Runs the recipe on its recording; the folder with picture.png."""
    files, moment = REAL[recipe]
    folder = work / f"{recipe}-real"
    folder.mkdir(parents=True, exist_ok=True)
    for made in folder.iterdir():
        made.unlink()
    for name in files:
        recording = recordings.resolve() / name
        if not recording.exists():
            raise OSError(f"{recording} is not there; docs/how-to/gallery.md says where it is from")
        (folder / name).symlink_to(recording)
    environment = os.environ | {"PATH": commands_in_path(program, work / "bin", plots=False)}
    run(["bash", "-euo", "pipefail", TOOLS / "gallery" / "real" / f"{recipe}.sh"], cwd=folder, env=environment)
    run([program, "-q", "--start", moment, "--exposure", "1f", files[0], "scene.png"], cwd=folder)
    return folder


def read(path):
    picture = cv2.imread(str(path))
    if picture is None:
        raise OSError(f"{path} cannot be read")
    return picture


def write(path, picture):
    if not cv2.imwrite(str(path), picture, [cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY, cv2.IMWRITE_PNG_COMPRESSION, 9]):
        raise OSError(f"{path} cannot be written")


def publish(recipe, folder, target):
    write(target / f"{recipe}.jpg", read(folder / "picture.png"))
    scene = cv2.resize(read(folder / "scene.png"), SCENE_SIZE, interpolation=cv2.INTER_AREA)
    write(target / f"{recipe}-scene.jpg", scene)
    plot = read(folder / "plot.png")
    reduced = cv2.resize(plot, None, fx=0.75, fy=0.75, interpolation=cv2.INTER_AREA)
    write(target / f"{recipe}-plot.png", reduced // 8 * 8 + 7)  # 32 levels: a third of the bytes, and looks the same


def publish_strip(work, target):
    tiles = [cv2.resize(read(work / recipe / "picture.png"), STRIP_TILE, interpolation=cv2.INTER_AREA) for recipe in RECIPES]
    write(target / "strip.jpg", np.vstack([np.hstack(tiles[:3]), np.hstack(tiles[3:])]))


def publish_recordings(work, target):
    def pair(name, size):
        return np.hstack([cv2.resize(read(work / f"{name}-real" / f"{which}.png"), size, interpolation=cv2.INTER_AREA)
                          for which in ("scene", "picture")])

    left = [pair(name, STRIP_TILE) for name in ("motion-study", "empty-street", "rear-curtain")]
    side = 3 * STRIP_TILE[1] // 2
    right = [pair(name, (side, side)) for name in ("falling-ball", "droplets")]
    write(target / "recordings.jpg", np.hstack([np.vstack(left), np.vstack(right)]))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True, type=Path, help="nutik-cl")
    parser.add_argument("--work", required=True, type=Path, help="where clips, captures and pictures lie")
    parser.add_argument("--size", default="768x432", help="of the scenes (default: 768x432)")
    parser.add_argument("--only", choices=RECIPES, action="append", help="this recipe; may be repeated")
    parser.add_argument("--publish", type=Path, metavar="FOLDER", help="write the pictures of docs/how-to/gallery.md")
    parser.add_argument("--recordings", type=Path, metavar="FOLDER", help="make the pictures of real recordings, which lie there")
    options = parser.parse_args()
    program, work = options.program.resolve(), options.work.resolve()
    if options.publish:
        options.publish.mkdir(parents=True, exist_ok=True)
    for recipe in [recipe for recipe in options.only or REAL if options.recordings and recipe in REAL]:
        folder = make_real(recipe, program, work, options.recordings)
        if options.publish:
            if recipe in RECIPES:
                write(options.publish / f"{recipe}-real.jpg", read(folder / "picture.png"))
    if options.publish and options.recordings and not options.only:
        publish_recordings(work, options.publish)
    recipes = [] if options.recordings else options.only or list(RECIPES)
    for recipe in recipes:
        folder = make(recipe, program, work, options.size)
        if options.publish:
            publish(recipe, folder, options.publish)
    if options.publish and recipes and all((work / recipe / "picture.png").exists() for recipe in RECIPES):
        publish_strip(work, options.publish)


if __name__ == "__main__":
    try:
        main()
    except (OSError, subprocess.CalledProcessError) as error:
        sys.exit(f"gallery.py: {error}")
