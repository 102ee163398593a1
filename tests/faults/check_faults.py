#!/usr/bin/env python3
"""Lets calls of the system fail, and kills the program, in the middle of every command that writes.

    check_faults.py --program nutik-cl --preload libfail_calls.so --work FOLDER [--kills N] [--points N]
                    [--only SECTION]

    calls   the n-th open, read, write, fsync, rename, mmap or large malloc fails, once or from then on
    kills   SIGKILL, SIGTERM or SIGINT at a random moment

Whatever happens, there is the old output or the whole new one; a video that SIGTERM or SIGINT ends has its frames so
far. A call that failed is told in a sentence, with an exit status above 0, and leaves no temporary file; or the program
got on without it, and the output is the right one.
"""

import argparse
import errno
import os
import random
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import cv2
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tools"))
from report import Report  # noqa: E402

WIDTH, HEIGHT, PICTURES = 160, 120, 24
ERRORS = {"open": [errno.EMFILE, errno.EACCES], "read": [errno.EIO], "write": [errno.ENOSPC, errno.EIO],
          "fsync": [errno.EIO], "rename": [errno.ENOSPC], "mmap": [errno.ENOMEM], "malloc": [errno.ENOMEM]}

# Command lines without the program, and what each writes: the same bytes whenever it is run.
COMMANDS = {
    "encode": ("clip/*.pgm -f 100 {}", "new.tik"),
    "encode, not packed": ("encode --codec none -f 100 clip/*.pgm {}", "new.tik"),
    "expose to PNG": ("--start 10ms --exposure 80ms clip.tik {}", "new.png"),
    "expose to TIFF": ("--start 10ms --exposure 80ms clip.tik {}", "new.tif"),
    "expose to PFM": ("--start 10ms --exposure 80ms clip.tik {}", "new.pfm"),
    "expose a clip": ("-f 100 --start 10ms --exposure 80ms clip/*.pgm {}", "new.pgm"),
    "video": ("video clip.tik {}", "new.avi"),
    "mask": ("mask --moving clip.tik {}", "new.pgm"),
    "contact": ("contact clip.tik {}", "new.png"),
    "activity": ("activity clip.tik {}", "new.png"),
    "trace": ("trace --start 10ms --exposure 80ms --pixel 20,20 clip.tik {}", "new.csv"),
    "recover": ("recover cut.tik {}", "new.tik"),
    "noise": ("noise clip/*.pgm -o {}", "new.noise"),
}


class Bench:
    """A folder with inputs, in which the program runs once and again."""

    def __init__(self, program, folder):
        self.program, self.folder = program, folder
        shutil.rmtree(folder, ignore_errors=True)
        (folder / "clip").mkdir(parents=True)
        draw = random.Random(1)
        still = bytes(draw.randrange(60, 70) for _ in range(WIDTH * HEIGHT))
        for k in range(PICTURES):
            picture = bytearray(still)
            for y in range(20, 60):
                at = y * WIDTH + 5 * k
                picture[at:at + 30] = b"\xd0" * 30
            (folder / f"clip/{k:02}.pgm").write_bytes(b"P5 %d %d 255\n" % (WIDTH, HEIGHT) + picture)
        self.run("encode --codec none -f 100 clip/*.pgm clip.tik".split(), {})
        whole = (folder / "clip.tik").read_bytes()
        (folder / "cut.tik").write_bytes(whole[:-100])

    def command(self, name):
        """Words of the command line; the output's path."""
        line, output = COMMANDS[name]
        return line.format(output).split(), self.folder / output

    def start(self, words, settings):
        environment = os.environ | {"NUTIK_SELF_TEST": "off"} | settings
        return subprocess.Popen([self.program, *words], cwd=self.folder, env=environment, stdin=subprocess.DEVNULL,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE)

    def run(self, words, settings, limit=120):
        process = self.start(words, settings)
        out, err = process.communicate(timeout=limit)
        return process.returncode, err.decode(errors="replace")

    def right_output(self, name):
        words, output = self.command(name)
        output.unlink(missing_ok=True)
        status, err = self.run(words, {})
        if status != 0:
            sys.exit(f"{name} fails without any fault: {err}")
        return output.read_bytes()

    def parts(self):
        return sorted(str(path.relative_to(self.folder)) for path in self.folder.rglob("*.part"))

    def clear_parts(self):
        for path in self.folder.rglob("*.part"):
            path.unlink()


def older(right):
    """Another file of the same kind, for files of other kinds are not replaced."""
    return right + b"\n"


def spread(count, points):
    """Up to so many of 1 … count: the first ones, the last ones, and some between."""
    if count <= points:
        return list(range(1, count + 1))
    third = points // 3
    middle = random.Random(count).sample(range(third + 1, count - third + 1), points - 2 * third)
    return sorted({*range(1, third + 1), *middle, *range(count - third + 1, count + 1)})


def check_calls(report, bench, preload, points):
    for name in COMMANDS:
        right = bench.right_output(name)
        old = older(right)
        words, output = bench.command(name)
        tried, wrong = 0, []
        for call, errors in ERRORS.items():
            counted = bench.folder / "calls"
            settings = {"LD_PRELOAD": str(preload), "NUTIK_FAIL_CALL": call, "NUTIK_FAIL_FOLDER": str(bench.folder),
                        "NUTIK_FAIL_REPORT": str(counted), "NUTIK_FAIL_AT": "0"}
            output.write_bytes(old)
            counted.write_text("0")
            bench.run(words, settings)
            count = int(counted.read_text())
            for at in spread(count, points):
                for goes_on in ("off", "on"):
                    error = errors[at % len(errors)]
                    output.write_bytes(old)
                    status, err = bench.run(words, settings | {
                        "NUTIK_FAIL_AT": str(at), "NUTIK_FAIL_ERROR": str(error), "NUTIK_FAIL_AFTER": goes_on})
                    tried += 1
                    flaw = flaw_of(status, err, output.read_bytes(), old, right, bench.parts())
                    bench.clear_parts()
                    if flaw:
                        wrong.append(f"{call} {at} of {count} ({os.strerror(error)}, then {goes_on}): {flaw}")
        report.hold(not wrong, f"{name}: {tried} faults" + "".join(f"\n    {each}" for each in wrong[:12]))


def flaw_of(status, err, output, old, right, parts):
    """What is wrong about how a run ended; empty where nothing is."""
    if output not in (old, right):
        return "the output is neither the old one nor the right one"
    if status == 0:
        return "" if output == right else "status 0 without the output"
    if status < 0:
        return f"ended by signal {-status}: {err[-200:]}"
    if parts:
        return f"left {', '.join(parts)}"
    # Up to the loader's own, where a library could not be loaded.
    if "nutik-cl" not in err and "error" not in err:
        return f"no message: {err[-200:]!r}"
    return ""


def is_beginning(video, right):
    """Whether a video's frames are the first of the right one's, at least one."""
    whole = video.with_name("whole.avi")
    whole.write_bytes(right)
    frames, expected = frames_of(video), frames_of(whole)
    return 0 < len(frames) <= len(expected) and all(map(np.array_equal, frames, expected))


def frames_of(video):
    reader, frames = cv2.VideoCapture(str(video)), []
    while True:
        read, frame = reader.read()
        if not read:
            return frames
        frames.append(frame)


def check_kills(report, bench, kills):
    draw = random.Random(7)
    for name in COMMANDS:
        right = bench.right_output(name)
        old = older(right)
        words, output = bench.command(name)
        began = time.monotonic()
        bench.run(words, {})
        whole = time.monotonic() - began
        wrong, finished = [], 0
        each = max(1, kills // len(COMMANDS))
        for _ in range(each):
            output.write_bytes(old)
            process = bench.start(words, {})
            time.sleep(draw.random() * whole)
            kind = draw.choice([signal.SIGKILL, signal.SIGTERM, signal.SIGINT])
            process.send_signal(kind)
            process.communicate(timeout=60)
            finished += process.returncode == 0
            is_kept = output.suffix == ".avi" and kind != signal.SIGKILL and is_beginning(output, right)
            if not is_kept and output.read_bytes() not in (old, right):
                wrong.append(f"{kind.name}: the output is neither the old one nor the right one")
            if kind != signal.SIGKILL and bench.parts():
                wrong.append(f"{kind.name}: left {', '.join(bench.parts())}")
            bench.clear_parts()
        report.hold(not wrong, f"{name}: {each} signals, {finished} after its end" +
                    "".join(f"\n    {each}" for each in wrong[:12]))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=Path, required=True)
    parser.add_argument("--preload", type=Path, required=True)
    parser.add_argument("--work", type=Path, required=True)
    parser.add_argument("--points", type=int, default=6, help="of the calls of a kind, that fail one by one")
    parser.add_argument("--kills", type=int, default=200)
    parser.add_argument("--only", choices=["calls", "kills"])
    arguments = parser.parse_args()
    report = Report()
    work = (arguments.work / (arguments.only or "all")).resolve()
    bench = Bench(arguments.program.resolve(), work)
    if arguments.only != "kills":
        check_calls(report, bench, arguments.preload.resolve(), arguments.points)
    if arguments.only != "calls":
        check_kills(report, bench, arguments.kills)
    report.end()


if __name__ == "__main__":
    main()
