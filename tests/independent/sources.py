"""Deep sources read by other means than the program's: .cine and TIFF byte by byte, raw YUV by the
standards' equations, grey video through a pipe from the ffmpeg command.

Samples are N x H x W x C arrays of codes as the file holds them.
"""

import json
import re
import struct
import subprocess
from fractions import Fraction
from pathlib import Path

import numpy as np


# The table that a format prescribes is no computation to be compared: what it is made from is asserted in
# tests/media/phantom_clip_test.cpp.
PHANTOM_TABLE = Path(__file__).parents[2] / "host" / "media" / "videos" / "phantom_file.cpp"


def read_cine(path):
    """A .cine with one grey value a pixel, 16-bit words or packed into 10 bits, which stand for light of 12: samples,
    bits of a code and the camera's times (ns from the first picture's, rounded; Fractions before that)."""
    data = open(path, "rb").read()
    count, _, setup, offsets = struct.unpack_from("<4I", data, 20)
    bitmap = struct.unpack_from("<I", data, 24)[0]
    width, height = struct.unpack_from("<2i", data, bitmap + 4)
    packed = struct.unpack_from("<I", data, bitmap + 16)[0] == 256
    bits = struct.unpack_from("<I", data, setup + 896)[0]  # RealBPP
    samples = []
    for offset in struct.unpack_from(f"<{count}Q", data, offsets):
        start = offset + struct.unpack_from("<I", data, offset)[0]
        size = width * height
        if packed:
            codes = _phantom_table()[_unpacked(np.frombuffer(data, np.uint8, size * 10 // 8, start), 10)]
        else:
            codes = np.frombuffer(data, "<u2", size, start)
        samples.append(codes.reshape(height, width, 1))
    return np.array(samples).astype(np.uint16), 12 if packed else bits, _cine_times(data, setup, count)


def _phantom_table():
    numbers = re.search(r"kPhantomLight = \{(.*?)\}", PHANTOM_TABLE.read_text(), re.DOTALL).group(1)
    return np.array([int(number) for number in re.findall(r"\d+", numbers)], np.uint16)


def _cine_times(data, setup, count):
    """The time of each picture, ns as Fractions from the first, of the tagged block 1002."""
    tag = setup + struct.unpack_from("<H", data, setup + 142)[0]
    size, kind = struct.unpack_from("<IH", data, tag)
    while kind != 1002:
        tag += size
        size, kind = struct.unpack_from("<IH", data, tag)
    times = struct.unpack_from(f"<{count}Q", data, tag + 8)
    return [Fraction((time - times[0]) * 10**9, 2**32) for time in times]


def _unpacked(packed, bits):
    """Codes of so many bits, the high bits first, behind one another in bytes."""
    ones = np.unpackbits(packed).reshape(-1, bits).astype(np.uint16)
    return (ones << np.arange(bits - 1, -1, -1, dtype=np.uint16)).sum(axis=1).astype(np.uint16)


def read_tiff(path):
    """All pages of a grey, uncompressed TIFF of 16 bits."""
    data = open(path, "rb").read()
    order = {b"II": "<", b"MM": ">"}[data[:2]]
    directory = struct.unpack_from(order + "I", data, 4)[0]
    pages = []
    while directory:
        fields = {}
        for entry in range(struct.unpack_from(order + "H", data, directory)[0]):
            at = directory + 2 + 12 * entry
            tag, kind, count = struct.unpack_from(order + "HHI", data, at)
            fields[tag] = _tiff_values(data, order, kind, count, at + 8)
        height, width = fields[257][0], fields[256][0]
        strips = [data[start:start + size] for start, size in zip(fields[273], fields[279])]
        pages.append(np.frombuffer(b"".join(strips), order + "u2").reshape(height, width, 1))
        directory = struct.unpack_from(order + "I", data, at + 12)[0]
    return np.array(pages).astype(np.uint16)


def _tiff_values(data, order, kind, count, at):
    """A field's whole numbers; None of other kinds."""
    if kind not in (3, 4):
        return None
    letter, size = {3: ("H", 2), 4: ("I", 4)}[kind]
    if count * size > 4:
        at = struct.unpack_from(order + "I", data, at)[0]
    return struct.unpack_from(f"{order}{count}{letter}", data, at)


def read_yuv420p10(path, width, height):
    """Luma and the two chroma planes of raw planar 10-bit video, as stored."""
    words = np.fromfile(path, "<u2").reshape(-1, width * height * 3 // 2)
    luma, rest = words[:, :width * height], words[:, width * height:]
    half = (-1, height // 2, width // 2)
    blue, red = np.split(rest, 2, axis=1)
    return luma.reshape(-1, height, width), blue.reshape(half), red.reshape(half)


def rgb_of_yuv10(luma, blue, red):
    """RGB codes of 16 bits of 10-bit planes of one size: BT.601, limited range."""
    bright = (luma.astype(np.float64) - 64) / 876
    blue, red = (blue - 512.0) / 896, (red - 512.0) / 896
    r, b = bright + 1.402 * red, bright + 1.772 * blue
    g = (bright - 0.299 * r - 0.114 * b) / 0.587
    return np.floor(65535 * np.clip(np.stack([r, g, b], axis=-1), 0, 1) + 0.5).astype(np.uint16)


def pipe(path, pixels, channels, *options):
    """What the ffmpeg command decodes, as raw `pixels` of 16-bit words, and each picture's time in
    seconds (Fractions) as its container has it."""
    shown = subprocess.run(
        ["ffprobe", "-v", "error", "-select_streams", "v:0", "-show_entries",
         "stream=width,height,time_base:packet=pts", "-of", "json", str(path)],
        capture_output=True, check=True)
    found = json.loads(shown.stdout)
    stream = found["streams"][0]
    times = sorted(int(packet["pts"]) for packet in found["packets"])
    seconds = [(time - times[0]) * Fraction(stream["time_base"]) for time in times]
    # passthrough: else pictures are repeated and dropped until they have one rate.
    decoded = subprocess.run(
        ["ffmpeg", "-v", "error", "-i", str(path), "-fps_mode", "passthrough", *options,
         "-f", "rawvideo", "-pix_fmt", pixels, "-"], capture_output=True, check=True)
    samples = np.frombuffer(decoded.stdout, "<u2")
    return samples.reshape(-1, stream["height"], stream["width"], channels), seconds
