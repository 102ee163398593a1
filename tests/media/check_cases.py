#!/usr/bin/env python3
"""Small clips of many kinds, each with what is right for it: codes of its pictures, or a refusal that names its kind.

    check_cases.py --program nutik-cl --cases FOLDER --work FOLDER

Each case is read as it is. Pictures are then exposed one by one with the clip's own transfer function, and their codes
compared with those that the file was made of.
"""

import argparse
import re
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import cv2
import numpy as np

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent / "tools")]
from report import Report  # noqa: E402


class Case(NamedTuple):
    clip: str
    options: str = ""
    status: int = 0
    said: tuple = ()  # parts of what is printed
    codes: tuple = ()  # of the first pixel (R, G, B or grey) of each picture from the first on
    within: int = 0  # codes; lossy codecs round
    size: tuple = ()
    values: tuple = ()  # all codes of the first picture
    quarter_turns: int = 0  # of the first picture, from what is stored to what is upright


RAMP = tuple(round(4 * k * 255 / 219) for k in range(48))  # luma 16 + 4 k of the limited range
RATED = ("240 pictures a second",)
ONCE = (*RATED, "48 samples", "edit list")
UNTOLD = ("does not say how fast it was taken", "state the rate (--fps)")
NOT_READ = "which is not read; "
TO_PNG = NOT_READ + "make PNGs of "

CASES = [
    Case("unsized-over-260kB/pad_260000.ts", said=(*RATED, "48 samples"), codes=RAMP, within=1),
    Case("unsized-over-260kB/pad_260111.ts", said=(*RATED, "48 samples"), codes=RAMP, within=1),
    # Cut within their ninth picture, on both sides of a limit that once was one.
    *(Case(f"unsized-over-260kB/{name}.mjpeg", "-f 240 --ignore-errors", said=(*RATED, "8 samples", "warning: "))
      for name in ("z1", "z2")),
    *(Case(f"unsized-over-260kB/{name}.mjpeg", "-f 240", 3, ("picture 8 ", "(--ignore-errors)"))
      for name in ("z1", "z2")),
    *(Case(f"edit-list/{name}", said=ONCE, codes=RAMP, within=1) for name in ("e_rate.mov", "e_loop.mp4", "e_back.mp4")),
    *(Case(f"rate-nobody-states/{name}", "", 3, UNTOLD) for name in ("pi_novui.h264", "pi.mjpeg", "b_nof.y4m")),
    Case("rate-nobody-states/pi_1M.h264", "", 3, ("its header states 1000000 a second", UNTOLD[1])),
    *(Case(f"rate-nobody-states/{name}", "-f 240", said=RATED, codes=RAMP, within=1)
      for name in ("pi_novui.h264", "pi.mjpeg", "pi_1M.h264")),
    Case("rate-nobody-states/b_nof.y4m", "-f 240", said=(*RATED, "24 samples")),
    Case("slow-motion-ramp/iramp.mov", said=("48 samples", "4.167 ms", "33.33 ms", "240 (--fps)"), codes=RAMP, within=1),
    Case("slow-motion-ramp/iramp.mov", "-f 240", said=(*RATED, "48 samples")),
    Case("tiff-one-directory/trunc.tif", "-f 100", said=("20 samples",), codes=tuple(range(0, 2000, 100)), size=(16, 12)),
    Case("tiff-channels-as-time/ijc.tif", "-f 100", 3, ("2 channels, 2 slices, 5 moments", "Make Subset")),
    Case("tiff-fps/ij.tif", said=("500 pictures a second", "20 samples"), codes=tuple(range(0, 2000, 100))),
    *(Case(f"tiff-grey-of-3-channels/{name}", "-f 100", 3, ("3 samples a pixel are channels of grey", "MinIsBlack"))
      for name in ("mb3.tif", "mb3p.tif")),
    Case("tiff-1bit-tiled/tiled-gray-i1.tif", "-f 100", said=("37 x 51 grey, 1 sample",), size=(37, 51), values=(0, 255)),
    *(Case(f"ser-byte-order/{name}", "-f 100", 3, ("it is taken for ser (SER", "16-bit TIFFs")) for name in ("b.ser", "c12.ser")),
    Case("fits-restretched/m.fits", "-f 100", 3, ("it is taken for fits (", "16-bit TIFFs")),
    Case("mosaic-without-black-level/t14.mlv", "-f 100", 3, ("mosaic of a sensor", "MLV App makes DNGs")),
    Case("dng-float16/f16.dng", "-f 100", 3, ("holds floating-point values", "16 bits")),
    Case("apng-named-png/a.png", said=("10 samples", "irregular times", "5 of the clip's 9 steps", "20 ms", "100 ms"),
         codes=tuple(range(0, 100, 10))),
    Case("png-exif-turned/exif.png", "-f 100", said=("37 x 53 grey",), size=(37, 53), quarter_turns=-1),
    Case("two-sequences-in-a-folder", "-f 100", 3, ("two sequences", "left_000.png", "right_000.png", "/*.png' takes all")),
    Case("name-with-colon/12:30:01.mkv", said=("120 pictures a second", "12 samples")),
    Case("no-index/nomoov.mp4", "", 3, ("its index (moov) is missing",)),
    Case("no-index/mj_badidx.avi", "", 3, ("picture 1 cannot be decoded", "(--ignore-errors)")),
    Case("avi-industrial-fourcc/fc_Y16_64.avi", "", 3, ("which the file calls 'Y16 '", "(--raw)")),
    Case("avi-industrial-fourcc/fc_BA81_64.avi", "", 3, ("which the file calls 'BA81'", "(--raw)")),
    *(Case(f"other-still-kinds/{name}", "-f 100", 3, (f" is {kind}, " + TO_PNG,))
      for name, kind in (("f000.bmp", "a BMP picture"), ("f001.dpx", "a DPX picture"), ("f000.webp", "a WebP picture"),
                         ("a.webp", "a WebP picture"), ("f001.jp2", "a JPEG 2000 picture"),
                         ("f001.jxl", "a JPEG XL picture"), ("f0.heic", "a HEIC picture"))),
    Case("other-still-kinds/f001.exr", "-f 100", 3, ("holds floating-point light, and nothing says how much of it is white",)),
    Case("event-kinds/generic.es", "", 3, ("an Event Stream recording (.es), " + NOT_READ + "if it holds events",)),
    Case("event-kinds/a.bag", "", 3, ("a ROS bag, " + NOT_READ,)),
    Case("event-kinds/ev.csv", "", 3, ("a table of stills has three: file,start_ns,exposure_ns",)),
    Case("event-kinds/ev.txt", "", 3, ("is a text, and no clip", "events are read as EVT 3.0 or DAT")),
    Case("event-kinds/norpix6.seq", "", 3, ("a NorPix sequence (.seq), " + NOT_READ, "StreamPix")),
]


class Cases:
    def __init__(self, program, cases, work):
        self.program, self.cases, self.work = program, cases, work
        self.report = Report()

    def run(self, *words):
        return subprocess.run([self.program, *words], cwd=self.work, capture_output=True, text=True, timeout=60)

    def pictures(self, count):
        files = [self.work / f"picture-{sample}.png" for sample in range(count)]
        for file in files:
            file.unlink(missing_ok=True)
        self.run("expose", "clip.tik", "-o", "picture-%d.png", "--start", "0f", "--exposure", "1f", "--every", "1f",
                 "--count", str(count), "--out-transfer", "source", "--renderer", "reference", "--no-recipe")
        found = [cv2.imread(str(file), cv2.IMREAD_UNCHANGED) for file in files]
        return [each[..., ::-1] if each is not None and each.ndim == 3 else each for each in found]

    def check(self, case):
        title = f"{case.clip} {case.options}".strip()
        ran = self.run("encode", "--overwrite", *case.options.split(), self.cases / case.clip, "clip.tik")
        printed = ran.stdout + ran.stderr
        self.report.hold(ran.returncode == case.status, f"{title}: status {ran.returncode}")
        missing = [part for part in case.said if part not in printed]
        self.report.hold(not missing, f"{title}: says what it is" + f", but not {missing}: {printed}" * bool(missing))
        if ran.returncode != 0:
            return
        pictures = self.pictures(max(1, len(case.codes)))
        if case.size:
            height, width = pictures[0].shape[:2]
            self.report.hold((width, height) == case.size, f"{title}: {width} x {height}")
        if case.values:
            values = np.unique(pictures[0]).tolist()
            self.report.hold(tuple(values) == case.values, f"{title}: codes {values}")
        if case.quarter_turns:
            stored = cv2.imread(str(self.cases / case.clip), cv2.IMREAD_UNCHANGED | cv2.IMREAD_IGNORE_ORIENTATION)
            self.report.hold(np.array_equal(pictures[0], np.rot90(stored, case.quarter_turns)), f"{title}: is upright")
        worst = max((65535 if found is None else abs(int(np.ravel(found)[0]) - right)
                     for found, right in zip(pictures, case.codes)), default=0)
        if case.codes:
            self.report.hold(worst <= case.within,
                             f"{title}: {len(case.codes)} pictures, {worst} codes away at most, {case.within} allowed")

    def every_case_is_held(self):
        """Nothing lies there of which nothing is said here."""
        there = {str(file.relative_to(self.cases)) for file in self.cases.glob("*/*")}
        said = {case.clip for case in CASES}
        left = {file for file in there if file not in said and file.split("/")[0] not in said}
        self.report.hold(not left, f"every file has a case{': not ' * bool(left)}{', '.join(sorted(left))}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True, type=Path)
    parser.add_argument("--cases", required=True, type=Path)
    parser.add_argument("--work", required=True, type=Path)
    given = parser.parse_args()
    if not given.cases.is_dir():
        print(f"SKIPPED: {given.cases} is not there")
        return
    given.work.mkdir(parents=True, exist_ok=True)
    cases = Cases(given.program.resolve(), given.cases.resolve(), given.work.resolve())
    for case in CASES:
        cases.check(case)
    cases.every_case_is_held()
    cases.report.end()


if __name__ == "__main__":
    main()
