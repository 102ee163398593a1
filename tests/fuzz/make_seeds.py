#!/usr/bin/env python3
"""Writes what each fuzz target starts from: small files of every kind that it reads.

    make_seeds.py --tests tests --seeds FOLDER

One folder a target. Videos are made by the ffmpeg command; without it a line says that they are missing.
"""

import argparse
import os
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib
from io import BytesIO
from pathlib import Path

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"
import cv2  # which asks for it when it is loaded
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
    yield "a.pgm", b"P7\nWIDTH 3\nHEIGHT 2\nDEPTH 1\nMAXVAL 4095\nTUPLTYPE GRAYSCALE\nENDHDR\n" + bytes(12)
    yield "a.ppm", b"P6 2 2 255\n" + bytes(range(12))
    yield "a.ppm", b"P3 1 2 65535 0 1 2 65535 4 5\n"
    light = (deep / 65535).astype(np.float32)
    yield "a.tif", encoded(".tif", light, options=(cv2.IMWRITE_TIFF_COMPRESSION, 1))
    yield "a.exr", encoded(".exr", light)
    yield "a.exr", encoded(".exr", light[:, :, 0])
    yield "a.pfm", b"PF\n%d %d\n-1.0\n" % (light.shape[1], light.shape[0]) + light.tobytes()
    for array in (light, light.astype(np.float64), grey, np.stack([deep, deep])):
        with BytesIO() as file:
            np.save(file, array)
            yield "a.npy", file.getvalue()


def lossless_jpeg(codes):
    """A grey picture of 16 bits: each pixel is told from its left neighbour, by how many bits the difference has."""
    height, width = codes.shape
    bits = []
    for y in range(height):
        for x in range(width):
            left = int(codes[y, x - 1]) if x > 0 else int(codes[y - 1, 0]) if y > 0 else 1 << 15
            difference = (int(codes[y, x]) - left + (1 << 15)) % (1 << 16) - (1 << 15)
            size = abs(difference).bit_length()
            bits.append(f"{size:05b}")  # seventeen codes of five bits
            if size:
                bits.append(f"{difference if difference > 0 else difference + (1 << size) - 1:0{size}b}")
    stream = "".join(bits)
    stream += "1" * (-len(stream) % 8)
    data = bytes(int(stream[at:at + 8], 2) for at in range(0, len(stream), 8)).replace(b"\xff", b"\xff\0")
    marker = lambda code, body: struct.pack(">BBH", 255, code, len(body) + 2) + body
    return (b"\xff\xd8" + marker(0xc3, struct.pack(">BHHB3B", 16, height, width, 1, 1, 0x11, 0)) +
            marker(0xc4, b"\0" + bytes([0, 0, 0, 0, 17] + [0] * 11) + bytes(range(17))) +
            marker(0xda, b"\1\1\0\1\0\0") + data + b"\xff\xd9")


def dng(codes, packed=False):
    """A sensor's mosaic R G / G B, [height, width] of 16 bits, as a DNG."""
    height, width = codes.shape
    pixels = lossless_jpeg(codes) if packed else codes.astype("<u2").tobytes()
    longs = lambda *words: struct.pack(f"<{len(words)}i", *words)
    matrix = longs(*(word for number in (6700, -1000, -600, -4000, 11600, 2600, -500, 1200, 6000)
                     for word in (number, 10000)))
    tags = [(254, 4, 1, longs(0)), (256, 3, 1, longs(width)), (257, 3, 1, longs(height)), (258, 3, 1, longs(16)),
            (259, 3, 1, longs(7 if packed else 1)), (262, 3, 1, longs(32803)), (271, 2, 8, b"Made up\0"),
            (272, 2, 8, b"Made up\0"), (273, 4, 1, None), (274, 3, 1, longs(1)), (277, 3, 1, longs(1)),
            (278, 3, 1, longs(height)), (279, 4, 1, longs(len(pixels))), (284, 3, 1, longs(1)),
            (33421, 3, 2, struct.pack("<HH", 2, 2)), (33422, 1, 4, b"\0\1\1\2"), (33434, 5, 1, longs(1, 200)),
            (36867, 2, 20, b"2026:11:21 13:22:27\0"), (50706, 1, 4, b"\1\4\0\0"), (50707, 1, 4, b"\1\1\0\0"),
            (50708, 2, 8, b"Made up\0"), (50714, 4, 1, longs(512)), (50717, 4, 1, longs(65535)),
            (50721, 10, 9, matrix), (50728, 5, 3, longs(1, 2, 1, 1, 4, 5)), (50778, 3, 1, longs(21)),
            (51044, 10, 1, longs(24, 1))]
    behind_at = 8 + 2 + 12 * len(tags) + 4
    sizes = [len(data) for *_, data in tags if data is not None and len(data) > 4]
    pixels_at, head, behind = behind_at + sum(sizes), struct.pack("<H", len(tags)), b""
    for tag, kind, count, data in tags:
        data = longs(pixels_at) if data is None else data
        head += struct.pack("<HHI", tag, kind, count)
        head += data.ljust(4, b"\0") if len(data) <= 4 else longs(behind_at + len(behind))
        behind += data if len(data) > 4 else b""
    return b"II*\0\x08\0\0\0" + head + longs(0) + behind + pixels


def sensors():
    mosaic = (np.arange(32 * 24).reshape(24, 32) * 251 % 60000 + 600).astype(np.uint16)
    yield "a.dng", dng(mosaic)
    yield "a.dng", dng(mosaic, packed=True)


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
    batch = ("# the paper's figure\n-k figure14.fn -m mask.pgm ball.tik 'a picture.png'\r\n\n"
             "--start 0.4s --exposure 10ms --ev -1 --precision double --depth 16 c.tik -o \"b.png\"\n"
             "  --shutter hann --shutter-angle 180 --region 1,2,30,40 --frames 1-9 c.tik\n")
    yield "lists", b"b" + batch.encode()
    yield "lists", b"b--delay each.pgm:0s..5s --mask-to n.pgm --feather 3 --noise auto --device all c.tik a\\ b.png"
    for pattern, *files in (("frame%04d.png", "frame0001.png", "frame0002.png", "frame0003.png"), ("",  "1.png", "2.png", "4.png"),
                            ("f*[0-9].tif", "f1.tif", "f10.tif", "f2.tif"), ("%3d.dng", "  1.dng", "  2.dng")):
        yield "lists", b"n" + "\n".join((pattern, *files)).encode()
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
    parser.add_argument("--sensor-kinds", nargs="+", required=True)
    parser.add_argument("--video-kinds", nargs="+", required=True)
    arguments = parser.parse_args()

    def clips(target, kinds, made):
        return ((target, bytes([kinds.index(name)]) + data) for name, data in made)

    seeds = [*texts(arguments.tests), *captures(arguments.tests), *clips("stills", arguments.still_kinds, stills()),
             *clips("sensors", arguments.sensor_kinds, sensors()), *clips("videos", arguments.video_kinds, videos())]
    for number, (target, data) in enumerate(seeds):
        folder = arguments.seeds / target
        folder.mkdir(parents=True, exist_ok=True)
        (folder / f"seed-{number:03}").write_bytes(data)
    return 0


if __name__ == "__main__":
    sys.exit(main())
