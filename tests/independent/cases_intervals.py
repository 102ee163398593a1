"""Plain exposures, --start and --exposure in every unit, against exact boxcars; and against the
function file that says the same but for ramps of 1 ns."""

from fractions import Fraction

import numpy as np

import functions as gain_functions
import pictures
import timeline as timelines
from cases_small import random_samples
from expose import expose

RATE, ANGLE, COUNT = "30000/1001", "180", 48
SECOND = 10**9

# (--start, --exposure, start and length in ns; None where it is the timeline that says)
INTERVALS = [
    ("0.4s", "10ms", 400_000_000, 10_000_000),
    ("400ms", "1/100s", 400_000_000, 10_000_000),
    ("2/5s", "10000us", 400_000_000, 10_000_000),
    ("0s", "1s", 0, SECOND),
    ("1.5s", "250us", 1_500_000_000, 250_000),
    ("1500000us", "250000ns", 1_500_000_000, 250_000),
    ("37f", "3f", None, None),
    ("0f", "48f", None, None),
    ("47f", "1f", None, None),
    ("1.59s", "10ms", 1_590_000_000, 10_000_000),
    ("1.6s", "10ms", 1_600_000_000, 10_000_000),  # ends after the capture: what is inside counts
]


def run(checks):
    checks.begin("interval", "Plain intervals")
    folder = checks.folder("interval")
    samples = random_samples(np.random.default_rng(100), (COUNT, 11, 23, 3), 255)
    pictures.write_lossless(folder / "clip.mkv", samples)
    checks.run(folder, "-q", "-f", RATE, "-a", ANGLE, "clip.mkv", "clip.tik")
    timeline = timelines.constant_rate(COUNT, RATE, ANGLE)
    for start, length, start_ns, length_ns in INTERVALS:
        if start_ns is None:  # whole pictures: from one start of a sample to another
            first, count = int(start[:-1]), int(length[:-1])
            bounds = timeline.starts + [timeline.end]
            start_ns, length_ns = bounds[first], bounds[first + count] - bounds[first]
        one_interval(checks, folder, samples, timeline, (start, length), (start_ns, length_ns))


def one_interval(checks, folder, samples, timeline, texts, times):
    start_ns, length_ns = times
    boxcar = gain_functions.Boxcar(start_ns, start_ns + length_ns)
    expected = expose(samples, timeline, {0: boxcar})
    name = f"--start {texts[0]} --exposure {texts[1]}"
    options = ["--start", texts[0], "--exposure", texts[1]]
    path = checks.expose_float(f"{name}: .tik", folder, options + ["clip.tik"], expected)
    plain = pictures.read_pfm(path) if path.exists() else None
    checks.expose_float(f"{name}: clip", folder, ["-f", RATE, "-a", ANGLE] + options + ["clip.mkv"],
                        expected)

    text = ramped(start_ns, start_ns + length_ns)
    (folder / "plain.fn").write_text(text)
    path = checks.expose_float(f"{name}: as a function file", folder, ["-kplain.fn", "clip.tik"],
                               expose(samples, timeline, gain_functions.parse_functions(text)))
    if plain is None or not path.exists():
        return
    # The ramps add 1 ns on average at each end to the integral's 2 halves and 2 ns to D.
    allowed = 2 * Fraction(2, min(length_ns, timeline.end - start_ns)) + Fraction(1, 10**6)
    worst = float(np.abs(plain - pictures.read_pfm(path)).max())
    checks.holds(f"{name}: the interval and the function file agree", worst <= allowed,
                 f"worst difference {worst:.1e}, allowed {float(allowed):.1e}")


def ramped(start_ns, end_ns):
    """A function file of gain 1 over [start, end] ns, with ramps of 1 ns outside it."""
    before = f"[{start_ns - 1}:0], " if start_ns > 0 else ""
    return f"M0 {before}[{start_ns}:1], [{end_ns}:1], [{end_ns + 1}:0]\n"
