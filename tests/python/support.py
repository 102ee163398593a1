"""What tests of the Python package have in common: small scenes, the command line, Netpbm and PFM files."""

import os
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy as np

PROGRAM = os.environ["NUTIK_CL"]
RATE = 960


def moving_box(samples=70, height=45, width=80, channels=3, dtype=np.uint8, seed=1):
    """Codes of a box that crosses a still, structured scene; noise flickers in a corner."""
    random = np.random.default_rng(seed)
    last = np.iinfo(dtype).max
    shape = (height, width) + ((channels,) if channels > 1 else ())
    scene = random.integers(0, last, shape, dtype)
    pictures = np.broadcast_to(scene, (samples, *shape)).copy()
    for k, picture in enumerate(pictures):
        left = 2 + (width - 24) * k // samples
        picture[10:25, left:left + 12] = last - last // 7 * (k % 3)
        picture[30:, :16] = random.integers(0, last, picture[30:, :16].shape, dtype)
    return pictures


def tags(height=45, width=80):
    """Three regions."""
    mask = np.zeros((height, width), np.uint8)
    mask[8:28, 20:40] = 128
    mask[15:40, 50:] = 255
    return mask


FUNCTIONS = """M0{[0:1], [72000000:1], [72000001:0]}
M128{[0:0], [20000000:0], [20000001:1.5], [30000000:-0.5], [30000001:0]}
M255{[0:0], [10000000:1], [60000000:0]}
"""


def read_netpbm(path):
    """Codes of a .pgm or .ppm."""
    data = Path(path).read_bytes()
    fields, at = [], 0
    while len(fields) < 4:
        line_end = data.index(b"\n", at)
        fields += data[at:line_end].split(b"#")[0].split()
        at = line_end + 1
    kind, width, height, most = fields[0], *map(int, fields[1:])
    values = np.frombuffer(data[at:], ">u2" if most > 255 else "u1").astype(np.uint16 if most > 255 else np.uint8)
    return values.reshape((height, width, 3) if kind == b"P6" else (height, width))


def read_pfm(path):
    """Light of a .pfm, whose rows come from the bottom up."""
    data = Path(path).read_bytes()
    kind, size, scale, raster = data.split(b"\n", 3)
    width, height = map(int, size.split())
    values = np.frombuffer(raster, "<f4" if float(scale) < 0 else ">f4").astype(np.float32)
    return values.reshape((height, width, 3) if kind == b"PF" else (height, width))[::-1]


def write_pgm(path, codes):
    """A grey picture of 8 or 16 bits."""
    most = np.iinfo(codes.dtype).max
    header = f"P5\n{codes.shape[1]} {codes.shape[0]}\n{most}\n".encode()
    Path(path).write_bytes(header + codes.astype(">u2" if most > 255 else "u1").tobytes())


class TestCase(unittest.TestCase):
    """With a folder of its own, and the command line."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="nutik-python-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def path(self, name):
        return str(self.folder / name)

    def run_program(self, *words):
        """What the command line prints. Fails where it does."""
        done = subprocess.run([PROGRAM, *map(str, words)], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, f"{words}: {done.stderr}")
        return done.stdout

    def assert_same(self, ours, theirs):
        """The same values, to the bit."""
        self.assertEqual(ours.dtype, theirs.dtype)
        self.assertEqual(ours.shape, theirs.shape)
        self.assertEqual(ours.tobytes(), np.ascontiguousarray(theirs).tobytes())

    def assert_raises(self, kind, words, call, *arguments, **named):
        """Raises exactly that, with all of the words in its message, which is returned."""
        with self.assertRaises(kind) as raised:
            call(*arguments, **named)
        self.assertIs(type(raised.exception), kind)
        message = str(raised.exception)
        for word in [words] if isinstance(words, str) else words:
            self.assertIn(word, message)
        self.assertNotIn("--", message, "it names an option of the command line")
        return raised.exception
