#!/usr/bin/python3
"""Holds the gallery to what docs/how-to/gallery.md promises.

    check_gallery.py --only page
    check_gallery.py --only recipes --program nutik-cl --work FOLDER

`page`: the page prints every recipe as tools/gallery.py runs it, and shows its pictures. `recipes`: three recipes are run
on small clips of their scenes, of which everything is known. What was measured is printed, also on success.
"""

import argparse
import re
import subprocess
import sys
from pathlib import Path

import cv2
import numpy as np

from report import Report

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
import gallery  # noqa: E402
from scenes import camera  # noqa: E402

LARGEST_GALLERY_BYTES = 2_500_000
SIZE = "256x144"  # one pixel for each of the slit-scan's columns
TOLERANCE = 2     # codes by which recipes let a capture differ from its clip
NOISE_SIGMAS = 6  # 110 592 codes: one in 1e9 lies further out


def check_page(report):
    page = (ROOT / "docs" / "how-to" / "gallery.md").read_text()
    blocks = re.findall(r"^```sh\n(.*?)^```$", page, re.DOTALL | re.MULTILINE)
    scripts = {path.stem: path.read_text() for path in (ROOT / "tools" / "gallery").glob("*.sh")}
    report.hold(set(scripts) == set(gallery.RECIPES), f"a script for each recipe: {', '.join(sorted(scripts))}")
    for name, text in scripts.items():
        report.hold(text in blocks, f"docs/how-to/gallery.md prints tools/gallery/{name}.sh as it is run")
    real = {path.stem: path.read_text() for path in (ROOT / "tools" / "gallery" / "real").glob("*.sh")}
    report.hold(set(real) == set(gallery.REAL), f"a script for each real recording: {', '.join(sorted(real))}")
    for name, text in real.items():
        report.hold(text in blocks, f"docs/how-to/gallery.md prints tools/gallery/real/{name}.sh as it is run")
        link = f"images/gallery/{name + '-real' if name in gallery.RECIPES else 'recordings'}.jpg"
        report.hold(f"](../{link})" in page and (ROOT / "docs" / link).exists(), f"the page shows {link}")
    report.hold(len(blocks) == len(scripts) + len(real), f"the page has {len(blocks)} scripts for {len(scripts)} recipes and {len(real)} recordings")
    pictures = ROOT / "docs" / "images" / "gallery"
    for name in scripts:
        for ending in (".jpg", "-scene.jpg", "-plot.png"):
            link = f"images/gallery/{name}{ending}"
            report.hold(f"](../{link})" in page and (ROOT / "docs" / link).exists(), f"the page shows {link}")
    size = sum(path.stat().st_size for path in pictures.iterdir())
    report.hold(size <= LARGEST_GALLERY_BYTES, f"pictures of {size} bytes, at most {LARGEST_GALLERY_BYTES}")


def read(path):
    """[height, width, channels], RGB, as real numbers."""
    picture = cv2.imread(str(path))
    if picture is None:
        sys.exit(f"{path} cannot be read")
    return picture[..., ::-1].astype(float)


def frames_of(folder):
    clip, frames = cv2.VideoCapture(str(folder / "clip.mkv"), cv2.CAP_FFMPEG), []
    while True:
        found, frame = clip.read()
        if not found:
            return np.array(frames)
        frames.append(frame[..., ::-1])


def empty_scene(folder):
    """The codes of what does not move, and how far from them a sample may be held: noise, tolerance, rounding."""
    light = np.load(folder / "background.npy").astype(float)
    sigma = camera.noise_sigma(light)
    reach = [camera.srgb_codes(light + way * NOISE_SIGMAS * sigma) for way in (-1, 1)]
    codes = camera.srgb_codes(light)
    return codes, np.maximum(codes - reach[0], reach[1] - codes) + TOLERANCE + 1


def check_slit_scan(folder, report):
    """Each column is that of its own picture of the clip."""
    picture, frames = read(folder / "picture.png"), frames_of(folder)
    expected = np.stack([frames[column, :, column] for column in range(256)], axis=1)
    worst = np.abs(picture - expected).max()
    report.hold(worst <= TOLERANCE, f"slit-scan: column k is picture k's; worst {worst:.0f} codes of {TOLERANCE}")
    single = [np.abs(picture - frames[k]).max() for k in (0, 128, 255)]
    report.hold(min(single) > 100, f"slit-scan: no single picture shows it; they are {min(single):.0f} codes off or more")


def check_empty_street(folder, report):
    """Nobody is left, though every picture of the clip has people in it."""
    picture, frames = read(folder / "picture.png"), frames_of(folder)
    empty, bound = empty_scene(folder)
    excess = np.abs(picture - empty) - bound
    row, column, channel = np.unravel_index(np.argmax(excess), excess.shape)
    report.hold(excess.max() <= 0, f"empty street: worst at x {column}, y {row}, {'RGB'[channel]}: "
                f"{picture[row, column, channel]:.0f} against {empty[row, column, channel]:.1f}, "
                f"may differ by {bound[row, column, channel]:.1f}")
    rms = np.sqrt(np.mean((read(folder / "plate.png") - empty) ** 2))
    report.hold(rms <= 1, f"empty street: the plate differs from the empty scene by {rms:.2f} codes, root mean square")
    people = [np.mean((np.abs(frame - empty) > bound).any(axis=-1)) for frame in frames.astype(float)]
    report.hold(min(people) > 0.01, f"empty street: in every picture of the clip people take {min(people):.1%} or more")


def check_frozen_subject(folder, report):
    """The salmon is that of a single picture, and the water is smooth."""
    picture, frames = read(folder / "picture.png"), frames_of(folder).astype(float)
    mask = cv2.imread(str(folder / "regions.pgm"), cv2.IMREAD_UNCHANGED)
    frame = frames[round(1.65 * 120)]
    subject = mask == 255
    worst = np.abs(picture - frame)[subject].max()
    report.hold(subject.sum() > 200 and worst <= TOLERANCE,
                f"frozen subject: {subject.sum()} pixels of the picture at 1.65 s; worst {worst:.0f} codes of {TOLERANCE}")
    water = np.ptp(frames[:144], axis=0).max(axis=-1) > 60
    water &= np.roll(water, 1, axis=0)
    rough = [np.abs(np.diff(image, axis=0, prepend=image[:1]))[water].mean() for image in (picture, frame)]
    report.hold(water.sum() > 2000 and rough[0] < rough[1] / 2,
                f"frozen subject: water changes from row to row by {rough[0]:.1f} codes, in a single picture by {rough[1]:.1f}")


def check_recipes(program, work, report):
    checks = {"slit-scan": check_slit_scan, "empty-street": check_empty_street, "frozen-subject": check_frozen_subject}
    for recipe, check in checks.items():
        try:
            folder = gallery.make(recipe, program, work, SIZE, plots=False)
        except subprocess.CalledProcessError as error:
            sys.exit(f"{recipe}: {error}")
        check(folder, report)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", choices=("page", "recipes"), required=True)
    parser.add_argument("--program", type=Path)
    parser.add_argument("--work", type=Path)
    options = parser.parse_args()
    report = Report()
    if options.only == "page":
        check_page(report)
    else:
        check_recipes(options.program.resolve(), options.work.resolve(), report)
    report.end()


if __name__ == "__main__":
    main()
