"""Gain functions: points, jumps, shutters, fits."""

import datetime
import math
import unittest
from fractions import Fraction

import nutik
import numpy as np

import support


class Functions(support.TestCase):
    def test_points(self):
        function = nutik.Function([0, "10ms", 0.01, 0.5], [0, 1, -2.5, 0])
        self.assertEqual(function.times_ns.tolist(), [0, 10_000_000, 10_000_000, 500_000_000])
        self.assertEqual(function.gains.tolist(), [0, 1, -2.5, 0])
        np.testing.assert_allclose(function([-1, 0.005, 0.0099999, 0.01, 0.255, 0.5, 9]),
                                   [0, 0.5, 0.99999, -2.5, -1.25, 0, 0], atol=1e-12)
        self.assertEqual(function(0.01), -2.5)
        self.assertEqual((nutik.Function([0, 1], [0, 49]) / 49).gains[1], 1)
        self.assertLess(abs(nutik.Function([0, 1], [-1.7e308, 1.7e308])(0.5)), 1e294)
        self.assertRaises(ZeroDivisionError, lambda: function / 0)
        for double in (function.scaled(2), function * np.array(2.0), np.array(2) * function):
            self.assertEqual(double.gains.tolist(), [0, 2, -5, 0])
        self.assertEqual(function.shifted("1ms").times_ns.tolist(), [1_000_000, 11_000_000, 11_000_000, 501_000_000])
        self.assertEqual(function, nutik.Function.from_ns(function.times_ns, function.gains))
        self.assertNotEqual(function, function.scaled(2))
        self.assertEqual(hash(function), hash(nutik.Function.from_ns(function.times_ns, function.gains)))
        self.assertEqual(nutik.boxcar("1/3s", "1/3s").times_ns.tolist(), [333333333, 333333333, 666666667, 666666667])

    def test_a_jump_at_a_float_has_its_later_side(self):
        rng = np.random.default_rng(5)
        for times in (np.concatenate([[8.118e-06, 1.7e9 + 0.1], rng.integers(1, 10 ** 13, 500) / 1e9]),
                      np.float32([0.7, 0.1, 12.3]), np.float16([0.7])):
            for time in times:
                jump, earlier = nutik.Function([time, time], [0, 1]), float(str(time)) * (1 - 1e-12) - 1e-9
                self.assertEqual((jump(time), jump(np.array([time]))[0], jump(earlier)), (1, 1, 0), time)
        self.assertEqual(jump(np.array([-np.inf, np.inf])).tolist(), [0, 1])

    def test_sums_and_multiples(self):
        rng = np.random.default_rng(8)
        for _ in range(300):
            drawn = []
            for _ in range(2):
                times = np.sort(rng.integers(0, 12, rng.integers(1, 7)))
                times = times[np.concatenate([[True, True], times[2:] != times[:-2]])[:len(times)]]  # two at a jump
                drawn.append(nutik.Function.from_ns(times * 1000, rng.integers(-4, 5, len(times))))
            a, b = drawn
            at = np.arange(-500, 12_500) / 1e9 + 0.25e-9
            np.testing.assert_allclose((a + b)(at), a(at) + b(at), atol=1e-9)
            np.testing.assert_allclose((2 * a - b / 4)(at), 2 * a(at) - b(at) / 4, atol=1e-9)
            self.assertEqual(np.float64(3) * a, a.scaled(3))
            self.assertEqual(-a, a.scaled(-1))
        jump = nutik.boxcar(0, 1) + nutik.boxcar(1, 1)
        self.assertEqual(jump, nutik.Function([0, 0, 2, 2], [0, 1, 1, 0]) + nutik.Function([1], [0]))
        self.assertEqual(jump.times.tolist(), [0, 0, 1, 2, 2])
        self.assertEqual(sum([jump, jump]), 2 * jump)
        zeros = nutik.Function([0, 1], [0, -1])
        self.assertEqual((zeros, hash(zeros)),
                         (nutik.Function([0, 1], [0, 1]) * -1, hash(nutik.Function([0, 1], [0, 1]) * -1)))
        for wrong in (lambda: jump + 1, lambda: jump * jump, lambda: jump - 1, lambda: "2" * jump):
            self.assertRaises(TypeError, wrong)

    def test_times_of_every_kind(self):
        box = nutik.boxcar(0, 0.1)
        for time in (0.01, "10ms", np.timedelta64(10, "ms"), datetime.timedelta(milliseconds=10), np.array(0.01)):
            self.assertEqual((box(time), type(box(time))), (1, float))
        times = np.array([[10, 99], [100, 10 ** 9]], "timedelta64[ms]")
        self.assertEqual(box(times).tolist(), [[1, 1], [0, 0]])
        self.assertEqual(box(np.array([datetime.timedelta(seconds=1)])).tolist(), [0])
        for wrong in (None, True, 1j, np.ones(2, bool)):
            self.assert_raises(nutik.WrongType, "no number", box, wrong)
        self.assert_raises(nutik.UsageError, "NaT", box, np.array(["NaT"], "timedelta64[ns]"))

    def test_gains_are_real_numbers(self):
        capture = nutik.encode(np.zeros((2, 8, 8), np.uint8), rate=1)
        for call in (lambda gains: nutik.Function([0, 1], gains), lambda gains: nutik.Function.from_ns([0, 1], gains),
                     capture.render, lambda gains: nutik.fit(lambda t: gains[0] * t, 0, 1),
                     lambda gains: capture.render_many([gains])):
            for wrong in (np.array([1j, 0]), np.array([1, 2], "timedelta64[ms]")):
                self.assert_raises(nutik.WrongType, f"dtype {wrong.dtype}", call, wrong)
        self.assertEqual(nutik.Function([0, 1], [Fraction(1, 2), 1]).gains.tolist(), [0.5, 1])

    def test_points_that_are_none(self):
        make, usage = nutik.Function, nutik.UsageError
        self.assert_raises(usage, ["control point 1", "not after"], make, [1, 0], [0, 0])
        self.assert_raises(usage, "a jump has two", make, [1, 1, 1], [0, 1, 2])
        self.assert_raises(usage, "control point 1: gain", make, [0, 1], [0, math.inf])
        self.assert_raises(usage, "126 years", make, [0, 5e9], [0, 1])
        self.assert_raises(usage, "one control point", make, [], [])
        self.assert_raises(usage, "as many times as gains", make, [0, 1], [0])
        self.assert_raises(usage, "int64", nutik.Function.from_ns, [0.5], [1])
        self.assert_raises(usage, "126 years", nutik.Function.from_ns, np.array([2 ** 64 - 1000, 0], np.uint64), [1, 0])
        self.assert_raises(usage, "functions is 7, no function",
                           nutik.encode(np.zeros((2, 8, 8), np.uint8), rate=1).render, 7)

    def test_files(self):
        functions = nutik.parse_functions(support.FUNCTIONS)
        nutik.write_functions(self.path("gains.fn"), functions)
        self.assertEqual(nutik.read_functions(self.path("gains.fn")), functions)
        nutik.write_functions(self.path("gains.fn"), functions)
        self.run_program("check", "-k", "gains.fn")
        for wrong, said in (({}, "empty"), ({3: np.ones(5)}, "a list of (time, gain)")):
            told = self.assert_raises(nutik.UsageError, said, nutik.write_functions, self.path("gains.fn"), wrong)
            self.assertNotIn("or an array", str(told))
        self.assertEqual(nutik.Function([0], [1]) / np.float16(3), nutik.Function([0], [1 / 3]))
        for name, said in (("clip.mp4", "are written as .fn"), ("clip.fn", "exists and is no function file")):
            with open(self.path(name), "wb") as film:
                film.write(b"\0\0\0\x20ftypisom")
            self.assert_raises(nutik.UsageError, said, nutik.write_functions, self.path(name), functions)
        self.assert_raises(nutik.InputError, "mine:1:18: time 1000000 is not after 2000000", nutik.parse_functions,
                           "M0 [2000000:1], [1000000:1]", name="mine")
        with self.assertWarnsRegex(nutik.NutikWarning, "functions:1:1: .*capital M"):
            nutik.parse_functions("m0 [0:1]\nM1 [0:1]")

    def test_shutters_are_the_command_lines(self):
        for shape in ("box", "trapezoid:0.25", "triangle", "gaussian", "hann", "strobe:5,0.1", "spline:0=0,0.3=1,1=0"):
            text = self.run_program("shutter", shape, "--start", "0.4s", "--exposure", "10ms", "--shutter-error",
                                    "1e-4")
            ours = nutik.shutter(shape, 0.4, "10ms", error=1e-4)
            self.assertEqual(ours.text(), text.splitlines()[1])
        self.assert_raises(nutik.UsageError, "box, trapezoid:R", nutik.shutter, "round", 0, 1)
        self.assert_raises(nutik.UsageError, "error=", nutik.shutter, "hann", 0, 1, error=0)

    def test_fits_stay_within_their_error(self):
        bumps = {"sine": lambda t: np.sin(9 * t), "sharp": lambda t: np.exp(-((t - 0.31) / 1e-4) ** 2) + 0.01,
                 "jumps": lambda t: np.where(t < 0.7, 1.0, -3.0), "flat": lambda t: 2.0,
                 "of numbers": lambda t: math.exp(-t) if t < 0.7 else 0.25, "steep": lambda t: np.sqrt(t)}
        for name, gain in bumps.items():
            for error in (1e-2, 1e-4):
                with self.subTest(name, error=error):
                    fitted = nutik.fit(gain, 0, 1, error=error)
                    times = np.unique(np.concatenate([np.linspace(0, 1, 54321)[:-1], 0.7 + np.array([-2e-9, 2e-9]),
                                                      0.31 + np.linspace(-1e-3, 1e-3, 999)]))
                    wanted = np.array([float(gain(float(t))) for t in times])
                    off = np.max(np.abs(fitted(times) - wanted)) / np.max(np.abs(wanted))
                    # The fit may use all of the error at what it looked at; between these, a tenth of it is added.
                    self.assertLessEqual(off, 1.1 * error)
                    self.assertEqual(fitted(-1e-9), 0)
                    self.assertEqual(fitted(1.5), 0)
        self.assertLess(len(nutik.fit(bumps["sine"], 0, 1).gains), 60)
        self.assertLess(len(nutik.fit(bumps["jumps"], 0, 1).gains), 8)

    def test_fits_see_what_hides_from_even_samples(self):
        times = np.random.default_rng(3).uniform(0, 1, 20_000)
        for name, gain, error in (
                ("strobe", lambda t: 1.0 * ((t * 100) % 1 < 0.01), 1e-3),
                ("of numbers", lambda t: float((t * 100) % 1 < 0.01), 1e-3),
                ("aliased", lambda t: np.sin(2 * np.pi * 1024 * t) + 0.5, 1e-2),
                ("bump", lambda t: np.exp(-((t - 0.12345) / 2e-5) ** 2), 1e-3),
                ("all bumps", lambda t: 1 + np.cos(2 * np.pi * 4096 * t), 1e-2)):
            with self.subTest(name):
                fitted = nutik.fit(gain, 0, 1, error=error)
                wanted = np.array([gain(t) for t in times])
                far = np.abs(times * 1e9 % 1e5 - 5e4) < 5e4 - 2  # from edges, which are steps of 1 ns
                self.assertLess(np.max(np.abs(fitted(times) - wanted)[far]) / np.max(np.abs(wanted)), 1.1 * error)
        self.assertLess(len(nutik.fit(lambda t: 1.0 * ((t * 100) % 1 < 0.01), 0, 1).gains), 410)
        capture = nutik.encode(np.full((100, 4, 4), 255, np.uint8), rate=100)
        strobe, = capture.trace(0, 0, functions=lambda t: 1.0 * ((t * 100) % 1 < 0.01))
        self.assertAlmostEqual(strobe.sum_ns[-1, 0] / 1e7, 1, delta=1e-4)  # 100 edges of 1 ns

    def test_fits_that_cannot_be(self):
        fit, usage = nutik.fit, nutik.UsageError
        self.assert_raises(usage, "not finite at 0.0 s", fit, lambda t: 1 / t if np.all(t) else np.nan * t, 0, 1)
        self.assert_raises(usage, "0 everywhere", fit, lambda t: 0 * t, 0, 1)
        self.assert_raises(usage, "not after its start", fit, lambda t: t, 1, 1)
        self.assert_raises(usage, "bends in too many places", fit, lambda t: np.sin(1e9 * t), 0, 1)
        self.assert_raises(usage, "one gain for each time", fit, lambda t: np.ones(3), 0, 1)
        self.assert_raises(usage, "error=2", fit, lambda t: t, 0, 1, error=2)
        self.assertRaisesRegex(KeyError, "mine", fit, lambda t: {}["mine"], 0, 1)

    def test_a_callable_is_exposed_over_all_of_the_capture(self):
        capture = nutik.encode(support.moving_box(20), rate=100)
        ours = capture.render(lambda t: 1 + t, dtype=np.float64, precision="double")
        wanted = capture.render(nutik.fit(lambda t: 1 + t, 0, "200ms"), dtype=np.float64, precision="double")
        self.assert_same(ours.array, wanted.array)
        self.assertEqual(ours.plan["functions"][0]["live_ns"], (0, capture.duration_ns))


if __name__ == "__main__":
    unittest.main()
