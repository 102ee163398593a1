"""What is found in a capture is what the command line finds; a trace adds up to the picture."""

import json
import unittest

import nutik
import numpy as np

import support


def rolling_ball(samples=120, height=120, width=200, seed=1):
    """A disc that rolls over a still scene with little noise."""
    random = np.random.default_rng(seed)
    y, x = np.mgrid[:height, :width]
    scene = (80 + 40 * np.sin(x / 9) * np.cos(y / 7))[..., None] + np.array([0, 10, 20])
    pictures = np.empty((samples, height, width, 3), np.uint8)
    for k in range(samples):
        ball = (x + 20 - 240 * k / samples) ** 2 + (y - 60) ** 2 < 14 ** 2
        light = np.where(ball[..., None], [230, 200, 60], scene)
        pictures[k] = np.clip(light + random.normal(0, 0.6, light.shape), 0, 255).round()
    return pictures


class Finds(support.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.pictures = rolling_ball()

    def setUp(self):
        super().setUp()
        self.capture = nutik.encode(self.pictures, self.path("clip.tik"), rate=960, tolerance=2)

    def test_a_trace_adds_up_to_the_picture(self):
        functions, mask = nutik.parse_functions(support.FUNCTIONS), np.zeros((120, 200), np.uint8)
        mask[40:80, 50:90], mask[40:80, 100:] = 128, 255
        light = nutik.open(self.path("clip.tik"), renderer="reference").render(functions, mask, feather=4,
                                                                              dtype=np.float64).array
        for x, y in ((0, 0), (60, 60), (120, 60), (51, 60)):
            traces = self.capture.trace(x, y, functions=functions, mask=mask, feather=4)
            self.assertAlmostEqual(sum(each.share for each in traces), 1, places=12)
            for trace in traces:
                np.testing.assert_array_equal(trace.times_ns[1:, 0], trace.times_ns[:-1, 1])
                np.testing.assert_allclose(np.cumsum(trace.integral_ns, axis=0), trace.sum_ns, rtol=1e-9, atol=1e-3)
                np.testing.assert_allclose(trace.sum_ns[-1] / trace.support_ns, trace.exposed, rtol=1e-12, atol=1e-15)
                self.assertEqual(trace.light.shape, (len(trace.times_ns), 2, 3))
            exposed = sum(each.share * each.exposed for each in traces)
            np.testing.assert_allclose(exposed, light[y, x], rtol=1e-12, atol=1e-12)
        (region,) = self.capture.trace(tag=128, functions=functions, mask=mask)
        plain = self.capture.render(functions, mask, dtype=np.float64, precision="double").array
        np.testing.assert_allclose(region.exposed, plain[mask == 128].mean(axis=0), atol=1e-9)
        self.assertEqual(region.pixels, 1600)
        for arguments in ({}, {"x": 1}, {"x": 1, "y": 1, "tag": 0}):
            self.assert_raises(nutik.UsageError, "Either a pixel", self.capture.trace, exposure=1, **arguments)
        self.assert_raises(nutik.UsageError, "pixel 200,0", self.capture.trace, 200, 0, exposure="1ms")

    def test_plates(self):
        self.run_program("background", "-q", "clip.tik", "plate.ppm", "--uncertain", "uncertain.pgm")
        plate = self.capture.background(codes=True)
        self.assert_same(plate.picture.array, support.read_netpbm(self.path("plate.ppm")))
        self.assert_same(plate.uncertain, support.read_netpbm(self.path("uncertain.pgm")) == 255)
        scene = self.pictures[0]
        self.assertLessEqual(np.max(np.abs(plate.picture.array[:40].astype(int) - scene[:40])), 8)
        self.assertEqual(self.capture.background().picture.dtype, np.float32)

    def test_activity(self):
        told = json.loads(self.run_program("activity", "--json", "clip.tik"))
        found = self.capture.activity()
        self.assertEqual(found.changed_pixels.tolist(), [each["changed_pixels"] for each in told["samples"]])
        self.assertEqual(found.busiest.samples, (told["busiest"]["first_sample"], told["busiest"]["last_sample"] + 1))
        self.assertEqual(found.quietest.times_ns[0], told["quietest"]["start_ns"])
        self.assertEqual(int(found.changes.sum()), int(found.changed_pixels.sum()))
        mask = np.zeros((120, 200), np.uint8)
        mask[:40] = 9
        self.assertEqual(self.capture.activity(mask).counted_pixels, 8000)
        self.assertEqual(self.capture.activity(mask, tag=0).counted_pixels, 16000)
        self.assert_raises(nutik.InputError, "no pixel with tag 3", self.capture.activity, mask, tag=3)
        self.assert_raises(nutik.UsageError, "mask=", self.capture.activity, tag=3)

    def test_results_compare_by_identity(self):
        made = lambda: (self.capture.activity(), self.capture.background(), self.capture.study(moments=3))  # noqa: E731
        for one, other in zip(made(), made()):
            self.assertTrue(one == one and one != other)
            self.assertEqual(len({one, one, other}), 2)

    def test_a_plate_is_done_at_the_end(self):
        told = []
        self.capture.background(progress=lambda done, total: told.append((done, total)))
        self.assertEqual(told[-1][0], told[-1][1])
        self.assertGreater(told[-1][1], 0)
        self.assertEqual(sorted(done for done, _ in told), [done for done, _ in told])

    def test_studies(self):
        self.run_program("study", "-q", "--moments", "3", "clip.tik", "study.ppm")
        study = self.capture.study(moments=3, codes=True)
        self.assert_same(study.picture.array, support.read_netpbm(self.path("study.ppm")))
        self.assert_same(study.mask.tags, support.read_netpbm(self.path("study.pgm")))
        self.assertEqual({tag: each.text(tag) for tag, each in study.functions.items()},
                         {tag: each.text(tag) for tag, each in nutik.read_functions(self.path("study.fn")).items()})
        self.assertEqual(len(study.moments), 3)
        by_hand = self.capture.render(study.functions, study.mask, feather="2px", normalize="integral", codes=True)
        self.assert_same(by_hand.array, study.picture.array)
        self.run_program("study", "-q", "--by", "9", "--feather", "4px", "clip.tik", "soft.ppm")
        soft = self.capture.study(by=9, feather=4, codes=True)
        self.assert_same(soft.picture.array, support.read_netpbm(self.path("soft.ppm")))
        self.run_program("study", "-q", "--style", "slit", "--moments", "100", "clip.tik", "slit.ppm")
        self.assert_same(self.capture.study("slit", moments=100, codes=True).picture.array,
                         support.read_netpbm(self.path("slit.ppm")))
        clean = self.capture.study("clean", codes=True)
        self.assertIsNone(clean.mask)
        self.assert_same(clean.picture.array, self.capture.background(codes=True).picture.array)
        self.assert_raises(nutik.UsageError, "choose trail, strobe", self.capture.study, "blur")
        for style, moments, told in (("slit", ["0.1s"], "how many there are, not which"),
                                     ("slit", 300, "a study has 2 to 256"),
                                     ("frozen", 5, "shows a single moment"), ("trail", 51, "a study has 1 to 50"),
                                     ("trail", [], "a study has 1 to 50")):
            self.assert_raises(nutik.UsageError, told, self.capture.study, style, moments=moments)
        still = nutik.encode(self.pictures[:1].repeat(30, 0), rate=960)
        with self.assertWarnsRegex(nutik.NutikNote, "nothing moves"):
            scene = still.study(codes=True)
        self.assertEqual((scene.moments, int(scene.mask.tags.max())), ([], 0))
        self.assert_same(scene.picture.array, still.background(codes=True).picture.array)

    def test_solutions(self):
        text = "M0{[0:0], [1:1], [100000000:1], [100000002:rest], [104000000:rest], [104000001:0]}\n"
        (self.folder / "named.fn").write_text(text)
        self.run_program("solve", "-q", "-k", "named.fn", "--normalize", "integral", "--free", "rest=-20..20", "--wish",
                         "all = 0.7 * plate", "clip.tik", "solved.fn")
        with self.assertWarnsRegex(nutik.NutikWarning, "least cost.*rest came to an end of free="):
            solution = self.capture.solve(text, ["all = 0.7 * plate"], free={"rest": (-20, 20)}, normalize="integral")
        self.assertFalse(solution.is_kept)
        self.assertEqual(solution.at_ends, ["rest"])
        self.assertEqual(solution.text, (self.folder / "solved.fn").read_text())
        self.assertEqual(solution.functions[0].gains[3], solution.gains["rest"])
        self.assertEqual(len(solution.wishes), 1)
        timed = "M0 [when:0], [when+1:1], [when+4000000:1], [when+4000001:0]\n"
        solution = self.capture.solve(timed, ["90,50,20,20 >= 0.4"], free={"when": ("0s", 0.1, "1f")})
        self.assertTrue(solution.is_kept)
        self.assertGreater(solution.wishes[0].reached[0], 0.4)
        self.assert_raises(nutik.UsageError, "free['when'] is (0.2, 0.1)", self.capture.solve, timed, ["all = 1"],
                           free={"when": (0.2, 0.1)})
        for ends in (5, (0, None), (None, None)):
            self.assert_raises(nutik.UsageError, f"free['rest'] is {ends!r}", self.capture.solve, text, ["all = 1"],
                               free={"rest": ends})
        self.assert_raises(nutik.UsageError, "free={'when': (0.6, 0.8)}", self.capture.solve, timed, ["all = 1"])
        self.assert_raises(nutik.InputError, "the functions:1", self.capture.solve, "M0 [x", ["all = 1"])
        self.assert_raises(nutik.UsageError, "nothing is wished", self.capture.solve, text, [])


if __name__ == "__main__":
    unittest.main()
