#!/usr/bin/env python3
"""Feeds every reader with every other's files under its own name, and with its own files cut at 24 places.

    check_names.py --program nutik-cl --work FOLDER [--only names|cuts]

    names   each file under the names that other kinds have: what it holds counts, or it is refused
    cuts    what is left of a file is its beginning, or a warning that --quiet keeps says what is missing, or it is refused

Pictures are compared by the mean of all that were read, which the reference makes.
"""

import argparse
import re
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "tools")]
from check_damage import HEIGHT, PICTURES, WIDTH, write_photron, write_recordings, write_stills, write_videos  # noqa: E402
from report import Report  # noqa: E402

CUTS = 24
# What write_videos does not make of colour.rgb: containers and streams that end where they like.
MORE_VIDEOS = {
    "a.nut": "-c:v ffv1 -pix_fmt bgr0", "a.ts": "-c:v mpeg2video -q:v 2", "a.mts": "-c:v libx264 -crf 12 -f mpegts",
    "a.mpg": "-c:v mpeg2video -q:v 2", "a.h264": "-c:v libx264 -crf 12", "a.hevc": "-c:v libx265 -x265-params log-level=error:pools=1",
    "a.mjpeg": "-c:v mjpeg -q:v 2 -pix_fmt yuvj420p", "a.gif": "-pix_fmt rgb8", "a.apng": "-f apng", "a.m2v": "-c:v mpeg2video -q:v 2",
    "a.dv": "-s 720x576 -r 25 -pix_fmt yuv420p", "mjpeg.mkv": "-c:v mjpeg -q:v 2 -pix_fmt yuvj420p",
    "a.webm": "-c:v libvpx-vp9 -cpu-used 8", "a.ivf": "-c:v libvpx-vp9 -cpu-used 8", "frag.mp4":
    "-c:v libx264 -crf 12 -movflags frag_keyframe+empty_moov -g 2", "a.flv": "-c:v flv1 -q:v 2 -pix_fmt yuv420p", "a.wmv": "-c:v wmv2 -q:v 2 -pix_fmt yuv420p",
    "a.ogv": "-c:v libtheora -pix_fmt yuv420p", "a.mxf": "-c:v mpeg2video -q:v 2 -r 25", "raw.mov": "-c:v rawvideo -pix_fmt rgb24",
    "color.y4m": "-pix_fmt yuv444p",
}
UNTIMED = (".h264", ".hevc", ".mjpeg", ".m2v")
# A name of each reader, and some that readers share.
NAMES = [".png", ".tif", ".pgm", ".ppm", ".jpg", ".dng", ".raw", ".dat", ".adder", ".csv", ".mraw", ".cih", ".cine",
         ".mp4", ".mkv", ".avi", ".gif", ".apng", ".ts", ".h264", ".mjpeg", ".dv", ".y4m", ".nut", ".tik", ".h261"]


class File(NamedTuple):
    path: Path
    options: list

    def sure(self, samples):
        """Of a cut file's samples those whose light nothing behind the cut tells. Nothing ends an H.265 stream's picture or
        an event's light but what comes next; the codecs of the other files have a checksum or a length."""
        return samples - self.path.name.endswith((".hevc", ".raw", ".dat", ".adder"))


class Bench:
    def __init__(self, program, folder):
        self.program, self.folder = program, folder

    def run(self, *words):
        done = subprocess.run([self.program, *map(str, words)], cwd=self.folder, stdin=subprocess.DEVNULL,
                              capture_output=True, timeout=120, check=False)
        return done.returncode, done.stdout.decode(errors="replace"), done.stderr.decode(errors="replace")

    def encode(self, words, capture):
        """Status, and what was said, also with --quiet."""
        capture.unlink(missing_ok=True)
        status, _, said = self.run("encode", "--quiet", *words, capture)
        return status, said

    def samples(self, capture):
        _, told, _ = self.run("info", capture)
        return int(re.search(r"samples +(\d[\d ]*)", told)[1].replace(" ", ""))

    def mean(self, capture, samples):
        picture = capture.with_suffix(f".{samples}.tif")
        status, _, said = self.run(capture, picture, "--start", "0f", "--exposure", f"{samples}f", "--renderer",
                                   "reference", "--no-recipe", "--depth", "16")
        if status != 0:
            return said
        try:
            return picture.read_bytes()
        finally:
            picture.unlink()

    @lru_cache(maxsize=None)
    def mean_of_whole(self, capture, samples):
        return self.mean(capture, samples)

    def is_beginning(self, capture, samples, whole, whole_samples, sure):
        if not 0 < samples <= whole_samples:
            return False
        return sure == 0 or self.mean(capture, sure) == self.mean_of_whole(whole, sure)

    def refused(self, status, said):
        return status in (2, 3) and said.strip() != ""


def files(folder):
    """Of each reader a file, and how it is told to read it."""
    for each in write_stills(folder):
        path = folder / each.words[-1]
        if path.is_dir() and path.name != "camera":
            path = sorted(path.iterdir())[0]
        if path.is_file():
            yield File(path, ["-f", "100"])
    for each in [*write_recordings(folder), *write_videos(folder)]:
        if "--raw" not in each.words:
            yield File(folder / each.words[-1], each.words[:-1])
    for name, options in MORE_VIDEOS.items():
        made = subprocess.run(["ffmpeg", "-v", "error", "-y", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{WIDTH}x{HEIGHT}",
                               "-r", "50", "-i", "colour.rgb", "-threads", "1", "-pix_fmt", "yuv420p" if "x26" in options
                               or "mpeg2" in options or "vp9" in options else "+", *options.split(), name],
                              cwd=folder, check=False, capture_output=True, text=True)
        if made.returncode != 0:
            print(f"left out: this ffmpeg does not make {name}: {made.stderr.strip().splitlines()[0]}")
            continue
        yield File(folder / name, (["-f", "100"] if name.endswith(UNTIMED) else []) + ["--deinterlace", "no"])


def whole_of(bench, file):
    capture = bench.folder / f"whole-{file.path.parent.name}-{file.path.name}.tik"
    status, said = bench.encode([*file.options, file.path], capture)
    if status != 0:
        sys.exit(f"{file.path} cannot be read: {said}")
    return capture, bench.samples(capture)


def check_names(report, bench, file):
    whole, samples = whole_of(bench, file)
    wrong, right = [], 0
    for ending in NAMES:
        folder = bench.folder / f"as-{whole.stem}{ending}"
        folder.mkdir()
        disguised = folder / f"film{ending}"
        shutil.copy(file.path, disguised)
        capture = folder / "read.tik"
        status, said = bench.encode([*file.options, disguised], capture)
        # Captures of the same pictures differ at most by what they say about the clip.
        if status == 0 and capture.read_bytes() != whole.read_bytes():
            found = bench.samples(capture)
            if found != samples or not bench.is_beginning(capture, found, whole, samples, found):
                wrong.append(f"as {ending}: {found} of {samples} pictures or others: {said[:300]}")
        elif status != 0 and not bench.refused(status, said):
            wrong.append(f"as {ending}: status {status}: {said[:300]}")
        right += status == 0
        shutil.rmtree(folder)
    report.hold(not wrong, f"{file.path.parent.name}/{file.path.name}: read under {right} of {len(NAMES)} names" +
                "".join(f"\n    {each}" for each in wrong))


def check_cuts(report, bench, file):
    whole, samples = whole_of(bench, file)
    data, wrong, warned, silent = file.path.read_bytes(), [], 0, 0
    folder = bench.folder / f"cut-{whole.stem}"
    folder.mkdir()
    for k in range(1, CUTS + 1):
        left = len(data) * k // (CUTS + 1)
        cut = folder / f"cut{file.path.suffix}"
        cut.write_bytes(data[:left])
        capture = folder / "read.tik"
        status, said = bench.encode([*file.options, cut], capture)
        found = bench.samples(capture) if status == 0 else 0
        if status != 0 and not bench.refused(status, said):
            wrong.append(f"{left} of {len(data)} bytes: status {status}: {said[:300]}")
        elif status == 0 and "warning:" in said:
            warned += 1
        elif status == 0 and not bench.is_beginning(capture, found, whole, samples, file.sure(found)):
            wrong.append(f"{left} of {len(data)} bytes: {found} of {samples} pictures, others: {said[:300]}")
        elif status == 0:
            silent += 1
    shutil.rmtree(folder)
    report.hold(not wrong, f"{file.path.parent.name}/{file.path.name}: {CUTS} cuts, {warned} warnings, {silent} its beginning, without a word" +
                "".join(f"\n    {each}" for each in wrong))


PARTS = {"names": check_names, "cuts": check_cuts}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=Path, required=True)
    parser.add_argument("--work", type=Path, required=True)
    parser.add_argument("--only", choices=PARTS)
    given = parser.parse_args()
    if shutil.which("ffmpeg") is None:
        print("SKIPPED: the ffmpeg command is missing, which makes videos")
        return
    report = Report()
    for part, check in PARTS.items():
        if given.only not in (None, part):
            continue
        folder = (given.work / part).resolve()
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        bench = Bench(given.program.resolve(), folder)
        with ThreadPoolExecutor(2) as pool:
            list(pool.map(lambda file: check(report, bench, file), list(files(folder))))
    report.end()


if __name__ == "__main__":
    main()
