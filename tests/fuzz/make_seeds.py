#!/usr/bin/env python3
"""Writes what each fuzz target starts from: small files of every kind that it reads.

    make_seeds.py --tests tests --seeds FOLDER

One folder a target. Videos are made by the ffmpeg command; without it a line says that they are missing.
"""

import argparse
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib
from pathlib import Path

import cv2
import numpy as np

SIZE = 12, 10  # width, height
# The names that clips.cpp gives a file by an input's first byte; CMakeLists.txt has the same lists, and passes them.
VIDEO_OPTIONS = {
    "a.mkv": ["-c:v", "ffv1"], "a.avi": ["-c:v", "mjpeg"], "a.mp4": ["-c:v", "libx264"],
    "a.mov": ["-c:v", "prores_ks"], "a.webm": ["-c:v", "libvpx-vp9"], "a.y4m": ["-pix_fmt", "yuv420p"],
}
RECIPE = ('{"nutik-cl":"0.1.0","capture":{"name":"clip.tik","checksum":"xxh3-64-tik:63a227c08c75a0a8"},'
          '"functions":{"name":"f.fn","text":"M0 [0:1], [10000000:0]\\n"},'
          '"mask":{"name":"mask.pgm","checksum":"xxh3-64:ef743acca1c83a5e"},'
          '"options":{"ev":"-1","start":"0.4s"},"renderer":"opencl","precision":"double"}')


def picture(kind, channels=3):
    ramp = np.arange(SIZE[0] * SIZE[1] * channels).reshape(SIZE[1], SIZE[0], channels)
    return (ramp * 7 % np.iinfo(kind).max).astype(kind)


def encoded(ending, *arguments, options=()):
    done, data = cv2.imencode(ending, *arguments, list(options))
    assert done
    return data.tobytes()


def stills():
    deep, grey = picture(np.uint16), picture(np.uint8, 1)
    yield "a.png", encoded(".png", picture(np.uint8))
    yield "a.png", encoded(".png", deep)
    yield "a.png", encoded(".png", grey)
    yield "a.jpg", encoded(".jpg", picture(np.uint8))
    yield "a.tif", encoded(".tif", deep, options=(cv2.IMWRITE_TIFF_COMPRESSION, 1))
    yield "a.tif", encoded(".tif", picture(np.uint8), options=(cv2.IMWRITE_TIFF_COMPRESSION, 5))
    with tempfile.TemporaryDirectory() as folder:
        pages = str(Path(folder) / "pages.tif")
        cv2.imwritemulti(pages, [grey, 255 - grey, grey // 2], [cv2.IMWRITE_TIFF_COMPRESSION, 1])
        yield "a.tif", Path(pages).read_bytes()
    yield "a.pgm", b"P5 4 3 4095\n" + bytes(range(24))
    yield "a.pgm", b"P2\n# a comment\n3 2 255\n0 1 2\n3 4 255\n"
    yield "a.ppm", b"P6 2 2 255\n" + bytes(range(12))
    yield "a.ppm", b"P3 1 2 65535 0 1 2 65535 4 5\n"


def cine():
    """A Phantom file of two pictures of 16-bit words, with their times."""
    width, height = 8, 4
    header, bitmap, setup, times = 44, 40, 5692, 8 + 2 * 8  # FFmpeg reads no shorter setup
    offsets_at = header + bitmap + setup + times
    first = offsets_at + 2 * 8
    frame = 8 + width * height * 2
    data = struct.pack("<2sHHHiIiIIIIQ", b"CI", header, 0, 1, 0, 2, 0, 2, header, header + bitmap, offsets_at, 0)
    data += struct.pack("<IiiHHIIiiII", bitmap, width, height, 1, 16, 0, width * height * 2, 0, 0, 0, 0)
    fields = bytearray(setup)
    fields[140:142] = b"ST"
    struct.pack_into("<H", fields, 142, setup)
    struct.pack_into("<I", fields, 768, 1000)  # pictures a second
    struct.pack_into("<I", fields, 896, 12)    # bits of a code
    data += bytes(fields) + struct.pack("<IHHQQ", times, 1002, 0, 0, 1 << 22)
    data += struct.pack("<QQ", first, first + frame)
    for k in range(2):
        data += struct.pack("<II", 8, width * height * 2)
        data += (np.arange(width * height, dtype="<u2") * 100 + k).tobytes()
    return data


def videos():
    yield "a.cine", cine()
    if shutil.which("ffmpeg") is None:
        print("the ffmpeg command is missing: the target videos starts from a .cine alone")
        return
    with tempfile.TemporaryDirectory() as folder:
        for name, codec in VIDEO_OPTIONS.items():
            path = Path(folder) / name
            subprocess.run(["ffmpeg", "-v", "error", "-f", "lavfi", "-i", "testsrc=size=16x16:rate=30", "-frames:v",
                            "4", *codec, str(path)], check=True)
            yield name, path.read_bytes()


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def with_text(png, text):
    """A PNG with a recipe behind its header."""
    return png[:33] + chunk(b"tEXt", b"nutik-cl\0" + text.encode()) + png[33:]


def texts(tests):
    for path in sorted((tests / "corpus/functions").glob("*.fn")):
        yield "functions", path.read_bytes()
    noise = ("nutik noise 0\nwhite 255\ntransfer srgb\nchannel grey\nread 0.0021\nshot 0.00012\ncurve {}\n"
             "point 12.5 1.32 5021\npoint 200 2.5 17\n")
    for curve in "sensor", "points":
        yield "noise", noise.format(curve).encode()
    columns = "picture,x,y,degrees,residual_pixels,agreeing,m0,m1,m2,m3,m4,m5,m6,m7,m8"
    warps = "0,0,0,0,0.1,1,1,0,0,0,1,0,0,0,1\n1,2.5,-1,0.3,0.1,0.9,0.99,-0.1,2.5,0.1,0.99,-1,1e-05,-2e-05,1\n"
    yield "paths", f"# nutik camera path,homography,0,64,48\n{columns}\n{warps}".encode()
    yield "tables", b"file,start_ns,exposure_ns\na.png,0,10000000\nb.png,40000000,20000000\n"
    yield "tables", b'\xef\xbb\xbf"a.png",5,\r\n\r\nb.png,99\r\n'
    for bits, depth, side in (8, 8, "Lower"), (12, 12, "Lower"), (16, 12, "Higher"):
        yield "recordings", (f"Record Rate(fps) : 4000\r\nShutter Speed(s) : 1/8000\r\nTotal Frame : {1920 // 40 // bits}"
                             f"\r\nImage Width : 8\r\nImage Height : 5\r\nColor Type : Mono\r\nColor Bit : {bits}\r\n"
                             f"EffectiveBit Depth : {depth}\r\nEffectiveBit Side : {side}\r\n").encode()
    yield "recordings", (b"<cih><imageDataInfo><resolution><width>8</width><height>5</height></resolution><colorInfo>"
                         b"<type>Raw</type><bit>16</bit></colorInfo></imageDataInfo><frameInfo><totalFrame>3</totalFrame>"
                         b"</frameInfo><recordInfo><recordRate>4000</recordRate></recordInfo></cih>")
    # A time and two events of each format of tests/fuzz/events.cpp, by the number of how the file begins.
    little = lambda size, *words: b"".join(word.to_bytes(size, "little") for word in words)
    yield "events", b"\0" + little(4, 8 << 28 | 5, 1 << 28 | 3 << 22 | 9 << 11 | 4, 9 << 11 | 4)
    yield "events", b"\1" + little(4, 8 << 28 | 5, 0, 1 << 28 | 3 << 22 | 9 << 11 | 4, 0x8001)
    yield "events", b"\2" + little(4, 0, 8 << 28 | 5, 0x8001, 1 << 28 | 3 << 22 | 9 << 11 | 4)
    yield "events", b"\3" + little(2, 0x8005, 0x6003, 4, 0x2809, 0x3009, 0x4081, 0x4003, 0x5001)
    yield "events", b"\4" + little(4, 7, 1 << 28 | 4 << 14 | 9, 8, 4 << 14 | 9)
    big = lambda *words: b"".join(word.to_bytes(size, "big") for word, size in words)
    adder = big((5, 2), (3, 2), (120000, 4), (5000, 4), (50000, 4), (9, 1), (1, 1), (0, 4), (1, 4), (1, 4))
    yield "events", b"\5" + adder + big((1, 2), (2, 2), (6, 1), (900, 4), (1, 2), (2, 2), (255, 1), (1900, 4)) + b"\xff" * 9
    for word in ("t0.4s", "t10ms", "t1/100s", "t37f", "t250us", "r29.97", "r30000/1001", "sbox", "strapezoid:0.2",
                 "shann", "sgaussian", "sstrobe:5", "sstrobe:3,0.25", "sspline:0=0,0.5=1,1=0.25", "striangle"):
        yield "words", word.encode()
    yield "recipes", RECIPE.encode()
    png = encoded(".png", picture(np.uint8))
    yield "recipes", with_text(png, RECIPE)
    yield "recipes", f"P5\n# nutik-cl {RECIPE}\n2 1 255\n".encode() + b"\0\1"
    yield "masks", b"P5 4 2 255\n" + bytes(8)
    yield "masks", b"P2 2 2 9 0 1 2 3\n"
    yield "masks", encoded(".png", picture(np.uint8, 1))


def packed_payloads(tik):
    """Stored payloads of a capture, behind bytes that choose its geometry (unpacking.cpp)."""
    data = tik.read_bytes()
    width, height = (int(number) for number in data.split(b"# TIK size: ")[1].split(b"\n")[0].split(b" x "))
    channels = 1 if data.startswith(b"P5") else 3
    deep = b"# TIK depth: 8 bits" not in data
    at = data.find(b"TIKblock")
    while at >= 0:
        samples, codec, exposures, stored, payload = struct.unpack_from("<24xIIQQQ", data, at)
        start = (at + 128 + exposures + 63) // 64 * 64
        if codec != 0 and width <= 40 and height <= 40 and samples <= 70 and payload % 64 == 0:
            words = payload // 64
            yield bytes([width - 1, height - 1, channels == 3, deep, samples - 1, words % 256, words // 256,
                         codec - 1]) + data[start:start + stored]
        at = data.find(b"TIKblock", at + 1)


def captures(tests):
    for path in sorted((tests / "golden").glob("*.tik")):
        if path.stat().st_size < 20_000:
            yield "captures", path.read_bytes()
        for payload in packed_payloads(path):
            yield "unpacking", payload


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tests", type=Path, required=True)
    parser.add_argument("--seeds", type=Path, required=True)
    parser.add_argument("--still-kinds", nargs="+", required=True)
    parser.add_argument("--video-kinds", nargs="+", required=True)
    arguments = parser.parse_args()

    def clips(target, kinds, made):
        return ((target, bytes([kinds.index(name)]) + data) for name, data in made)

    seeds = [*texts(arguments.tests), *captures(arguments.tests), *clips("stills", arguments.still_kinds, stills()),
             *clips("videos", arguments.video_kinds, videos())]
    for number, (target, data) in enumerate(seeds):
        folder = arguments.seeds / target
        folder.mkdir(parents=True, exist_ok=True)
        (folder / f"seed-{number:03}").write_bytes(data)
    return 0


if __name__ == "__main__":
    sys.exit(main())
