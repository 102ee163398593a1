#!/usr/bin/env python3
"""Recordings of events, against a decoder and integrals of their own.

    check_events.py --program PATH [--media DIR] --work DIR [--only SECTION]

recording   a real recording: its counts and times by another decoder, and exposures of it against exact integrals
scenes      random light whose changes are known: what is exposed of EVT 2.0, EVT 3.0, DAT and ADΔER, with functions of
            both signs, against the integral over the true times
cost        a thousand changes in a hundred million ticks: bytes of the file and of memory

Exit status 0 if everything agrees, 1 otherwise; a section that cannot run prints SKIPPED.
"""

import argparse
import json
import re
import subprocess
import sys
from pathlib import Path

import numpy as np

from pictures import read_pfm

sys.path[:0] = [str(Path(__file__).resolve().parent.parent / "tools")]
from words import over  # noqa: E402

HALF_CODE = 0.5 / 65535
# Of a PFM's single precision and of the arithmetic, whose bound `auto` keeps within a share of a code of 16 bits.
ARITHMETIC = 1e-6


def run(program, *words, folder, fails=False):
    result = subprocess.run([program, *map(str, over(words))], cwd=folder, capture_output=True, text=True)
    if (result.returncode != 0) != fails:
        sys.exit(f"{' '.join(map(str, words))}: {result.returncode}\n{result.stderr}")
    return result.stdout + result.stderr


def decode_evt2(path):
    """Times in us, x, y and polarity of all events."""
    data = path.read_bytes()
    start = 0
    while data[start:start + 2] == b"% ":
        start = data.index(b"\n", start) + 1
    words = np.frombuffer(data[start:start + (len(data) - start) // 4 * 4], "<u4")
    kinds = words >> 28
    highs = np.where(kinds == 8, (words & 0xFFFFFFF).astype(np.int64) << 6, -1)
    last = np.maximum.accumulate(np.where(highs >= 0, np.arange(len(words)), -1))
    chosen = (kinds <= 1) & (last >= 0)
    times = highs[last[chosen]] + (words[chosen] >> 22 & 63)
    return times, words[chosen] >> 11 & 0x7FF, words[chosen] & 0x7FF, kinds[chosen].astype(bool)


def integrals(shape, times_ns, pixels, light, start, end_ns, weigh):
    """Per pixel, the sum of light times what weigh(from, to) gives, over the stretches between its changes."""
    order = np.lexsort((np.arange(len(pixels)), times_ns, pixels))
    times, pixels, light = times_ns[order], pixels[order], light[order]
    total = start * weigh(np.zeros(len(start)), np.full(len(start), float(end_ns)))
    is_last = np.append(pixels[1:] != pixels[:-1], True)
    until = np.where(is_last, end_ns, np.append(times[1:], end_ns))
    # From its time on a change replaces the light before it, until the next one does.
    np.add.at(total, pixels, light * weigh(times.astype(float), until.astype(float)))
    first = np.append(True, pixels[1:] != pixels[:-1])
    np.add.at(total, pixels[first], -start[pixels[first]] * weigh(times[first].astype(float),
                                                                np.full(first.sum(), float(end_ns))))
    return total.reshape(shape)


def boxcar(begin, end):
    return lambda a, b: np.maximum(0, np.minimum(b, end) - np.maximum(a, begin)) / (end - begin)


def piecewise(points):
    """The integral of a piecewise linear gain, by its support."""
    xs, ys = np.array([p[0] for p in points], float), np.array([p[1] for p in points], float)
    areas = np.append(0, np.cumsum((ys[1:] + ys[:-1]) / 2 * np.diff(xs)))

    def integral(t):
        t = np.clip(t, xs[0], xs[-1])
        i = np.clip(np.searchsorted(xs, t, "right") - 1, 0, len(xs) - 2)
        slope = (ys[i + 1] - ys[i]) / (xs[i + 1] - xs[i])
        return areas[i] + ys[i] * (t - xs[i]) + slope * (t - xs[i]) ** 2 / 2

    support = xs[-1] - xs[0]
    scale = sum(abs(y0 + y1) / 2 * (x1 - x0) if y0 * y1 >= 0 else (y0 * y0 + y1 * y1) / (2 * abs(y1 - y0)) * (x1 - x0)
                for (x0, y0), (x1, y1) in zip(points, points[1:])) / support
    return lambda a, b: (integral(b) - integral(a)) / support, scale


def light_of_steps(pixels, ups, count, start, up, down):
    """After each event, in the files' order."""
    order = np.argsort(pixels, kind="stable")
    steps = np.where(ups, up, -down)[order]
    sums = np.cumsum(steps)
    first = np.append(True, pixels[order][1:] != pixels[order][:-1])
    before = np.maximum.accumulate(np.where(first, np.arange(len(sums)), 0))
    result = np.empty(len(sums))
    result[order] = np.minimum(1, start * np.exp(sums - (sums - steps)[before]))
    return result


def close(name, found, expected, bound):
    worst = float(np.max(np.abs(found - expected)))
    print(f"{name}: off by {worst:.2e}, allowed {bound:.2e}")
    if not worst <= bound:
        sys.exit(f"{name}: {worst} is more than {bound}")


def recording(program, media, work):
    path = media / "evt2.raw" if media else Path("none")
    if not path.exists():
        print(f"SKIPPED: no recording {path}")
        return
    times, x, y, ups = decode_evt2(path)
    facts = (len(times), int(ups.sum()), int((~ups).sum()), int(times[0]), int(times[-1]))
    if facts != (521252, 185861, 335391, 913716224, 913812095):
        sys.exit(f"the decoder here found {facts}")
    told = run(program, "encode", path, "real.tik", folder=work)
    for text in ("185861 events up and 335391 down", "time 0 at 913716224 us", "EVT 2.0, 640 x 480 (from plugin_name hal_plugin_gen3_fx3)"):
        if text not in told:
            sys.exit(f"no '{text}' in:\n{told}")
    info = json.loads(run(program, "info", "--json", "real.tik", folder=work))
    samples, seconds = info["samples"], info["duration_ns"]
    if samples != len(np.unique(times)) or seconds != 1000 * (times[-1] - times[0] + 1):
        sys.exit(f"{samples} samples, {seconds} ns")
    print(f"recording: {samples} samples, {(work / 'real.tik').stat().st_size} bytes")
    pixels = y.astype(np.int64) * 640 + x
    light = light_of_steps(pixels, ups, 640 * 480, 0.18, 0.2, 0.2)
    times_ns = (times - times[0]) * 1000
    for begin, length in ((0, 95_872_000), (20_000_000, 5_000_000), (61_234_567, 1_001), (95_000_000, 872_000)):
        run(program, "expose", "real.tik", "--start", f"{begin}ns", "--exposure", f"{length}ns", "real.pfm", folder=work)
        expected = integrals((480, 640), times_ns, pixels, light, np.full(640 * 480, 0.18), 95_872_000,
                             boxcar(begin, begin + length))
        close(f"recording, {length} ns from {begin}", read_pfm(work / "real.pfm")[:, :, 0], expected,
              HALF_CODE + ARITHMETIC)


def random_events(random, width, height, count, span_us):
    times = np.sort(random.integers(0, span_us, count))
    times[0] = 0
    return times, random.integers(0, width, count), random.integers(0, height, count), random.random(count) < 0.5


def dat(width, height, times, x, y, ups):
    header = f"% Data file containing CD events\n% Version 2\n% Width {width}\n% Height {height}\n".encode() + b"\x0c\x08"
    words = np.empty((len(times), 2), "<u4")
    words[:, 0] = times
    words[:, 1] = x | y << 14 | ups.astype(np.int64) << 28
    return header + words.tobytes()


def evt2(width, height, times, x, y, ups):
    words = []
    for t, a, b, up in zip(times.tolist(), x.tolist(), y.tolist(), ups.tolist()):
        words += [8 << 28 | t >> 6, up << 28 | (t & 63) << 22 | a << 11 | b]
    return f"% format EVT2;width={width};height={height}\n% end\n".encode() + np.array(words, "<u4").tobytes()


def evt3(width, height, times, x, y, ups):
    words = []
    for t, a, b, up in zip(times.tolist(), x.tolist(), y.tolist(), ups.tolist()):
        words += [8 << 12 | t >> 12 & 0xFFF, 6 << 12 | t & 0xFFF, b, 2 << 12 | up << 11 | a]
    return f"% geometry {width}x{height}\n% evt 3.0\n% end\n".encode() + np.array(words, "<u2").tobytes()


def functions(random, span_ns):
    """Control points in whole nanoseconds within the capture, with gains of both signs."""
    inner = sorted(set(random.integers(1, span_ns - 1, 6).tolist()))
    return [(t, round(float(random.uniform(-2, 2)), 3)) for t in inner]


def with_ends(points):
    return [(points[0][0] - 1, 0.0), *points, (points[-1][0] + 1, 0.0)]


def exposed(program, work, capture, points):
    text = "M0{" + " , ".join(f"[{t}:{g}]" for t, g in points) + "}\n"
    (work / "random.fn").write_text(text)
    run(program, "expose", capture, "-k", "random.fn", "random.pfm", folder=work)
    return read_pfm(work / "random.pfm")


def scenes(program, _media, work):
    width, height, span_us = 37, 21, 400_000
    for seed, (kind, write) in enumerate((("a.dat", dat), ("b.raw", evt2), ("c.raw", evt3), ("d.dat", dat))):
        random = np.random.default_rng(seed)
        times, x, y, ups = random_events(random, width, height, 3000, span_us)
        (work / kind).write_bytes(write(width, height, times, x, y, ups))
        run(program, "encode", "--contrast", "0.23:0.19", "--start-picture", "0.3", kind, "scene.tik", folder=work)
        pixels = y * width + x
        light = light_of_steps(pixels, ups, width * height, 0.3, 0.23, 0.19)
        end_ns = 1000 * (int(times[-1]) + 1)
        points = with_ends(functions(random, end_ns))
        weigh, scale = piecewise(points)
        expected = integrals((height, width), times * 1000, pixels, light, np.full(width * height, 0.3), end_ns, weigh)
        found = exposed(program, work, "scene.tik", points)[:, :, 0]
        close(f"scene {kind}", found, expected, scale * (HALF_CODE + ARITHMETIC))
    adder(program, work)


def adder(program, work):
    """Pixels that gather light until they have 2^D units of it, as the paper's cameras do."""
    random = np.random.default_rng(77)
    width, height, rate, interval = 11, 6, 120_000, 5000
    file = b"adder\x03b" + b"".join(int(n).to_bytes(b, "big") for n, b in (
        (width, 2), (height, 2), (rate, 4), (interval, 4), (interval * 10, 4), (9, 1), (1, 1), (6, 4), (1, 4), (1, 4)))
    events, stretches = [], []
    for pixel in range(width * height):
        now = 0
        while now < 100_000:
            length, d = int(random.integers(40, 4000)), int(random.integers(0, 7))
            events.append((now + length, pixel, d))
            stretches.append((now, now + length, pixel, min(1.0, 2**d / length * interval / 255)))
            now += length
    for t, pixel, d in sorted(events):
        file += b"".join(int(n).to_bytes(b, "big") for n, b in ((pixel % width, 2), (pixel // width, 2), (d, 1), (t, 4)))
    (work / "a.adder").write_bytes(file + b"\xff\xff\xff\xff\0\0\0\0\0")
    run(program, "encode", "a.adder", "adder.tik", folder=work)
    points = with_ends(functions(random, 700_000_000))
    weigh, scale = piecewise(points)
    expected = np.zeros(width * height)
    last = {pixel: end for _, end, pixel, _ in stretches}
    whole = max(last.values())
    for begin, end, pixel, light in stretches:
        end = whole if end == last[pixel] else end
        expected[pixel] += light * weigh(np.array(begin * 1e9 / rate), np.array(end * 1e9 / rate))
    # Ticks of 8333.3 ns: each change is half a nanosecond off at most.
    jitter = 2 * len(stretches) / (width * height) * 0.5 * 2 / (points[-1][0] - points[0][0])
    found = exposed(program, work, "adder.tik", points)[:, :, 0]
    close("scene a.adder", found, expected.reshape(height, width), scale * (HALF_CODE + ARITHMETIC) + jitter)


SIDE, CHANGES, TICKS = 256, 1000, 100_000_000
MAX_COST = 2_000_000  # bytes, of a file, and of tables in memory
# What a process takes varies by some megabytes: by libraries' pages, and by when a compiler of kernels is there. A byte
# for each tick would be 100 MB, and whole samples at least 65 MB.
MAX_PROCESS_COST = 20_000_000


# A process counts as its own peak what its parent held when it was made, so a small one starts the program.
STARTER = """
import os, resource, subprocess, sys
process = subprocess.Popen(sys.argv[1:], stdout=subprocess.DEVNULL)
_, status, usage = os.wait4(process.pid, 0)
process.returncode = os.waitstatus_to_exitcode(status)
print(process.returncode, usage.ru_maxrss, int(open('/proc/self/statm').read().split()[1]) * resource.getpagesize() >> 10)
"""


def peak_bytes(program, *words, folder):
    """The most that the program ever held: the least of some runs, for what libraries take varies."""
    peaks = []
    for _ in range(5):
        line = [sys.executable, "-I", "-S", "-c", STARTER, program, *map(str, over(words)), "-q"]
        told = subprocess.run(line, cwd=folder, check=True, stdout=subprocess.PIPE, text=True).stdout
        status, peak_kb, starter_kb = map(int, told.split())
        if status != 0:
            sys.exit(f"{' '.join(map(str, words))}: {status}")
        if peak_kb <= starter_kb:
            sys.exit(f"the program's peak, {peak_kb} kB, cannot be told from that of what started it")
        peaks.append(peak_kb * 1024)
    return min(peaks)


def table_bytes(told):
    """Of the plan that -v tells: tables and maps, and all that is on the device."""
    units = {"bytes": 1, "kB": 1e3, "MB": 1e6}
    tables = re.search(r"tables of gains: ([0-9.]+) (\w+); map of functions: ([0-9.]+) (\w+)", told)
    device = re.search(r"at most ([0-9.]+) MB on the device", told)
    if not tables or not device:
        sys.exit(f"no tables in:\n{told}")
    return (float(tables[1]) * units[tables[2]] + float(tables[3]) * units[tables[4]], float(device[1]) * 1e6)


def memory(program, work):
    """What a thousand changes in many ticks take beside a capture of the same size in which one pixel changes twice."""
    twice = ([0, TICKS - 1], [5, 5], [5, 5], [True, False])
    (work / "still.dat").write_bytes(dat(SIDE, SIDE, *(np.array(n) for n in twice)))
    half = ("--start", "0s", "--exposure", f"{TICKS // 2}us")
    lines = {"encode": lambda name: ("encode", f"{name}.dat", f"{name}-m.tik"),
             "expose": lambda name: ("expose", f"{name}.tik", *half, f"{name}.pfm"),
             "expose, reference": lambda name: ("expose", "--renderer", "reference", f"{name}.tik", *half, f"{name}.pfm")}
    run(program, "encode", "still.dat", "still.tik", "--codec", "none", folder=work)
    for what, words in lines.items():
        more = peak_bytes(program, *words("wide"), folder=work) - peak_bytes(program, *words("still"), folder=work)
        print(f"cost, memory: {what} takes {more} bytes more than where two things change")
        if more > MAX_PROCESS_COST:
            sys.exit(f"{what} of {TICKS} ticks takes {more} bytes")
    tables, device = table_bytes(run(program, *lines["expose"]("wide"), "-v", folder=work))
    print(f"cost, memory: {tables:.0f} bytes of tables and maps, {device:.0f} on the device")
    if tables > MAX_COST or device > MAX_COST:
        sys.exit(f"tables of {TICKS} ticks take more than 2 MB")


def little_memory(program, work):
    """With the least memory that the program asks for, samples in which little changes are still not written whole."""
    words = ["encode", "wide.dat", "little.tik", "--codec", "none", "--memory", "1MB"]
    for _ in range(2):  # what reading the recording takes is known before what its blocks do
        told = run(program, *words, folder=work, fails=True)
        words[-1] = re.search(r"allow more: --memory ([0-9]+MB)", told)[1]
        if subprocess.run([program, *over(words)], cwd=work, capture_output=True).returncode == 0:
            break
    else:
        sys.exit(f"{words[-1]} is too little, too")
    size = (work / "little.tik").stat().st_size
    print(f"cost, little memory: {size} bytes with --memory {words[-1]}")
    if size > MAX_COST:
        sys.exit(f"with little memory the file takes {size} bytes")


def cost(program, _media, work):
    random = np.random.default_rng(5)
    times = np.sort(random.choice(TICKS, CHANGES, replace=False))
    times[0], times[-1] = 0, TICKS - 1
    x, y, ups = random.integers(0, SIDE, CHANGES), random.integers(0, SIDE, CHANGES), random.random(CHANGES) < 0.5
    (work / "wide.dat").write_bytes(dat(SIDE, SIDE, times, x, y, ups))
    run(program, "encode", "wide.dat", "wide.tik", "--codec", "none", folder=work)
    size = (work / "wide.tik").stat().st_size
    samples = json.loads(run(program, "info", "--json", "wide.tik", folder=work))["samples"]
    print(f"cost: {samples} samples in {TICKS} ticks, {size} bytes unpacked")
    if size > MAX_COST or samples > CHANGES:
        sys.exit("a thousand changes cost more than 2 MB, or more samples than there are")
    memory(program, work)
    little_memory(program, work)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", required=True, type=Path)
    parser.add_argument("--media", type=Path)
    parser.add_argument("--work", required=True, type=Path)
    parser.add_argument("--only", default="")
    words = parser.parse_args()
    for name, section in (("recording", recording), ("scenes", scenes), ("cost", cost)):
        if words.only in name:
            work = words.work.resolve() / name
            work.mkdir(parents=True, exist_ok=True)
            section(words.program.resolve(), words.media and words.media.resolve(), work)
    return 0


if __name__ == "__main__":
    sys.exit(main())
