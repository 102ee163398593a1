"""Small generated clips: awkward sizes, rates, angles, tolerances and transfers, random functions.

The samples are known without decoding (FFV1 loses nothing), so that reading video is checked too.
"""

from collections import namedtuple

import numpy as np

import functions as gain_functions
import pictures
import timeline as timelines
from expose import expose

# samples x height x width x channels; white above 255 makes a 16-bit clip. rate None: the file's.
Case = namedtuple("Case", "name shape rate angle transfer tolerance white",
                  defaults=["360", "srgb", 0, 255])

FILE_RATE = "25"
MASK_VALUES = (0, 64, 128, 196, 255)

CASES = [
    Case("colour 17 x 9", (40, 9, 17, 3), "30000/1001"),
    Case("colour 17 x 9, 180 degrees, bt709", (40, 9, 17, 3), "29.97", "180", "bt709"),
    Case("colour 17 x 9, 1 degree, tolerance 4", (40, 9, 17, 3), "960", "1", "srgb", 4),
    Case("colour 17 x 9, the file's rate, gamma:2.2", (40, 9, 17, 3), None, "180", "gamma:2.2"),
    Case("grey 17 x 9", (40, 9, 17, 1), "960", "180"),
    Case("grey 63 x 3, linear, tolerance 4", (30, 3, 63, 1), "29.97", "180", "linear", 4),
    Case("grey 64 x 1, bt709", (30, 1, 64, 1), "30000/1001", "90", "bt709"),
    Case("grey 65 x 2, gamma:0.5", (30, 2, 65, 1), "120", "360", "gamma:0.5"),
    Case("1 x 1 colour", (9, 1, 1, 3), "960", "180"),
    Case("1 x 1 grey", (9, 1, 1, 1), "24", "1"),
    Case("one sample", (1, 9, 17, 3), "30000/1001", "180"),
    Case("one sample of 1 x 1 grey", (1, 1, 1, 1), "29.97"),
    Case("two samples", (2, 5, 7, 3), "30000/1001", "180"),
    Case("two samples, tolerance 4", (2, 5, 7, 3), "960", "360", "linear", 4),
    Case("65 samples", (65, 6, 5, 3), "30000/1001", "172.8", "srgb"),
    Case("200 samples, tolerance 4", (200, 6, 35, 3), "400000000", "180", "srgb", 4),
    Case("12 bits, linear", (12, 9, 17, 1), "30000", "216", "linear", 0, 4095),
    Case("12 bits, srgb, tolerance 40", (12, 9, 17, 1), "90000", "180", "srgb", 40, 4095),
    Case("16 bits, bt709", (12, 9, 17, 1), "1000", "360", "bt709", 0, 65535),
]

# Ways to the same picture, each against the same expectation.
WAYS = [
    ("opencl", []),
    ("reference", ["--renderer", "reference"]),
    ("single precision", ["--precision", "single"]),
    ("every sample", ["--live", "all"]),
]


def run(checks):
    checks.begin("small", "Small clips, random functions")
    for seed, case in enumerate(CASES):
        one_case(checks, case, seed)


def one_case(checks, case, seed):
    """Expose a generated clip directly and from a .tik, in every way."""
    random = np.random.default_rng(seed)
    folder = checks.folder(f"small-{seed}")
    samples = random_samples(random, case.shape, case.white)
    pictures.write_lossless(folder / "clip.mkv", samples, FILE_RATE)
    timeline = timelines.constant_rate(case.shape[0], case.rate or FILE_RATE, case.angle)
    mask = random.choice(np.array(MASK_VALUES, np.uint8), size=case.shape[1:3])
    pictures.write_pgm(folder / "mask.pgm", mask)
    text = random_file(random, timeline)
    (folder / "gains.fn").write_bytes(text.encode())
    expected = expose(samples, timeline, gain_functions.parse_functions(text), mask, case.transfer,
                      case.white, case.tolerance)

    exposure = ["-m", "mask.pgm", "-k", "gains.fn"]
    name = f"{case.name} (seed {seed})"
    checks.expose_float(f"{name}: clip", folder, source_options(case) + exposure + ["clip.mkv"],
                        expected)
    checks.run(folder, "-q", *source_options(case), "clip.mkv", "clip.tik")
    for way, options in WAYS:
        checks.expose_float(f"{name}: .tik, {way}", folder, exposure + options + ["clip.tik"],
                            expected)
    integer_pictures(checks, name, folder, case, exposure, expected)


def integer_pictures(checks, name, folder, case, exposure, expected):
    """The capture's own depth, 8 and 16 bits, with each transfer function and the capture's own codes."""
    own_bits = 8 if case.white == 255 else 16
    full = {8: 255, 16: 65535}
    ways = [([], own_bits, "srgb", full[own_bits]),
            (["--depth", "16"], 16, "srgb", 65535),
            (["--depth", "8", "--out-transfer", "linear"], 8, "linear", 255),
            (["--out-transfer", "bt709"], own_bits, "bt709", full[own_bits]),
            (["--depth", "16", "--out-transfer", "gamma:1.8"], 16, "gamma:1.8", 65535),
            (["--out-transfer", "source"], own_bits, case.transfer, case.white),
            # A 16-bit picture of a capture that has 16-bit codes keeps its codes and white code.
            (["--depth", "16", "--out-transfer", "source"], 16, case.transfer,
             65535 if own_bits == 8 else case.white)]
    for options, bits, transfer, white in ways:
        path = folder / "codes.png"
        path.unlink(missing_ok=True)
        run = checks.run(folder, *exposure, *options, "clip.tik", "-o", path.name)
        if run.status == 0:
            checks.integer_picture(f"{name}: {' '.join(options) or 'own depth'}", path, expected,
                                   transfer, run.command, white, bits)


def source_options(case):
    options = ["-a", case.angle, "--transfer", case.transfer, "--tolerance", case.tolerance]
    if case.rate:
        options += ["-f", case.rate]
    if case.white != 255:
        options += ["--white", case.white]
    return options


def random_samples(random, shape, white):
    """Codes where pixels rest, waver by a few codes or jump, so that holding makes a difference."""
    count, height, width, channels = shape
    codes = random.integers(0, white + 1, shape[1:])
    samples = []
    for _ in range(count):
        samples.append(codes)
        waver = random.integers(-6, 7, codes.shape) * max(1, white // 1000)
        jump = random.integers(0, white + 1, codes.shape)
        kind = random.integers(0, 10, (height, width, 1))
        codes = np.where(kind < 5, codes, np.where(kind < 8, codes + waver, jump)).clip(0, white)
    return np.array(samples).astype(np.uint8 if white == 255 else np.uint16)


def random_points(random, end):
    """Control points over and a little beyond [0, end] ns, some a nanosecond apart."""
    count = int(random.choice([1, 2, 3, 8, 60]))
    times = set(int(time) for time in random.integers(-end // 10, end + end // 10 + 2, count))
    times |= {time + 1 for time in times if random.random() < 0.4}
    gains = random.choice([0, 0, 1, -0.5, 2.25, 0.001, -3], len(times))
    return list(zip(sorted(times), gains))


def random_file(random, timeline):
    """A function file with a function for each mask value, in all the ways the format allows."""
    text = "\ufeff" if random.random() < 0.5 else ""
    text += "gains of a random test, seeded\n"
    for mask_value in MASK_VALUES:
        points = [f"[{time}:{gain}]" for time, gain in random_points(random, timeline.end)]
        style = random.integers(0, 3)
        if style == 0:
            text += f"M{mask_value} " + ", ".join(points) + "\n"
        elif style == 1:
            text += f"  M{mask_value}{{" + " ,\n   ".join(points) + "}\n"
        else:
            text += f"M{mask_value} {{" + ",".join(points) + "}\nthe next one\n\n"
    return text.replace("\n", "\r\n") if random.random() < 0.5 else text
