"""With a mask only the functions in use are drawn."""

import re
import unittest

from fnplotter.setting import draw, needs_matplotlib, paths, run, write


@needs_matplotlib
class Masks(unittest.TestCase):
    """With a mask only the functions in use are drawn."""

    PIXELS = bytes([0] * 6 + [128] * 2 + [7, 8, 9, 200])

    def check_plot(self, mask):
        output = paths.work / "masked.svg"
        result = draw(paths.corpus / "figure14.fn", "--mask", mask, "-o", output)
        self.assertEqual(result.returncode, 0, result.stderr)
        unmapped = "mask values without a function: 7…9, 200 (4 pixels)"
        self.assertIn(f"warning: {mask}: {unmapped}\n", result.stderr)
        self.assertIn(f"warning: {mask}: functions that it does not use: 64, 196, 255\n", result.stderr)
        text = output.read_text(encoding="utf-8")
        tags = re.findall(r"<!-- (M\d+) -->", text)
        self.assertEqual(tags, ["M0", "M128"])
        self.assertIn("<!-- 50 % of the mask -->", text)

    def test_raw_pgm(self):
        self.check_plot(write("raw.pgm", b"P5\n# ball\n4 3\n255\n" + self.PIXELS))

    def test_plain_pgm(self):
        numbers = " ".join(map(str, self.PIXELS))
        self.check_plot(write("plain.pgm", f"P2 # ball\n4 3 # size\n255\n{numbers} # end\n"))

    def test_small_maximum_is_not_scaled(self):
        self.check_plot(write("small.pgm", b"P5 4 3 200\n" + self.PIXELS))

    def test_png(self):
        from PIL import Image

        path = paths.work / "mask.png"
        Image.frombytes("L", (4, 3), self.PIXELS).save(path)
        self.check_plot(path)

    def check_refused(self, mask, status, words):
        result = run(paths.corpus / "figure14.fn", "--mask", mask, "-o", paths.work / "refused.svg")
        self.assertEqual(result.returncode, status)
        self.assertIn(words, result.stderr)
        self.assertNotIn("Traceback", result.stderr)

    def test_damaged_masks(self):
        short = write("short.pgm", b"P5 4 3 255\n" + self.PIXELS[:5])
        self.check_refused(short, 3, "cut off: 5 of 4 x 3 pixels")
        self.check_refused(write("header.pgm", b"P5 4 "), 3, "its header is cut off")
        self.check_refused(write("deep.pgm", b"P5 4 3 65535\n" + bytes(24)), 3, "maximum 65535")
        self.check_refused(write("word.pgm", "P2 2 1 255 1 x"), 3, "'x' is no mask value")
        self.check_refused(write("colour.ppm", b"P6 1 1 255\n" + bytes(3)), 3, "neither a PGM nor a PNG")
        self.check_refused(paths.work / "none.pgm", 3, "No such file")

    def test_mask_that_uses_no_function(self):
        mask = write("other.pgm", b"P5 2 1 255\n" + bytes([1, 2]))
        self.check_refused(mask, 3, "uses no function of")
