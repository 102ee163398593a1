#!/usr/bin/env python3
"""nutik-cl noise against an independent robust estimate, on recordings of more than 8 bits.

The estimate here: clips decoded by other means (sources.py), pixels that drift left out by comparing the ends
of the clip, and of the others the median absolute second difference in time, taken over all pixels of a
stretch of codes. The program takes means of squares pixel by pixel. They must agree within 10 % wherever
enough pixels are still.
"""

import argparse
import subprocess
import sys
from pathlib import Path

import numpy as np

import pictures
import sources

TOLERANCE = 0.10
MIN_VALUES = 5000  # second differences: their median absolute deviation is good to 1.6 %
MIN_STILL_SHARE = 0.7  # of a stretch's pixels: a median bears no more that are something else
SKIPPED = "SKIPPED: "


def read_points(path):
    """The points of each channel of a noise file: lists of (code, sd, pixels)."""
    channels = []
    for line in path.read_text().splitlines():
        words = line.split("#")[0].split()
        if words[:1] == ["channel"]:
            channels.append([])
        elif words[:1] == ["point"]:
            channels[-1].append(tuple(float(word) for word in words[1:]))
    return channels


def still_pixels(samples):
    """Which pixels neither drift nor come near black or white. samples: N x H x W."""
    third = min(max(len(samples) // 3, 1), 5)
    step = samples[2:] - 2 * samples[1:-1] + samples[:-2]
    sd = np.sqrt(np.median(step**2, axis=0) / (6 * 0.455))  # 0.455: the median of chi squared
    ends = np.abs(samples[:third].mean(axis=0) - samples[-third:].mean(axis=0))
    common = np.median(samples[-third:].mean(axis=0) - samples[:third].mean(axis=0))
    still = ends <= abs(common) + 4 * np.maximum(sd, 0.5) * np.sqrt(2 / third)
    mean = samples.mean(axis=0)
    return still & (mean > 4 * sd) & (mean < samples.max() - 4 * sd)


def robust_sd(samples, still, inside):
    """Median absolute second difference of pixels of a stretch, as a standard deviation of one sample."""
    step = (samples[2:] - 2 * samples[1:-1] + samples[:-2])[:, still & inside]
    if step.size < MIN_VALUES:
        return None
    # Codes are whole numbers: a uniform dither makes their distribution one that has quantiles.
    dither = np.random.default_rng(1).uniform(-0.5, 0.5, step.shape)
    step = step - np.median(step, axis=1, keepdims=True) + dither
    variance = (np.median(np.abs(step)) / 0.67449) ** 2 - 1 / 12
    return np.sqrt(max(variance, 0) / 6)


def compare(name, samples, points):
    """Prints a line for each stretch of codes; returns how many differ by more than TOLERANCE."""
    samples = samples.astype(np.float64)
    mean = samples.mean(axis=0)
    still = still_pixels(samples)
    codes = np.array([point[0] for point in points])
    # Stretches of points: of several, where they are close, so that each has enough pixels.
    stretches = np.array_split(np.arange(len(codes)), min(len(codes), 12))
    wrong = compared = 0
    for stretch in stretches:
        margin = 0.5 * np.min(np.diff(codes)) if len(codes) > 1 else 1
        inside = (mean >= codes[stretch[0]] - margin) & (mean <= codes[stretch[-1]] + margin)
        if not inside.any() or still[inside].mean() < MIN_STILL_SHARE:
            continue
        want = robust_sd(samples, still, inside)
        if want is None:
            continue
        at = np.interp(mean[still & inside], codes, [point[1] for point in points])
        got = np.sqrt(np.mean(at**2))
        compared += 1
        is_wrong = abs(got / want - 1) > TOLERANCE
        wrong += is_wrong
        print(f"  {'FAIL' if is_wrong else 'ok  '} {name}, codes {codes[stretch[0]]:.5g} … "
              f"{codes[stretch[-1]]:.5g}: program {got:.4g}, here {want:.4g} ({100 * (got / want - 1):+.1f} %)")
    if compared == 0:
        print(f"  FAIL {name}: no stretch of codes could be compared")
        wrong += 1
    return wrong


def clips(media):
    """Name, what the program is given, and the samples as sources.py reads them."""
    stills = sorted((media / "ball_12bit_png").glob("*.png"))
    yield ("ball_12bit_png", ["--white", "4095", media / "ball_12bit_png"],
           np.stack([pictures.read_codes(path) for path in stills]))
    for name in ("cine_781.cine", "data_small_cine.cine"):
        yield name, [media / name], sources.read_cine(media / name)[0]
    yield "stuck.tif", [media / "stuck.tif"], sources.read_tiff(media / "stuck.tif")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", type=Path, required=True)
    parser.add_argument("--media", type=Path, required=True)
    parser.add_argument("--work", type=Path, required=True)
    arguments = parser.parse_args()
    if not (arguments.media / "stuck.tif").exists():
        print(f"{SKIPPED}no recordings in {arguments.media}")
        return 0
    arguments.work.mkdir(parents=True, exist_ok=True)
    wrong = 0
    for name, operands, samples in clips(arguments.media):
        path = arguments.work / f"{name}.noise"
        subprocess.run([arguments.program, "noise", "-q", "--overwrite", *operands, "-o", path], check=True)
        (points,) = read_points(path)
        wrong += compare(name, samples[..., 0] if samples.ndim == 4 else samples, points)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
