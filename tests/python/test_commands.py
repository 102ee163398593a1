"""Commands of the program from Python: their arguments are the schema's rows, they answer as to scripts, and errors are
this package's."""

import inspect
import json
import os
import signal
import threading
import time
import unittest

import nutik
import numpy as np
from nutik import _commands, _nutik, _words

import support

NAMES = ("batch", "check", "contact", "noise", "recover", "retime", "validate", "video")


class Commands(support.TestCase):
    def setUp(self):
        super().setUp()
        self.clip = self.path("clip.tik")
        nutik.encode(support.moving_box(), self.clip, rate=support.RATE, codec="none", block_samples=10)

    def test_arguments_are_rows_of_the_schema(self):
        for name in NAMES:
            function = getattr(nutik, name)
            summary, _, rows = _nutik.described(name)
            offered = set(inspect.signature(function).parameters) - {"files", "progress"}
            rest = set(rows) - {each.rstrip("_") for each in offered}
            self.assertLessEqual(rest, {"json", "progress", "quiet", "verbose"}, name)
            self.assertTrue(function.__doc__.startswith(summary.split("--")[0]), name)
            self.assertNotRegex(function.__doc__, "--[a-z]")
            for each in offered:
                self.assertIn(f"\n{each} : ", function.__doc__)

    def test_retime(self):
        told = nutik.retime(self.clip, self.path("slow.tik"), rate=1000 / 3, shutter_angle=180)
        self.assertEqual(told["samples_a_second"], "1000/3")
        self.assertEqual(str(nutik.open(self.path("slow.tik")).rate), "1000/3")
        nutik.retime(self.clip, in_place=True, rate=100)
        self.assertEqual(nutik.open(self.clip).rate, 100)

    def test_recover(self):
        cut = self.folder / "cut.tik"
        cut.write_bytes((self.folder / "clip.tik").read_bytes()[:-40_000])
        told = nutik.recover(cut, self.path("whole.tik"))
        whole = nutik.open(self.path("whole.tik"))
        self.assertEqual(len(whole), told["samples"])
        self.assert_same(whole[:], support.moving_box()[:len(whole)])

    def test_check(self):
        (self.folder / "f.fn").write_text("M0{[0:1], [5:1], [3:0]}\n")
        told = nutik.check(self.clip, functions=self.folder / "f.fn")
        self.assertEqual((told["mistakes"], len(told["findings"])), (1, 1))
        self.assertEqual(nutik.check(self.clip)["mistakes"], 0)

    def test_contact_and_video(self):
        told = nutik.contact(self.clip, self.path("sheet.png"), exposure=0.01, columns=3)
        self.assertEqual(told["columns"], 3)
        self.assertTrue((self.folder / "sheet.png").exists())
        steps = []
        told = nutik.video(self.clip, self.path("film.mp4"), out_fps=240, from_=0, to="0.05s",
                           progress=lambda done, total: steps.append((done, total)))
        self.assertEqual(len(nutik.open(self.path("film.mp4"), rate=24)), told["frames"])
        self.assertTrue(steps and all(0 <= done <= total == 100 for done, total in steps), steps)

    def test_batch(self):
        (self.folder / "list").write_text(f"--start 0s --exposure 10ms {self.path('a.png')}\n"
                                          f"--start 9s --exposure 10ms {self.path('b.png')}\n")
        with self.assertWarnsRegex(nutik.NutikWarning, "list:2"):
            told = nutik.batch(self.folder / "list", self.clip)
        self.assertEqual(told["failed_lines"], [2])
        self.assertTrue((self.folder / "a.png").exists())

    def test_bound_budget_and_map_from_wherever_a_picture_comes(self):
        """The same exposure of codes, by expose, a batch, a film and in Python: one bound, one budget, one map."""
        terms = ["all_bounds", "arithmetic", "rounding", "held_samples", "times"]
        clip = self.path("held.tik")
        nutik.encode(support.moving_box(), clip, rate=support.RATE, tolerance=2)
        (self.folder / "list").write_text(
            f"--start 0f --exposure 40f {self.path('b.png')} --bounds {self.path('b.npy')}\n")
        expose = json.loads(self.run_program("expose", "--json", "--start", "0f", "--exposure", "40f", "--bounds",
                                             "e.npy", clip, "e.png"))
        batch = nutik.batch(self.folder / "list", clip)["pictures"][0]
        film = nutik.video(clip, self.path("film.mkv"), out_fps=24, out_angle=360, bounds=self.path("f%d.npy"))
        picture = nutik.open(clip).render(start="0f", exposure="40f", codes=True, bounds=True)
        for uncertainty in (expose["uncertainty"], batch["uncertainty"], film["uncertainty"], picture.uncertainty):
            self.assertEqual([each["term"] for each in uncertainty["terms"]], terms[1:])
            bound = uncertainty["terms"][0]
            self.assertEqual((bound["is"], bound["codes"] < 0.01, bound["light"] < 1e-5), ("bound", True, True))
            self.assertEqual(uncertainty["terms"], expose["uncertainty"]["terms"])
            self.assertEqual(uncertainty["bounds"], expose["uncertainty"]["bounds"])
        ours = np.stack([picture.bounds[term] for term in terms])
        self.assertEqual(list(picture.bounds), terms)
        for name in ("e.npy", "b.npy", "f0.npy"):
            np.testing.assert_array_equal(np.load(self.folder / name), ours, name)
        most = np.float32(picture.uncertainty["bounds"]["codes"])
        self.assertLessEqual(ours[0].max(), np.nextafter(most, np.float32(np.inf)))  # maps are rounded up

    def test_validate_and_noise(self):
        told = nutik.validate(self.clip, start=0, exposure=0.01, runs=1)
        self.assertTrue(told["is_within_bounds"])
        random = np.random.default_rng(1)
        still = np.clip(np.linspace(20, 230, 64 * 64).reshape(64, 64) + random.normal(0, 3, (96, 64, 64)), 0, 255)
        (self.folder / "still").mkdir()
        for k, picture in enumerate(still.astype(np.uint8)):
            support.write_pgm(self.folder / "still" / f"{k:03}.pgm", picture)
        nutik.noise(self.folder / "still", transfer="linear", output=self.path("camera.noise"))
        self.assertTrue((self.folder / "camera.noise").exists())

    def test_errors(self):
        self.assert_raises(nutik.UsageError, "no argument colour=", nutik.video, self.clip, colour=1)
        self.assert_raises(nutik.UsageError, "columns 'many'", nutik.contact, self.clip, self.path("x.png"),
                           columns="many")
        self.assert_raises(nutik.UsageError, "in_place=", nutik.retime, self.clip)
        self.assert_raises(nutik.FileMissing, "absent.tik", nutik.contact, self.path("absent.tik"), self.path("x.png"))
        self.assert_raises(nutik.OutputError, "absent", nutik.contact, self.clip, self.path("absent/x.png"),
                           exposure=0.01)

    def test_a_flag_that_says_no_is_not_set(self):
        there = self.folder / "there.tik"
        nutik.encode(support.moving_box()[:9], there, rate=1)
        held = there.read_bytes()
        for no in (0, False, np.False_, np.array(False)):
            with self.assertRaisesRegex(nutik.UsageError, "overwrite="):
                nutik.retime(self.clip, there, rate=1, overwrite=no)
            self.assert_raises(nutik.UsageError, "in_place=", nutik.retime, self.clip, rate=1, in_place=no)
        for flag in ("overwrite", "in_place"):
            with self.assertRaisesRegex(TypeError, f"{flag}= is 'no'"):
                nutik.retime(self.clip, there, rate=1, **{flag: "no"})
        self.assertEqual(there.read_bytes(), held)
        stills = self.path("%d.pgm")
        for k in range(3):
            support.write_pgm(stills % k, np.full((4, 4), k, np.uint8))
        (self.folder / "2.pgm").write_bytes((self.folder / "2.pgm").read_bytes()[:-1])
        for name in ("ignore_errors", "as_far_as_it_goes"):
            with self.assertRaisesRegex(nutik.InputError, "2.pgm"):
                nutik.open(stills, rate=1, **{name: np.False_})
            with self.assertRaisesRegex(TypeError, "ignore_errors= is 'no'"):
                nutik.open(stills, rate=1, **{name: "no"})

    def test_messages_state_arguments(self):
        said = _words.in_python
        self.assertEqual(said("an interval (--start 0.4s --exposure 10ms), or --functions"),
                         "an interval (start='0.4s', exposure='10ms'), or functions=")
        self.assertEqual(said("--mask-share says 3; --depth float, --moving clip.tik. --by 3; (--unmapped zero)"),
                         "mask_share= says 3; depth='float', moving='clip.tik'. by='3'; (unmapped='zero')")
        self.assertEqual(said("--polygon needs --tag. 3 or --ev"), "polygon= needs tag=. 3 or ev=")
        told = self.assert_raises(nutik.UsageError, "start='0.4s', exposure='10ms'", nutik.validate, self.clip)
        self.assertNotIn("= 0", str(told))
        nutik.encode(np.zeros((3, 8, 8), np.uint8), self.path("wide.tik"), rate=3, pixel_aspect=2)
        with self.assertWarnsRegex(nutik.NutikNote, "made square.*[(]keep_pixels="):
            nutik.video(self.path("wide.tik"), self.path("wide.mp4"), out_fps=3)

    def test_ctrl_c_ends_it(self):
        """Noise that is made a long film of: tens of seconds."""
        noise = np.random.default_rng(1).integers(0, 256, (128, 384, 512, 3), np.uint8)
        nutik.encode(noise, self.path("noise.tik"), rate=128)
        sent = []

        def interrupt():
            sent.append(time.monotonic())
            os.kill(os.getpid(), signal.SIGINT)

        timer = threading.Timer(2, interrupt)
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            nutik.video(self.path("noise.tik"), self.path("film.mkv"), out_fps=1000, speed=0.1)
        self.assertLess(time.monotonic() - sent[0], 5)
        timer.join()
        self.assertEqual([each.name for each in self.folder.iterdir() if "film" in each.name], [])

    def test_what_it_made_goes_and_nothing_else(self):
        nutik.encode(np.random.default_rng(1).integers(0, 256, (64, 200, 300, 3), np.uint8), self.path("noise.tik"),
                     rate=64)
        film = self.folder / "film.mkv"

        def stop(done, _):
            if done > 2:
                for process in _commands._running:
                    process.send_signal(signal.SIGINT)  # as a terminal does
                time.sleep(0.5)
                if content:
                    film.write_text(content)
                raise ZeroDivisionError

        for content in ("", "somebody else's"):
            with self.assertRaises(ZeroDivisionError):
                nutik.video(self.path("noise.tik"), film, out_fps=1000, speed=0.1, progress=stop)
            self.assertEqual([each.read_text() for each in self.folder.iterdir() if "film" in each.name],
                             [content] if content else [])


if __name__ == "__main__":
    unittest.main()
