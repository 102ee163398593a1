#!/usr/bin/env python3
"""Adds golden captures: one small .tik for each case below that has none yet.

    make_golden.py --program nutik-cl

Files that exist are never made again: they are what earlier programs wrote, and check_golden.py holds every later one
to them. To cover something new in the format, add a case, run this, and commit the file and golden.json.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
from itertools import combinations
from pathlib import Path
from typing import NamedTuple

import numpy as np

import check_golden
from check_golden import HERE, MANIFEST

CHANNELS = {"grey": 1, "colour": 3}
RATES = {"constant": ["-f", "300"], "fractional": ["-f", "240000/1001", "-a", "172.8"], "irregular": []}


class Case(NamedTuple):
    codec: str
    tiles: str
    depth: int       # bits of the source's codes
    channels: str
    timeline: str
    change: str      # what is a change: "lossless", "tolerance", or a noise model's curve ("auto": measured)
    transfer: str
    samples: int = 22
    block_samples: int = 6
    width: int = 19  # no multiples of a tile's 8
    height: int = 13
    name: str = ""
    options: tuple = ()  # of encoding, besides

    def file(self):
        words = (self.codec, self.tiles, f"{self.depth}-bit", *self[3:6], self.transfer.replace(":", "-"))
        return (self.name or "-".join(words)) + ".tik"


# Every two values of every two columns meet in a line: main() holds that.
CASES = [
    Case("lz4", "auto", 8, "colour", "irregular", "sensor", "gamma:2.2"),
    Case("lz4", "dense", 12, "colour", "fractional", "tolerance", "bt709"),
    Case("lz4", "records", 16, "colour", "irregular", "lossless", "srgb"),
    Case("lz4", "records", 8, "grey", "constant", "points", "linear"),
    Case("lz4", "rows", 10, "grey", "constant", "points", "srgb"),
    Case("lz4", "rows", 16, "grey", "constant", "sensor", "linear"),
    Case("none", "auto", 16, "colour", "constant", "points", "bt709"),
    Case("none", "auto", 16, "grey", "fractional", "tolerance", "linear"),
    Case("none", "dense", 12, "grey", "constant", "sensor", "srgb"),
    Case("none", "dense", 8, "grey", "irregular", "lossless", "linear"),
    Case("none", "records", 10, "grey", "irregular", "tolerance", "bt709"),
    Case("none", "rows", 10, "colour", "fractional", "lossless", "gamma:2.2"),
    Case("none", "rows", 12, "colour", "irregular", "lossless", "bt709"),
    Case("zstd", "auto", 10, "grey", "fractional", "sensor", "srgb"),
    Case("zstd", "auto", 12, "grey", "constant", "lossless", "linear"),
    Case("zstd", "dense", 10, "colour", "fractional", "points", "linear"),
    Case("zstd", "dense", 16, "colour", "constant", "tolerance", "gamma:2.2"),
    Case("zstd", "records", 12, "grey", "irregular", "points", "gamma:2.2"),
    Case("zstd", "records", 8, "grey", "fractional", "sensor", "bt709"),
    Case("zstd", "rows", 8, "colour", "constant", "tolerance", "srgb"),
]
SPECIAL = [
    Case("zstd", "auto", 8, "colour", "constant", "lossless", "srgb", samples=1, width=1, height=1, name="one-pixel"),
    Case("lz4", "auto", 8, "grey", "irregular", "lossless", "srgb", block_samples=1, name="one-sample-a-block"),
    Case("zstd", "auto", 8, "colour", "fractional", "auto", "srgb", samples=40, block_samples=9, name="noise-auto"),
    # More than 255 samples a block take an index of two bytes.
    Case("zstd", "rows", 8, "grey", "constant", "lossless", "srgb", 310, 300, 9, 3, "long-block-rows"),
    Case("none", "records", 12, "colour", "irregular", "lossless", "linear", 310, 300, 9, 3, "long-block-records"),
    # Fields, which version 0 has none of.
    Case("zstd", "auto", 10, "colour", "constant", "lossless", "hlg", name="version-1-wide-bt2020-hlg",
         options=("--primaries", "bt2020", "--pixel-aspect", "32:27")),
    Case("lz4", "auto", 8, "grey", "irregular", "tolerance", "gamma:1.8", name="version-1-narrow-irregular",
         options=("--pixel-aspect", "3:4")),
    # Rice codes: of each width, in records, and with an index of two bytes.
    Case("rice", "auto", 8, "colour", "constant", "lossless", "srgb", name="rice-colour"),
    Case("rice", "records", 12, "grey", "irregular", "points", "linear", name="rice-records-wide"),
    Case("rice", "rows", 8, "grey", "constant", "lossless", "srgb", 310, 300, 9, 3, "rice-long-block-rows"),
    Case("rice", "dense", 16, "colour", "fractional", "tolerance", "bt709", name="rice-dense-wide"),
    # A packed group of tiles has up to 2 MiB unpacked.
    Case("zstd", "dense", 12, "colour", "constant", "lossless", "bt709", 100, 100, 131, 67, "several-groups-of-tiles"),
]

EXPOSURES = [  # options of `expose`; functions and masks lie beside this script
    "--start 7ms --exposure 23ms --depth 8",
    "--start 2f --exposure 1f",
    "--start 0s --exposure 55ms --shutter hann --normalize integral --depth 16",
    "-m regions-{size}.pgm -k regions.fn --depth 16 --negative offset",
    "-m regions-{size}.pgm -k regions.fn --start 9ms --normalize absolute --ev 0.5 --depth 8 --negative abs",
]
ONE_SAMPLE = [  # of a capture that has one, 1/300 s long
    "--start 0f --exposure 1f",
    "--start 1ms --exposure 2ms --gain 0.7 --depth 16",
    "-m regions-{size}.pgm -k regions.fn --depth 8 --negative offset",
]


def light_of(case):
    """Sample by sample [height, width, channels], shares of white: a still ramp, a square that moves, a pixel that
    blinks, a tile that is never still, and in cases with a noise model a little noise everywhere."""
    random = np.random.default_rng(list(case.file().encode()))
    channels = CHANNELS[case.channels]
    x, y, c = np.meshgrid(np.arange(case.width), np.arange(case.height), np.arange(channels), indexing="xy")
    ramp = (x + 2 * y + 3 * c + 2) / (case.width + 2 * case.height + 3 * channels + 4)
    for k in range(case.samples):
        light = ramp.copy()
        left = (k * 2) % (case.width + 4) - 3
        light[2:7, max(left, 0):max(left + 4, 0)] = [0.9, 0.55, 0.3][:channels]
        if k % 5 == 0:
            light[-1, 0] = 1
        light[8:16, -3:] = random.random(light[8:16, -3:].shape)
        if case.change in ("sensor", "points", "auto"):
            light += random.normal(0, 0.01, light.shape)
        yield np.clip(light, 0, 1)


def write_stills(case, folder):
    """The case's clip in a folder, as a list of names."""
    white = 2 ** case.depth - 1
    kind, ending = ("P5", "pgm") if case.channels == "grey" else ("P6", "ppm")
    names = []
    for k, light in enumerate(light_of(case)):
        codes = np.floor(light * white + 0.5).astype(">u2" if white > 255 else np.uint8)
        names.append(f"{k:03}.{ending}")
        header = f"{kind} {case.width} {case.height} {white}\n".encode()
        (folder / names[-1]).write_bytes(header + codes.tobytes())
    return names


def write_table(names, path):
    """Exposures of 1 to 3 ms, with and without a gap to the next."""
    lines, start = [], 0
    for k, name in enumerate(names):
        exposure = 1_000_003 + 500_000 * (k % 5)
        lines.append(f"{name},{start},{exposure}\n")
        start += exposure + 700_001 * (k % 3)
    path.write_text("".join(lines))


def write_noise(case, path):
    white, points = 2 ** case.depth - 1, "point 0.1 0.008 90\npoint 0.4 0.011 120\npoint 0.9 0.010 80\n"
    text = f"nutik noise 0\nwhite {white}\ntransfer {case.transfer}\n"
    for channel in ["grey"] if case.channels == "grey" else ["red", "green", "blue"]:
        text += f"channel {channel}\nread 0.009\nshot 0.0001\ncurve {case.change}\n"
        for line in points.splitlines():
            code, deviation, pixels = line.split()[1:]
            text += f"point {float(code) * white:.6g} {float(deviation) * white:.6g} {pixels}\n"
    path.write_text(text)


def write_capture(program, case):
    with tempfile.TemporaryDirectory() as scratch:
        scratch = Path(scratch)
        names = write_stills(case, scratch)
        source = f"*.{names[0].split('.')[1]}"
        if case.timeline == "irregular":
            source = "table.csv"
            write_table(names, scratch / source)
        change = {"lossless": [], "tolerance": ["--tolerance", str(2 ** case.depth // 90 + 1)],
                  "auto": ["--noise", "auto"]}.get(case.change)
        if change is None:
            write_noise(case, scratch / "camera.noise")
            change = ["--noise", "camera.noise", "--sigmas", "3.5"]
        subprocess.run([program, "encode", "-q", *case.options, *RATES[case.timeline], "--transfer", case.transfer, *change,
                        "--codec", case.codec, "--tiles", case.tiles, "--block-samples", str(case.block_samples),
                        source, str(HERE / case.file())], cwd=scratch, check=True)


def write_mask(case):
    """Three regions, which no tile's edge divides. Returns the size in the mask's name."""
    size = f"{case.width}x{case.height}"
    x, y = np.meshgrid(np.arange(case.width), np.arange(case.height))
    mask = np.where(x + 2 * y < case.width, 0, np.where(y < case.height // 2 + 2, 128, 255)).astype(np.uint8)
    path = HERE / f"regions-{size}.pgm"
    if not path.exists():
        path.write_bytes(f"P5 {case.width} {case.height} 255\n".encode() + mask.tobytes())
    return size


def hold_pairs():
    values = [sorted({case[column] for case in CASES}, key=str) for column in range(7)]
    for first, second in combinations(range(7), 2):
        for pair in ((one, other) for one in values[first] for other in values[second]):
            if not any((case[first], case[second]) == pair for case in CASES):
                sys.exit(f"no case has both {pair[0]} and {pair[1]}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True, type=os.path.abspath)
    program = parser.parse_args().program
    hold_pairs()
    manifest = json.loads(MANIFEST.read_text()) if MANIFEST.exists() else {}
    for case in CASES + SPECIAL:
        if (HERE / case.file()).exists() or case.file() in manifest:
            continue
        write_capture(program, case)
        size = write_mask(case)
        exposures = [line.format(size=size) for line in (EXPOSURES if case.samples > 1 else ONE_SAMPLE)]
        with tempfile.TemporaryDirectory() as work:
            checksums = check_golden.checksums_of(program, case.file(), exposures, Path(work))
        manifest[case.file()] = {"info": check_golden.info_of(program, case.file()),
                                 "pictures": dict(zip(exposures, checksums))}
        print(case.file())
        MANIFEST.write_text(json.dumps(manifest, indent=1, ensure_ascii=False) + "\n")


if __name__ == "__main__":
    main()
