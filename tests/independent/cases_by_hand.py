"""End to end against numbers worked out by hand, written out below. Only the comparison is shared
with the other cases: nothing here is computed by expose.py, but for `numbers`, which checks it."""

from fractions import Fraction

import numpy as np

import figures
import functions as gain_functions
import pictures
import timeline as timelines
from expose import Exposure
from light import light_table

TRANSFERS = ("srgb", "bt709", "linear", "gamma:2.2")
SECOND = 10**9


def by_hand(values):
    """An Exposure of grey light, one row of the values, to be met within 1e-5."""
    row = np.array(values, dtype=np.float64).reshape(1, -1, 1)
    return Exposure(row, np.ones((1, row.shape[1])), {})


def grey_row(*samples):
    """A grey clip one pixel high: samples[k][x] is the code of pixel x at sample k."""
    return np.array(samples, dtype=np.uint8)[:, None, :, None]


def run(checks):
    checks.begin("by-hand", "By hand: numbers worked out on paper")
    folder = checks.folder("by-hand")
    lines_and_gaps(checks, folder)
    masks_and_ramps(checks, folder)
    rounded_timeline(checks, folder)
    held_codes(checks, folder)
    means_in_light(checks, folder)
    codes_come_back(checks, folder)
    still_scenes(checks, folder)


def lines_and_gaps(checks, folder):
    """100 samples a second, 180 degrees: sample k is exposed from 10 k to 10 k + 5 ms.

    Codes 51, 153, 255, 0 are, linear, light 0.2, 0.6, 1, 0; the second pixel is 0.4 all along.
    """
    samples = grey_row([51, 102], [153, 102], [255, 102], [0, 102])
    pictures.write_lossless(folder / "gaps.mkv", samples)
    source = ["-f100", "-a180", "--transfer", "linear", "gaps.mkv"]
    cases = [
        ("a boxcar over exactly sample 1", "10ms", "5ms", 0.6),
        ("1 us inside sample 1", "12ms", "1us", 0.6),
        ("the whole gap from 0.6 to 1", "15ms", "5ms", 0.8),
        ("1 ms of that gap: the line at 16.5 ms", "16ms", "1ms", 0.72),
        ("from the middle of sample 1 to the middle of the gap after it: "
         "(2.5 x 0.6 + 2.5 x 0.7) / 5", "12500us", "5ms", 0.65),
        ("after the last exposure its light holds", "36ms", "4ms", 0.0),
        ("all: (5 x 0.2 + 5 x 0.4 + 5 x 0.6 + 5 x 0.8 + 5 x 1 + 5 x 0.5 + 10 x 0) / 40",
         "0s", "40ms", 0.4375),
        ("half of it outside the capture: only the inside counts, 2 ms of 0", "38ms", "4ms", 0.0),
    ]
    for name, start, exposure, light in cases:
        checks.expose_float(name, folder, ["--start", start, "--exposure", exposure] + source,
                            by_hand([light, 0.4]))


def masks_and_ramps(checks, folder):
    """The same clip with no gaps: sample k shows 0.2, 0.6, 1, 0 from 10 k to 10 k + 10 ms."""
    source = ["-f100", "--transfer", "linear", "gaps.mkv"]
    (folder / "ramp.fn").write_text("M0 [0:0], [40000000:1]\n")
    # Weights (10 k + 5) / 4 ms = 1.25, 3.75, 6.25, 8.75; D = 40 ms.
    checks.expose_float("a gain that ramps from 0 to 1: (0.2 x 1.25 + 0.6 x 3.75 + 1 x 6.25) / 40",
                        folder, ["-k", "ramp.fn"] + source, by_hand([0.21875, 0.2]))
    (folder / "sign.fn").write_text(
        "M0 [0:1], [10000000:1], [10000001:-1], [20000000:-1], [20000001:0]\n")
    checks.expose_float("sample 0 less sample 1: (10 x 0.2 - 10 x 0.6) / 20", folder,
                        ["-k", "sign.fn"] + source, by_hand([-0.2, 0.0]))
    pictures.write_pgm(folder / "two.pgm", np.array([[7, 128]], np.uint8))
    (folder / "two.fn").write_text(
        "M7{[0:1],\n[9999999:1], [10000000:0]}\n"
        "M128 [0:0], [20000000:0], [20000001:3], [29999999:3], [30000000:0]\n")
    checks.expose_float("mask values 7 and 128 with gain 1 and 3: 0.2 and 3 x 0.4", folder,
                        ["-mtwo.pgm", "-ktwo.fn"] + source, by_hand([0.2, 1.2]))


def rounded_timeline(checks, folder):
    """400 million samples a second: starts 0, 2.5, 5, 7.5 and end 10 ns are 0, 3, 5, 8, 10, halves
    up. Light 0.2, 0.6, 1, 0 and 0.4."""
    source = ["-f400000000", "--transfer", "linear", "gaps.mkv"]
    (folder / "all.fn").write_text("M0 [0:1]\n")
    checks.expose_float("halves of a nanosecond round up: (3 x 0.2 + 2 x 0.6 + 3 x 1) / 10", folder,
                        ["-kall.fn"] + source, by_hand([0.48, 0.4]))
    # Exposures [0, 1], [3, 4], [5, 6], [8, 9]: weights 2, 2.5, 2.5, 3 ns.
    checks.expose_float("the same with 180 degrees: (2 x 0.2 + 2.5 x 0.6 + 2.5 x 1) / 10", folder,
                        ["-kall.fn", "-a180"] + source, by_hand([0.44, 0.4]))
    checks.expose_float("picture 1 of that clip, by number: 0.6", folder,
                        ["--start", "1f", "--exposure", "1f"] + source, by_hand([0.6, 0.4]))


def held_codes(checks, folder):
    """Tolerance 4, steps of 9: 100, 104, 105, 101 is held as 100, 100, 109, 100."""
    pictures.write_lossless(folder / "held.mkv", grey_row([100, 9], [104, 9], [105, 9], [101, 9]))
    source = ["-f100", "--transfer", "linear", "--tolerance", "4", "held.mkv"]
    whole = ["--start", "0s", "--exposure", "40ms"]
    checks.expose_float("tolerance 4 holds 100, 100, 109, 100: mean 102.25", folder, whole + source,
                        by_hand([102.25 / 255, 9 / 255]))
    checks.expose_float("a gap without a record at its end doesn't ramp: 100", folder,
                        ["--start", "6ms", "--exposure", "4ms", "-a180"] + source,
                        by_hand([100 / 255, 9 / 255]))
    colours = np.array([[[[100, 50, 20]]], [[[104, 52, 20]]], [[[105, 62, 24]]]], np.uint8)
    pictures.write_lossless(folder / "colours.mkv", colours)
    expected = Exposure(np.array([[[309, 159, 60]]]) / 3 / 255, np.ones((1, 1)), {})
    checks.expose_float("each channel moves by steps of its own: (100 100 109, 50 50 59, 20 20 20) / 3", folder,
                        ["-f100", "--transfer", "linear", "--tolerance", "4", "--start", "0s",
                         "--exposure", "30ms", "colours.mkv"], expected)


def means_in_light(checks, folder):
    """The mean of black and white is light 0.5: by sRGB code 187.516, by BT.709 179.886 and by a
    pure power of 2 180.312. Half of code 254's light gives 186.767, 179.154 and 179.605."""
    pictures.write_lossless(folder / "means.mkv", grey_row([0, 0], [255, 254]))
    for transfer, want in (("srgb", [[188], [187]]), ("bt709", [[180], [179]]),
                           ("gamma:2", [[180], [180]])):
        checks.codes_are(f"{transfer}: half of codes 255 and 254", folder,
                         ["-f100", "--transfer", transfer, "--out-transfer", "source", "--start", "0s",
                          "--exposure", "2f", "means.mkv"], np.array(want))
    # Shown as sRGB, light 0.5 is 187.516 whatever the codes were; 254 of linear 255 is 0.498039: 187.192.
    for transfer in ("srgb", "bt709", "linear", "gamma:2"):
        checks.codes_are(f"{transfer}, shown: half of code 255", folder,
                         ["-f100", "--transfer", transfer, "--start", "0s", "--exposure", "2f",
                          "means.mkv"], np.array([[188], [187]]))


def codes_come_back(checks, folder):
    """A boxcar over exactly one sample gives its codes back, all 256 of each channel."""
    codes = np.arange(256, dtype=np.uint8).reshape(16, 16)
    samples = np.stack([np.stack([codes, codes[::-1], codes.T], axis=2) ^ change
                        for change in (0, 85, 255)]).astype(np.uint8)
    pictures.write_lossless(folder / "codes.mkv", samples)
    for transfer in TRANSFERS:
        for name, interval in (("exactly sample 1", ("--start", "1f", "--exposure", "1f")),
                               ("1 us inside it", ("--start", "15ms", "--exposure", "1us"))):
            checks.codes_are(f"{transfer}: {name} gives its codes back", folder,
                             ["-f100", "--transfer", transfer, "--out-transfer", "source", *interval,
                              "codes.mkv"], samples[1])
    checks.codes_are("srgb is shown as it is", folder,
                     ["-f100", "--start", "1f", "--exposure", "1f", "codes.mkv"], samples[1])


def still_scenes(checks, folder):
    """30 samples at 10 a second, all alike: 3 s of a still scene that shows every code."""
    codes = np.arange(256, dtype=np.uint8).reshape(1, 16, 16, 1).repeat(30, axis=0)
    pictures.write_lossless(folder / "still.mkv", codes)
    light = light_table("srgb", 255).reshape(16, 16, 1)
    # Figure 14 as printed, in ns: up 0.5, at one 99999999, down from 1 to -25 by 900000002 x -12,
    # at -25 for 9999998, back to 0 by -12.5: -10949999987 / 1010000001 = -10.8415840. Of |g| the
    # ramp is 1/26 x 900000002 x 0.5 + 25/26 x 900000002 x 12.5, and all 11184615370: S = 11.07.
    # (name, file, still gain, S = integral of |g| / D, or less)
    cases = [("Figure 4", figures.FIGURE_4, 0.250009006, 1.0),
             ("Figure 14 as printed", figures.FIGURE_14, -10.8415840, 11.07),
             ("Figure 14 restored", figures.FIGURE_14_RESTORED, 0.742574, 1.0)]
    pictures.write_pgm(folder / "still.pgm", np.zeros((16, 16), np.uint8))
    arguments = ["-f10", "-mstill.pgm", "-kstill.fn", "still.mkv"]
    for name, text, gain, scale in cases:
        (folder / "still.fn").write_text(text)
        expected = Exposure(light * gain, np.full((16, 16), scale), {})
        checks.expose_float(f"{name} on a still scene: its light x {gain}", folder, arguments,
                            expected)
    (folder / "still.fn").write_text(figures.FIGURE_14)
    checks.codes_are("Figure 14 as printed makes a still scene black", folder, arguments, 0)


def numbers(checks):
    """expose.py's own numbers over a 3 s domain: exact where they are known exactly."""
    checks.begin("numbers", "The paper's figures over 3 s, from expose.py")
    ms = Fraction(10**6)
    # (figure, file, mask value, integral of g in ns, D in ns)
    cases = [("Figure 4", figures.FIGURE_4, 0, Fraction("20.83350075") * ms,
              Fraction("83.331001") * ms),
             ("Figure 7", figures.FIGURE_7, 128, Fraction("40.0000035") * ms,
              Fraction("40.000007") * ms),
             ("Figure 14 restored", figures.FIGURE_14_RESTORED, 0, Fraction("750.000013") * ms,
              Fraction("1010.000001") * ms),
             ("Figure 16", figures.FIGURE_16, 0, Fraction("200.000001") * ms,
              Fraction("200.000001") * ms)]
    for name, text, mask_value, integral, duration in cases:
        got = gain_functions.measure(gain_functions.parse_functions(text)[mask_value], 3 * SECOND)
        checks.holds(f"{name} M{mask_value}", (got.integral, got.duration) == (integral, duration),
                     f"integral {float(got.integral)} ns, D {float(got.duration)} ns, "
                     f"still gain {float(got.integral / got.duration):.9f}")
    irregular(checks)
    gains = [("Figure 4", figures.FIGURE_4, "0.250009006"),
             ("Figure 14", figures.FIGURE_14, "-10.84"),
             ("Figure 14 restored", figures.FIGURE_14_RESTORED, "0.742574")]
    for name, text, gain in gains:
        got = gain_functions.measure(gain_functions.parse_functions(text)[0], 3 * SECOND)
        decimals = len(gain.split(".")[1])
        still = f"{float(got.integral / got.duration):.{decimals}f}"
        checks.holds(f"{name} still gain", still == gain, f"{still}, the paper's file gives {gain}")


def irregular(checks):
    """Timelines and weights of irregular samples, in ns, and |g| across a change of sign."""
    ones = gain_functions.GainFunction([(0, 1)])
    # Exposed [0, 10], [20, 30], [60, 64]: gaps of 10 and 30 ns, half of each to either side.
    given = timelines.from_exposures([(100, 110), (120, 130), (160, 164)])
    checks.holds("weights of exposures [0, 10], [20, 30], [60, 64]",
                 timelines.weights(given, ones) == {0: 15, 1: 30, 2: 19},
                 "10 + 5, 5 + 10 + 15, 15 + 4")
    # Starts 0, 10, 30 with 180 degrees: exposed [0, 5], [10, 20], [30, 40], end 50.
    starts = timelines.from_starts([7, 17, 37], "180")
    checks.holds("weights of starts 0, 10, 30 with 180 degrees",
                 timelines.weights(starts, ones) == {0: 7.5, 1: 17.5, 2: 25},
                 "5 + 2.5, 2.5 + 10 + 5, 5 + 10 + 10")
    ramp = gain_functions.measure(gain_functions.GainFunction([(0, -1), (4, 3), (5, 0)]), 100)
    checks.holds("from -1 to 3 over 4 ns, then to 0", ramp == (5, Fraction(11, 2), Fraction(13, 2)),
                 "D 5, integral -0.5 + 4.5 + 1.5, of |g| 0.5 + 4.5 + 1.5")
