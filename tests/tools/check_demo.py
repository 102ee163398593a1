#!/usr/bin/python3
"""Holds the demo's pictures to what the paper says of them.

    check_demo.py --program nutik-cl --scene tools/scene.py --work FOLDER

The scene is filmed anew, with known truth, and exposed from a lossless capture. What was measured is printed, also on
success. A failure names the pixel and both values, leaves the files in FOLDER and sets the exit status to 1.
"""

import argparse
import json
import subprocess
import sys
from functools import cache
from pathlib import Path

import cv2
import numpy as np

from report import Report

# Integral of the gain over the time that it is not zero, exactly, for the functions as printed.
STILL_GAIN = {
    "difference": 20.83350075 / 83.331001,
    "strobe": 40.0000035 / 40.000007,
    "motion-study": 750.000013 / 1010.000001,
    "one-blur": 1.0,
}
MASKS = {"difference": None, "strobe": "whole", "motion-study": "regions", "one-blur": "regions"}

# A picture's 10 ms and a region's differ by its 1 ns ramp, 5e-8 of the light, and by single precision, 1e-6: together
# less than this many codes. A value that close to a half may be rounded either way.
TIE_CODES = 1e-3
# Codes of 8 bits by which still pixels may be off: their median, and each of them. Half is for rounding the picture,
# 0.8 for 5.5 standard deviations of noise in the darks of Figure 4, 0.2 for rounding the clip, which noise evens out.
MEDIAN_CODES = 1.0
PIXEL_CODES = 1.5
SPEED_SHARE = 0.10
SHORT_STARTS_S = (0.4, 0.5, 0.6, 0.7, 0.8)
# Single precision: about 1000 additions of terms up to 1.25 times the light, with 2^-24 each.
FLOAT_LIGHT = 1e-4


class Demo:
    """The scene's files and the program."""

    def __init__(self, program, scene, folder):
        self.program, self.folder = program, folder
        folder.mkdir(parents=True, exist_ok=True)
        run(sys.executable, scene, folder, "--size", "320x180")
        self.truth = json.loads((folder / "truth.json").read_text())
        self.background = np.load(folder / "background.npy").astype(np.float64)
        self.regions = cv2.imread(str(folder / "regions.pgm"), cv2.IMREAD_UNCHANGED)
        self.capture = folder / "clip.tik"
        run(program, "encode", "-q", "--overwrite", "--codec", "zstd:1", folder / "clip.mkv", self.capture)
        self.along, self.above = self.track_coordinates()

    def track_coordinates(self):
        """Of the pixels' centres: pixels along the path of the ball's centre, and above it."""
        height, width = self.regions.shape
        y, x = np.mgrid[:height, :width] + 0.5
        (start_x, start_y), (right, down) = self.truth["start_px"], self.truth["direction"]
        return (x - start_x) * right + (y - start_y) * down, (x - start_x) * down - (y - start_y) * right

    def still(self):
        """Whether the ball, its blur and its shadow never come near a pixel."""
        reach = 1.3 * self.truth["radius_px"] + 3
        within = (self.along > -reach) & (self.along < self.truth["path_length_px"] + reach)
        return ~(within & (np.abs(self.above) < reach))

    def figure(self, name, ending):
        mask = MASKS[name]
        chosen = ["-m", self.folder / f"{mask}.pgm"] if mask else []
        return self.expose(name + ending, *chosen, "-k", self.folder / f"{name}.fn")

    def interval(self, name, start_s, length_s):
        return self.expose(name, "--start", f"{start_s}s", "--exposure", f"{length_s}s")

    @cache
    def expose(self, name, *options):
        """[height, width, 3], RGB: codes of a .png, light of a .pfm."""
        path = self.folder / name
        run(self.program, "expose", "--overwrite", "-q", *options, self.capture, "-o", path)
        picture = cv2.imread(str(path), cv2.IMREAD_UNCHANGED)
        if picture is None or picture.shape != self.background.shape:
            sys.exit(f"{path} cannot be read, or is not of the clip's size")
        return picture[..., ::-1].astype(np.float64)


def run(*command):
    """Runs a command, which must succeed."""
    command = [str(part) for part in command]
    print("$ " + " ".join(command), flush=True)
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{done.stdout}{done.stderr}exit status {done.returncode}")


def codes_of(light):
    """Light -> 8-bit sRGB codes, not rounded (IEC 61966-2-1)."""
    light = np.clip(light, 0, 1)
    return 255 * np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)


def worst_pixel(error, where):
    """(row, column, channel) of the largest error within a region; a NaN counts as the largest."""
    error = np.where(where[..., None], np.nan_to_num(np.abs(error), nan=np.inf), -1)
    return np.unravel_index(np.argmax(error), error.shape)


def at(pixel):
    row, column, channel = pixel
    return f"at x {column}, y {row}, {'RGB'[channel]}"


def check_regions(demo, report):
    """(a) Each region of Figure 14 is its own 10 ms picture, code for code."""
    picture = demo.figure("motion-study", ".png")
    for value, start in demo.truth["regions"].items():
        region = demo.regions == int(value)
        length = demo.truth["exposure_s"]
        alone = demo.interval(f"region{value}.png", start, length)
        real = codes_of(demo.interval(f"region{value}.pfm", start, length))
        tie = (np.abs(real - np.floor(real) - 0.5) < TIE_CODES) & (np.abs(picture - alone) == 1)
        different = (picture != alone) & region[..., None]
        pixel = worst_pixel(np.where(tie, 0, picture - alone), region)
        report.hold(region.any() and not (different & ~tie).any(),
                    f"Figure 14, region {value}: {3 * region.sum()} codes as in the 10 ms from {start} s, "
                    f"{(different & tie).sum()} of them rounded the other way; worst {at(pixel)}: "
                    f"{picture[pixel]:.0f} against {alone[pixel]:.0f}")


def check_trail(demo, report):
    """(b) The trail's contrast falls with the ball's speed as 1 / speed.

    A place on the ball's way sees it for the time that the ball takes to roll by, its length / speed. Let q be the
    light of the ball, summed over all pixels of a short picture. In dt it moves by ds = v dt, so in an exposure of
    length D each ds of its path is left q dt / D = q ds / (v D). The trail's light per pixel of the path, summed across
    the track, is therefore q / (v D), whatever the ball looks like: what its pattern and its turning do to one pixel
    evens out across the track and along it. The start is left out, where v changes while the ball rolls by, and so is
    the end, which it doesn't roll by. What the still background shows through the trail is taken away first, by the
    time that the ball covers each pixel.
    """
    length, radius = 1.0, demo.truth["radius_px"]
    near = np.abs(demo.above) <= radius + 0.5
    edges = np.arange(3 * radius, demo.truth["path_length_px"] - radius, radius / 2)
    trail = ball_light(demo, "roll.pfm", 0, length)
    density = np.histogram(demo.along[near], edges, weights=trail[near])[0] / np.diff(edges)
    speed = np.sqrt(2 * demo.truth["acceleration_px_per_s2"] * (edges[:-1] + edges[1:]) / 2)
    short = [ball_light(demo, f"ball{start}.pfm", start, demo.truth["exposure_s"]) for start in SHORT_STARTS_S]
    expected = np.mean([light[near].sum() for light in short]) / (speed * length)
    ratio = density / expected
    worst = int(np.argmax(np.nan_to_num(np.abs(ratio - 1), nan=np.inf)))
    report.hold(np.all(np.abs(ratio - 1) <= SPEED_SHARE),
                f"trail: light x speed / light of the ball = {ratio.min():.3f} ... {ratio.max():.3f} over {len(ratio)} "
                f"stretches, {speed[0]:.0f} to {speed[-1]:.0f} pixels/s; worst from {edges[worst]:.0f} to "
                f"{edges[worst + 1]:.0f} pixels along the track: {density[worst]:.4f} against {expected[worst]:.4f}")
    exponent = np.polyfit(np.log(speed), np.log(density), 1)[0] if np.all(density > 0) else np.nan
    report.hold(abs(exponent + 1) <= SPEED_SHARE, f"trail: it goes as speed to the power {exponent:.3f}, expected -1")


def ball_light(demo, name, start, length):
    """What the ball adds to an exposure, mean of the channels: light less what is seen of the background."""
    radius, acceleration = demo.truth["radius_px"], demo.truth["acceleration_px_per_s2"]
    half_chord = np.sqrt(np.maximum(0, radius ** 2 - demo.above ** 2))
    enters, leaves = (np.sqrt(2 * np.maximum(0, demo.along + side * half_chord) / acceleration) for side in (-1, 1))
    covered = np.maximum(0, np.minimum(leaves, start + length) - np.maximum(enters, start)) / length
    seen = demo.background * (1 - covered)[..., None]
    return (demo.interval(name, start, length) - seen).mean(axis=-1)


def check_background(demo, report):
    """(c) What is still has its still gain times its light."""
    still = demo.still()
    for name, gain in STILL_GAIN.items():
        picture = demo.figure(name, ".png")
        expected = codes_of(gain * demo.background)
        error = picture - expected
        median, pixel = np.median(error[still]), worst_pixel(error, still)
        report.hold(abs(median) <= MEDIAN_CODES and abs(error[pixel]) <= PIXEL_CODES,
                    f"{name}.png: still background at gain {gain:.6f}: median error {median:+.3f} codes; "
                    f"worst {at(pixel)}: {picture[pixel]:.0f} against {expected[pixel]:.3f}")


def check_negative_end(demo, report):
    """(d) M0 of Figure 14 is negative where the ball comes to rest: 1 s of the roll less 25 times 10 ms of its end."""
    lines = (demo.folder / "motion-study.fn").read_text().splitlines()
    (demo.folder / "m0.fn").write_text("".join(line + "\n" for line in lines if line.startswith("M0")))
    alone = demo.expose("m0.pfm", "-k", demo.folder / "m0.fn")
    roll, end = demo.interval("roll.pfm", 0, 1.0), demo.interval("end.pfm", 1.0, 0.01)
    expected = (1.0 * roll - 0.25 * end) / 1.01
    pixel = worst_pixel(alone - expected, np.ones(demo.regions.shape, bool))
    report.hold(abs(alone[pixel] - expected[pixel]) <= FLOAT_LIGHT,
                f"Figure 14, M0 alone: the roll less its end; worst {at(pixel)}: {alone[pixel]:.7f} against "
                f"{expected[pixel]:.7f}")
    ball = np.hypot(demo.along - demo.truth["path_length_px"], demo.above) < demo.truth["radius_px"] - 1
    red, lowest = alone[..., 0][ball], worst_pixel(np.minimum(alone, 0), ball)
    report.hold(np.median(red) < 0 and alone[lowest] < -0.01,
                f"Figure 14, M0 alone, where the ball lies: red has median {np.median(red):+.4f}, "
                f"mean {red.mean():+.4f}, {np.mean(red < 0):.1%} below 0; lowest {at(lowest)}: {alone[lowest]:+.4f}")
    report.hold(np.all(alone[demo.still()] > 0), "Figure 14, M0 alone: nothing still is 0 or below; "
                f"lowest {np.min(alone[demo.still()]):+.5f}")


def check_difference(demo, report):
    """(e) Figure 4 as light: the still background has its still gain times its light, and motion goes below 0."""
    light, still, gain = demo.figure("difference", ".pfm"), demo.still(), STILL_GAIN["difference"]
    expected = gain * demo.background
    error = codes_of(light) - codes_of(expected)
    pixel, share = worst_pixel(error, still), np.median(light[still] / demo.background[still])
    report.hold(abs(share / gain - 1) <= 2e-3 and abs(error[pixel]) <= PIXEL_CODES,
                f"difference.pfm: still background / truth has median {share:.6f}, still gain {gain:.6f}; "
                f"worst {at(pixel)}: {light[pixel]:.6f} against {expected[pixel]:.6f}, {error[pixel]:+.3f} codes")
    report.hold(light.min() < -0.01 and light.max() > 0.1,
                f"difference.pfm: motion from {light.min():+.4f} to {light.max():+.4f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True, help="nutik-cl")
    parser.add_argument("--scene", required=True, help="tools/scene.py")
    parser.add_argument("--work", required=True, type=Path, help="folder for the clip and the pictures")
    options = parser.parse_args()
    demo, report = Demo(options.program, options.scene, options.work), Report()
    for check in (check_regions, check_trail, check_background, check_negative_end, check_difference):
        check(demo, report)
    report.end(f"; the files are in {options.work}")
    for large in ("clip.mkv", "clip.tik"):
        (options.work / large).unlink()


if __name__ == "__main__":
    main()
