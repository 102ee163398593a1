#!/usr/bin/env python3
"""Every command on files that were made to hurt: how much memory it takes, and how soon it answers SIGTERM.

    check_hostile.py --program nutik-cl --work FOLDER [--markdown]

Each command line is run twice: to its end, and ended by SIGTERM in the middle. Memory must stay below a ceiling that
follows from what the file honestly needs; SIGTERM is answered within a second, of which three are allowed on a machine
that is busy. --markdown prints what it measured as a table.
"""

import argparse
import os
import random
import shutil
import signal
import struct
import subprocess
import sys
import time
import zlib
from pathlib import Path
from typing import NamedTuple

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "tools"))
from report import Report  # noqa: E402
from words import over  # noqa: E402

MB = 1 << 20
# Beside what the program takes with its libraries and an OpenCL driver for a tiny capture, which is 104 MB on Debian 12
# and 163 on 13: small pictures; and OpenCL's compiler.
SMALL_MB = 16
DEVICE_MB = 210
# More of it where kernels of all arithmetics are compiled: 240 MB were measured, 190 for single precision alone.
ALL_ARITHMETICS_MB = 30
ANSWER_S, PATIENCE = 1.0, 3.0
LONGEST_S = 300

SIDE, SAMPLES = 600, 64
BLOCK_MB = SIDE * SIDE * SAMPLES / MB  # of a black clip whose tiles are all kept: a few kB in the file
PNG_SIDE = 8_000
PNG_MB = PNG_SIDE * PNG_SIDE / MB
POINTS = 300_000
POINTS_MB = POINTS * (16 + 20) / MB    # as the program keeps them, and their text

SENSOR_W, SENSOR_H, EVENT_SWEEPS = 1280, 720, 6
# An event as it is read and as it is kept, and what is known of a pixel, of which blocks hold copies.
EVENTS_MB = SENSOR_W * SENSOR_H * (EVENT_SWEEPS * (16 + 12) + 21 + 8 * 2) / MB
DELAYS = 65_536
# A function with its course, and its table of a block's samples, here and on the device.
DELAYS_MB = DELAYS * (600 + 2 * 16 * (SAMPLES + 1)) / MB


class Line(NamedTuple):
    words: str
    needs_mb: float = 0  # beside what every command takes: copies of a picture, a block or points
    statuses: tuple = (0,)
    uses_device: bool = False


LINES = (
    Line("encode -f 10 huge.tif o.tik", 0, (3,)),
    Line("encode -f 10 black.png o.tik", 6 * PNG_MB),
    Line(f"encode -f 10 --raw {SIDE}x{SIDE}:gray black.gray o.tik", 2 * BLOCK_MB),
    Line("info dense.tik"),
    Line("check dense.tik", BLOCK_MB),
    Line("check -k points.fn dense.tik", 3 * POINTS_MB + BLOCK_MB),
    Line("--start 0s --exposure 6s dense.tik o.png", 2 * BLOCK_MB, uses_device=True),
    Line("--renderer reference --start 0s --exposure 6s dense.tik o.png", 2 * BLOCK_MB),
    Line("-k points.fn dense.tik o.png", 6 * POINTS_MB + 2 * BLOCK_MB, uses_device=True),
    Line("--start 0s --exposure 1s -m black.png -k points.fn dense.tik o.png", 0, (2, 3), uses_device=True),
    Line("--start 0s --exposure 1f --every 1f dense.tik -o o-%03d.png", 2 * BLOCK_MB, uses_device=True),
    Line("batch list.txt dense.tik", 2 * BLOCK_MB, (1,), uses_device=True),
    Line("video --out-fps 100 dense.tik o.mkv", 2 * BLOCK_MB, uses_device=True),
    Line("video --out-fps 1 --key 0s points.fn --key 1s points.fn dense.tik o.mkv", 9 * POINTS_MB + 2 * BLOCK_MB,
         (0, 2), uses_device=True),
    Line("contact --every 2f dense.tik o.png", 2 * BLOCK_MB, uses_device=True),
    Line("contact ages.tik o.png", uses_device=True),
    Line("sweep --start 0s --exposure 1f --shift 0f..30f/2f dense.tik o.png", 2 * BLOCK_MB, uses_device=True),
    Line("trace --pixel 5,5 --start 0s --exposure 6s dense.tik", BLOCK_MB),
    Line("validate --runs 1 --start 0s --exposure 6s dense.tik", 4 * BLOCK_MB + ALL_ARITHMETICS_MB, uses_device=True),
    Line("mask --moving dense.tik o.pgm", 2 * BLOCK_MB),
    Line(f"mask --size {PNG_SIDE}x{PNG_SIDE} --ellipse 4000,4000,3500,3000 --smooth 100 -o o.pgm", 14 * PNG_MB),
    Line("activity dense.tik o.png", 2 * BLOCK_MB),
    Line("activity ages.tik o.png"),
    Line("background dense.tik o.png", 3 * BLOCK_MB),
    Line("background busy.tik o.png", 4 * BLOCK_MB),
    Line("study busy.tik -o s.png", 4 * BLOCK_MB, (3,)),
    Line("solve -k solve.fn --wish all=plate busy.tik o.fn", 4 * BLOCK_MB, uses_device=True),
    Line(f"encode --align homography -f 10 --raw {SIDE}x{SIDE}:gray busy.gray o.tik", 2 * BLOCK_MB, (3,)),
    Line(f"encode --deflicker -f 10 --raw {SIDE}x{SIDE}:gray busy.gray o.tik", 4 * BLOCK_MB),
    Line("noise huge.tif -o o.noise", 0, (3,)),
    Line("recover cut.tik o.tik"),
    Line("thumbnail dense.tik o.png", 2 * BLOCK_MB),
    Line("retime -f 20 dense.tik o.tik"),
    Line("join dense.tik dense.tik -o o.tik"),
    Line("reproduce text.png", 0, (3,)),
    Line("encode full.raw o.tik", EVENTS_MB),
    Line("encode --memory 100MB full.raw o.tik", 0, (2,)),
    Line("--start 0s --exposure 1s --delay each.pgm:0s..5s dense.tik o.png", DELAYS_MB + 2 * BLOCK_MB, uses_device=True),
)


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def png(width, height, *texts):
    """Black, whole, and a thousandth of what it holds."""
    packer = zlib.compressobj(9)
    row = bytes(width + 1)
    data = b"".join(packer.compress(row) for _ in range(height)) + packer.flush()
    head = struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + b"".join(texts) + chunk(b"IDAT", data) + chunk(b"IEND", b"")


def tiff_of_few_bytes():
    """A grey TIFF of 16 bits that states 65536 x 65536 pixels."""
    data = bytes(40)
    entries = ((256, 4, 65536), (257, 4, 65536), (258, 3, 16), (259, 3, 5), (262, 3, 1), (273, 4, 8), (277, 3, 1),
               (278, 4, 65536), (279, 4, len(data)))
    file = b"II*\0" + struct.pack("<I", 8 + len(data)) + data + struct.pack("<H", len(entries))
    return file + b"".join(struct.pack("<HHII", tag, kind, 1, value) for tag, kind, value in entries) + bytes(4)


def events_of_few_bytes():
    """EVT 3.0 of full vectors: 12 events in 2 bytes, of all pixels, again and again."""
    lines = b"".join(struct.pack("<HH", y, 0x3800) + struct.pack("<H", 0x4FFF) * (SENSOR_W // 12) for y in range(SENSOR_H))
    return b"%% evt 3.0\n%% geometry %dx%d\n%% end\n" % (SENSOR_W, SENSOR_H) + struct.pack("<H", 0x8000) + lines * EVENT_SWEEPS


def write_inputs(folder, run):
    (folder / "huge.tif").write_bytes(tiff_of_few_bytes())
    (folder / "black.png").write_bytes(png(PNG_SIDE, PNG_SIDE))
    (folder / "full.raw").write_bytes(events_of_few_bytes())
    delays = [DELAYS * pixel // (SIDE * SIDE) for pixel in range(SIDE * SIDE)]
    (folder / "each.pgm").write_bytes(b"P5 %d %d 65535\n" % (SIDE, SIDE) + struct.pack(f">{len(delays)}H", *delays))
    (folder / "text.png").write_bytes(png(8, 8, *(chunk(b"tEXt", b"nutik-cl\0{" + b"[" * 60_000) for _ in range(40))))
    with (folder / "black.gray").open("wb") as black:
        black.truncate(SIDE * SIDE * SAMPLES)
    noise = random.Random(1)
    with (folder / "busy.gray").open("wb") as busy:  # picture by picture: what this process holds, a child begins with
        for _ in range(SAMPLES):
            busy.write(noise.randbytes(SIDE * SIDE))
    (folder / "solve.fn").write_text("M0 [0:1], [1000000000:1], [1000000001:g], [5000000000:g], [5000000001:0]\n")
    with (folder / "points.fn").open("w") as functions:
        functions.write("M0 {" + ",".join(f"[{1000 * i}:{i % 7}]" for i in range(POINTS)) + "}\n")
    (folder / "list.txt").write_text("--start 0s --exposure 1s a.png\n--" + "x" * 8_000_000 + "\n" +
                                     "".join(f"--start 0s --exposure {k}f l-{k}.png\n" for k in range(1, 12)))
    run(f"encode --tiles dense --block-samples {SAMPLES} -f 10 --raw {SIDE}x{SIDE}:gray black.gray dense.tik")
    run(f"encode -f 10 --raw {SIDE}x{SIDE}:gray busy.gray busy.tik")
    (folder / "tiny.gray").write_bytes(noise.randbytes(10 * 10 * 10))
    run("encode -f 10 --raw 10x10:gray tiny.gray tiny.tik")
    dense = (folder / "dense.tik").read_bytes()
    (folder / "cut.tik").write_bytes(dense[:-100])
    # One picture a year, for longer than anybody lives.
    (folder / "age").mkdir()
    table = "file,start_ns,exposure_ns\n"
    for year in range(120):
        (folder / f"age/{year}.pgm").write_bytes(b"P5 8 8 255\n" + bytes([year]) * 64)
        table += f"age/{year}.pgm,{year * 31_557_600 * 10**9},1000000\n"
    (folder / "ages.csv").write_text(table)
    run("encode ages.csv ages.tik")


class Bench:
    def __init__(self, program, folder):
        self.program, self.folder = program, folder

    def start(self, words):
        with (self.folder / "log").open("wb") as log:
            environment = os.environ | {"XDG_CACHE_HOME": str(self.folder / "cache")}
            return subprocess.Popen([self.program, *over(words.split()), "-q"], cwd=self.folder, env=environment,
                                    stdin=subprocess.DEVNULL, stdout=log, stderr=log)

    def said(self):
        return (self.folder / "log").read_text(errors="replace")[-300:]

    def run(self, words):
        """Status, seconds and peak of memory in MB."""
        began = time.monotonic()
        process = self.start(words)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        return process.returncode, time.monotonic() - began, usage.ru_maxrss / 1024

    def answers_in(self, words, after_s):
        """Seconds from SIGTERM to the end, and the status; None where it had ended before."""
        process = self.start(words)
        time.sleep(after_s)
        if process.poll() is not None:
            return None, process.returncode
        sent = time.monotonic()
        process.send_signal(signal.SIGTERM)
        process.wait(LONGEST_S)
        return time.monotonic() - sent, process.returncode


def check(bench, line, base_mb):
    """What is printed of a line, and what is wrong."""
    status, seconds, peak_mb = bench.run(line.words)
    ceiling_mb, wrong = base_mb + SMALL_MB + DEVICE_MB * line.uses_device + line.needs_mb, []
    if status not in line.statuses:
        wrong.append(f"status {status}: {bench.said()}")
    if peak_mb > ceiling_mb:
        wrong.append(f"{peak_mb:.0f} MB, of which {ceiling_mb:.0f} are allowed")
    # Not before the program has its handlers.
    answer_s, status = bench.answers_in(line.words, max(0.15, seconds / 2))
    if answer_s is not None and status not in (128 + signal.SIGTERM, *line.statuses):
        wrong.append(f"after SIGTERM status {status}: {bench.said()}")
    if answer_s is not None and answer_s > ANSWER_S * PATIENCE:
        wrong.append(f"SIGTERM was answered after {answer_s:.2f} s")
    left = [path.name for path in bench.folder.glob("*.part")] + [path.name for path in bench.folder.glob(".*.part")]
    if left:
        wrong.append(f"left {', '.join(left)}")
    return peak_mb, ceiling_mb, answer_s, wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=Path, required=True)
    parser.add_argument("--work", type=Path, required=True)
    parser.add_argument("--markdown", action="store_true")
    arguments = parser.parse_args()
    report, folder = Report(), arguments.work.resolve()
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    bench = Bench(arguments.program.resolve(), folder)

    def make(words):
        status, _, _ = bench.run(words)
        if status != 0:
            sys.exit(f"{words}: {bench.said()}")

    write_inputs(folder, make)
    status, _, base_mb = bench.run("background tiny.tik o.png")
    report.hold(status == 0, f"background tiny.tik o.png: {base_mb:.0f} MB, which every command may take")
    rows = []
    for line in LINES:
        peak_mb, ceiling_mb, answer_s, wrong = check(bench, line, base_mb)
        answered = "ends sooner" if answer_s is None else f"{answer_s:.2f} s"
        rows.append(f"| `{line.words}` | {peak_mb:.0f} | {ceiling_mb:.0f} | {answered} |")
        report.hold(not wrong, f"{line.words}: {peak_mb:.0f} MB of {ceiling_mb:.0f}, SIGTERM: {answered}" +
                    "".join(f"\n    {each}" for each in wrong))
    shutil.rmtree(folder)
    if arguments.markdown:
        print("| command line | peak MB | ceiling | SIGTERM |\n| --- | ---: | ---: | ---: |", *rows, sep="\n")
    report.end()


if __name__ == "__main__":
    main()
