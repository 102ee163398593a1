#!/usr/bin/env python3
"""Damages every kind of file that the program reads, and demands that it notices, or that nothing is lost.

    check_damage.py --program nutik-cl --work FOLDER [--flips N] [--seed N] [--only PART]

    inputs     each format of stills and cameras' recordings, cut by 1 to 8 bytes at its end, and N times with a bit flipped
    videos     the same of each codec and container that the ffmpeg command makes
    captures   .tik files of every kind with a bit flipped N times in every class of their bytes
    golden     captures of earlier programs, cut, and with a bit flipped N / 8 times in every class of their bytes

All samples are exposed by the reference. A damaged file is refused with status 3 and a sentence, or its picture is the
right one, or a note or warning tells that something is damaged or missing. Where a format keeps no checksum, a flipped bit may be another picture too, and where it says nowhere how many records
it has, whole ones may be missing at its end: these are counted and printed. Nothing else may happen: no signal, no other status, no other picture in silence.
"""

import argparse
import os
import random
import re
import shutil
import struct
import subprocess
import sys
from collections import Counter
from pathlib import Path
from typing import Callable, NamedTuple

import cv2
import numpy as np

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent / "tools"), str(HERE.parent / "fuzz")]
from make_seeds import cine, dng  # noqa: E402
from report import Report  # noqa: E402
from words import over  # noqa: E402

WIDTH, HEIGHT, PICTURES = 48, 32, 6
EXPOSE = ["--renderer", "reference", "--start", "0s", "--exposure", "1s", "--no-recipe"]
CUTS = range(1, 9)
SHOWN = 8
GOLDEN = Path(__file__).resolve().parent.parent / "golden"
# Other notes and warnings say nothing of damage.
TELLS_OF_DAMAGE = re.compile(r"(note|warning): .*(damaged|cut off|missing|could be decoded|left out)")


FOR_RECOVERY = "exposures of blocks"  # which a whole file says again at its end


def nowhere(_):
    return []


class Input(NamedTuple):
    name: str
    words: list                        # how the program is told to read it
    damaged: str                       # the file that is damaged
    notices: Callable = nowhere        # where a flipped bit must be noticed: pairs of offset and bytes
    record_bytes: int = 0              # whole records that are missing at the end leave a shorter file that is whole


def pictures(channels):
    """A disc that crosses noise, [pictures, height, width, channels]."""
    noise = np.random.default_rng(3).integers(60, 120, (PICTURES, HEIGHT, WIDTH, channels))
    x, y = np.meshgrid(np.arange(WIDTH), np.arange(HEIGHT))
    for k in range(PICTURES):
        noise[k][(x - 7 * k - 4) ** 2 + (y - 15) ** 2 < 40] = 220
    return noise.astype(np.uint8)


def whole_file(path):
    return [(0, path.stat().st_size)]


def jpeg_front(path):
    """The marker that a lossless JPEG begins with, and its size: without them nothing is developed."""
    start = path.read_bytes().index(b"\xff\xd8")
    return [(start, 2), (start + 7, 4)]


def packets(path):
    """Where a container holds what its codec made. A container's own bytes have no checksums."""
    told = subprocess.run(["ffprobe", "-v", "error", "-show_entries", "packet=pos,size", "-of", "csv=p=0", path],
                          capture_output=True, text=True, check=True).stdout
    return [(int(at), int(size)) for size, at in re.findall(r"(\d+),(\d+)", told)]


def write_stills(folder):
    """A folder of each format; the third picture is damaged. Yields inputs."""
    grey, colour = pictures(1), pictures(3)
    formats = {
        "png": (".png", colour, []), "png-grey": (".png", grey, []),
        "png-16": (".png", colour.astype(np.uint16) * 257, []),
        "tiff": (".tif", colour, [cv2.IMWRITE_TIFF_COMPRESSION, 1]),
        "tiff-lzw": (".tif", colour, [cv2.IMWRITE_TIFF_COMPRESSION, 5]),
        "tiff-deflate": (".tif", colour.astype(np.uint16) * 257, [cv2.IMWRITE_TIFF_COMPRESSION, 8]),
        "jpeg": (".jpg", colour, []), "pgm": (".pgm", grey, []), "ppm-16": (".ppm", colour.astype(np.uint16) * 257, []),
    }
    for name, (ending, clip, options) in formats.items():
        (folder / name).mkdir()
        for k, picture in enumerate(clip):
            cv2.imwrite(str(folder / name / f"{k}{ending}"), picture, options)
        yield Input(name, ["-f", "100", name], f"{name}/2{ending}", whole_file if ending == ".png" else nowhere)
    cv2.imwritemulti(str(folder / "pages.tif"), list(colour), [cv2.IMWRITE_TIFF_COMPRESSION, 1])
    yield Input("tiff of pages", ["-f", "100", "pages.tif"], "pages.tif")
    mosaic = grey[..., 0].astype(np.uint16) * 200 + 512
    for name, packed in ("dng", False), ("dng-packed", True):
        (folder / name).mkdir()
        for k, picture in enumerate(mosaic):
            (folder / name / f"{k}.dng").write_bytes(dng(picture, packed))
        yield Input(name, ["-f", "100", name], f"{name}/2.dng", jpeg_front if packed else nowhere)
    (folder / "camera").mkdir()
    for k, picture in enumerate(grey):
        cv2.imwrite(str(folder / "camera" / f"{k}.png"), picture)
    (folder / "camera/camera.cih").write_text("#Camera Information Header\nRecord Rate(fps) : 1000\n"
                                              "Shutter Speed(s) : 1/2000\nTotal Frame : 6\n")
    yield Input(".cih", ["camera"], "camera/camera.cih")


def packed_12(codes):
    """Codes of 12 bits, two in three bytes, the high bits first."""
    first, second = codes.astype(np.uint32).reshape(-1, 2).T
    pairs = first << 12 | second
    return np.stack([pairs >> 16, pairs >> 8 & 255, pairs & 255], 1).astype(np.uint8).tobytes()


def write_photron(folder):
    """A recording of each depth. Yields inputs: the pictures damaged, and what is said of them."""
    codes = pictures(1).ravel()
    text = ("Record Rate(fps) : 1000\nShutter Speed(s) : 1/2000\nTotal Frame : {count}\nImage Width : {width}\n"
            "Image Height : {height}\nColor Type : Mono\nColor Bit : {bits}\nFile Format : MRaw\n"
            "EffectiveBit Depth : {bits}\nEffectiveBit Side : Lower\nEND\n")
    xml = ("<?xml version=\"1.0\"?><cih><imageFileInfo><fileFormat>Mraw</fileFormat></imageFileInfo><imageDataInfo>"
           "<resolution><width>{width}</width><height>{height}</height></resolution><colorInfo><type>Mono</type><bit>{bits}"
           "</bit></colorInfo><effectiveBit><depth>{bits}</depth><side>Lower</side></effectiveBit></imageDataInfo>"
           "<frameInfo><totalFrame>{count}</totalFrame></frameInfo><recordInfo><recordRate>1000</recordRate>"
           "<shutterSpeedNsec>500000</shutterSpeedNsec></recordInfo></cih>")
    for name, bits, data, header in (
            ("p8.cih", 8, codes.tobytes(), text), ("p12.cihx", 12, packed_12(codes.astype(np.uint16) * 16), xml),
            ("p16.cih", 16, (codes.astype("<u2") * 257).tobytes(), text)):
        (folder / name).write_text("#Camera Information Header\n" * (header is text) +
                                   header.format(count=PICTURES, width=WIDTH, height=HEIGHT, bits=bits))
        pictures_of = Path(name).with_suffix(".mraw")
        (folder / pictures_of).write_bytes(data)
        yield Input(f".mraw of {bits} bits", [name], str(pictures_of))
        yield Input(f"{name[name.index('.'):]} of it", [name], name)


def write_recordings(folder):
    """Clips that nobody else has to make. Yields inputs."""
    (folder / "raw.gray").write_bytes(pictures(1).tobytes())
    yield Input("raw video", ["-f", "100", "--raw", f"{WIDTH}x{HEIGHT}:gray", "raw.gray"], "raw.gray")
    (folder / "clip.cine").write_bytes(cine())
    yield Input(".cine", ["clip.cine"], "clip.cine")
    frames = b"".join(b"FRAME\n" + picture.tobytes() for picture in pictures(1))
    (folder / "clip.y4m").write_bytes(f"YUV4MPEG2 W{WIDTH} H{HEIGHT} F100:1 Ip A1:1 Cmono\n".encode() + frames)
    yield Input(".y4m", ["clip.y4m"], "clip.y4m")
    for name, data, record_bytes in event_files():
        (folder / name).write_bytes(data)
        yield Input(name, [name], name, record_bytes=record_bytes)


def event_files():
    """A dot that wanders, in each format of events: name, file, and the bytes of a record."""
    little = lambda size, *words: b"".join(word.to_bytes(size, "little") for word in words)
    events = [(64 * k, 3 + k % 40, 5 + k % 20, k % 3 != 0) for k in range(1, 400)]  # microsecond, x, y, up
    size = f"height={HEIGHT};width={WIDTH}"
    header = lambda kind: f"% format {kind};{size}\n% geometry {WIDTH}x{HEIGHT}\n% end\n".encode()
    yield "evt2.raw", header("EVT2") + b"".join(
        little(4, 8 << 28 | at // 64, up << 28 | at % 64 << 22 | x << 11 | y) for at, x, y, up in events), 4
    yield "evt21.raw", header("EVT21") + b"".join(
        little(8, 8 << 60 | at // 64 << 32, up << 60 | at % 64 << 54 | x // 32 * 32 << 43 | y << 32 | 1 << x % 32)
        for at, x, y, up in events), 8
    yield "evt3.raw", header("EVT3") + b"".join(
        little(2, 8 << 12 | at >> 12, 6 << 12 | at & 0xFFF, y, 2 << 12 | up << 11 | x) for at, x, y, up in events), 2
    yield "events.dat", f"% Height {HEIGHT}\n% Width {WIDTH}\n".encode() + b"\x0c\x08" + b"".join(
        little(4, at, up << 28 | y << 14 | x) for at, x, y, up in events), 8
    # ADΔER of version 2: units of light since the event before at the same pixel, then the mark of its end.
    told = b"".join(struct.pack(">HHBI", x, y, 6, 500 + 100 * (k + x) % 700) for k in range(3)
                    for y in range(HEIGHT) for x in range(WIDTH))
    yield "light.adder", (b"adder" + struct.pack(">BcHHIIIBBII", 2, b"b", WIDTH, HEIGHT, 120_000, 5000, 50_000, 9, 1, 0, 0) +
                          told + b"\xff" * 9), 0


def write_videos(folder):
    """A clip of each codec and container. Yields inputs."""
    (folder / "colour.rgb").write_bytes(pictures(3)[..., ::-1].tobytes())
    for name, options, notices in (
            ("h264.mp4", "-c:v libx264 -crf 12 -pix_fmt yuv420p", None),
            ("h264.mkv", "-c:v libx264 -crf 12 -pix_fmt yuv420p", None),
            ("hevc.mp4", "-c:v libx265 -crf 12 -pix_fmt yuv420p -x265-params log-level=error:pools=1", None),
            ("ffv1.mkv", "-c:v ffv1 -level 3 -slices 4 -slicecrc 1 -pix_fmt bgr0", packets),
            ("ffv1.avi", "-c:v ffv1 -level 3 -slices 4 -slicecrc 1 -pix_fmt bgr0", packets),
            ("prores.mov", "-c:v prores_ks -pix_fmt yuv422p10le", None),
            ("mjpeg.avi", "-c:v mjpeg -q:v 2 -pix_fmt yuvj420p", None),
            ("raw.avi", "-c:v rawvideo -pix_fmt bgr24", None)):
        made = subprocess.run(["ffmpeg", "-v", "error", "-y", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s",
                               f"{WIDTH}x{HEIGHT}", "-r", "100", "-i", "colour.rgb", "-threads", "1", "-fflags",
                               "bitexact", *options.split(), name], cwd=folder, check=False, capture_output=True, text=True)
        if made.returncode != 0:
            print(f"left out: this ffmpeg does not make {name}: {made.stderr.strip().splitlines()[0]}")
            continue
        yield Input(name, [name], name, notices or nowhere)


def classes_of(data):
    """The classes of a capture's bytes (docs/reference/tik-format.md): name and a list of pairs of offset and bytes."""
    found = {}

    def add(name, first, last):
        if last > first:
            found.setdefault(name, []).append((first, last - first))

    size = re.search(rb"\n(\d+) (\d+)\n(\d+)\n", data)
    raster = int(size[1]) * int(size[2]) * (3 if data[:2] == b"P6" else 1) * (2 if int(size[3]) > 255 else 1)
    block = data.index(b"TIKblock", size.end() + raster)
    fields = data.find(b"TIKfield", size.end() + raster, block)  # version 0 has none
    fields_end = fields + struct.unpack_from("<Q", data, fields + 8)[0] if fields > 0 else size.end() + raster
    add("text", 0, size.end())
    add("first picture", size.end(), size.end() + raster)
    if fields > 0:
        add("padding", size.end() + raster, fields)
        add("fields", fields, fields_end)
    add("padding", fields_end, block)
    while data[block:block + 8] == b"TIKblock":
        exposures, stored = struct.unpack_from("<QQ", data, block + 32)
        header_end, exposures_end = block + 128, block + 128 + exposures
        payload = aligned(exposures_end)
        add("block headers", block, header_end)
        add(FOR_RECOVERY, header_end, exposures_end)
        add("padding", exposures_end, payload)
        add("payloads", payload, payload + stored)
        block = aligned(payload + stored)
        add("padding", payload + stored, block)
    footer = len(data) - 128
    blocks, _, exposures = struct.unpack_from("<QQQ", data, footer + 8)
    index_end = block + 48 * blocks
    add("index", block, index_end)
    add("padding", index_end, exposures or footer)
    if exposures:
        add("exposures", exposures, footer)
    add("footer", footer, len(data))
    return found


def aligned(offset):
    return -(-offset // 64) * 64


class Bench:
    """Exposes what is damaged, and says what became of it."""

    def __init__(self, program, folder):
        self.program, self.folder = program, folder

    def run(self, words):
        environment = os.environ | {"XDG_CACHE_HOME": str(self.folder / "cache")}
        done = subprocess.run([self.program, *words], cwd=self.folder, env=environment, stdin=subprocess.DEVNULL,
                              capture_output=True, timeout=120, check=False)
        return done.returncode, done.stdout.decode(errors="replace"), done.stderr.decode(errors="replace")

    def expose(self, words):
        """The picture, None where there is none; status and what was said."""
        picture = self.folder / "picture.tif"
        picture.unlink(missing_ok=True)
        status, _, said = self.run([*EXPOSE, *words, picture.name])
        return picture.read_bytes() if picture.exists() else None, status, said

    def right(self, words):
        picture, status, said = self.expose(words)
        if status != 0:
            sys.exit(f"{' '.join(words)} fails without any damage: {said}")
        return picture, said

    def outcome(self, words, right):
        """refused, same, told or silent; else what is wrong."""
        picture, status, said = self.expose(words)
        if status == 0:
            if picture == right[0]:
                return "same"
            is_new = any(line not in right[1] for line in said.splitlines() if TELLS_OF_DAMAGE.match(line))
            return "told" if is_new else "silent"
        if status == 3 and picture is None and said.strip():
            return "refused"
        # A header that says nothing of the rate any more leaves it to be stated.
        if status == 2 and picture is None and "--fps" in said:
            return "refused"
        return f"status {status}, {'a' if picture else 'no'} picture: {said[-200:]}"


    def is_lost_by_recovery(self, capture, at):
        """Whether recover, of a file that was cut off, keeps nothing of the block with this byte."""
        whole, recovered = capture.read_bytes(), self.folder / "recovered.tik"
        recovered.unlink(missing_ok=True)
        (self.folder / "cut.tik").write_bytes(whole[:-1])
        status, _, said = self.run(["recover", "cut.tik", recovered.name])
        if status == 3 and said.strip() and not recovered.exists():
            return True
        return status == 0 and recovered.read_bytes()[:at + 1] != whole[:at + 1]


def damaged(data, at, bit):
    changed = bytearray(data)
    changed[at] ^= 1 << bit
    return bytes(changed)


def check_inputs(report, bench, flips, seed):
    check_each(report, bench, flips, seed,
               [*write_stills(bench.folder), *write_photron(bench.folder), *write_recordings(bench.folder)])


def check_videos(report, bench, flips, seed):
    if shutil.which("ffmpeg") is None:
        print("SKIPPED: the ffmpeg command is missing, which makes videos")
        return
    made = list(write_videos(bench.folder))
    report.hold(made, f"{len(made)} kinds of videos are damaged")
    check_each(report, bench, flips, seed, made)


def check_each(report, bench, flips, seed, inputs):
    for each in inputs:
        path = bench.folder / each.damaged
        data, right, draw = path.read_bytes(), bench.right(each.words), random.Random(seed)
        wrong, came, silent = [], Counter(), 0
        for cut in CUTS:
            path.write_bytes(data[:-cut])
            outcome = bench.outcome(each.words, right)
            came[outcome] += 1
            is_whole = each.record_bytes > 0 and cut % each.record_bytes == 0
            if outcome not in ("refused", "same", "told") and not (is_whole and outcome == "silent"):
                wrong.append(f"cut by {cut}: {outcome}")
        path.write_bytes(data)
        noticed = each.notices(path)
        for k in range(flips):
            # Half of them where they must be noticed, if anywhere.
            first, count = draw.choice(noticed) if noticed and k % 2 == 0 else (0, len(data))
            at, bit = first + draw.randrange(count), draw.randrange(8)
            path.write_bytes(damaged(data, at, bit))
            outcome = bench.outcome(each.words, right)
            came[outcome] += 1
            is_noticed = any(first <= at < first + count for first, count in noticed)
            silent += outcome == "silent"
            if outcome not in ("refused", "same", "told") and (outcome != "silent" or is_noticed):
                wrong.append(f"bit {bit} of byte {at} of {len(data)}: {outcome}")
        path.write_bytes(data)
        report.hold(not wrong, f"{each.name}: " + summary(came) + "".join(f"\n    {one}" for one in wrong[:SHOWN]))


def summary(came):
    return ", ".join(f"{count} {outcome}" for outcome, count in sorted(came.items()) if " " not in outcome)


# How captures are made from stills: with a rate or with times, grey and colour, packed and not.
CAPTURES = {
    "packed": "encode -f 100 --block-samples 4 png {}",
    "not packed": "encode -f 100 --codec none --block-samples 4 --pixel-aspect 2:1 png-grey {}",
    "16 bits, with times": "encode --codec lz4 --tiles records --block-samples 4 table.csv {}",
}


def check_captures(report, bench, flips, seed):
    list(write_stills(bench.folder))
    table = "".join(f"png-16/{k}.png,{10_000_000 * k + 7 * k * k},2000000\n" for k in range(PICTURES))
    (bench.folder / "table.csv").write_text("file,start_ns,exposure_ns\n" + table)
    path = bench.folder / "c.tik"
    for name, line in CAPTURES.items():
        status, _, said = bench.run(over(line.format(path.name).split()))
        if status != 0:
            sys.exit(f"{line} fails: {said}")
        data, right, draw = path.read_bytes(), bench.right([path.name]), random.Random(seed)
        for kind, parts in classes_of(data).items():
            wrong, came = [], Counter()
            for _ in range(flips):
                first, count = draw.choice(parts)
                at, bit = first + draw.randrange(count), draw.randrange(8)
                path.write_bytes(damaged(data, at, bit))
                outcome = bench.outcome([path.name], right)
                came[outcome] += 1
                where = f"bit {bit} of byte {at} of {len(data)}"
                if outcome not in ("refused", "same"):
                    wrong.append(f"{where}: {outcome}")
                if kind == FOR_RECOVERY:
                    came["refused"] += bench.is_lost_by_recovery(path, at)
                # What an exposure of everything refuses, check says.
                checked, told, _ = bench.run(["check", path.name])
                if (checked == 3) != (outcome == "refused"):
                    wrong.append(f"{where}: {outcome}, but check ends with {checked}: {told[-200:]}")
            if kind == FOR_RECOVERY and came["refused"] != flips:
                wrong.append(f"recover kept {flips - came['refused']}")
            if kind != "padding" and came["refused"] == 0:
                wrong.append("not one flip was noticed")
            report.hold(not wrong, f"capture, {name}, {kind}: " + summary(came) +
                        "".join(f"\n    {one}" for one in wrong[:SHOWN]))


def check_golden(report, bench, flips, seed):
    path = bench.folder / "c.tik"
    captures = sorted(GOLDEN.glob("*.tik"))
    report.hold(captures, f"{len(captures)} captures of earlier programs are damaged")
    for golden in captures:
        data, draw, wrong, came = golden.read_bytes(), random.Random(seed), [], Counter()
        path.write_bytes(data)
        right = bench.right([path.name])

        def check(changed, where, must_be_noticed):
            path.write_bytes(changed)
            outcome = bench.outcome([path.name], right)
            checked, told, _ = bench.run(["check", path.name])
            came[outcome] += 1
            # An exposure need not see all that check sees.
            if outcome not in ("refused", "same") or (outcome == "refused" and checked != 3):
                wrong.append(f"{where}: {outcome}, and check ends with {checked}: {told[-200:]}")
            elif must_be_noticed and checked != 3:
                wrong.append(f"{where}: check ends with {checked}: {told[-200:]}")

        for left in (len(data) - 1, len(data) - 100, len(data) // 2, 10):
            check(data[:left], f"cut to {left} of {len(data)} bytes", True)
        for kind, parts in classes_of(data).items():
            for _ in range(-(-flips // 8)):
                first, count = draw.choice(parts)
                at, bit = first + draw.randrange(count), draw.randrange(8)
                check(damaged(data, at, bit), f"{kind}, bit {bit} of byte {at} of {len(data)}",
                      kind not in ("padding", FOR_RECOVERY))
        report.hold(not wrong, f"{golden.stem}: " + summary(came) + "".join(f"\n    {one}" for one in wrong[:SHOWN]))


PARTS = {"inputs": check_inputs, "videos": check_videos, "captures": check_captures, "golden": check_golden}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=Path, required=True)
    parser.add_argument("--work", type=Path, required=True)
    parser.add_argument("--flips", type=int, default=8, help="of each format, and of each class of a capture's bytes")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", choices=PARTS)
    arguments = parser.parse_args()
    report = Report()
    for part, check in PARTS.items():
        if arguments.only in (None, part):
            folder = (arguments.work / part).resolve()
            shutil.rmtree(folder, ignore_errors=True)
            folder.mkdir(parents=True)
            check(report, Bench(arguments.program.resolve(), folder), arguments.flips, arguments.seed)
    report.end(f" (--seed {arguments.seed})")


if __name__ == "__main__":
    main()
