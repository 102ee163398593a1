#!/usr/bin/env python3
"""nutik-cl beside what people use today: the same clip, the same picture, in one run.

    tools/bench/peers.py --build build [--size 1920x1080 --frames 240 | --clip FILE] [--runs 5]
                         [--slow] [--csv FILE] [--chart FILE.png]

Whole processes, in turns, medians: nutik-cl from the clip and from captures, its scalar reference, a loop in
Python with OpenCV, one with a mask of 16 regions in NumPy, ffmpeg's tmix and ImageMagick's mean. tmix makes
a picture for each frame on the way, so its time per picture stands beside it, and both average codes where
the others average light. With --slow also those two where they take minutes.

Beside them the arithmetic alone, decoded frames being in memory: the loops' and the kernel's, by the
device's own clock. Without --clip one is made: noise over moving shapes, H.264.
"""

import pathlib
import re
import statistics
import sys
import tempfile
from functools import partial

from tables import command_line, output_of, peak_megabytes, pyplot, run, run_once, size_of, write_outputs

LOOPS = pathlib.Path(__file__).with_name("peer_loops.py")
KERNEL = re.compile(r"read by the kernel in ([\d.]+) ms")
# Above this many values ffmpeg and ImageMagick take minutes and gigabytes.
LARGEST_WITHOUT_SLOW = 640 * 480 * 64
PYTHON = "/usr/bin/python3"


def make_clip(path, size, frames):
    run_once("ffmpeg", "-v", "error", "-y", "-f", "lavfi", "-i", f"testsrc2=size={size}:rate=240,noise=alls=6:allf=t",
        "-frames:v", str(frames), "-c:v", "libx264", "-preset", "veryfast", "-pix_fmt", "yuv420p", path)


def region_inputs(folder, width, height, frames):
    """A mask of 16 stripes and functions with a gain for each frame: what the NumPy loop computes."""
    stripes = bytes(x * 16 // width for x in range(width)) * height
    (folder / "regions.pgm").write_bytes(b"P5\n%d %d\n255\n" % (width, height) + stripes)
    period = 1e9 / 240
    with (folder / "regions.fn").open("w") as file:
        for region in range(16):
            points = [f"[{round(k * period)}:{1 + (k * (region + 3)) % 7}]" for k in range(frames + 1)]
            file.write(f"M{region}{{{', '.join(points)}}}\n")


def programs(build, clip, folder, frames, values, slow):
    """What is timed: name, command, pictures that it makes."""
    program = build / "nutik-cl"
    plain = ("--start", "0s", "--exposure", "24h")
    masked = ("-m", folder / "regions.pgm", "-k", folder / "regions.fn")
    picture = folder / "picture.png"
    for codec in ("none", "rice"):
        run_once(program, "encode", "--overwrite", "-q", "--codec", codec, clip, folder / f"{codec}.tik")
    yield "nutik-cl, from the clip", (program, "expose", "--overwrite", "-q", *plain, clip, picture), 1
    yield "nutik-cl, from a capture (rice)", (program, "expose", "--overwrite", "-q", *plain, folder / "rice.tik", picture), 1
    yield "nutik-cl, from a capture (none)", (program, "expose", "--overwrite", "-q", *plain, folder / "none.tik", picture), 1
    yield "nutik-cl, 16 regions, from a capture (none)", (program, "expose", "--overwrite", "-q", *masked, folder / "none.tik",
                                                          picture), 1
    yield "scalar reference, from a capture (none)", (program, "expose", "--overwrite", "-q", "--renderer", "reference", *plain,
                                                      folder / "none.tik", picture), 1
    yield "Python and OpenCV, a loop", (PYTHON, LOOPS, "loop", clip, picture), 1
    yield "Python and NumPy, 16 regions", (PYTHON, LOOPS, "regions", clip, picture), 1
    if values > LARGEST_WITHOUT_SLOW and not slow:
        return
    yield "ffmpeg tmix", ("ffmpeg", "-v", "error", "-y", "-i", clip, "-vf", f"tmix=frames={frames}", "-f", "null",
                          "-"), frames
    stills = folder / "stills"
    stills.mkdir()
    run_once("ffmpeg", "-v", "error", "-i", clip, stills / "%05d.png")
    yield "ImageMagick mean (of stills)", ("convert", f"{stills}/*.png", "-evaluate-sequence", "mean", picture), 1


def arithmetic(build, clip, folder):
    """Seconds of the arithmetic alone, by name: once each call."""
    program = build / "nutik-cl"
    for precision in ("single", "double"):
        report = output_of(program, "expose", "--overwrite", "-v", "--precision", precision, "--start", "0s", "--exposure", "24h",
                           folder / "none.tik", folder / "picture.png")
        yield f"kernel, {precision}", float(KERNEL.search(report)[1]) / 1e3
    yield "Python and OpenCV, a loop", float(output_of(PYTHON, LOOPS, "loop", "--memory", clip))
    yield "Python and NumPy, 16 regions", float(output_of(PYTHON, LOOPS, "regions", "--memory", clip))


def chart(path, rows, title):
    plt = pyplot()

    kinds = {"process": ("#0060a8", "whole process"), "arithmetic": ("#c85000", "arithmetic alone")}
    figure, axes = plt.subplots(figsize=(10, 0.36 * len(rows) + 1.4), layout="constrained")
    ordered = sorted(rows, key=lambda row: (row["kind"] == "arithmetic", row["seconds"]), reverse=True)
    for place, row in enumerate(ordered):
        axes.barh(place, row["seconds"], color=kinds[row["kind"]][0])
        axes.text(row["seconds"] * 1.05, place, f"{row['seconds']:.3g} s", va="center", fontsize=9)
    axes.set_yticks(range(len(ordered)), [row["what"] for row in ordered])
    axes.set_xscale("log")
    axes.set_xlim(right=max(row["seconds"] for row in rows) * 3)
    axes.set_xlabel("seconds, median")
    axes.set_title(title, fontsize=11)
    handles = [plt.Rectangle((0, 0), 1, 1, color=colour) for colour, _ in kinds.values()]
    axes.legend(handles, [name for _, name in kinds.values()], loc="upper right")
    figure.savefig(path, dpi=110)


def main():
    parser = command_line(__doc__, runs=5, chart=True)
    parser.add_argument("--size", default="640x480")
    parser.add_argument("--frames", type=int, default=30)
    parser.add_argument("--clip", type=pathlib.Path)
    parser.add_argument("--slow", action="store_true")
    arguments = parser.parse_args()
    build = arguments.build.resolve()

    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        clip = arguments.clip
        if clip is None:
            clip = folder / "clip.mp4"
            make_clip(clip, arguments.size, arguments.frames)
        width, height, frames = size_of(clip)
        region_inputs(folder, width, height, frames)
        timed = list(programs(build, clip, folder, frames, width * height * frames, arguments.slow))
        seconds = {}
        for _ in range(arguments.runs + 1):
            for name, command, _ in timed:
                seconds.setdefault(("process", name), []).append(run(*command))
            for name, value in arithmetic(build, clip, folder):
                seconds.setdefault(("arithmetic", name), []).append(value)
        memory = {name: peak_megabytes(*command) for name, command, _ in timed}

    pictures = {name: count for name, _, count in timed}
    rows = []
    for (kind, name), values in seconds.items():
        median = statistics.median(values[1:])  # the first one warmed up
        rows.append({"what": name, "kind": kind, "seconds": median, "least": min(values[1:]), "most": max(values[1:]),
                     "seconds_per_picture": median / pictures[name] if kind == "process" else None,
                     "peak_mb": memory[name] if kind == "process" else None})
    loop = next(row["seconds"] for row in rows if row["what"].startswith("Python and OpenCV"))
    loop_alone = next(row["seconds"] for row in rows
                      if row["what"].startswith("Python and OpenCV") and row["kind"] == "arithmetic")
    print(f"{width} x {height}, {frames} frames, medians of {arguments.runs}")
    print(f"{'':46} {'s':>8} {'/ loop':>7} {'s/picture':>10} {'peak MB':>8}")
    for row in rows:
        ratio = row["seconds"] / (loop if row["kind"] == "process" else loop_alone)
        each = f"{row['seconds_per_picture']:10.3f} {row['peak_mb']:8.0f}" if row["kind"] == "process" else ""
        print(f"{row['kind'] + ': ' if row['kind'] == 'arithmetic' else ''}{row['what']:{46 if row['kind'] == 'process' else 34}}"
              f" {row['seconds']:8.3f} {ratio:7.2f} {each}")
    write_outputs(arguments, rows, partial(chart, title=f"{width} × {height}, {frames} frames, to one picture"))


if __name__ == "__main__":
    main()
