"""Options that must not change the picture, or must change it in one stated way; and times that
come from the file."""

import subprocess

import cv2
import numpy as np

import functions as gain_functions
import pictures
import timeline as timelines
from cases_small import MASK_VALUES, random_file, random_samples
from expose import expose
from soft_masks import expose_soft, feathered

SHAPE, RATE, ANGLE = (150, 9, 17, 3), "240", "180"

# How a capture is kept: none of it may show in a picture.
STORED = [
    ["--codec", "none"], ["--codec", "rice"], ["--codec", "lz4"], ["--codec", "zstd"], ["--codec", "zstd:19"],
    ["--tiles", "dense"], ["--tiles", "rows"], ["--tiles", "records"],
    ["--block-samples", "1"], ["--block-samples", "7"], ["--block-samples", "64"],
]


def run(checks):
    checks.begin("options", "Options, and times from the file")
    folder = checks.folder("options")
    random = np.random.default_rng(200)
    samples = random_samples(random, SHAPE, 255)
    pictures.write_lossless(folder / "clip.mkv", samples)
    timeline = timelines.constant_rate(SHAPE[0], RATE, ANGLE)
    mask = random.choice(np.array(MASK_VALUES, np.uint8), size=SHAPE[1:3])
    pictures.write_pgm(folder / "mask.pgm", mask)
    text = random_file(random, timeline)
    (folder / "gains.fn").write_bytes(text.encode())
    functions = gain_functions.parse_functions(text)
    stored_in_every_way(checks, folder, expose(samples, timeline, functions, mask, tolerance=3))
    another_transfer(checks, folder, expose(samples, timeline, functions, mask, "linear"))
    masks(checks, folder, samples, timeline, functions, mask)
    soft_masks(checks, folder, samples, timeline, functions)
    irregular_times(checks, samples[:12])


def stored_in_every_way(checks, folder, expected):
    """Tiles, blocks and codecs, in a .tik and straight from the clip; tolerance 3."""
    source = ["-f", RATE, "-a", ANGLE, "--tolerance", "3"]
    exposure = ["-mmask.pgm", "-kgains.fn"]
    for options in STORED:
        name = " ".join(options)
        (folder / "stored.tik").unlink(missing_ok=True)
        checks.run(folder, "encode", "-q", *source, *options, "clip.mkv", "stored.tik")
        checks.expose_float(f"{name}: .tik", folder, exposure + ["stored.tik"], expected)
        if options[0] != "--codec":
            checks.expose_float(f"{name}: clip", folder, source + options + exposure + ["clip.mkv"],
                                expected)


def another_transfer(checks, folder, expected):
    """A .tik exposed with another transfer function than it names."""
    checks.run(folder, "-q", "-f", RATE, "-a", ANGLE, "--transfer", "bt709", "clip.mkv", "clip.tik")
    arguments = ["--transfer", "linear", "-mmask.pgm", "-kgains.fn", "clip.tik"]
    checks.expose_both("--transfer linear on a bt709 .tik", folder, arguments, expected)


def masks(checks, folder, samples, timeline, functions, mask):
    """A PNG mask; a plain PGM; mask values without a function."""
    expected = expose(samples, timeline, functions, mask)
    cv2.imwrite(str(folder / "mask.png"), mask)
    source = ["-f", RATE, "-a", ANGLE]
    checks.expose_float("a PNG mask", folder, [*source, "-mmask.png", "-kgains.fn", "clip.mkv"],
                        expected)
    rows = "\n".join(" ".join(str(value) for value in row) for row in mask)
    size = f"{mask.shape[1]} {mask.shape[0]}"
    (folder / "plain.pgm").write_text(f"P2\n# plain\n{size}\n255\n{rows}\n")
    checks.expose_float("a plain (P2) mask", folder,
                        [*source, "-mplain.pgm", "-kgains.fn", "clip.mkv"], expected)

    (folder / "zero.fn").write_text("M128 [0:1], [300000000:1], [300000001:0]\n")
    some = gain_functions.read_functions(folder / "zero.fn")
    blank = {value: gain_functions.GainFunction([(0, 0)]) for value in MASK_VALUES}
    arguments = [*source, "-mmask.pgm", "-kzero.fn", "clip.mkv"]
    checks.expose_float("--unmapped zero", folder, [*arguments, "--unmapped", "zero"],
                        expose(samples, timeline, blank | some, mask))
    checks.refused("mask values without a function", folder, arguments, "mask values without")


def soft_masks(checks, folder, samples, timeline, functions):
    """A feathered mask; the same as layers; layers of 8 bits that leave a rest."""
    mask = np.full(SHAPE[1:3], MASK_VALUES[0], np.uint8)
    mask[:, 6:] = MASK_VALUES[1]
    mask[5:, 3:12] = MASK_VALUES[2]
    pictures.write_pgm(folder / "patches.pgm", mask)
    source = ["-f", RATE, "-a", ANGLE, "-kgains.fn"]
    expected = expose_soft(samples, timeline, functions, feathered(mask, 2))
    checks.expose_float("a feather of 2 pixels", folder,
                        [*source, "-mpatches.pgm", "--feather", "2px", "clip.mkv"], expected)
    checks.run(folder, "mask", "-q", "--base", "patches.pgm", "--feather", "2px", "-o", "soft-%d.png")
    checks.expose_float("the same as layers", folder, [*source, "-m", "soft-%d.png", "clip.mkv"], expected)

    layer = np.linspace(0, 255, mask.size).astype(np.uint8).reshape(mask.shape)
    pictures.write_pgm(folder / f"layer-{MASK_VALUES[1]}.pgm", layer)
    shares = {MASK_VALUES[1]: layer.astype(np.int64) * 257}
    first = min(functions)
    shares[first] = shares.get(first, 0) + 65535 - layer.astype(np.int64) * 257
    checks.expose_float("a layer of 8 bits, whose rest has the first function", folder,
                        [*source, "-m", "layer-%d.pgm", "clip.mkv"],
                        expose_soft(samples, timeline, functions, shares))


def irregular_times(checks, samples):
    """A file whose pictures have times of their own, in ms: each sample's period is its own."""
    folder = checks.folder("irregular")
    starts = [0, 40, 80, 120, 160, 200, 240, 360, 480, 600, 730, 840]  # ms
    pictures.write_lossless(folder / "even.mkv", samples)
    times = "+".join(f"eq(N,{k})*{start}" for k, start in enumerate(starts))
    subprocess.run(["ffmpeg", "-v", "error", "-y", "-i", "even.mkv",
                    "-vf", f"settb=1/1000,setpts='{times}'", "-fps_mode", "vfr",
                    "-enc_time_base", "1:1000",  # else times are rounded to the file's 25 a second
                    "-c:v", "ffv1", "-pix_fmt", "bgr0", "irregular.mkv"], cwd=folder, check=True)
    text = "M0 [0:0], [50000000:1], [300000000:-0.5], [800000000:2], [940000000:0]\n"
    (folder / "gains.fn").write_text(text)
    functions = gain_functions.parse_functions(text)
    for angle in ("360", "180", "7"):
        timeline = timelines.from_starts([start * 10**6 for start in starts], angle)
        expected = expose(samples, timeline, functions)
        name = f"irregular times, {angle} degrees"
        checks.expose_float(f"{name}: clip", folder, ["-a", angle, "-kgains.fn", "irregular.mkv"],
                            expected)
        checks.run(folder, "-q", "-a", angle, "irregular.mkv", "irregular.tik")
        checks.expose_float(f"{name}: .tik", folder, ["-kgains.fn", "irregular.tik"], expected)
