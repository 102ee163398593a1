"""Captures of arrays and iterables: values, times, what is refused."""

import datetime
import functools
import itertools
import os
import subprocess
import sys
import unittest
import unittest.mock
import warnings
from decimal import Decimal
from fractions import Fraction
from pathlib import Path

import nutik
import numpy as np
from nutik import _nutik
from nutik._words import settings_of

import support


def sample(capture, k):
    return capture.render(start=f"{k}f", exposure="1f", codes=True, transfer="source").array


class Arrays(support.TestCase):
    def test_however_they_lie(self):
        base = support.moving_box(12, 33, 50)
        deep = support.moving_box(12, 33, 50, dtype=np.uint16)
        grey = support.moving_box(12, 33, 50, channels=1)
        for name, array in {
            "backwards in time": base[::-1], "mirrored": base[:, :, ::-1], "BGR": base[..., ::-1],
            "every second": base[::2, ::2, ::2], "upside down": base[:, ::-1], "deep and mirrored": deep[:, ::-1, ::-1],
            "one channel": grey[..., None], "a channel of colour": base[..., 1],
            "columns first": grey.transpose(0, 2, 1),
            "Fortran's order": np.asfortranarray(deep), "one picture": base[:1],
        }.items():
            with self.subTest(name):
                capture = nutik.encode(array, rate=100)
                wanted = array[..., 0] if array.shape[-1] == 1 else array
                self.assertEqual(capture.shape, wanted.shape)
                self.assertEqual(capture.dtype, array.dtype)
                for k in {0, len(array) // 2, len(array) - 1}:
                    self.assert_same(sample(capture, k), wanted[k])

    def test_iterables(self):
        pictures = support.moving_box(9, 20, 30)
        for source in (list(pictures), (each for each in pictures), iter(pictures)):
            capture = nutik.encode(source, rate=100)
            self.assertEqual(capture.shape, pictures.shape)
            for k in (0, 8):
                self.assert_same(sample(capture, k), pictures[k])

    def test_light_is_rounded_as_that_of_a_file(self):
        """Floats in memory, from an iterable and in a .npy: the same facts, and the same bounds."""
        light = np.random.default_rng(2).random((5, 6, 7))
        np.save(self.path("light.npy"), light)
        stated = dict(rate=100, white=1.5, transfer="linear")
        file = nutik.open(self.path("light.npy"), **stated)
        terms = file.render(exposure="20ms").uncertainty["terms"]
        self.assertIn("rounded_codes", [each["term"] for each in terms])
        for source in (light, light.astype(">f8"), list(light), iter(light)):
            for output in (None, self.path("light.tik")):
                capture = nutik.encode(source if not hasattr(source, "__next__") else iter(light), output, **stated)
                self.assertIn("light 1.5 is white, to the nearest of 65535 steps, as stated", capture.facts)
                self.assertEqual(sorted(capture.facts[-3:]), sorted(file.facts[-3:]))
                self.assertEqual(capture.render(exposure="20ms").uncertainty["terms"], terms)
        for transfer in ("srgb", "pq"):  # codes of that curve hold the same light
            held = [nutik.encode(source, rate=100, white=1.5, transfer=transfer).render(exposure="20ms", dtype="float64")
                    for source in (light, self.path("light.npy"))]
            self.assert_same(held[0].array, held[1].array)
            self.assertLess(np.abs(held[0].array - light[:2].mean(0) / 1.5).max(), 1e-4)
        clipped = np.full((2, 6, 7), 0.1, np.float32)  # which is above 0.1
        np.save(self.path("clipped.npy"), clipped)
        for source in (clipped, self.path("clipped.npy")):
            self.assertEqual(np.asarray(nutik.encode(source, rate=1, white=0.1)).min(), 65535)
        self.assert_raises(nutik.InputError, "state a larger white", nutik.encode, clipped * 1.01, rate=1, white=0.1)
        codes = nutik.encode(np.zeros((2, 8, 8), np.uint16), rate=1).render(exposure=1)
        self.assertNotIn("rounded_codes", [each["term"] for each in codes.uncertainty["terms"]])

    def test_integers_in_files_are_to_be_codes(self):
        for dtype, advice in ((">u2", "astype('uint16')"), ("<i8", ".clip(0, 65535).astype('uint16')"),
                              (">f4", "astype('float32')")):
            np.save(self.path("wrong.npy"), np.zeros((2, 8, 8), dtype))
            self.assert_raises(nutik.InputError, advice, nutik.open, self.path("wrong.npy"), rate=1, white=1.0)

    def test_white_that_nobody_states(self):
        codes = np.arange(4096, dtype=np.uint16).reshape(4, 32, 32)
        for source in (codes, iter(codes)):
            with self.assertWarnsRegex(nutik.NutikNote, "no code is above 4095, .* 65535; .* white=4095"):
                capture = nutik.encode(source, self.path("dark.tik"), rate=1)
            self.assertIn("white 65535, assumed", capture.facts)
            self.assertTrue(any("4095" in note for note in capture.notes))
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            self.assertIn("white 4095, as stated", nutik.encode(codes, rate=1, white=4095).facts)
            self.assertEqual(nutik.encode(codes, rate=1, white=65535).figures["white"], 65535)
            for quiet in (codes * 16, codes * 0, (codes >> 4).astype(np.uint8)):
                nutik.encode(quiet, rate=1)
            nutik.encode(codes / 65535, rate=1, white=1.0)

    def test_one_picture_in_colour(self):
        for picture in (np.zeros((6, 8, 3), np.uint8), np.zeros((6, 8, 1), np.uint8)):
            with self.assertWarnsRegex(nutik.NutikNote, r"6 grey samples, [13] wide; .* array\[None\]"):
                nutik.encode(picture, rate=1)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            self.assertEqual(nutik.encode(picture[None], rate=1).shape, (1, 6, 8))

    def test_arguments_without_axes(self):
        capture = nutik.encode(np.full((2, 8, 8), 255, np.uint8), rate=np.array(2), white=np.array(255),
                               exposures=np.array(0.25))
        self.assertEqual((capture.rate, capture.times_ns[0].tolist()), (2, [0, 250_000_000]))
        self.assertEqual(capture.render(start=np.array(0), exposure=np.array(1), gain=np.array(2)).array[0, 0], 2)
        self.assertEqual(nutik.encode(np.ones((2, 8, 8)), rate=1, white=np.array(1.0))[0][0, 0], 65535)

    def test_codes_are_picked_as_numpy_picks_them(self):
        each, colour = np.s_[::-2], support.moving_box(12, 20, 24)
        for array in (colour, colour[..., 0].copy()):
            capture = nutik.encode(array, rate=1, white=np.float32(255.0))
            rest = (slice(None),) * (array.ndim - 1)
            for key in (3, -1, np.int64(2), np.s_[2:5], each, np.s_[20:30], (), ..., None, np.s_[5:1:-2, ::2, 1],
                        np.s_[3, ..., 0], np.s_[2:4, None, ...], np.s_[None, None, 3], np.s_[..., None],
                        (..., 2, *rest), (..., each, *rest), (3, *rest, ...), (None, ..., each, *rest[1:], 0), np.s_[..., 2:5, :]):
                with self.subTest(key=key):
                    self.assert_same(capture[key], array[key])
            for key in (12, (3, 99), (0, *rest, 0), (..., 0, *rest, 0)):
                with self.subTest(key=key), self.assertRaises(IndexError):
                    capture[key]

    def test_records_that_take_too_much(self):
        """Their limit is `memory`, whatever that is: 4 GiB were the most once."""
        noise = np.random.default_rng(5).integers(0, 256, (60, 200, 300), np.uint8)
        nutik.encode(noise, self.path("noise.tik"), rate=100)
        with nutik.open(self.path("noise.tik"), memory="80MB") as capture:
            self.assert_raises(nutik.MemoryTooLittle, ["60000 pixels over 60 samples", "region=", "first="],
                               capture.records)
            held = capture.records((0, 0, 300, 20))
        self.assertEqual(len(held), 300 * 20 + np.count_nonzero(np.diff(noise[:, :20], axis=0)))
        with nutik.open(self.path("noise.tik"), memory="200MB") as capture:
            held = capture.records()
        self.assertGreater(held.nbytes, 80e6)
        self.assertEqual(len(held), noise[0].size + np.count_nonzero(np.diff(noise, axis=0)))
        self.assertIn("MemoryTooLittle", nutik.Capture.records.__doc__)

    def test_numbers_of_numpy(self):
        codes = np.zeros((4, 8, 8), np.uint8)
        for rate in (np.float32(12.5), np.float64(12.5)):
            self.assertEqual(nutik.encode(codes, rate=rate).rate, Fraction(25, 2))
        self.assertEqual(nutik.encode(codes, rate=np.int64(12)).rate, 12)
        np.save(self.path("light.npy"), np.full((2, 8, 8), 0.5))
        for white in (1.0, np.float32(1)):
            self.assertEqual(nutik.open(self.path("light.npy"), rate=1, white=white)[0][0, 0], 32768)

    def test_an_iterable_that_fails(self):
        def broken():
            yield np.zeros((8, 8), np.uint8)
            raise OSError("the camera is gone")

        with self.assertRaisesRegex(OSError, "^the camera is gone$"):
            nutik.encode(broken(), self.path("broken.tik"), rate=10)
        unlike = [np.zeros((8, 8), np.uint8), np.zeros((8, 9), np.uint8)]
        self.assert_raises(nutik.InputError, ["picture 1", "(8, 9)"], nutik.encode, unlike, self.path("u.tik"), rate=10)
        unlike[1] = np.zeros((8, 8), np.uint16)
        self.assert_raises(nutik.InputError, ["picture 1", "uint16"], nutik.encode, unlike, self.path("u.tik"), rate=10)
        self.assertEqual(list(self.folder.iterdir()), [], "it left a file behind")

    def test_what_codes_stand_for(self):
        codes = np.arange(0, 250, 10, dtype=np.uint8).reshape(1, 5, 5)
        fractions = codes[0] / 250
        wanted = {"linear": fractions, "gamma:2": fractions ** 2,
                  "srgb": np.where(fractions <= 0.04045, fractions / 12.92, ((fractions + 0.055) / 1.055) ** 2.4)}
        for transfer, light in wanted.items():
            capture = nutik.encode(codes, rate=1, transfer=transfer, white=250)
            exposed = capture.render(start=0, exposure=1, dtype=np.float64).array
            np.testing.assert_allclose(exposed, light, atol=1e-12)
        self.assert_raises(nutik.InputError, ["picture 0", "240", "100", "white="], nutik.encode, codes, rate=1,
                           white=100)

    def test_noise_is_left_out(self):
        pictures = np.full((40, 32, 32), 100, np.uint8)
        pictures += np.random.default_rng(1).integers(0, 3, pictures.shape, np.uint8)
        lossless, held = (nutik.encode(pictures, rate=1, tolerance=each).figures for each in (0, 2))
        self.assertEqual(held["tolerance"], 2)
        self.assertEqual([held[name] for name in ("rate", "shutter_angle", "pixel_aspect")], [1, 360, 1])
        self.assertLess(held["records"], lossless["records"] / 10)

    def test_refused(self):
        pictures = np.zeros((4, 8, 8), np.uint8)
        encode, usage = nutik.encode, nutik.UsageError
        self.assert_raises(usage, ["float64", "white=1.0"], encode, pictures.astype(float), rate=1)
        self.assert_raises(usage, "clip.png is no name for a capture, which ends in .tik", encode, pictures,
                           self.path("clip.png"), rate=1)
        self.assert_raises(usage, "white '254.5'", encode, pictures, rate=1, white=254.5)
        self.assert_raises(usage, "int64", encode, pictures.astype(int), rate=1)
        for white in (float("nan"), 0, -1):
            self.assert_raises(usage, f"white={white} is no light above 0", encode, pictures.astype(float), rate=1,
                               white=white)
        self.assert_raises(usage, "(8, 8)", encode, pictures[0], rate=1)
        self.assert_raises(usage, "(8, 8, 4)", encode, np.zeros((4, 8, 8, 4), np.uint8), rate=1)
        self.assert_raises(usage, "(0, 8, 8)", encode, pictures[:0], rate=1)
        self.assert_raises(nutik.InputError, "no picture", encode, [], rate=1)
        self.assert_raises(nutik.WrongType, "int holds no pictures", encode, 3, rate=1)
        self.assert_raises(usage, ["rate=", "times="], encode, pictures)
        self.assert_raises(usage, "not both", encode, pictures, rate=1, times=range(4))
        self.assert_raises(usage, "3 times for 4", encode, pictures, times=range(3))
        self.assert_raises(usage, "give one for all", encode, pictures, rate=1, exposures=[1, 1, 1, 1])
        self.assert_raises(usage, "leave one out", encode, pictures, rate=1, exposures=1, shutter_angle=180)
        self.assert_raises(usage, "x.png", encode, pictures, self.path("x.png"), rate=1)
        self.assert_raises(usage, "rate", encode, pictures, rate=float("nan"))
        self.assert_raises(usage, "rate", encode, pictures, rate=-1)
        self.assert_raises(usage, "zstd:19", encode, pictures, self.path("x.tik"), rate=1, codec="zip")
        self.assert_raises(usage, ["codec=", "output="], encode, pictures, rate=1, codec="zstd:19")
        self.assert_raises(usage, "name=", encode, self.path("clip.mkv"), rate=1, name="clip")
        self.assert_raises(usage, "noise='auto'", encode, pictures, rate=1, sigmas=3)
        self.assert_raises(usage, "read once", encode, (each for each in pictures), rate=1, noise="auto")
        self.assert_raises(usage, "align='rigid'", encode, pictures, rate=1, align_to="1f")
        self.assert_raises(nutik.InputError, "sample 2", encode, pictures, times=[0, 2, 1, 3])
        self.assert_raises(nutik.MemoryTooLittle, "memory='", encode, pictures, rate=1, memory="1kB")
        self.assert_raises(usage, "2GB", encode, pictures, rate=1, memory="much")
        self.assert_raises(usage, "choose opencl or reference", encode, pictures, rate=1, renderer="gpu")
        self.assert_raises(nutik.DeviceError, "no such device",
                           lambda: encode(pictures, rate=1, device="no such device").render(exposure="1f"))

    def test_pictures_moved_along_a_known_path(self):
        scene = np.kron(np.random.default_rng(5).integers(40, 220, (20, 28)), np.ones((8, 8))).astype(np.uint8)
        pictures = np.stack([scene[10 + k:138 + k, 20 - 2 * k:196 - 2 * k] for k in range(4)])
        for k, picture in enumerate(pictures):
            (self.folder / f"moved{k}.pgm").write_bytes(b"P5 176 128 255\n" + picture.tobytes())
        path = self.path("path.csv")
        subprocess.run([support.PROGRAM, "encode", "-q", "-f", "10", "--align", "translation", "--camera-path", path,
                        self.path("moved*.pgm"), self.path("moved.tik")], check=True)
        found = nutik.open(self.path("moved.tik")).render(exposure="4f")
        with warnings.catch_warnings(record=True):
            along = nutik.encode(pictures, rate=10, align_along=path).render(exposure="4f")
        self.assert_same(along.array, found.array)
        self.assert_raises(nutik.UsageError, "leave align= out", nutik.encode, pictures, rate=10, align_along=path,
                           align="rigid")

    def test_files_that_are_none(self):
        (self.folder / "text.tik").write_text("nothing")
        self.assert_raises(nutik.InputError, "text.tik", nutik.open, self.path("text.tik"))
        self.assert_raises(nutik.FileMissing, "no such file", nutik.open, self.path("absent.mp4"))
        self.assert_raises(nutik.FileMissing, "No such file", nutik.open, self.path("absent.tik"), rate=2)
        for name in ("a\udcff.tik", "a\0b.tik"):
            for call in (nutik.open, nutik.read_mask, lambda path: nutik.encode(np.zeros((2, 8, 8)), path, white=1.0)):
                self.assert_raises(nutik.UsageError, "is no path", call, name)
        nutik.encode(np.zeros((4, 8, 8), np.uint8), self.path("clip.tik"), rate=1)
        whole = (self.folder / "clip.tik").read_bytes()
        (self.folder / "damaged.tik").write_bytes(whole.replace(b"srgb", b"sr\xedb", 1))
        self.assert_raises(nutik.InputError, r"sr\xedb", nutik.open, self.path("damaged.tik"))
        (self.folder / "latin.csv").write_bytes(b"caf\xe9.png,0,10\n")
        self.assert_raises(nutik.InputError, r"caf\xe9.png", nutik.open, self.path("latin.csv"))
        for argument in ("transfer", "name"):
            self.assert_raises(nutik.UsageError, "no UTF-8", nutik.encode, np.zeros((2, 8, 8), np.uint8), rate=1,
                               **{argument: "\udce9"})
        for name, value, helps in (("rate", 2, "nutik.retime("), ("transfer", "srgb", "nutik.retime("),
                                   ("noise", "a.noise", "Encode the clip again")):
            self.assert_raises(nutik.UsageError, [f"{name}= describes a clip", "encoded already", helps], nutik.open,
                               self.path("clip.tik"), **{name: value})

    def test_what_should_be_known_of_a_clip(self):
        """Of stills that are numbered with a hole, whether they are read or written to a file."""
        for k in (1, 2, 4):
            support.write_pgm(self.path(f"still-{k}.pgm"), np.full((8, 8), k, np.uint8))
        for call in (lambda: nutik.open(self.path("."), rate=1),
                     lambda: nutik.encode(self.path("."), self.path("stills.tik"), rate=1)):
            with self.assertWarnsRegex(nutik.NutikNote, "still-3.pgm") as warned:
                capture = call()
            self.assertEqual(capture.notes, [str(warned.warning)])
            self.assertEqual(len(capture), 3)
        self.assert_raises(nutik.UsageError, "nutik.open()", nutik.encode, self.path("stills.tik"),
                           self.path("again.tik"))

    def test_a_part_of_a_clip(self):
        for k in range(6):
            support.write_pgm(self.path(f"still-{k}.pgm"), np.full((8, 8), 9 * k, np.uint8))
        for call in (lambda **part: nutik.open(self.path("still-%d.pgm"), rate=10, **part),
                     lambda **part: nutik.encode(self.path("still-%d.pgm"), self.path("part.tik"), rate=10, **part)):
            part = call(begin="2f", end=0.5, crop=(1, 2, 6, 4))
            self.assertEqual(part.shape, (3, 4, 6))
            self.assert_same(sample(part, 0), np.full((4, 6), 18, np.uint8))
        self.assert_raises(nutik.UsageError, "crop= is said of a clip's files", nutik.encode,
                           np.zeros((2, 8, 8), np.uint8),
                           rate=1, crop=(0, 0, 4, 4))
        with self.assertRaisesRegex(TypeError, "'chop'"):
            nutik.encode(self.path("still-%d.pgm"), rate=1, chop=1)

    def test_an_argument_by_its_name_in_earlier_versions(self):
        for k in range(3):
            support.write_pgm(self.path(f"still-{k}.pgm"), np.full((8, 8), k, np.uint8))
        cut = self.folder / "still-2.pgm"
        cut.write_bytes(cut.read_bytes()[:-9])
        for call in (nutik.open, nutik.encode):
            with self.assertWarns(nutik.NutikWarning):
                self.assertEqual(len(call(self.path("still-%d.pgm"), rate=10, as_far_as_it_goes=True)), 2)
            self.assertNotIn("as_far_as_it_goes", call.__doc__)
            self.assertRaises(TypeError, call, self.path("still-%d.pgm"), rate=10, as_far_as_that=True)
        self.assertEqual(_nutik.command_words("contact", {"as_far_as_it_goes": [[]]}), ["contact", "--ignore-errors"])

    def test_words_of_values(self):
        self.assertEqual(settings_of({"noise": b"a.json", "align_along": b"path.csv", "start_picture": b"dark.png"}),
                         {"noise": "a.json", "align_along": "path.csv", "start_picture": "dark.png"})
        for light in (0.18, np.float32(0.18), Fraction(18, 100), "0.18"):
            self.assertEqual(settings_of({"start_picture": light}), {"start_picture": "0.18"})
        for stated in ({"noise": 3}, {"start_picture": [0.5]}):
            self.assert_raises(nutik.WrongType, next(iter(stated)), settings_of, stated)
        encode = functools.partial(nutik.encode, np.zeros((4, 8, 8), np.uint8), rate=1)
        for size in ("5000B", "5000", "5KB", "0.005 MB", 5000, 5e3, np.int64(5000), Fraction(5000)):
            self.assert_raises(nutik.MemoryTooLittle, "5000 bytes of memory", encode, memory=size)
        for size in ("5IB", "-5", -5, "inf"):
            self.assert_raises(nutik.UsageError, f"'{size}' is no size; write 500MB, 2GB", encode, memory=size)

    def test_light_before_the_first_event(self):
        words = [0x80000000, *(0x10000000 | k << 22 | (k % 4) << 11 | k % 3 for k in range(40))]  # EVT 2.0
        Path(self.path("e.raw")).write_bytes(b"% evt 2.0\n% geometry 4x3\n% end\n" + np.array(words, "<u4").tobytes())
        first = [float(nutik.open(self.path("e.raw"), start_picture=light).render(exposure="1f").array.max())
                 for light in (0.5, 0.1)]
        self.assertGreater(first[0], 3 * first[1])

    def test_the_first_of_two_wrong_arguments_is_named(self):
        script = "import nutik, numpy; nutik.encode(numpy.zeros((2, 8, 8), 'u1'), rate=[1], align_to=[], noise=3)"
        for seed in "123456":
            ran = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True,
                                 env={**os.environ, "PYTHONHASHSEED": seed})
            self.assertIn("WrongType: rate", ran.stderr)

    def test_parts_are_joined(self):
        """Pieces of a recording as they came, and parts of a clip in any order."""
        pictures = support.moving_box(24, 33, 50)
        for codec in ("none", "rice"):
            whole = nutik.encode(pictures, self.path("whole.tik"), rate=50, block_samples=8, codec=codec)
            pieces = [self.path(f"piece-{k}.tik") for k in range(2)]
            for piece, taken in zip(pieces, (pictures[:16], pictures[16:])):
                nutik.encode(taken, piece, rate=50, block_samples=8, codec=codec)
            told = []
            with self.assertWarns(nutik.NutikNote):
                joined = nutik.join(pieces, self.path("joined.tik"), progress=lambda *far: told.append(far))
            self.assert_same(joined.times_ns, whole.times_ns)
            self.assert_same(joined.render(start="1f", exposure="20f", codes=True).array,
                             whole.render(start="1f", exposure="20f", codes=True).array)
            self.assertEqual(told[-1], (24, 24))
        for k in range(6):
            support.write_pgm(self.path(f"still-{k}.pgm"), np.full((8, 8), 9 * k, np.uint8))
        parts = [self.path("part-1.tik"), self.path("part-0.tik")]
        for part, (begin, end) in zip(parts, (("3f", "6f"), ("0f", "3f"))):
            nutik.encode(self.path("still-%d.pgm"), part, rate=10, begin=begin, end=end)
        joined = nutik.join(iter(parts), self.path("joined.tik"))
        self.assertEqual([sample(joined, k)[0, 0] for k in range(6)], [9 * k for k in range(6)])

    def test_parts_that_cannot_be_joined(self):
        parts = [self.path("a.tik"), self.path("b.tik")]
        for part, side in zip(parts, (8, 9)):
            nutik.encode(np.zeros((2, side, side), np.uint8), part, rate=1)
        output = self.path("whole.tik")
        self.assert_raises(nutik.InputError, ["b.tik", "9 x 9"], nutik.join, parts, output)
        self.assert_raises(nutik.FileMissing, "absent.tik", nutik.join, [parts[0], self.path("absent.tik")], output)
        self.assert_raises(nutik.UsageError, "two captures", nutik.join, parts[:1], output)
        self.assert_raises(nutik.UsageError, "a list", nutik.join, parts[0], output)
        self.assert_raises(nutik.UsageError, "a.tik", nutik.join, [parts[0], parts[0]], parts[0])
        self.assert_raises(nutik.UsageError, "no name for a capture", nutik.join, parts, self.path("whole.png"))
        self.assertFalse(os.path.exists(output))

    def test_closed(self):
        with nutik.encode(np.zeros((4, 8, 8), np.uint8), rate=1) as capture:
            picture = capture.render(exposure=1)
        self.assertEqual(picture.array.sum(), 0)
        self.assert_raises(nutik.UsageError, "closed", capture.render, exposure=1)


class Times(support.TestCase):
    pictures = np.zeros((4, 8, 8), np.uint8)

    def check(self, wanted, **stated):
        self.assertEqual(nutik.encode(self.pictures, **stated).times_ns.tolist(), wanted)

    def test_rates(self):
        thirds = [[0, 333333333], [333333333, 666666667], [666666667, 10 ** 9], [10 ** 9, 1333333333]]
        for rate in (3, "3", Fraction(3), Decimal(3), 3.0, np.int32(3)):
            self.check(thirds, rate=rate)
        self.check([[0, 5], [10, 15], [20, 25], [30, 35]], rate=1e8, shutter_angle=180)
        self.check([[0, 4], [10, 14], [20, 24], [30, 34]], rate=1e8, exposures="4ns")
        ntsc = nutik.encode(self.pictures, rate="30000/1001")
        self.assertEqual(ntsc.rate, Fraction(30000, 1001))
        self.assertEqual(ntsc.duration_ns, round(Fraction(4 * 1001 * 10 ** 9, 30000)))

    def test_starts(self):
        wanted = [[0, 100], [100, 300], [300, 700], [700, 1100]]
        nanoseconds = [5, 105, 305, 705]
        for times in (np.array(nanoseconds, "timedelta64[ns]"), [f"{each}ns" for each in nanoseconds],
                      [Fraction(each, 10 ** 9) for each in nanoseconds], np.array(nanoseconds) * 1e-9):
            self.check(wanted, times=times)
        self.check([[0, 50], [100, 200], [300, 500], [700, 900]], times=np.array(nanoseconds) / 1e9, shutter_angle=180)
        self.check([[0, 10 ** 6], [10 ** 6, 3 * 10 ** 6], [3 * 10 ** 6, 4 * 10 ** 6], [4 * 10 ** 6, 5 * 10 ** 6]],
                   times=[datetime.timedelta(milliseconds=each) for each in (0, 1, 3, 4)])

    def test_exposures(self):
        self.check([[0, 10], [100, 120], [300, 330], [700, 740]], times=[f"{each}ns" for each in (0, 100, 300, 700)],
                   exposures=np.array([10, 20, 30, 40], "timedelta64[ns]"))
        self.check([[0, 60], [100, 160], [300, 360], [700, 760]], times=[f"{each}ns" for each in (0, 100, 300, 700)],
                   exposures="60ns")
        for times, rate in ((np.arange(4) / 100, 100), (np.arange(4) * 1001 / 30000, Fraction(2997, 100)),
                            ([0, 0.01, 0.03, 0.06], 50)):
            capture = nutik.encode(self.pictures, self.path("short.tik"), times=times, exposures="2ms")
            self.assertEqual((capture.rate, nutik.open(self.path("short.tik")).rate), (rate, rate))
            self.assertEqual(capture.figures["shutter_angle"], Fraction(round(720 * rate), 1000))
            self.assertIn(f"{float(rate):g}", capture.facts[0])
        self.assert_raises(nutik.InputError, "sample 0", nutik.encode, self.pictures, times=[0, 1, 2, 3],
                           exposures=[1.5, 0.5, 0.5, 0.5])
        self.assert_raises(nutik.InputError, "exposures='15ms': sample 1 starts 10000000 ns after sample 0",
                           nutik.encode, self.pictures, times=[0, 0.01, 0.02, 0.05], exposures="15ms")
        self.check([[0, 1000], [1000, 2000], [2000, 3005], [4000, 5005]], exposures="1005ns",
                   times=[f"{each}us" for each in (0, 1, 2, 4)])
        self.assert_raises(nutik.UsageError, "3 exposures for 4", nutik.encode, self.pictures, times=range(4),
                           exposures=[1, 1, 1])

    def test_an_endless_iterable_ends_with_its_times(self):
        with self.assertWarnsRegex(nutik.NutikWarning, "4 pictures and 6 times"):
            capture = nutik.encode(iter(self.pictures), times=range(6))
        self.assertEqual(len(capture), 4)
        self.assert_raises(nutik.InputError, "more pictures, but only 6 times", nutik.encode,
                           itertools.repeat(self.pictures[0]), times=range(6))

    def test_floats_are_what_they_show(self):
        """0.1 is a tenth, and 0.1 + 0.2, which shows more digits than a time has, the nanosecond next to it."""
        capture = nutik.encode(self.pictures, rate=2)
        for start, wanted in ((0.1, 100_000_000), (0.1 + 0.2, 300_000_000), (1e-9, 1), (Fraction(1, 3), 333_333_333),
                              (np.float64(0.25), 250_000_000), (np.timedelta64(2, "ms"), 2_000_000),
                              (datetime.timedelta(microseconds=7), 7000), ("1/300s", 3_333_333),
                              (Decimal("0.07"), 70_000_000), (Finer(microseconds=2), 2999)):
            plan = capture.render(start=start, exposure="100ms").plan
            self.assertEqual(plan["functions"][0]["live_ns"][0], wanted, start)
        for wrong in (float("nan"), None, True, np.timedelta64("NaT"), np.timedelta64(1, "Y"), "soon", [1]):
            with self.assertRaises(nutik.UsageError, msg=repr(wrong)):
                capture.render(start=0, exposure=wrong)


class Finer(datetime.timedelta):
    """As pandas' Timedelta, which has nanoseconds besides."""

    nanoseconds = 999


class Between(support.TestCase):
    def test_samples_are_made_and_marked(self):
        y, x = np.mgrid[0:80, 0:128]
        pictures = []
        for k in range(3):
            inside = (x >= 20 + 6 * k) & (x < 50 + 6 * k) & (y >= 25) & (y < 55)
            square = 190 + 40 * np.sin(0.6 * (x - 6 * k)) * np.cos(0.5 * y)
            ground = 80 + 25 * np.sin(0.4 * x + 0.2 * y) * np.cos(0.33 * y)
            pictures.append(np.where(inside, square, ground).round().astype(np.uint8))
        capture = nutik.encode(np.stack(pictures), rate=20, transfer="srgb", between=3)
        self.assertEqual(capture.shape, (9, 80, 128))
        for k, picture in enumerate(pictures):
            self.assert_same(capture[4 * k], picture)
        self.assert_same(capture.render(start="1f", exposure="2f").array,
                         capture.render(start=0.05, exposure=0.1).array)
        made = capture.trace(50, 40, start=0, exposure=0.15)[0].made
        self.assertTrue(made.any() and not made.all())
        with self.assertRaises(nutik.UsageError):
            nutik.encode(np.stack(pictures), rate=20, between="many")


if __name__ == "__main__":
    unittest.main()
