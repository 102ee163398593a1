#!/usr/bin/env python3
"""How much longer encoding and exposing a clip take than decoding it.

    tools/bench/decoding.py --build build --clips FOLDER [--only NAME ...] [--runs 7] [--csv FILE]

Decoding alone is done three ways: by this program's reader and nothing else, by ffmpeg (to rgb24, thrown away), both
as whole processes, and by OpenCV in a loop, without the interpreter's start. The others are whole processes:
encoding without and with compression, and exposing all of the clip to a PNG. In turns, medians, in seconds.
"""

import pathlib
import statistics
import tempfile

from tables import command_line, output_of, run, write_outputs

LOOPS = pathlib.Path(__file__).with_name("peer_loops.py")
PYTHON = "/usr/bin/python3"


def measure(clip, build, folder, runs):
    program, capture, picture = build / "nutik-cl", folder / "capture.tik", folder / "picture.png"

    def encode(codec):
        return run(program, "encode", "--overwrite", "-q", "--codec", codec, clip, capture, makes=capture)

    timed = {
        "decode": lambda: run(build / "bench_decode", clip),
        "ffmpeg": lambda: run("ffmpeg", "-v", "error", "-i", clip, "-f", "rawvideo", "-pix_fmt", "rgb24", "-y",
                              "/dev/null"),
        "opencv": lambda: float(output_of(PYTHON, LOOPS, "decode", clip)),
        "encode, none": lambda: encode("none"),
        "encode, rice": lambda: encode("rice"),
        "expose": lambda: run(program, "expose", "--overwrite", "-q", "--start", "0s", "--exposure", "24h", clip, picture),
    }
    seconds = {name: [] for name in timed}
    for _ in range(runs + 1):
        for name, once in timed.items():
            seconds[name].append(once())
    return {"clip": clip.name} | {name: statistics.median(values[1:]) for name, values in seconds.items()}


def main():
    arguments = command_line(__doc__, runs=7, clips=True).parse_args()
    rows = []
    print(f"{'':34} {'decode':>7} {'ffmpeg':>7} {'opencv':>7}  encode, none: s, / decode, / ffmpeg, / opencv   "
          "rice: s, / decode   expose: s, / decode, / ffmpeg, / opencv")
    with tempfile.TemporaryDirectory() as scratch:
        for name in arguments.only:
            row = measure(arguments.clips / name, arguments.build.resolve(), pathlib.Path(scratch), arguments.runs)
            rows.append(row)
            peers = ("decode", "ffmpeg", "opencv")
            print(f"{name:34} " + " ".join(f"{row[peer]:7.3f}" for peer in peers)
                  + f"  {row['encode, none']:14.3f} " + " ".join(f"{row['encode, none'] / row[p]:9.2f}" for p in peers)
                  + f"   {row['encode, rice']:7.3f} {row['encode, rice'] / row['decode']:8.2f}"
                  + f"   {row['expose']:9.3f} " + " ".join(f"{row['expose'] / row[p]:9.2f}" for p in peers),
                  flush=True)
    write_outputs(arguments, rows)


if __name__ == "__main__":
    main()
