#!/usr/bin/env python3
"""What the lightest, darkest and middle sample cost beside an exposure of the same interval: whole processes, from a
capture, in turns whose order changes; medians of the processor's time and of a clock's, and their ratios to the exposure's.
`tail` lightens with a gain that falls.

    tools/bench/combining.py NUTIK_CL CLIP … [--seconds 2] [--runs 9]
"""
import argparse
import pathlib
import random
import resource
import statistics
import subprocess
import tempfile
import time


def run(*words):
    subprocess.run([str(word) for word in words], check=True, capture_output=True)


def processor_time():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def measured(nutik, clip, seconds, runs, folder):
    capture, picture, falls = folder / "clip.tik", folder / "picture.png", folder / "falls.fn"
    run(nutik, "encode", "-q", "--overwrite", clip, capture)
    falls.write_text(f"M0 [0:1], [{round(seconds * 1e9)}:0]\n")
    interval = ["--start", "0s", "--exposure", f"{seconds}s"]
    ways = {"exposure": interval, "tail": ["--combine", "lighten", "-k", falls]}
    ways |= {how: ["--combine", how, *interval] for how in ("lighten", "darken", "median")}
    took = {name: [] for name in ways}
    order = list(ways)
    for turn in range(runs + 1):  # the first is not counted: kernels are built
        random.Random(turn).shuffle(order)
        for name in order:
            start = time.perf_counter(), processor_time()
            run(nutik, "expose", "-q", "--overwrite", *ways[name], capture, picture)
            if turn > 0:
                took[name].append((time.perf_counter() - start[0], processor_time() - start[1]))
    return {name: [statistics.median(each) for each in zip(*times)] for name, times in took.items()}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("nutik")
    parser.add_argument("clips", nargs="+", type=pathlib.Path)
    parser.add_argument("--seconds", type=float, default=2)
    parser.add_argument("--runs", type=int, default=9)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        for clip in given.clips:
            times = measured(given.nutik, clip, given.seconds, given.runs, pathlib.Path(folder))
            clock, processor = times.pop("exposure")
            ratios = ", ".join(f"{name} {own / processor:.2f} ({by_clock / clock:.2f})"
                               for name, (by_clock, own) in times.items())
            print(f"{clip.name}: exposure {1000 * processor:.0f} ms of processor time; {ratios}", flush=True)


if __name__ == "__main__":
    main()
