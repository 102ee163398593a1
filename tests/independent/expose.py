"""Exposure from its definition: a picture is the integral of each pixel's light times a gain.

    out_m(p) = integral of g_m(t) v_p(t) dt / D_m = sum over samples k of v_k(p) w_k / D_m

with v_k the light of the codes that the pixel holds at sample k, w_k the exact integral of the
gain g_m against sample k's hat, and D_m the length of the times at which g_m is not zero.

As a command it exposes a clip and prints each function's measures:

    expose.py clip.mp4 --rate 300 --angle 180 --functions f.fn [--mask m.pgm] [--output light.pfm]
"""

import argparse
from collections import namedtuple
from fractions import Fraction

import cv2
import numpy as np

import functions as gain_functions
import light as transfers
import pictures
import timeline as timelines

# light: float64 H x W x C. scale: float64 H x W, the integral of |g| / D of each pixel's function
# (0 where D is 0): the unit that errors are measured in. measures: {mask value: Measures}.
Exposure = namedtuple("Exposure", "light scale measures")


def expose(samples, timeline, functions, mask=None, transfer="srgb", white=255, tolerance=0):
    """Expose a picture.

    samples: anything with samples[k] an H x W x C array of codes 0 … white, k = 0 … N-1 of the
    timeline. functions: {mask value: GainFunction or Boxcar}. mask: uint8 H x W, or None for all
    zeros. Returns an Exposure.
    """
    shape = samples[0].shape
    mask = np.zeros(shape[:2], np.uint8) if mask is None else mask
    if mask.shape != shape[:2]:
        raise ValueError(f"mask {mask.shape}, pictures {shape[:2]}")
    used = [int(value) for value in np.unique(mask)]
    measures = {m: gain_functions.measure(functions[m], timeline.end) for m in used}
    shares = {m: _shares(timeline, functions[m], measures[m]) for m in used}
    sums = _sum_light(samples, shares, mask, transfers.light_table(transfer, white), tolerance)
    scale = np.zeros(shape[:2])
    for m in used:
        if measures[m].duration:
            scale[mask == m] = float(measures[m].absolute / measures[m].duration)
    return Exposure(sums, scale, measures)


def _shares(timeline, function, measures):
    """w_k / D of each sample with a weight: {k: float}."""
    found = timelines.weights(timeline, function)
    return {k: float(weight / measures.duration) for k, weight in found.items()}


def _sum_light(samples, shares, mask, table, tolerance):
    """The sum over samples of light x share, float64 H x W x C; each pixel its mask's shares."""
    needed = sorted(set().union(*shares.values()))
    height, width, channels = samples[0].shape
    pixels = {m: np.flatnonzero(mask == m) for m in shares}
    sums = {m: np.zeros((len(pixels[m]), channels)) for m in shares}
    for k, codes in _needed_codes(samples, needed, tolerance, len(table) - 1) if needed else ():
        flat = codes.reshape(-1, channels)
        for m, share in shares.items():
            if k in share:
                of_mask, scaled = flat if len(shares) == 1 else flat.take(pixels[m], axis=0), table * share[k]
                # OpenCV is quicker where it can.
                sums[m] += cv2.LUT(of_mask, scaled) if codes.dtype == np.uint8 and len(table) == 256 else scaled[of_mask]
    picture = np.empty((height * width, channels))
    picture[np.concatenate([*pixels.values()])] = np.concatenate([*sums.values()])
    return picture.reshape(height, width, channels)


def _needed_codes(samples, needed, tolerance, white):
    """(k, held codes) of the needed samples. What is held depends on all samples before, unless
    the tolerance is 0: then it is what the sample shows, and the others needn't be looked at."""
    if tolerance == 0:
        return ((k, samples[k]) for k in needed)
    past = (samples[k] for k in range(needed[-1] + 1))
    wanted = set(needed)
    return ((k, codes) for k, codes in enumerate(transfers.held_codes(past, tolerance, white))
            if k in wanted)


def _arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("clip")
    parser.add_argument("--rate", help="samples a second: 300, 29.97, 30000/1001")
    parser.add_argument("--angle", default="360", help="shutter angle in degrees")
    parser.add_argument("--transfer", default="srgb", help="srgb, bt709, linear or gamma:G")
    parser.add_argument("--tolerance", type=int, default=0, help="codes")
    parser.add_argument("--mask", help="8-bit grey PGM or PNG; without it all pixels are 0")
    parser.add_argument("--functions", required=True, help="function file")
    parser.add_argument("--output", help="PFM picture of the light")
    return parser.parse_args()


def main():
    arguments = _arguments()
    clip = pictures.Clip(arguments.clip)
    rate = arguments.rate or Fraction(clip.rate()).limit_denominator(10_000)
    timeline = timelines.constant_rate(len(clip), rate, arguments.angle)
    mask = pictures.read_mask(arguments.mask) if arguments.mask else None
    exposure = expose(clip, timeline, gain_functions.read_functions(arguments.functions), mask,
                      arguments.transfer, tolerance=arguments.tolerance)
    for m, (duration, integral, absolute) in exposure.measures.items():
        still = integral / duration if duration else Fraction(0)
        print(f"M{m}: D {float(duration):.12g} ns, integral {float(integral):.12g}, "
              f"of |g| {float(absolute):.12g}, still gain {float(still):.9g}")
    print(f"light {exposure.light.min():.6g} … {exposure.light.max():.6g}, "
          f"mean {exposure.light.mean():.6g}")
    if arguments.output:
        pictures.write_pfm(arguments.output, exposure.light)


if __name__ == "__main__":
    main()
