#!/usr/bin/env python3
"""What each codec costs and saves, over real clips: sizes, encoding, whole renders cold and warm.

    tools/bench/codecs.py --build build --clips FOLDER [--only NAME ...] [--runs 5] [--csv FILE]

Encoding is compared with decoding the same clip and doing nothing with it, in turns in the same run. A
render is the whole process that exposes all of it, from file to picture; cold, the file's pages are dropped
from the system's cache before. FFV1 (level 3, bgr0, as ffmpeg makes it) is the lossless peer, the clip itself
the smallest; pictures are exposed straight from both. Times are medians, in seconds.
"""

import os
import pathlib
import statistics
import tempfile

from tables import command_line, run, run_once, write_outputs

CODECS = ("none", "lz4", "zstd:1", "zstd:3", "zstd:9")


def drop_from_cache(path):
    descriptor = os.open(path, os.O_RDONLY)
    os.fsync(descriptor)
    os.posix_fadvise(descriptor, 0, 0, os.POSIX_FADV_DONTNEED)
    os.close(descriptor)


def encode_ffv1(clip, target):
    return run("ffmpeg", "-v", "error", "-y", "-i", clip, "-an", "-c:v", "ffv1", "-level", "3", "-pix_fmt", "bgr0",
               target)


def measure(clip, build, folder, runs):
    """Rows of one clip: its captures, and the same picture straight from the clip and from FFV1."""
    program = build / "nutik-cl"
    sources = {codec: folder / f"{codec.replace(':', '-')}.tik" for codec in CODECS}
    sources |= {"FFV1": folder / "peer.mkv", "clip": clip}
    picture = folder / "picture.png"
    times = {"decode": []}
    for _ in range(runs):
        times["decode"].append(run(build / "bench_decode", clip))
        for codec in CODECS:
            times.setdefault(("encode", codec), []).append(
                run(program, "encode", "--overwrite", "-q", "--codec", codec, clip, sources[codec], makes=sources[codec]))
        times.setdefault(("encode", "FFV1"), []).append(encode_ffv1(clip, sources["FFV1"]))
    for _ in range(runs):
        for codec, source in sources.items():
            render = (program, "expose", "--overwrite", "-q", "--start", "0s", "--exposure", "24h", "--live", "all", source, picture)
            drop_from_cache(source)
            times.setdefault(("cold", codec), []).append(run_once(*render))
            times.setdefault(("warm", codec), []).append(run(*render))
    medians = {key: statistics.median(values) for key, values in times.items()}
    rows = []
    for codec, source in sources.items():
        rows.append({
            "clip": clip.name, "codec": codec, "bytes": source.stat().st_size, "decode_s": medians["decode"],
            "encode_s": medians.get(("encode", codec)), "cold_s": medians["cold", codec],
            "warm_s": medians["warm", codec]})
        if codec != "clip":
            source.unlink()
    return rows


def main():
    arguments = command_line(__doc__, runs=5, clips=True).parse_args()

    everything = []
    print(f"{'clip':34} {'codec':7} {'MB':>7} {'/ FFV1':>6} {'encode':>7} {'/ dec.':>6} {'cold':>6} {'warm':>6}")
    with tempfile.TemporaryDirectory() as scratch:
        for name in arguments.only:
            rows = measure(arguments.clips / name, arguments.build.resolve(), pathlib.Path(scratch), arguments.runs)
            everything += rows
            peer = next(row["bytes"] for row in rows if row["codec"] == "FFV1")
            for row in rows:
                encode = f"{row['encode_s']:7.3f} {row['encode_s'] / row['decode_s']:6.2f}" if row["encode_s"] else " " * 14
                print(f"{row['clip']:34} {row['codec']:7} {row['bytes'] / 1e6:7.2f} {row['bytes'] / peer:6.2f} "
                      f"{encode} {row['cold_s']:6.3f} {row['warm_s']:6.3f}", flush=True)
    write_outputs(arguments, everything)


if __name__ == "__main__":
    main()
