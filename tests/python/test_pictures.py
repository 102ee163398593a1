"""A picture from Python is the command line's, bit for bit: codes and light, in every arithmetic, every mask."""

import copy
import json
import pickle
import unittest
import warnings

import nutik
from nutik import _words
import numpy as np

import support


class Devices(support.TestCase):
    def test_are_those_of_the_command_line(self):
        told = json.loads(self.run_program("devices", "--json"))["devices"]
        ours = nutik.devices()
        self.assertEqual([(each.index, each.name, each.kind, each.memory_bytes) for each in ours],
                         [(each["number"], each["name"], each["kind"], each["memory_bytes"]) for each in told])
        capture = nutik.encode(np.zeros((2, 8, 8), np.uint8), rate=1, device=ours[0].index)
        for precision in ours[0].precisions:
            self.assertEqual(capture.render(exposure=1, precision=precision).precision, precision)


class Pictures(support.TestCase):
    def setUp(self):
        super().setUp()
        self.pictures = support.moving_box()
        self.capture = nutik.encode(self.pictures, self.path("clip.tik"), rate=support.RATE)
        self.tags = support.tags()
        support.write_pgm(self.path("mask.pgm"), self.tags)
        (self.folder / "gains.fn").write_text(support.FUNCTIONS)
        self.functions = nutik.parse_functions(support.FUNCTIONS)

    def check(self, words, name="picture.ppm", **asked):
        """Both of the same exposure. Returns ours."""
        self.run_program("-q", "--overwrite", *words, "clip.tik", name)
        theirs = (support.read_pfm if name.endswith(".pfm") else support.read_netpbm)(self.path(name))
        picture = self.capture.render(**asked)
        self.assert_same(picture.array, theirs)
        return picture

    def test_an_interval(self):
        self.check(["--start", "0.02s", "--exposure", "12ms"], start=0.02, exposure="12ms", codes=True)
        self.check(["--start", "0.02s", "--exposure", "12ms"], "light.pfm", start="20ms", exposure=0.012)
        self.check(["--start", "7f", "--exposure", "9f", "--shutter", "hann", "--shutter-error", "1e-4"], start="7f",
                   exposure="9f", shutter="hann", shutter_error=1e-4, codes=True)

    def test_every_arithmetic(self):
        for precision in ("single", "compensated", "double", "fixed"):
            for name, codes in (("picture.ppm", True), ("light.pfm", False)):
                with self.subTest(precision=precision, codes=codes):
                    picture = self.check(["-m", "mask.pgm", "-k", "gains.fn", "--precision", precision], name,
                                         functions=self.functions, mask=self.tags, precision=precision, codes=codes)
                    self.assertEqual(picture.precision, precision)

    def test_feathers_and_what_codes_say(self):
        self.check(["-m", "mask.pgm", "-k", "gains.fn", "--feather", "3px", "--normalize", "integral"],
                   functions=self.functions, mask=self.tags, feather=3, normalize="integral", codes=True)
        self.check(["-m", "mask.pgm", "-k", "gains.fn", "--negative", "offset", "--out-transfer", "linear", "--depth",
                    "16", "--gain", "0.5"], functions=self.path("gains.fn"), mask=self.path("mask.pgm"),
                   negative="offset", transfer="linear", dtype=np.uint16, gain=0.5, codes=True)

    def test_delays(self):
        interval = ["--start", "5ms", "--exposure", "12ms", "--delay"]
        ours = dict(start="5ms", exposure="12ms", codes=True)
        height, width = self.tags.shape
        for delay in ("rows:30ms", "columns:30ms..-4ms", "radial:-2ms..20ms"):
            self.check([*interval, delay], delay=delay, **ours)
        self.check(["-m", "mask.pgm", "-k", "gains.fn", "--feather", "3px", "--delay", "rows:10ms"], "light.pfm",
                   functions=self.functions, mask=self.tags, feather=3, delay="rows:10ms")
        # The same from arrays: of seconds, and of a map's codes.
        rows = np.linspace(0, 0.030, height)[:, None].repeat(width, axis=1)
        self.check([*interval, "rows:30ms"], delay=rows, **ours)
        self.check([*interval, "rows:30ms"], delay=np.round(rows * 1e9).astype("timedelta64[ns]"), **ours)
        codes = np.random.default_rng(3).integers(0, 256, (height, width)).astype(np.uint8)
        support.write_pgm(self.path("delays.pgm"), codes)
        self.check([*interval, "delays.pgm:0s..25.5ms"], delay=codes * np.timedelta64(100, "us"), **ours)
        self.check([*interval, "delays.pgm:0s..25.5ms"], delay=self.path("delays.pgm") + ":0s..25.5ms", **ours)
        # A pixel is traced with its own delay.
        trace = self.capture.trace(3, height - 1, start="5ms", exposure="12ms", delay=rows)[0]
        light = self.capture.render(start="5ms", exposure="12ms", delay=rows, precision="double", dtype=np.float64)
        np.testing.assert_allclose(light.array[height - 1, 3], trace.exposed, rtol=1e-12)

    def test_delays_are_rounded_halves_upward(self):
        picoseconds = np.array([[1500, -1500, 1499]], "timedelta64[ps]")
        self.assertEqual(_words.delays_ns(picoseconds).tolist(), [[2, -1, 1]])
        self.assertEqual(_words.delays_ns(np.array([[2.5e-9, -2.5e-9]])).tolist(), [[3, -2]])
        rng = np.random.default_rng(4)
        for seconds in (np.array(rng.integers(-10 ** 13, 10 ** 13, 2000) / 2e9), np.float32([0.7, 1e-3, -0.3]),
                        np.float16([0.7]), np.array([1.7e9 + 0.1, 3])):
            self.assertEqual(_words.delays_ns(seconds).tolist(), _words.array_ns(seconds, "").tolist())

    def test_delays_that_are_none(self):
        for delay, said in (("rows", "does not say where and by how much"), (np.zeros((3, 4)), "3 x 4|4 x 3"),
                            (np.full(self.tags.shape, np.nan), "no number of seconds"),
                            (np.full(self.tags.shape, 200_000, "timedelta64[D]"), "126 years"),
                            (np.zeros(5), "two axes"),
                            (np.zeros(self.tags.shape, bool), "dtype bool")):
            with self.subTest(delay=str(delay)), self.assertRaisesRegex(nutik.Error, said):
                self.capture.render(start="5ms", exposure="12ms", delay=delay)

    def test_soft_masks_from_alphas(self):
        height, width = self.tags.shape
        ramp = np.linspace(0, 1, width, dtype=np.float64)[None].repeat(height, 0)
        shares = {128: np.rint(ramp * 65535).astype(np.uint16), 255: np.rint((1 - ramp) * 40000).astype(np.uint16)}
        for tag, share in shares.items():
            support.write_pgm(self.path(f"layer-{tag}.pgm"), share)
        for precision in ("single", "fixed"):
            self.check(["-m", "layer-%d.pgm", "-k", "gains.fn", "--precision", precision], functions=self.functions,
                       mask=shares, precision=precision, codes=True)
        self.check(["-m", "layer-%d.pgm", "-k", "gains.fn"], "light.pfm", functions=self.functions, mask=shares)
        mask = nutik.Mask.of_layers({128: ramp, 255: shares[255]})
        half = np.full((height, width), 0.5, np.float16)
        self.assertEqual(nutik.Mask.of_layers({128: half}).share(128)[0, 0], 32768)
        self.assertTrue(mask.is_soft)
        self.assertEqual(mask.tags_in_use, [0, 128, 255])
        self.assert_same(mask.share(128), shares[128])
        self.assert_same(nutik.read_mask(self.path("layer-%d.pgm")).share(255), shares[255])

    def test_deep_grey(self):
        pictures = support.moving_box(channels=1, dtype=np.uint16)
        self.capture = nutik.encode(pictures, self.path("clip.tik"), rate="30000/1001")
        self.assertEqual(self.capture.facts[2], "transfer linear, assumed")
        picture = self.check(["--start", "3f", "--exposure", "8f"], "picture.pgm", start="3f", exposure="8f",
                             codes=True)
        self.assertEqual(picture.dtype, np.uint16)
        self.check(["--start", "3f", "--exposure", "8f"], "light.pfm", start="3f", exposure="8f")

    def test_one_sample_comes_back(self):
        for k in (0, 63, 64, 69):
            picture = self.capture.render(start=f"{k}f", exposure="1f", codes=True, transfer="source")
            self.assert_same(picture.array, self.pictures[k])
        part = self.capture.render(start="5f", exposure="1f", codes=True, transfer="source", region=(20, 10, 30, 8))
        self.assert_same(part.array, self.pictures[5, 10:18, 20:50])

    def test_a_capture_of_an_array_is_that_of_its_file(self):
        """Stills of the same codes, encoded by the command line."""
        for k, picture in enumerate(self.pictures[:6]):
            (self.folder / f"{k}.ppm").write_bytes(b"P6\n80 45\n255\n" + picture.tobytes())
        self.run_program("-q", "-f", str(support.RATE), self.path("%d.ppm"), "stills.tik")
        stills = nutik.open(self.path("stills.tik"))
        array = nutik.encode(self.pictures[:6], rate=support.RATE)
        self.assert_same(array.times_ns, stills.times_ns)
        for k in range(6):
            ours, theirs = (each.render(start=f"{k}f", exposure="1f", dtype=np.float64) for each in (array, stills))
            self.assert_same(ours.array, theirs.array)

    def test_what_is_told_of_a_picture(self):
        picture = self.capture.render(self.functions, self.tags)
        self.assertEqual([each["tag"] for each in picture.plan["functions"]], [0, 128, 255])
        self.assertEqual([each["pixels"] for each in picture.plan["functions"]],
                         [int(np.sum(self.tags == tag)) for tag in (0, 128, 255)])
        self.assertEqual(picture.plan["functions"][0]["support_ns"], 72_000_000 + 1)
        self.assertEqual(picture.plan["samples"], 70)
        self.assertIsNone(picture.saturated)
        reference = nutik.open(self.path("clip.tik"), renderer="reference").render(self.functions, self.tags,
                                                                                  dtype=np.float64)
        self.assertIsNone(reference.error_bound)
        for precision in ("single", "double", "fixed"):
            ours = self.capture.render(self.functions, self.tags, dtype=np.float64, precision=precision)
            worst = np.max(np.abs(ours.array - reference.array))
            self.assertGreater(ours.error_bound, 0)
            self.assertLessEqual(worst, ours.error_bound, precision)
        self.assertIsNone(ours.bounds)
        mapped = self.capture.render(self.functions, self.tags, dtype=np.float64, precision="fixed", bounds=True)
        self.assertEqual(list(mapped.bounds), ["all_bounds", "arithmetic", "times"])
        arithmetic = mapped.bounds["arithmetic"]
        self.assertEqual((arithmetic.shape, arithmetic.dtype), (self.tags.shape, np.float32))
        self.assertEqual(arithmetic.max(), np.nextafter(np.float32(mapped.error_bound), np.float32(1)))
        off = np.abs(mapped.array - reference.array).reshape(*self.tags.shape, -1).max(axis=2)
        self.assertTrue((off <= arithmetic).all())
        np.testing.assert_allclose(mapped.bounds["all_bounds"], arithmetic + mapped.bounds["times"], rtol=1e-6)
        part = self.capture.render(self.functions, self.tags, dtype=np.float64, precision="fixed", bounds=True,
                                   region=(3, 2, 9, 5))
        for term, each in pickle.loads(pickle.dumps(part)).bounds.items():
            np.testing.assert_array_equal(each, part.bounds[term])
            np.testing.assert_array_equal(each, mapped.bounds[term][2:7, 3:12])
        self.assertRaises(ValueError, lambda: mapped.__array__(np.float32, copy=False))
        tiny = self.capture.render(nutik.boxcar(0, 0.05, 1e-300), dtype=np.float64, bounds=True)
        self.assertGreater(tiny.bounds["arithmetic"].max(), 0)
        terms = {each["term"]: each for each in ours.uncertainty["terms"]}
        self.assertEqual(terms["arithmetic"]["light"], ours.error_bound)
        self.assertEqual(terms["times"]["is"], "bound")
        self.assertNotIn("rounding", terms)  # of 64 bits
        self.assertAlmostEqual(ours.uncertainty["bounds"]["light"], sum(each["light"] for each in terms.values()), 15)
        self.assertGreater(ours.uncertainty["scale"], 0)
        codes = self.capture.render({0: [(0, 3.0), (0.06, 3.0), (0.06, 0)]}, codes=True)
        light = self.capture.render({0: [(0, 3.0), (0.06, 3.0), (0.06, 0)]})
        self.assertEqual(codes.saturated[0], 0)
        self.assertGreater(codes.saturated[1], 0)
        self.assertLessEqual(codes.saturated[1], np.sum(np.any(light.array > 0.99, axis=2)))

    def test_a_function_without_a_mask_may_have_any_tag(self):
        function = nutik.boxcar(0, "10ms")
        wanted = self.capture.render(function)
        self.assert_same(self.capture.render({128: function}).array, wanted.array)
        self.assert_same(self.capture.render([(0, 0), (0, 1), ("10ms", 1), (0.01, 0)]).array, wanted.array)

    def test_files(self):
        picture = self.capture.render(start=0, exposure="10ms", codes=True)
        picture.write(self.path("ours.ppm"))
        self.assert_same(support.read_netpbm(self.path("ours.ppm")), picture.array)
        self.assert_raises(nutik.UsageError, "light comes without codes=True", picture.write, self.path("codes.pfm"))
        deep = self.capture.render(start=0, exposure="10ms", codes=True, dtype=np.uint16)
        self.assert_raises(nutik.UsageError, "those of dtype=np.uint8", deep.write, self.path("codes.jpg"))
        self.assert_raises(nutik.UsageError, "grey pictures only", picture.write, self.path("codes.pgm"))
        for wrong in (-5, 0, 101, 2 ** 31, 5.5):
            self.assert_raises(nutik.UsageError, f"quality '{wrong}'", picture.write, self.path("q.jpg"), quality=wrong)
        with self.assertRaisesRegex(TypeError, "keep_pixels= is 'no'"):
            picture.write(self.path("q.jpg"), keep_pixels="no")
        deep = self.capture.render(start=0, exposure="10ms", dtype=np.float64)
        self.assert_raises(nutik.UsageError, "float32", deep.write, self.path("light.exr"))
        self.assert_raises(nutik.UsageError, "kind='.png'", lambda: deep.write(self.path("light.tif"), kind=".png"))
        deep.write(self.path("light.tif"))
        self.assert_same(nutik.open(self.path("light.tif"), rate=1, white=1.0)[0],
                         (deep.array * 65535 + 0.5).clip(0, 65535).astype(np.uint16))
        self.assert_raises(nutik.OutputError, "absent", picture.write, self.path("absent/ours.ppm"))
        wide = nutik.encode(self.pictures[:4], rate=support.RATE, pixel_aspect="2:1").render(exposure="1f", codes=True)
        for name, keep, width in (("eyes.png", False, 160), ("kept.png", True, 80)):
            wide.write(self.path(name), keep_pixels=keep)
            size = (self.folder / name).read_bytes()[16:24]
            self.assertEqual(size, width.to_bytes(4, "big") + (45).to_bytes(4, "big"))

    def test_what_makes_no_sense(self):
        render, usage = self.capture.render, nutik.UsageError
        self.assert_raises(usage, "functions=", render)
        self.assert_raises(usage, "functions=", render, mask=self.tags, exposure=1)
        self.assert_raises(usage, "shutter_error= says nothing without shutter=", render, exposure=1, shutter_error=0.1)
        self.assert_raises(usage, "unmapped= says nothing without mask=", render, exposure=1, unmapped="zero")
        self.assert_raises(usage, "by lies further away than 126 years", nutik.boxcar(0, 1).shifted, 4.2e9)
        for call in (nutik.open, nutik.read_mask, nutik.read_functions, render(exposure="1f").write):
            self.assert_raises(nutik.WrongType, "3 is no path", call, 3)
        self.assert_raises(usage, ["exposure=", "functions="], render, [(0, 1)], exposure=1)
        self.assert_raises(usage, "3 functions; mask=", render, self.functions)
        self.assert_raises(usage, "float32 or float64", render, exposure="1ms", dtype=np.uint8)
        self.assert_raises(usage, "codes are uint8", render, exposure="1ms", codes=True, dtype=np.float32)
        self.assert_raises(usage, "negative=", render, exposure="1ms", negative="offset")
        self.assert_raises(usage, "transfer=", render, exposure="1ms", transfer="srgb")
        self.assert_raises(usage, "single, compensated", render, exposure="1ms", precision="halves")
        self.assert_raises(usage, "0.4s, 10ms", render, exposure="10 parsecs")
        self.assert_raises(usage, "rectangle", render, exposure="1ms", region=(70, 0, 20, 20))
        self.assert_raises(usage, "0 ... 255", render, {300: [(0, 1)]}, self.tags)
        self.assert_raises(nutik.InputError, ["80 x 45", "4 x 3"], render, {0: [(0, 1)]}, np.zeros((3, 4), np.uint8))
        found = self.assert_raises(nutik.InputError, ["128, 255; give each one", "unmapped='zero'"], render,
                                   {0: [(0, 1)]}, self.tags)
        self.assertEqual(found.settings, ("unmapped='zero'",))
        self.assert_raises(nutik.InputError, "more than all", nutik.Mask.of_layers,
                           {1: np.ones((2, 2)), 2: np.ones((2, 2))})
        self.assert_raises(usage, "0 ... 255", nutik.Mask, np.full((2, 2), 256))
        self.assert_raises(usage, "and this array has dtype <U8;", nutik.Mask, "mask.png")
        self.assert_raises(usage, "outside 0 ... 1", nutik.Mask.of_layers, {1: np.full((2, 2), 1.5)})

    def test_integers_of_16_bits_are_tags(self):
        labels = np.arange(256, dtype=np.uint16).reshape(16, 16)
        np.save(self.path("labels.npy"), labels)
        self.assert_same(nutik.read_mask(self.path("labels.npy")).tags, nutik.Mask(labels).tags)
        np.save(self.path("labels.npy"), labels + 257)
        self.assert_raises(nutik.InputError, "pixel 0,0 has the value 257", nutik.read_mask, self.path("labels.npy"))

    def test_arguments_of_wrong_types(self):
        pictures, wrong = np.zeros((2, 2, 2), np.uint8), nutik.WrongType
        self.assert_raises(wrong, "times is 0.1; give a list", nutik.Function, 0.1, 1)
        self.assert_raises(wrong, "gains has dtype object", nutik.Function, [0], [10 ** 400])
        self.assert_raises(wrong, "feather [2] is no number", nutik.Mask(self.tags).feathered, [2])
        self.assert_raises(wrong, "codec is 3, no text", nutik.encode, pictures, rate=1, codec=3)
        self.assert_raises(wrong, "name is 3, no text", nutik.encode, pictures, rate=1, name=3)
        self.assert_raises(wrong, "a wish is 3", self.capture.solve, "M0 [0:g], [1:0]", [3], free={"g": (0, 1)})
        self.assert_raises(wrong, "shape is 3", nutik.shutter, 3, 0, 1)
        self.assert_raises(wrong, "text is 3", nutik.parse_functions, 3)
        self.assert_raises(wrong, "factor has dtype", nutik.boxcar(0, 1).scaled, "x")
        self.assert_raises(wrong, "bounds is 'x'", self.capture.render, exposure=1, bounds="x")
        self.assert_raises(wrong, "bounds is 'x'", self.capture.render_many, exposures=[1], bounds="x")
        self.assert_raises(wrong, "count_redrawn is 'x'", self.capture.activity, count_redrawn="x")
        self.assert_raises(wrong, "shutter is <nutik.Capture", self.capture.render, exposure=1, shutter=self.capture)

    def test_messages_name_what_helps(self):
        render, many, usage = self.capture.render, self.capture.render_many, nutik.UsageError
        light, box = render(exposure="5ms"), nutik.boxcar(0, "5ms")
        for name in ("light.png", "light.jpg", "light.ppm"):
            self.assert_raises(usage, [name, "codes=True"], light.write, self.path(name))
            self.assert_raises(usage, [name, "codes=True"], render(exposure="5ms", dtype=np.float64).write,
                               self.path(name))
        self.assert_raises(usage, ["2 functions", "{tag: function}", "with mask= say which"], render, [box, box],
                           mask=self.tags)
        self.assert_raises(usage, ["2 functions", "render_many()"], render, [box, box])
        self.assert_raises(usage, ["{tag: function} for each", "takes a list"], many, {0: box, 128: box, 255: box},
                           mask=self.tags)
        for wrong in (box, np.sin, "gains.fn", np.ones(70)):
            self.assert_raises(usage, "render_many() takes a list", many, wrong)
        said = self.assert_raises(usage, ["500 in all", "no function"], render, [1.0] * 500)
        self.assertLess(len(str(said)), 250)

    def test_error_bound_of_combined_pictures(self):
        for how in ("lighten", "darken", "median"):
            picture = self.capture.render(exposure="10ms", combine=how)
            self.assertIsNone(picture.error_bound)
            self.assertIn("light", picture.uncertainty["bounds"])
        self.assertIn("'lighten', 'darken'", nutik.Picture.error_bound.__doc__)

    def test_only_negative_still_gains_are_warned_of(self):
        """Of a positive one light may be below 0, too, where something moves: that is counted."""
        moving = [(0, -1), (0.03, -1), (0.03, 1.2), (0.07, 1.2), (0.07, 0)]
        with warnings.catch_warnings():
            warnings.simplefilter("error", nutik.NutikWarning)
            picture = self.capture.render(moving, codes=True)
            many = self.capture.render_many([moving], codes=True)
        self.assertGreater(picture.saturated[0], 0)
        self.assertEqual(tuple(many.saturated[0]), picture.saturated)
        with self.assertWarnsRegex(nutik.NutikWarning, "M0: the still gain is -1"):
            self.capture.render_many([moving, [(0, -1), (0.05, -1), (0.05, 0)]], codes=True)

    def test_black_is_warned_of(self):
        with self.assertWarnsRegex(nutik.NutikWarning, "still gain is -1: .* negative='offset'") as warned:
            self.capture.render([(0, -1), (0.05, -1), (0.05, 0)], codes=True)
        self.assertEqual(warned.filename, __file__)

    def test_strict(self):
        for precision, gain in ((None, 1e14), ("single", 1e6)):
            wild = [(0, gain), (0.01, -gain), (0.02, gain), (0.03, 0)]
            asked = dict(codes=True, dtype=np.uint16, precision=precision)
            with self.subTest(precision=precision), warnings.catch_warnings():
                warnings.simplefilter("ignore")
                self.capture.render(wild, **asked)
                for call, functions in ((self.capture.render, wild), (self.capture.render_many, [wild] * 2)):
                    raised = self.assert_raises(nutik.ImpreciseError, "0.5 of a code", call, functions, strict=True,
                                                **asked)
                    self.assertIsInstance(raised, ArithmeticError)

    def test_a_stated_arithmetic_is_doubted(self):
        wild = [(0, 1e6), (0.01, -1e6), (0.02, 1e6), (0.03, 0)]
        for call, functions in ((self.capture.render, wild), (self.capture.render_many, [wild])):
            with self.assertWarnsRegex(nutik.NutikWarning, "single is not sure to be right to 0.5 of a code") as warned:
                call(functions, codes=True, dtype=np.uint16, precision="single")
            self.assertEqual(warned.filename, __file__)

    def test_many_know_their_uncertainty(self):
        starts = [0, "10ms", 0.03]
        for capture in (self.capture, nutik.encode(self.pictures[:, :9, :9], rate=support.RATE, tolerance=3)):
            for asked in (dict(), dict(codes=True), dict(precision="double", dtype=np.float64), dict(combine="mean")):
                many = capture.render_many(starts=starts, exposures="5ms", **asked)
                self.assertEqual(len(many.uncertainty), 3)
                for start, alone, told in zip(starts, many.uncertainty, copy.deepcopy(many).uncertainty):
                    self.assertEqual(alone, told)
                    picture = capture.render(start=start, exposure="5ms", **{"precision": "double", **asked})
                    self.assertEqual([each["term"] for each in alone["terms"]],
                                     [each["term"] for each in picture.uncertainty["terms"]])
                    if capture is not self.capture or "dtype" in asked:
                        self.assertEqual(alone, picture.uncertainty)

    def test_many_in_one_call(self):
        starts, lengths = np.linspace(0, 0.05, 30), np.linspace(1e-3, 2e-2, 30)
        functions = [nutik.boxcar(start, length) * (1 + start) for start, length in zip(starts, lengths)]
        grey = nutik.encode(support.moving_box(channels=1), rate=support.RATE)
        small = nutik.encode(self.pictures[:, :16, :16], rate=support.RATE)
        for capture in (small, grey, self.capture, nutik.open(self.path("clip.tik"), renderer="reference")):
            for asked in (dict(starts=starts, exposures=lengths), dict(starts=starts, exposures="5ms", shutter="hann"),
                          dict(starts="1/960s", exposures=list(lengths)), dict(functions=functions)):
                for output in (dict(), dict(dtype=np.float64), dict(codes=True),
                               dict(region=(3, 2, 9, 5), precision="double")):
                    many = capture.render_many(**asked, **output)
                    self.assertEqual(len(many), 30)
                    self.assertFalse(many.array.flags.writeable)
                    for k in (0, 7, 29):
                        alone = {name[:-1] if name in ("starts", "exposures") else name:
                                 value[k] if name != "shutter" and not isinstance(value, str) else value
                                 for name, value in asked.items()}
                        picture = capture.render(**alone, **output)
                        self.assertEqual((many.array[k].shape, many.array.dtype), (picture.shape, picture.dtype))
                        if "codes" in output:
                            self.assertLess(np.mean(many.array[k] != picture.array), 1e-3)
                        elif picture.error_bound is None:
                            self.assert_same(many.array[k], picture.array)
                            self.assertTrue(np.isnan(many.error_bounds[k]))
                        else:
                            error = np.abs(many.array[k].astype(np.float64) - picture.array).max()
                            self.assertLessEqual(error, many.error_bounds[k] + picture.error_bound)

    def test_many_more_than_one_pass_makes(self):
        capture = nutik.encode(self.pictures[:, :4, :4, 0], rate=support.RATE)
        starts = np.linspace(0, 0.06, 5000)
        many = capture.render_many(starts=starts, exposures="3ms", precision="double", dtype=np.float64)
        for k in (0, 4095, 4096, 4999):
            alone = capture.render(start=starts[k], exposure="3ms", precision="double", dtype=np.float64)
            self.assertLessEqual(np.abs(many.array[k] - alone.array).max(), many.error_bounds[k] + alone.error_bound)

    def test_many_through_a_mask(self):
        many = self.capture.render_many([self.functions, self.functions], self.tags, feather=2)
        self.assert_same(many.array[1], self.capture.render(self.functions, self.tags, feather=2).array)

    def test_many_warn_as_one_does(self):
        both = [nutik.boxcar(0, 0.05, -1), nutik.boxcar(0, 0.05)]
        for capture in (self.capture, nutik.encode(self.pictures[:, :16, :16], rate=support.RATE)):
            for named in (dict(gain=3.0), dict(negative="abs"), dict(precision="double")):
                with warnings.catch_warnings(record=True) as alone:
                    warnings.simplefilter("always")
                    pictures = [capture.render(each, codes=True, **named) for each in both]
                with warnings.catch_warnings(record=True) as together:
                    warnings.simplefilter("always")
                    many = capture.render_many(both, codes=True, **named)
                self.assertEqual({str(each.message) for each in together}, {str(each.message) for each in alone})
                self.assertEqual(bool(alone), "negative" not in named)
                self.assertEqual(many.saturated.tolist(), [list(each.saturated) for each in pictures])
        self.assertIsNone(self.capture.render_many(both).saturated)

    def test_many_name_the_pictures_that_they_warn_of(self):
        for capture in (self.capture, nutik.encode(self.pictures[:, :16, :16], rate=support.RATE)):
            for late, said in (([3], "picture 3: M0"), ([2, 5, 7], "picture 2 and 2 more: M0"), (range(9), "M0")):
                with self.assertWarnsRegex(nutik.NutikWarning, f"^{said}: .*after the capture's end"):
                    capture.render_many([nutik.boxcar(0, 9 if k in late else 0.01) for k in range(9)])

    def test_many_tell(self):
        capture, told = nutik.encode(self.pictures[:, :16, :16, 0], rate=support.RATE), []
        capture.render_many(starts=np.linspace(0, 0.05, 400), exposures=0.01,
                            progress=lambda *each: told.append(each))
        self.assertEqual(told[-1], (400, 400))

    def test_many_that_make_no_sense(self):
        many, usage = self.capture.render_many, nutik.UsageError
        self.assert_raises(usage, "2 starts, 3 exposures", many, starts=[0, 1], exposures=[1, 2, 3])
        self.assert_raises(usage, "0 functions", many, [])
        self.assert_raises(usage, "needs a plain interval", many)
        self.assert_raises(usage, "starts[1]", many, starts=[0, float("nan")], exposures=1)
        self.assert_raises(usage, "rectangle", many, starts=[0, 0], exposures="1ms", region=(70, 0, 20, 20))


if __name__ == "__main__":
    unittest.main()
