#!/usr/bin/env python3
"""What storing a capture by what changes saves: the same clip with tiles chosen one by one, and forced.

    tools/bench/tiles.py --build build --clips FOLDER [--only NAME:TOLERANCE ...] [--runs 7] [--csv FILE]

Every capture is exposed as a whole, uncompressed and warm, the kinds in turns. Given are the bytes that the
kernel reads, the milliseconds it takes by the device's own clock, the memory on the device at most, and the
seconds of the whole process; medians, and the share of what dense tiles take.
"""

import pathlib
import re
import statistics
import subprocess
import tempfile
import time

from tables import command_line, write_outputs

KINDS = ("auto", "dense", "rows", "records")
CLIPS = ("one-by-one-person-detection.mp4:4", "one-by-one-person-detection.mp4:0", "bikes.mp4:0", "bikes.mp4:4",
         "bicycle-wheel.mp4:0", "bottle-detection.mp4:0")
REPORT = re.compile(r"(\w+) precision; \d+ blocks? of ([\d.]+) MB made ready in [\d.]+ ms, read by the kernel in "
                    r"([\d.]+) ms .* at most ([\d.]+) MB on the device")


def measure(clip, tolerance, build, folder, runs, precision):
    captures = {kind: folder / f"{kind}.tik" for kind in KINDS}
    for kind, capture in captures.items():
        subprocess.run([build / "nutik-cl", "encode", "--overwrite", "-q", "--codec", "none", "--tiles", kind, "--tolerance",
                        tolerance, clip, capture], check=True)
    values = {kind: {"kernel_ms": [], "process_s": []} for kind in KINDS}
    for run in range(runs + 1):  # the first one warms up
        for kind in KINDS:
            start = time.perf_counter()
            out = subprocess.run([build / "nutik-cl", "expose", "--overwrite", "-v", "--precision", precision, "--start", "0s",
                                  "--exposure", "24h", captures[kind], folder / "picture.png"],
                                 check=True, capture_output=True, text=True).stdout
            seconds = time.perf_counter() - start
            report = REPORT.search(out)
            if run == 0:
                continue
            values[kind]["kernel_ms"].append(float(report[3]))
            values[kind]["process_s"].append(seconds)
            values[kind]["read_mb"], values[kind]["device_mb"] = float(report[2]), float(report[4])
    rows = []
    for kind in KINDS:
        row = {"clip": clip.name, "tolerance": tolerance, "tiles": kind, "precision": precision}
        for name, value in values[kind].items():
            row[name] = statistics.median(value) if isinstance(value, list) else value
        rows.append(row)
        captures[kind].unlink()
    return rows


def main():
    parser = command_line(__doc__, runs=7)
    parser.add_argument("--clips", type=pathlib.Path, required=True)
    parser.add_argument("--only", nargs="*", default=CLIPS)
    parser.add_argument("--precision", default="single")
    arguments = parser.parse_args()

    everything = []
    print(f"{'clip':32} {'tol.':>4} {'tiles':8} {'MB read':>8} {'share':>5} {'kernel ms':>9} {'share':>5} "
          f"{'device MB':>9} {'share':>5} {'process s':>9} {'share':>5}")
    with tempfile.TemporaryDirectory() as scratch:
        for entry in arguments.only:
            name, tolerance = entry.rsplit(":", 1)
            rows = measure(arguments.clips / name, tolerance, arguments.build.resolve(), pathlib.Path(scratch),
                           arguments.runs, arguments.precision)
            dense = next(row for row in rows if row["tiles"] == "dense")
            for row in rows:
                columns = [f"{row[key]:{width}.{digits}f} {row[key] / dense[key]:5.2f}"
                           for key, width, digits in (("read_mb", 8, 1), ("kernel_ms", 9, 2), ("device_mb", 9, 1),
                                                      ("process_s", 9, 3))]
                print(f"{name:32} {tolerance:>4} {row['tiles']:8} {' '.join(columns)}", flush=True)
            everything += rows
    write_outputs(arguments, everything)


if __name__ == "__main__":
    main()
