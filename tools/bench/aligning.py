#!/usr/bin/env python3
"""What aligning a clip costs beside ffmpeg's decoding of it, in processor time of whole processes: encoding with each
codec and exposing, with and without --align, and a pair of pictures with a sample made between them (--between).

    tools/bench/aligning.py CLIP … [--nutik build/nutik-cl OTHER …] [--motion rigid] [--runs 7]

In turns whose order changes; medians, and their ratios to `ffmpeg -i CLIP -f null -` on two threads.
"""
import argparse
import pathlib
import random
import statistics
import subprocess
import tempfile

from combining import processor_time

PICTURES = 20  # of which pairs are made


def measured(clip, programs, motion, runs, folder):
    capture, picture = folder / "clip.tik", folder / "picture.png"
    ways = {"ffmpeg": ["ffmpeg", "-v", "error", "-threads", "2", "-i", clip, "-f", "null", "-"],
            "ffmpeg to RGB": ["ffmpeg", "-v", "error", "-threads", "2", "-i", clip, "-f", "rawvideo",
                              "-pix_fmt", "rgb24", "-y", "/dev/null"]}
    for program in programs:
        encode = [program, "encode", "-q", "--overwrite"]
        expose = [program, "expose", "-q", "--overwrite", "--start", "0s", "--exposure", "24h"]
        part = [*encode, "--codec", "none", "--to", f"{PICTURES}f"]
        aligned = ["--align", motion]
        ways |= {f"{program} {name}": words for name, words in {
            "encode": [*encode, clip, capture],
            "encode --align": [*encode, *aligned, clip, capture],
            "encode --align, uncompressed": [*encode, "--codec", "none", *aligned, clip, capture],
            "expose --align": [*expose, *aligned, clip, picture],
            "pairs without": [*part, clip, capture],
            "pairs": [*part, "--between", "1", clip, capture]}.items()}
    took = {name: [] for name in ways}
    order = list(ways)
    for turn in range(runs + 1):  # the first is not counted: kernels are built
        random.Random(turn).shuffle(order)
        for name in order:
            start = processor_time()
            subprocess.run([str(word) for word in ways[name]], check=True, capture_output=True)
            if turn > 0:
                took[name].append(processor_time() - start)
    return {name: statistics.median(times) for name, times in took.items()}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("clips", nargs="+", type=pathlib.Path)
    parser.add_argument("--nutik", nargs="+", type=pathlib.Path, default=[pathlib.Path("build/nutik-cl")])
    parser.add_argument("--motion", default="rigid")
    parser.add_argument("--runs", type=int, default=7)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        for clip in given.clips:
            times = measured(clip, given.nutik, given.motion, given.runs, pathlib.Path(folder))
            for program in given.nutik:
                without = times.pop(f"{program} pairs without")
                times[f"{program} a pair"] = (times.pop(f"{program} pairs") - without) / (PICTURES - 1)
            print(clip.name)
            for name, seconds in times.items():
                print(f"  {name:50} {seconds:6.2f} s, {seconds / times['ffmpeg']:5.2f} times decoding", flush=True)


if __name__ == "__main__":
    main()
