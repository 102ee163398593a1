"""Plain exposures, --start and --exposure in every unit, against exact boxcars; and against the
function file that says the same but for ramps of 1 ns."""

from fractions import Fraction

import numpy as np

import functions as gain_functions
import pictures
import timeline as timelines
from cases_small import random_samples
from expose import expose

RATE, COUNT = "30000/1001", 48
SECOND = 10**9

# (--start, --exposure, start and length in ns), of a capture with gaps.
INTERVALS = [
    ("0.4s", "10ms", 400_000_000, 10_000_000),
    ("400ms", "1/100s", 400_000_000, 10_000_000),
    ("2/5s", "10000us", 400_000_000, 10_000_000),
    ("0s", "1s", 0, SECOND),
    ("1.5s", "250us", 1_500_000_000, 250_000),
    ("1500000us", "250000ns", 1_500_000_000, 250_000),
    ("1.59s", "10ms", 1_590_000_000, 10_000_000),
    ("1.6s", "10ms", 1_600_000_000, 10_000_000),  # ends after the capture: what is inside counts
]

# (first picture, number of pictures). One picture is its exposure. Whether several reach from the
# first's start to the last's end, or to the start of the next, isn't written down, so they are
# asked for only where there are no gaps and both are the same.
PICTURES = {"180": [(0, 1), (37, 1)], "360": [(0, 1), (37, 3), (0, 48), (47, 1)]}


def run(checks):
    checks.begin("interval", "Plain intervals")
    samples = random_samples(np.random.default_rng(100), (COUNT, 11, 23, 3), 255)
    for angle, picture_counts in PICTURES.items():
        folder = checks.folder(f"interval-{angle}")
        pictures.write_lossless(folder / "clip.mkv", samples)
        source = ["-f", RATE, "-a", angle]
        checks.run(folder, "-q", *source, "clip.mkv", "clip.tik")
        timeline = timelines.constant_rate(COUNT, RATE, angle)
        intervals = list(INTERVALS) if angle == "180" else []
        for first, count in picture_counts:
            start_ns, end_ns = timeline.starts[first], timeline.ends[first + count - 1]
            intervals.append((f"{first}f", f"{count}f", start_ns, end_ns - start_ns))
        for interval in intervals:
            one_interval(checks, folder, source, samples, timeline, interval)


def one_interval(checks, folder, source, samples, timeline, interval):
    """One of INTERVALS: from the .tik, from the clip, and as a function file."""
    start, length, start_ns, length_ns = interval
    boxcar = gain_functions.Boxcar(start_ns, start_ns + length_ns)
    expected = expose(samples, timeline, {0: boxcar})
    name = f"-a{source[-1]} --start {start} --exposure {length}"
    options = ["--start", start, "--exposure", length]
    path = checks.expose_float(f"{name}: .tik", folder, options + ["clip.tik"], expected)
    plain = pictures.read_pfm(path) if path.exists() else None
    checks.expose_float(f"{name}: clip", folder, source + options + ["clip.mkv"], expected)

    text = ramped(start_ns, start_ns + length_ns)
    (folder / "plain.fn").write_text(text)
    path = checks.expose_float(f"{name}: as a function file", folder, ["-kplain.fn", "clip.tik"],
                               expose(samples, timeline, gain_functions.parse_functions(text)))
    if plain is None or not path.exists():
        return
    # The ramps add up to 1 ns of light to the integral A and 2 ns to D: (A + 1) / (D + 2) and
    # A / D, A <= D, differ by 2 / D at most. The rest is for both pictures' own errors.
    allowed = Fraction(2, min(length_ns, timeline.end - start_ns)) + Fraction(1, 10**6)
    worst = float(np.abs(plain - pictures.read_pfm(path)).max())
    checks.holds(f"{name}: the interval and the function file agree", worst <= allowed,
                 f"worst difference {worst:.1e}, allowed {float(allowed):.1e}")


def ramped(start_ns, end_ns):
    """A function file of gain 1 over [start, end] ns, with ramps of 1 ns outside it."""
    before = f"[{start_ns - 1}:0], " if start_ns > 0 else ""
    return f"M0 {before}[{start_ns}:1], [{end_ns}:1], [{end_ns + 1}:0]\n"
