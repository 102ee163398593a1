#!/usr/bin/env python3
"""How time and memory grow: with samples, pixels, functions, control points, and cores.

    tools/bench/scaling.py --build build [--runs 3] [--csv FILE] [--chart FILE.png]

One thing is varied at a time from 640 x 360, 240 samples, one function with two control points, all cores; cores at
1920 x 1080, where a kernel takes long enough for all of them to wake up.
Captures are uncompressed, made from a noisy clip so that nearly every tile is dense. Given are the kernel's
milliseconds by the device's own clock, the seconds of the whole process from .tik to PNG, and the most
memory that it held; medians. Beside the kernel's time stands what the first of its kind would become in proportion: as
many times as long as there are more samples or pixels, as long with more functions and points, parted among the cores.
"""

import os
import pathlib
import re
import statistics
import tempfile
import time

from tables import command_line, output_of, peak_megabytes, pyplot, run_once, write_outputs

KERNEL = re.compile(r"read by the kernel in ([\d.]+) ms")
BASE = {"samples": 240, "pixels": (640, 360), "functions": 1, "control points": 2, "cores": None}
VALUES = {
    "samples": (30, 60, 120, 240, 480, 960),
    "pixels": ((160, 90), (320, 180), (640, 360), (1280, 720), (1920, 1080)),
    "functions": (1, 4, 16, 64, 256),
    "control points": (2, 10, 100, 1000, 10_000, 100_000),
    "cores": tuple(range(1, len(os.sched_getaffinity(0)) + 1)),
}
GROWTH = {"samples": 1, "pixels": 1, "functions": 0, "control points": 0, "cores": -1}  # the power of proportion
ELSEWHERE = {"cores": {"pixels": (1920, 1080)}}
RATE = 240


def make_capture(program, folder, samples, pixels):
    """A capture of this size, made once."""
    width, height = pixels
    capture = folder / f"{width}x{height}x{samples}.tik"
    if not capture.exists():
        clip = folder / "clip.mkv"
        run_once("ffmpeg", "-v", "error", "-y", "-f", "lavfi", "-i",
            f"testsrc2=size={width}x{height}:rate={RATE},noise=alls=6:allf=t", "-frames:v", str(samples), "-c:v",
            "libx264", "-preset", "ultrafast", clip)
        run_once(program, "encode", "--overwrite", "-q", "--codec", "none", clip, capture)
    return capture


def make_functions(folder, pixels, functions, points, samples):
    """A mask of vertical stripes, and for each a function whose gain goes up and down."""
    width, height = pixels
    mask, file = folder / "mask.pgm", folder / "functions.fn"
    mask.write_bytes(b"P5\n%d %d\n255\n" % pixels + bytes(x * functions // width for x in range(width)) * height)
    last = samples * 1_000_000_000 // RATE
    times = [last * i // (points - 1) for i in range(points)]
    file.write_text("".join(
        f"M{tag}{{{','.join(f'[{at}:{1 + (i + tag) % 3}]' for i, at in enumerate(times))}}}\n"
        for tag in range(functions)))
    return mask, file


def measure(program, folder, setting, runs):
    capture = make_capture(program, folder, setting["samples"], setting["pixels"])
    mask, functions = make_functions(folder, setting["pixels"], setting["functions"], setting["control points"],
                                     setting["samples"])
    command = [program, "expose", "--overwrite", "-v", "-m", mask, "-k", functions, capture, folder / "picture.png"]
    if setting["cores"]:
        command = ["taskset", "-c", ",".join(map(str, sorted(os.sched_getaffinity(0))[:setting["cores"]])), *command]
    kernel, process = [], []
    for number in range(runs + 1):
        start = time.perf_counter()
        report = output_of(*command)
        if number == 0:  # warms up
            continue
        process.append(time.perf_counter() - start)
        kernel.append(float(KERNEL.search(report)[1]))
    return {"kernel_ms": statistics.median(kernel), "process_s": statistics.median(process),
            "peak_mb": peak_megabytes(*command)}


def label_of(value):
    return f"{value[0]}×{value[1]}" if isinstance(value, tuple) else str(value)


def chart(path, rows):
    plt = pyplot()

    lines = {"kernel_ms": ("kernel, ms", "#c85000", "o"), "process_ms": ("whole process, ms", "#0060a8", "s"),
             "peak_mb": ("memory at most, MB", "#505050", "^")}
    figure, axes = plt.subplots(1, len(VALUES), figsize=(4 * len(VALUES), 3.8), sharey=True, layout="constrained")
    for panel, varied in zip(axes, VALUES):
        own = [row for row in rows if row["varied"] == varied]
        at = [row["amount"] for row in own]
        for key, (name, colour, marker) in lines.items():
            values = [row["process_s"] * 1e3 if key == "process_ms" else row[key] for row in own]
            panel.plot(at, values, color=colour, marker=marker, label=name)
        panel.set_xlabel(varied)
        panel.set_yscale("log")
        if varied == "cores":
            panel.set_xticks(at)
        else:
            panel.set_xscale("log")
        panel.grid(color="#d4d4d4", linewidth=0.5)
    axes[0].set_ylabel("milliseconds; megabytes")
    axes[0].legend(fontsize=9)
    figure.savefig(path, dpi=100)


def main():
    parser = command_line(__doc__, runs=3, chart=True)
    arguments = parser.parse_args()
    program = arguments.build.resolve() / "nutik-cl"
    rows = []
    print(f"{'':16} {'':>11} {'kernel ms':>10} {'propor.':>7} {'process s':>10} {'peak MB':>8}")
    with tempfile.TemporaryDirectory() as scratch:
        for varied, values in VALUES.items():
            for value in values:
                setting = BASE | ELSEWHERE.get(varied, {}) | {varied: value}
                amount = value[0] * value[1] if varied == "pixels" else value
                measured = measure(program, pathlib.Path(scratch), setting, arguments.runs)
                rows.append({"varied": varied, "amount": amount, **measured})
                first = next(row for row in rows if row["varied"] == varied)
                proportional = first["kernel_ms"] * (amount / first["amount"]) ** GROWTH[varied]
                print(f"{varied:16} {label_of(value):>11} {measured['kernel_ms']:10.2f} {proportional:7.2f} "
                      f"{measured['process_s']:10.3f} {measured['peak_mb']:8.0f}", flush=True)
    write_outputs(arguments, rows, chart)


if __name__ == "__main__":
    main()
