"""With a capture its samples and its changes lie behind the functions, and what counts is its domain.

A capture is made and listed by the program itself. Where captures must be odd or large, the program is stood in for by a
script that prints the table of `nutik-cl activity --csv -`.
"""

import re
import struct
import subprocess
import sys
import unittest

from fnplotter.setting import CAPTURE_NS, draw, colour_count, needs_matplotlib, paths, run, write

EXPOSURE = (0xFB, 0xF7, 0xCF)  # as palette.py has it

STAND_IN = """\
if sys.argv[1:4] != ["activity", "--csv", "-"]:
    sys.exit("nutik-cl: what is this?")
print("sample,start_ns,end_ns,changed_pixels,changed_share")
for k in range({count}):
    start_ns = k * {duration} // {count}
    print(k, start_ns, start_ns + {exposure}, k % 5, k % 5 / 100, sep=",")
"""


def write_program(text, name="stand-in"):
    """A script that says what it likes of captures; functions are read by the program itself."""
    start = f"#!{sys.executable}\nimport os, sys\n"
    functions = f"if sys.argv[1] == 'check': os.execv({str(paths.program)!r}, sys.argv)\n"
    program = write(name, start + functions + text)
    program.chmod(0o755)
    return program


def stand_in(count, exposure=1_000_000):
    """A program that lists so many samples of the capture, exposed for so many nanoseconds."""
    values = {"count": count, "duration": CAPTURE_NS, "exposure": exposure}
    return write_program(STAND_IN.format(**values))


def write_capture(count, name="clip.tik", duration_ns=CAPTURE_NS, magic=b"TIKend 0"):
    """The ends of a capture: what the plotter itself reads of it."""
    footer = struct.pack("<4Qq80x8s", count, 1, 64, 0, duration_ns, magic)
    return write(name, b"P5\n# TIK 0\n1 1\n255\n\0\n" + footer)


@needs_matplotlib
class Captures(unittest.TestCase):
    def plot(self, count, output, *options, **exposure):
        clip, program = write_capture(count), stand_in(count, **exposure)
        output = paths.work / output
        capture = ("--capture", clip, "--program", program)
        result = draw(paths.corpus / "figure04.fn", "-o", output, *capture, *options)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        return output

    def texts(self, *arguments, **exposure):
        return re.findall("<!-- (.*) -->", self.plot(*arguments, **exposure).read_text(encoding="utf-8"))

    def test_the_domain_counts(self):
        texts = self.texts(30, "domain.svg")
        figures = "D 83.331001 ms    ∫g 20.83350075 ms    still gain 0.250009    over the capture (3 s)"
        self.assertIn(figures, texts)

    def test_few_samples_are_drawn_one_by_one(self):
        self.assertIn("exposures of the 30 samples", self.texts(30, "few.svg"))

    def test_many_samples_are_thinned_and_the_plot_says_so(self):
        self.assertIn("every 200th of 9600 samples", self.texts(9600, "many.svg"))

    def test_zoom_shows_the_samples_of_the_stretch(self):
        texts = self.texts(9600, "zoom.svg", "--zoom", "1500ms..1510ms")
        self.assertIn("exposures of the 9600 samples", texts)

    def test_bands_are_as_wide_as_exposures(self):
        period = CAPTURE_NS // 30
        half, quarter = (
            colour_count(self.plot(30, "bands.png", exposure=period // part), EXPOSURE) for part in (2, 4)
        )
        self.assertAlmostEqual(quarter / half, 0.5, delta=0.05)

    def test_of_many_changes_the_highest_are_drawn(self):
        import numpy as np
        from fnplot.backdrops import Activity
        from fnplot.capture import Capture
        from fnplot.view import View

        count = 5000
        starts_ns = np.arange(count) * 10
        changed = np.zeros(count)
        changed[[0, 1234, 4999]] = 0.5, 0.25, 0.125
        clip = Capture(count * 10, starts_ns, starts_ns + 5, changed)
        for window in ((-10, 50_010), (12_300, 12_400), (-20, -10), (60_000, 70_000)):
            view = View(*window, 0, count * 10, count * 10)
            activity = Activity(clip, view)
            steps = list(zip(activity.x[::2], activity.x[1::2], activity.y[::2], activity.y[1::2]))
            for sample in range(max(0, window[0] // 10), min(count, window[1] // 10)):
                time = view.axis.coordinate(int(starts_ns[sample]))
                within = [step for step in steps if step[0] <= time < step[1]]
                self.assertEqual(len(within), 1)
                self.assertGreaterEqual(within[0][2], 100 * changed[sample])
            self.assertEqual(activity.y[::2].tolist(), activity.y[1::2].tolist())
            visible = changed[max(0, window[0] // 10) : max(0, window[1] // 10)]
            if visible.any():
                self.assertEqual(max(activity.y), 100 * visible.max())

    def test_a_legend_for_one_sample_and_for_none(self):
        self.assertIn("exposure of the one sample", self.texts(1, "one.svg"))
        self.assertIn("the first of 3 samples", self.texts(3, "far.svg", "--zoom=-1000h..1000h"))

    def test_changes_have_an_axis_of_their_own(self):
        texts = self.texts(30, "changes.svg")
        self.assertLessEqual({"pixels that change", "change", "0 %", "4 %"}, set(texts))

    def test_the_table_is_read_to_the_last_digit(self):
        from fnplot.capture import read_capture

        clip = read_capture(write_capture(7), stand_in(7))
        self.assertEqual(clip.duration_ns, CAPTURE_NS)
        self.assertEqual(clip.starts_ns.tolist(), [k * CAPTURE_NS // 7 for k in range(7)])
        self.assertEqual((clip.ends_ns - clip.starts_ns).tolist(), [1_000_000] * 7)
        self.assertEqual(clip.changed.tolist(), [0, 0.01, 0.02, 0.03, 0.04, 0, 0.01])


@needs_matplotlib
class TheProgram(unittest.TestCase):
    """Ten pictures of 8 x 8 pixels, 10 a second with a shutter of 180 degrees, of which 1, 2, … 9 pixels change."""

    def capture(self):
        folder = paths.work / "stills"
        folder.mkdir(exist_ok=True)
        pixels = bytearray(64)
        for number in range(10):
            for pixel in range(number):
                pixels[pixel] += 20
            (folder / f"{number}.pgm").write_bytes(b"P5 8 8 255\n" + pixels)
        clip = paths.work / "stills.tik"
        command = [paths.program, "encode", "-q", "-f", "10", "-a", "180", "--overwrite", folder, clip]
        subprocess.run(command, check=True)
        return clip

    def test_its_table_is_read(self):
        from fnplot.capture import read_capture

        clip = read_capture(self.capture(), paths.program)
        self.assertEqual(clip.duration_ns, 1_000_000_000)
        self.assertEqual(clip.starts_ns.tolist(), [k * 100_000_000 for k in range(10)])
        self.assertEqual((clip.ends_ns - clip.starts_ns).tolist(), [50_000_000] * 10)
        self.assertEqual((clip.changed * 64).tolist(), list(range(10)))

    def test_it_is_drawn(self):
        output = paths.work / "program.svg"
        functions = write("ramp.fn", "M0 [0:0], [500000000:2], [500000001:0]\n")
        result = run(functions, "--capture", self.capture(), "--program", paths.program, "-o", output)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        texts = set(re.findall("<!-- (.*) -->", output.read_text(encoding="utf-8")))
        self.assertLessEqual({"exposures of the 10 samples", "pixels that change", "14.1 %"}, texts)
        self.assertTrue([text for text in texts if text.endswith("over the capture (1 s)")], texts)


@needs_matplotlib
class Mistakes(unittest.TestCase):
    def check(self, clip, program, status, words):
        output = paths.work / "refused.png"
        capture = ("--capture", clip, "--program", program)
        result = run(paths.corpus / "figure04.fn", "-o", output, *capture)
        self.assertEqual(result.returncode, status, result.stderr)
        self.assertIn(words, result.stderr)
        self.assertNotIn("Traceback", result.stderr)
        self.assertFalse(output.exists())

    def test_captures(self):
        self.check(paths.work / "none.tik", stand_in(3), 3, "none.tik: No such file")
        self.check(write("video.tik", b"\0\0\0\x18ftyp" * 20), stand_in(3), 3, "is no .tik capture")
        cut = write("cut.tik", b"P5\n# TIK 0\n" + bytes(500))
        self.check(cut, stand_in(3), 3, "nutik-cl recover")
        self.check(write_capture(3, "short.tik", magic=b"TIKend 1"), stand_in(3), 3, "nutik-cl recover")
        self.check(write_capture(3, "0s.tik", duration_ns=0), stand_in(3), 3, "its footer is damaged")
        self.check(write_capture(4, "four.tik"), stand_in(3), 3, "has 4 samples, but")

    def test_programs(self):
        clip = write_capture(3)
        self.check(clip, paths.work / "no-program", 5, "say where nutik-cl is: --program")
        program = write_program("print('nutik-cl: damaged', file=sys.stderr)\nsys.exit(3)\n")
        self.check(clip, program, 3, "failed: nutik-cl: damaged")
        for row in ("0,1", "0,1,x", "0,1,2", "0.5,1,0"):
            table = f"start_ns,end_ns,changed_share\n{row}"
            program = write_program(f"print({table!r})\n")
            self.check(clip, program, 3, "cannot be understood")
