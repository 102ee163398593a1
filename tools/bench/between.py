#!/usr/bin/env python3
"""How near a long exposure of a slow clip comes to that of the fast clip it was taken from, with and without samples made
between its pictures (--between auto).

Every 4th and every 8th picture of each clip is taken, and a long exposure over all of them compared with that of the whole
clip, where something moves: root mean square differences, in codes of 255. `line`: light goes in a straight line from one
picture to the next. `floor`: what noise alone leaves, the difference that still pixels have between the two. `share` is
between's part of line's error.

    tools/bench/between.py NUTIK_CL CLIP … [--pictures 65] [--first N] [--json]
"""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

import cv2
import numpy as np

CHANGED = 8  # codes


def run(*words):
    return subprocess.run([str(word) for word in words], check=True, capture_output=True, text=True).stdout


def pictures_of(clip, first, count):
    video = cv2.VideoCapture(str(clip))
    taken = []
    for number in range(first + count):
        there, picture = video.read()
        if not there:
            break
        if number >= first:
            taken.append(picture)
    return taken


def exposed(nutik, clip, folder, name, *options, rate, end):
    picture = folder / f"{name}.png"
    run(nutik, "expose", "-q", "--overwrite", "-f", rate, *options, "--start", f"{0.5 / 1000}s",
        "--exposure", f"{end / 1000}s", "--depth", "16", clip, picture)
    return cv2.imread(str(picture), cv2.IMREAD_UNCHANGED).astype(np.float64) / 257


def measured(nutik, clip, first, count, folder):
    pictures = pictures_of(clip, first, count)
    rows = []
    for every in (4, 8):
        last = (len(pictures) - 1) // every * every
        whole = pictures[:last + 1]
        for name, taken in (("whole", whole), ("part", whole[::every])):
            target = folder / name
            target.mkdir(exist_ok=True)
            for old in target.glob("*"):
                old.unlink()
            for number, picture in enumerate(taken):
                cv2.imwrite(str(target / f"{number:04}.png"), picture)
        still = ("--transfer", "srgb")
        truth = exposed(nutik, folder / "whole", folder, "truth", *still, rate=1000, end=last)
        slow = (*still, "-a", f"{360 / every:g}")
        pace = {"rate": f"{1000 // every}", "end": last}
        line = exposed(nutik, folder / "part", folder, "line", *slow, **pace)
        made = exposed(nutik, folder / "part", folder, "made", *slow, "--between", "auto", **pace)
        step = max(1, every // 2)
        moves = np.zeros(truth.shape[:2], bool)
        for number in range(0, last - step + 1, step):
            moves |= cv2.blur(cv2.absdiff(whole[number], whole[number + step]), (3, 3)).max(2) > CHANGED

        def error(picture, where):
            return float(np.sqrt(np.mean((picture - truth)[where] ** 2))) if where.any() else 0.0
        rows.append({"clip": clip.stem, "every": every, "moves": float(moves.mean()), "line": error(line, moves),
                     "between": error(made, moves), "floor": error(line, ~moves)})
    return rows


def main():
    words = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    words.add_argument("nutik", type=pathlib.Path)
    words.add_argument("clips", type=pathlib.Path, nargs="+")
    words.add_argument("--pictures", type=int, default=65)
    words.add_argument("--first", type=int, default=0)
    words.add_argument("--json", action="store_true")
    asked = words.parse_args()
    print(f"{'clip':32} {'every':>5} {'moves':>6} {'line':>7} {'between':>7} {'share':>6} {'floor':>6}")
    for clip in asked.clips:
        with tempfile.TemporaryDirectory() as folder:
            for row in measured(asked.nutik, clip, asked.first, asked.pictures, pathlib.Path(folder)):
                print(f"{row['clip']:32} {row['every']:5} {row['moves']:6.1%} {row['line']:7.3f} {row['between']:7.3f} "
                      f"{row['between'] / max(row['line'], 1e-9):6.3f} {row['floor']:6.3f}", flush=True)
                if asked.json:
                    print(json.dumps(row), file=sys.stderr)


if __name__ == "__main__":
    main()
