"""What scripts of a laboratory do: other kinds of arrays and numbers, copies, errors that they catch."""

import io
import copy
import datetime
import os
import pickle
import shutil
import subprocess
import sys
import unittest
from fractions import Fraction
from pathlib import Path

import nutik
import numpy as np

import support

ROOT = Path(__file__).resolve().parents[2]


class Numbers(support.TestCase):
    def encoded(self, **stated):
        return nutik.encode(np.zeros((4, 3, 5), np.uint8), **stated)

    def test_a_float_of_any_width_is_taken_as_it_is_printed(self):
        function = nutik.Function([0, np.float32(0.1), np.float16(0.25)], [0, 1, 0])
        self.assertEqual(function.times_ns.tolist(), [0, 100_000_000, 250_000_000])
        self.assertEqual(self.encoded(rate=np.float32(29.97)).rate, Fraction(2997, 100))

    def test_a_rate_that_is_a_quotient_is_that_quotient(self):
        for rate, wanted in ((1000 / 3, Fraction(1000, 3)), (1 / 0.0003, Fraction(10_000, 3)),
                             (24 / 1.001, Fraction(24_000, 1001)),
                             (np.float64(1000 / 7), Fraction(1000, 7))):
            self.assertEqual(self.encoded(rate=rate).rate, wanted)
        self.assert_raises(nutik.UsageError, "15 digits", self.encoded, rate=Fraction(10 ** 16, 3))

    def test_dates_count_from_the_first(self):
        begin = np.datetime64("2026-01-31T23:59:59.995", "ns")
        dates = begin + np.array([0, 10, 25, 40]) * np.timedelta64(1, "ms")
        wanted = self.encoded(times=[0, "10ms", "25ms", "40ms"], exposures="5ms").times_ns
        self.assert_same(self.encoded(times=dates, exposures="5ms").times_ns, wanted)
        self.assert_same(self.encoded(times=list(dates.astype("datetime64[us]").astype(datetime.datetime)),
                                      exposures="5ms").times_ns, wanted)
        dates[2] = np.datetime64("NaT")
        self.assert_raises(nutik.UsageError, "NaT", self.encoded, times=dates)

    def test_facts_say_what_the_caller_said(self):
        self.assertIn("shutter 1.08 degrees, from what the caller said: 3000000 ns",
                      self.encoded(rate=1, exposures="3ms").facts)
        facts = self.encoded(times=[0, 1, 2, 4], exposures=[0.5] * 4).facts
        self.assertIn("from what the caller said", facts[0])
        self.assertNotIn("file", " ".join(facts))

    def test_an_exposure_lasts_longer_than_nothing(self):
        for exposures in (-1, 0, "-1s", np.timedelta64(0, "ms")):
            self.assert_raises(nutik.UsageError, ["exposures", "longer than 0"], self.encoded, rate=1,
                               exposures=exposures)
        self.assert_raises(nutik.UsageError, ["exposures[2]", "longer than 0"], self.encoded, times=[0, 1, 2, 3],
                           exposures=[1, 1, -1, 1])


class Arrays(support.TestCase):
    def test_a_masked_array_is_refused_where_something_is_masked(self):
        pictures = np.ma.masked_array(support.moving_box(), mask=False)
        wanted = nutik.encode(support.moving_box(), rate=960).render(exposure="3f").array
        self.assert_same(nutik.encode(pictures, rate=960).render(exposure="3f").array, wanted)
        pictures[3, 4, 5] = np.ma.masked
        tags, gains = np.ma.masked_equal(support.tags(), 128), np.ma.masked_equal(np.arange(70.0), 9)
        capture = nutik.encode(support.moving_box(), rate=960)
        for call in (lambda: nutik.encode(pictures, rate=960), lambda: nutik.encode(iter(pictures[3:]), rate=960),
                     lambda: nutik.encode(iter(pictures), rate=960),
                     lambda: nutik.Mask(tags), lambda: nutik.Mask.of_layers({128: tags}),
                     lambda: capture.render(exposure="1f", delay=np.ma.masked_equal(np.zeros((45, 80)), 0)),
                     lambda: capture.render(gains), lambda: capture.render_many(gains[None]),
                     lambda: capture.render_many(starts=gains, exposures="1f"), lambda: nutik.Function(gains, gains),
                     lambda: nutik.Function.from_ns(np.arange(70), gains),
                     lambda: nutik.encode(pictures.data, times=gains)):
            self.assert_raises(nutik.UsageError, ["mask", ".filled("], call)

    def test_a_memoryview_is_an_array(self):
        pictures = support.moving_box()
        wanted = nutik.encode(pictures, rate=960).render(exposure="3f").array
        self.assert_same(nutik.encode(memoryview(pictures), rate=960).render(exposure="3f").array, wanted)

    def test_a_capture_is_a_sequence_of_its_codes(self):
        still = np.random.default_rng(5).integers(0, 256, (200, 19, 30, 3), np.uint8)
        still[40:130, 3:12] = 7  # tiles of every kind, over several blocks
        for pictures in (still, still[..., 0].astype(np.uint16) * 257, support.moving_box()):
            capture = nutik.encode(pictures, rate=100, block_samples=64)
            self.assert_same(np.asarray(capture), pictures)
            for key in (0, -1, 69, np.int64(3), slice(10, 140, 7), slice(None, None, -1), slice(5, 5), ...,
                        (slice(60, 70), slice(2, 9), -1), (..., 1), (3, 4)):
                self.assert_same(capture[key], pictures[key])
            for held, picture in zip(capture, pictures, strict=True):
                self.assert_same(held, picture)
            self.assertEqual(capture.times.tolist(), (np.arange(len(pictures)) / 100).tolist())
            for key in (len(pictures), -len(pictures) - 1):
                self.assertRaises(IndexError, capture.__getitem__, key)
            self.assertRaises(TypeError, capture.__getitem__, 1.5)
            self.assertRaises(ValueError, capture.__array__, copy=False)

    def test_too_much_at_once(self):
        capture = nutik.encode((np.zeros((1080, 1920, 3), np.uint8) for _ in range(700)), rate=100)
        self.assert_raises(nutik.MemoryTooLittle, ["700 samples", "4.4 GB", "render()"], np.asarray, capture)
        self.assertEqual(capture[699, 5, 5].tolist(), [0, 0, 0])

    def test_records_are_what_pixels_hold(self):
        rng = np.random.default_rng(6)
        for shape in ((150, 17, 21), (150, 17, 21, 3)):
            pictures = np.repeat(rng.integers(0, 256, (30, *shape[1:]), np.uint8), 5, axis=0)
            pictures[:, 8:] = pictures[0, 8:]
            capture = nutik.encode(pictures, times=np.cumsum(rng.integers(1, 9, 150)) / 1000, exposures=1e-4,
                                   block_samples=64)
            begins = capture.times_ns[:, 0]
            first, last = 33, 149
            records = capture.records((2, 3, 9, 11), first=first, last=last)
            again = np.zeros_like(pictures)
            for x, y, start, end, code in records.tolist():
                held = (begins >= start) & (begins < end)
                self.assertFalse(again[held, y, x].any())
                again[held, y, x] = code
            self.assert_same(again[first:last, 3:14, 2:11], pictures[first:last, 3:14, 2:11])
            of_one = records[(records["x"] == 2) & (records["y"] == 13)]  # where nothing changes
            self.assertEqual(len(of_one), 1)
            self.assertEqual(of_one["end_ns"], begins[last])
            self.assertEqual(capture.records()["end_ns"].max(), capture.times_ns[-1, 1])
            for wrong in (dict(region=(0, 0, 22, 1)), dict(first=150), dict(last=151), dict(first=9, last=9)):
                self.assertRaises(nutik.UsageError, capture.records, **wrong)

    def test_light_in_floats_is_encoded_where_white_is_stated(self):
        light = np.random.default_rng(7).random((9, 8, 12, 3)) * 0.5
        light[0, 0, 0] = [0, 0.5, 0.25]
        for pictures, white in ((light, 0.5), (light.astype(np.float32) * 800, 400), (light.astype(np.float16), 1)):
            for source in (pictures, iter(pictures)):
                capture = nutik.encode(source, rate=10, white=white)
                self.assertLessEqual(np.abs(np.asarray(capture) / 65535 - pictures.astype(float) / white).max(),
                                     0.5 / 65535 + 1e-12)
                self.assertIn("transfer linear, assumed", capture.facts)
        for wrong in (light - 0.1, light * 3, np.where(light > 0.4, np.nan, light)):
            self.assert_raises(nutik.InputError, ["0 and white=1", "larger white"], nutik.encode, wrong, rate=1,
                               white=1)
        self.assert_raises(nutik.UsageError, "white=1.0", nutik.encode, light, rate=1)
        self.assert_raises(nutik.UsageError, "white=1.0", nutik.encode, light, rate=1, white=np.inf)
        mixed = [np.zeros((8, 12), np.uint16), np.zeros((8, 12))]
        for pictures in (mixed, mixed[::-1]):
            self.assert_raises(nutik.InputError, "some pictures are codes", nutik.encode, pictures, rate=1, white=1)
        self.assert_raises(nutik.UsageError, "a capture already", nutik.encode, nutik.encode(light, rate=1, white=1),
                           rate=1)

    def test_other_orders_of_bytes_and_dlpack(self):
        pictures = support.moving_box().astype(np.uint16) * 200

        class Tensor:
            def __dlpack__(self, **how):
                return pictures.__dlpack__(**how)

            def __dlpack_device__(self):
                return pictures.__dlpack_device__()

        for source in (pictures.astype(">u2"), iter(pictures.astype(">u2")), Tensor()):
            self.assert_same(np.asarray(nutik.encode(source, rate=960)), pictures)

    def test_open_files_are_read_and_written(self):
        pictures = support.moving_box()
        nutik.encode(pictures, self.path("a.tik"), rate=960)
        with open(self.path("a.tik"), "rb") as file:
            bytes_of_capture = file.read()
        self.assert_same(np.asarray(nutik.open(io.BytesIO(bytes_of_capture))), pictures)
        self.assert_same(np.asarray(nutik.encode(io.BytesIO(b"P5 3 2 255\n" + bytes(6)), rate=1)),
                         np.zeros((1, 2, 3), np.uint8))
        picture = nutik.open(self.path("a.tik")).render(exposure="3f", dtype=float)
        file = io.BytesIO()
        picture.write(file, kind=".npy")
        file.seek(0)
        self.assert_same(np.load(file), picture.array)
        picture.write(self.path("p.npy"))
        self.assert_same(np.load(self.path("p.npy")), picture.array)
        self.assert_raises(nutik.OutputError, ["p.npy cannot be", "no folder"], picture.write,
                           self.path("absent/p.npy"))
        self.assert_raises(nutik.UsageError, "kind='.png'", picture.write, file)

    def test_what_notebooks_show(self):
        capture = nutik.encode(support.moving_box(), rate=960, name="<b>")
        codes = capture.render(exposure="3f", codes=True)
        codes.write(self.path("codes.png"))
        with open(self.path("codes.png"), "rb") as file:
            self.assertEqual(codes._repr_png_(), file.read())
        for light in (capture.render(exposure="3f"), capture.render(exposure="3f", dtype=float)):
            self.assertEqual(light._repr_png_(), codes._repr_png_())
        hlg = nutik.encode(support.moving_box(), rate=960, transfer="hlg")
        self.assertEqual(hlg.render(exposure="3f")._repr_png_(), hlg.render(exposure="3f", codes=True)._repr_png_())
        self.assertIn("<b>&lt;b&gt;</b>", capture._repr_html_())
        try:
            from matplotlib import pyplot
        except ImportError:
            self.skipTest("matplotlib is not installed")
        pyplot.switch_backend("agg")
        trace, = capture.trace(3, 4, functions=nutik.boxcar(0, 0.01))
        for drawn, label in ((nutik.boxcar(0, 1), "gain"), (trace, "light"), (capture.activity(), "share of pixels")):
            axes = drawn.plot(pyplot.figure().gca())
            self.assertIn(label, axes.get_ylabel())
            self.assertGreater(len(axes.lines), 0)
            self.assertEqual(axes.get_xlabel(), "time, s")
        np.testing.assert_array_equal(axes.lines[0].get_xdata(), capture.times)
        self.assertRegex(repr(trace), r"^<nutik.Trace of M0: \d+ steps, light \[.+\]>$")

    def test_light_beyond_floats_is_told(self):
        capture = nutik.encode(support.moving_box(), self.path("a.tik"), rate=960)
        with self.assertWarnsRegex(nutik.NutikWarning, "10800 values are beyond floating point"):
            self.assertTrue(np.isinf(capture.render(exposure="3f", gain=1e200).array).any())
        words = [support.PROGRAM, "--gain", "1e200", "--start", "0s", "--exposure", "3f", "a.tik"]
        for more, status, said in (([self.path("a.pfm")], 0, "beyond floating point of 32 bits"),
                                   ([self.path("a.exr"), "--depth", "half"], 5, "16-bit floating point ends at 65504")):
            done = subprocess.run([*words, *more], cwd=self.folder, capture_output=True, text=True)
            self.assertEqual(done.returncode, status, done.stderr)
            self.assertIn(said, done.stderr)

    def test_the_bound_is_that_of_the_array(self):
        """Of one sample, whose light is known exactly: what float32 rounds counts."""
        codes = np.arange(256, dtype=np.uint16).reshape(1, 16, 16) * 257 + 1
        capture = nutik.encode(np.repeat(codes, 3, axis=0), rate=100)
        for precision in ("single", "compensated", "double", "fixed"):
            picture = capture.render(exposure="1f", precision=precision)
            exact = codes[0].astype(np.longdouble) / 65535
            error = float(np.abs(picture.array.astype(np.longdouble) - exact).max())
            self.assertLessEqual(error, picture.error_bound, precision)
            self.assertLess(picture.error_bound, 1e-3)
            double = capture.render(exposure="1f", precision=precision, dtype=np.float64)
            self.assertLessEqual(double.error_bound, picture.error_bound)


class Copies(support.TestCase):
    def test_functions_masks_and_pictures(self):
        capture = nutik.encode(support.moving_box(), rate=960)
        function = nutik.shutter("hann", 0, "10ms")
        soft = nutik.Mask(support.tags()).feathered(3)
        made = [function, nutik.Mask(support.tags()), soft, capture.render(exposure="3f"),
                capture.render(exposure="3f", codes=True), capture.render(exposure="3f", dtype=np.float64),
                capture.background()]
        for given in made:
            pickled = (pickle.loads(pickle.dumps(given, way)) for way in range(pickle.HIGHEST_PROTOCOL + 1))
            for copied in (*pickled, copy.deepcopy(given), copy.copy(given)):
                self.assertIs(type(copied), type(given))
                if isinstance(given, nutik.Mask):
                    self.assert_same(copied.tags, given.tags)
                    for tag in given.tags_in_use:
                        self.assert_same(copied.share(tag), given.share(tag))
                elif isinstance(given, nutik.Picture):
                    self.assert_same(copied.array, given.array)
                    self.assertEqual((copied.plan, copied.precision, copied.error_bound), (given.plan, given.precision,
                                                                                         given.error_bound))
                elif isinstance(given, nutik.Function):
                    self.assertEqual(copied, given)

    def test_a_capture_is_opened_anew(self):
        capture = nutik.encode(support.moving_box(), self.path("box.tik"), rate=960)
        for protocol in range(pickle.HIGHEST_PROTOCOL + 1):
            with self.assertRaisesRegex(TypeError, "box.tik.*path.*nutik.open"):
                pickle.dumps(capture, protocol)

    def test_a_copied_picture_writes_the_same_file(self):
        capture = nutik.encode(support.moving_box(dtype=np.uint16), rate=960, white=65535, primaries="bt2020")
        for name, picture in (("a.png", capture.render(exposure="3f", codes=True, transfer="source")),
                              ("a.exr", capture.render(exposure="3f"))):
            picture.write(self.path(name))
            pickle.loads(pickle.dumps(picture)).write(self.path("copied-" + name))
            self.assertEqual(Path(self.path(name)).read_bytes(), Path(self.path("copied-" + name)).read_bytes())

    def test_traces_are_equal_where_all_of_them_is(self):
        capture = nutik.encode(support.moving_box(), rate=960)
        first, again = (capture.trace(5, 12, exposure="3f")[0] for _ in range(2))
        self.assertTrue(first == again)
        self.assertFalse(first == capture.trace(6, 12, exposure="3f")[0])
        self.assertFalse(first == capture.trace(5, 12, exposure="4f")[0])
        self.assertFalse(first == 3)

    def test_a_plan_is_the_callers_own(self):
        picture = nutik.encode(support.moving_box(), rate=960).render(exposure="3f")
        wanted = copy.deepcopy(picture.plan)
        picture.plan["functions"][0]["tag"] = 7
        picture.plan.clear()
        picture.statistics.clear()
        self.assertEqual(picture.plan, wanted)
        self.assertTrue(picture.statistics)


class Labelled:
    """As xarray's, whose items are arrays without a dimension."""

    def __init__(self, values):
        self.values = values

    def __array__(self, dtype=None, copy=None):
        return self.values

    def __iter__(self):
        return (Labelled(each) for each in self.values)


class Errors(support.TestCase):
    def test_a_missing_file_is_an_oserror_too(self):
        black = np.zeros((2, 8, 8), np.uint8)
        for call in (lambda: nutik.open(self.path("none.tik")), lambda: nutik.encode(Path(self.path("none.mp4"))),
                     lambda: nutik.read_functions(self.path("none.fn")), lambda: nutik.read_mask(self.path("none.pgm")),
                     lambda: nutik.join([self.path("a.tik"), self.path("b.tik")], self.path("c.tik")),
                     lambda: nutik.encode(black, rate=1, noise=self.path("none.noise")),
                     lambda: nutik.encode(black, rate=1, align_along=self.path("none.csv")),
                     lambda: nutik.encode(black, rate=1).render(exposure=1, delay=self.path("none.tif") + ":0s..1s"),
                     lambda: nutik.open(self.path("*.png"), rate=1), lambda: nutik.open(self.path("%d.png"), rate=1),
                     lambda: nutik.retime(self.path("none.tik"), rate=1, in_place=True),
                     lambda: nutik.batch(self.path("none.txt"), self.path("a.tik"))):
            with self.assertRaises(FileNotFoundError) as raised:
                call()
            self.assertIsInstance(raised.exception, nutik.InputError)
            self.assertIn(raised.exception.filename, str(raised.exception))
            self.assertEqual(os.path.dirname(raised.exception.filename), str(self.folder))
        Path(self.path("broken.tik")).write_bytes(b"nothing")
        self.assert_raises(nutik.InputError, "broken.tik", nutik.open, self.path("broken.tik"))

    def test_a_wrong_type_is_a_typeerror_too(self):
        capture = nutik.encode(support.moving_box(), rate=960)
        for call in (lambda: nutik.encode(3, rate=1), lambda: nutik.encode(support.moving_box(), rate=[1]),
                     lambda: capture.render(start=object(), exposure="1f"),
                     lambda: capture.trace("x", "y", exposure="1f"),
                     lambda: capture.background(by=1.5), lambda: capture.background(codes="no"),
                     lambda: nutik.encode(["a.png", "b.png"], rate=1), lambda: nutik.fit(3, 0, 1),
                     lambda: nutik.check("a.tik", functions={0: nutik.boxcar(0, 1)}),
                     lambda: capture.solve({0: nutik.boxcar(0, 1)}, []), lambda: capture.solve("", [], free=["g"])):
            with self.assertRaises(TypeError) as raised:
                call()
            self.assertIsInstance(raised.exception, nutik.UsageError)

    def test_every_error_is_one_of_ours(self):
        capture = nutik.encode(support.moving_box(), rate=960)
        for call in (lambda: capture.render(exposure="1f", dtype="bogus"), lambda: capture.background(dtype="bogus"),
                     lambda: capture.render(exposure="1f", progress=3),
                     lambda: nutik.check(self.path("a"), progress=3)):
            self.assertRaises(nutik.UsageError, call)
        self.assertRaises(TypeError, capture.render, exposure="1f", progress=3)

    def test_progress_that_takes_nothing_is_always_found(self):
        capture = nutik.encode(np.zeros((2, 8, 8), np.uint8), rate=1)
        for _ in range(20):
            self.assertRaises(TypeError, capture.render, exposure="1f", progress=lambda: 0)

    def test_docstrings_say_what_is_meant(self):
        self.assertIn("rear-curtain", nutik.Capture.study.__doc__)
        self.assertIn("'zero'", nutik.Capture.render.__doc__)
        self.assertIn("0.001 of its largest gain", " ".join(nutik.Capture.render.__doc__.split()))
        self.assertIn("codec : str, optional\n    of output", nutik.encode.__doc__)

    def test_a_codec_is_one_with_and_without_a_file(self):
        for output in (None, self.path("a.tik")):
            self.assert_raises(nutik.UsageError, "gif", nutik.encode, support.moving_box(), output, rate=1, codec="gif")

    def test_a_gain_for_each_sample(self):
        codes = np.random.default_rng(1).integers(0, 65536, (50, 6, 8), np.uint16)
        capture = nutik.encode(codes, rate=1000)
        gains = np.random.default_rng(2).random((7, 50))
        many = capture.render_many(gains, normalize="integral", dtype=np.float64)
        for k in range(7):
            wanted = np.average(codes / 65535, axis=0, weights=gains[k])
            self.assertLessEqual(np.abs(many[k] - wanted).max(), many.error_bounds[k] + 1e-12)
            alone = capture.render({0: gains[k]}, normalize="integral")
            self.assertLessEqual(np.abs(alone.array - wanted).max(), alone.error_bound + 1e-12)
        self.assert_raises(nutik.UsageError, ["49 gains for 50 samples", "Function(times, gains)"], capture.render,
                           gains[0, 1:])
        self.assert_raises(nutik.UsageError, "an array of shape (7, 50)", capture.render, gains)
        self.assert_raises(nutik.UsageError, "say start= and exposure=", capture.render, 0.01)
        self.assert_raises(nutik.UsageError, "an array with a gain for each sample", capture.render, list(gains[0]))
        self.assert_same(capture.render(Labelled(gains[0])).array, capture.render(gains[0]).array)
        self.assert_same(capture.render_many(Labelled(gains)).array, capture.render_many(gains).array)
        points = Labelled(np.array([[0, 1], [0.05, 0]]))
        self.assert_same(capture.render(points).array, capture.render([(0, 1), (0.05, 0)]).array)
        self.assert_raises(nutik.UsageError, "takes a list", capture.render_many, gains[0])

    def test_many_pictures_are_an_array(self):
        many = nutik.encode(np.zeros((20, 4, 5), np.uint8), rate=100).render_many(starts=[0, 0.1], exposures=0.05)
        self.assertEqual((many.shape, many[0].shape, [each.shape for each in many]), ((2, 4, 5), (4, 5), [(4, 5)] * 2))
        self.assertEqual(repr(many), "<nutik.Pictures 2 x 4 x 5, float32>")

    def test_times_are_what_numpy_makes_an_array_of(self):
        times = Labelled(np.arange(20) / 100)
        capture = nutik.encode(np.zeros((20, 4, 5), np.uint8), times=times, exposures=Labelled(np.full(20, 0.005)))
        self.assertEqual(capture.times_ns[3].tolist(), [30_000_000, 35_000_000])
        self.assertEqual(len(capture.render_many(starts=times, exposures=0.01)), 20)


class Wheels(support.TestCase):
    def test_a_build_that_failed_may_be_tried_again(self):
        """CMake that writes its cache and then fails, as it does where pybind11 is missing."""
        for part in ("setup.py", "README.md", "CMakeLists.txt", "LICENSE"):
            shutil.copy(ROOT / part, self.folder)
        fake = self.folder / "bin" / "cmake"
        fake.parent.mkdir()
        fake.write_text('#!/bin/sh\necho "$@" >>calls\nmkdir -p build-python\n'
                        'touch build-python/CMakeCache.txt\nexit 1\n')
        fake.chmod(0o755)
        environment = {**os.environ, "PATH": f"{fake.parent}:{os.environ['PATH']}"}
        environment.pop("NUTIK_BUILD_DIR", None)
        for _ in range(2):
            done = subprocess.run([sys.executable, "setup.py", "build_ext"], cwd=self.folder, env=environment,
                                  capture_output=True, text=True)
            self.assertNotEqual(done.returncode, 0)
            self.assertNotIn("Traceback", done.stderr)
            self.assertIn("cmake", done.stderr)
        calls = (self.folder / "calls").read_text().splitlines()
        self.assertEqual([call.split()[0] for call in calls], ["--preset", "--preset"],
                         "it went on without build.ninja")


if __name__ == "__main__":
    unittest.main()
