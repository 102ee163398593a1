"""The lightest, darkest and middle sample: NumPy's, bit for bit."""

import os
import unittest
from pathlib import Path

import numpy as np

import nutik
from support import moving_box, TestCase, tags

# Of 640 x 272 to 1920 x 1080, in daylight, indoors and at night.
CLIPS = "bikes.mp4", "bicycle-wheel.mp4", "bulk-water.mov", "diabolo-cm-trajectory.mp4"
COMBINED = {"lighten": np.max, "darken": np.min, "median": np.median}


def check(test, capture, first, last):
    """Against NumPy over samples from `first` on and before `last`, in light and in the capture's own codes."""
    codes = capture[first:last]
    white = np.float64(np.iinfo(codes.dtype).max)
    interval = dict(start=f"{first}f", exposure=f"{last - first}f")
    for how, combined in COMBINED.items():
        picture = capture.render(**interval, combine=how, dtype="float64")
        test.assert_same(picture.array, combined(codes / white, axis=0))
        if how != "median":
            picture = capture.render(**interval, combine=how, codes=True, transfer="source")
            test.assert_same(picture.array, combined(codes, axis=0))


class Combining(TestCase):
    def test_real_clips(self):
        if not Path(os.environ.get("NUTIK_TEST_MEDIA", ""), CLIPS[0]).is_file():
            self.skipTest("there are no recorded clips")
        for name in CLIPS:
            with self.subTest(name):
                clip = Path(os.environ["NUTIK_TEST_MEDIA"], name)
                capture = nutik.open(clip, rate=100, shutter_angle=360, transfer="linear", begin="10f", end="50f")
                check(self, capture, 3, 36)

    def test_regions(self):
        """Three functions, each with its own samples."""
        pictures = moving_box(samples=40)
        capture = nutik.encode(pictures, rate=100, transfer="linear")
        mask = tags()
        functions = {0: nutik.boxcar("0ms", "400ms"), 128: nutik.boxcar("50ms", "200ms"),
                     255: nutik.boxcar("110ms", "70ms")}
        for how, combined in COMBINED.items():
            found = capture.render(functions, mask=mask, combine=how, dtype="float64").array
            for tag, part in {0: slice(0, 40), 128: slice(5, 25), 255: slice(11, 18)}.items():
                expected = combined(pictures[part] / 255.0, axis=0)
                self.assert_same(found[mask == tag], expected[mask == tag])

    def test_comet_tail(self):
        """A gain that falls scales light before the lightest is taken."""
        pictures = moving_box(samples=40, dtype=np.uint16)
        capture = nutik.encode(pictures, rate=100, transfer="linear")
        steps = nutik.Function.from_ns([10_000_000 * (k + end) for k in range(40) for end in (0, 1)],
                                       [0.5 ** k for k in range(40) for _ in range(2)])
        found = capture.render(steps, combine="lighten", dtype="float64").array
        gains = 0.5 ** np.arange(40)
        self.assert_same(found, np.max(gains[:, None, None, None] * (pictures / 65535.0), axis=0))

    def test_what_it_goes_with(self):
        capture = nutik.encode(moving_box(samples=10), rate=100)
        interval = dict(start=0, exposure="10f")
        mean = capture.render(**interval, combine="mean")
        self.assert_same(mean.array, capture.render(**interval, normalize="integral").array)
        self.assert_same(capture.render(**interval, combine="integral").array, capture.render(**interval).array)
        self.assert_raises(nutik.UsageError, "choose integral, mean, lighten, darken or median", capture.render,
                           **interval, combine="brighten")
        bounds = capture.render(**interval, combine="darken", bounds=True, codes=True).bounds
        self.assertNotIn("times", bounds, "nothing is added up")
        self.assertLess(np.max(bounds["all_bounds"]), 0.5001, "what is combined is a code of the capture")
        self.assert_raises(nutik.UsageError, ["combine", "delay"], capture.render, **interval, combine="darken",
                           delay="rows:5ms")

    def test_many(self):
        """Combined, and with maps of bounds: each picture and map that of render(), of one function and of masks."""
        capture = nutik.encode(moving_box(samples=40), rate=100)
        starts = [0, 0.1, 0.25]
        for stated in ({}, {"region": (3, 4, 10, 7), "codes": True}):
            for how in ("mean", *COMBINED):
                many = capture.render_many(starts=starts, exposures="70ms", combine=how, **stated)
                self.assertIsNone(many.bounds)
                for start, picture in zip(starts, many):
                    self.assert_same(picture, capture.render(start=start, exposure="70ms", combine=how, **stated).array)
            many = capture.render_many(starts=starts, exposures="70ms", bounds=True, **stated)
            for k, start in enumerate(starts):
                one = capture.render(start=start, exposure="70ms", bounds=True, **stated)
                self.assert_same(many[k], one.array)
                self.assertEqual(many.bounds.keys(), one.bounds.keys())
                for term, each in many.bounds.items():
                    self.assert_same(each[k], one.bounds[term])
        functions = [{0: nutik.boxcar(0, "0.2s"), 128: nutik.boxcar("0.1s", each), 255: nutik.boxcar(0, each)}
                     for each in (0.1, 0.2)]
        many = capture.render_many(functions, mask=tags(), bounds=True)
        for k, each in enumerate(functions):
            self.assert_same(many.bounds["all_bounds"][k],
                             capture.render(each, mask=tags(), bounds=True).bounds["all_bounds"])


if __name__ == "__main__":
    unittest.main()
