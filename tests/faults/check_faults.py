#!/usr/bin/env python3
"""Lets calls of the system and of the device fail, and kills the program, in the middle of every command.

    check_faults.py --program nutik-cl --libraries FOLDER --work FOLDER [--kills N] [--points N] [--only SECTION]

    calls   the n-th open, read, write, fsync, rename, mapping, large allocation or start of a thread fails, once or
            from then on; somebody else makes the input shorter right before the output gets its name, or right after
            that
    device  the n-th call of OpenCL of a kind fails, once or from then on, in every command that uses a device
    kills   SIGKILL, SIGTERM or SIGINT at a random moment, or once a temporary file is seen

Whatever happens, there is the old output or the whole new one; a video that SIGTERM or SIGINT ends has its frames so
far. A call that failed is told in a sentence, with an exit status above 0, and leaves no temporary file; or the program
got on without it, and the output is the right one. A device that failed is status 4, and the sentence names the
reference.
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
from collections import Counter
from pathlib import Path

import cv2
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tools"))
from report import Report  # noqa: E402
from words import over  # noqa: E402

WIDTH, HEIGHT, PICTURES = 160, 120, 24
ERRORS = {"open": [errno.EMFILE, errno.EACCES], "read": [errno.EIO], "write": [errno.ENOSPC, errno.EIO],
          "fsync": [errno.EIO], "rename": [errno.ENOSPC], "mmap": [errno.ENOMEM],
          "malloc": [errno.ENOMEM], "thread": [errno.EAGAIN]}
# Those without which no output appears whole and for good.
NEEDED_CALLS = ["open", "write", "fsync", "rename"]

# Of OpenCL, by kind of call (fail_device.cpp).
OUT_OF_RESOURCES, OUT_OF_HOST_MEMORY, NO_ALLOCATION, LOST_EVENT, NO_BUILD = -5, -6, -4, -14, -11
DEVICE_ERRORS = {"start": [OUT_OF_RESOURCES, OUT_OF_HOST_MEMORY], "build": [NO_BUILD, OUT_OF_HOST_MEMORY],
                 "arguments": [OUT_OF_RESOURCES, OUT_OF_HOST_MEMORY],
                 "allocate": [NO_ALLOCATION, OUT_OF_RESOURCES, OUT_OF_HOST_MEMORY],
                 "enqueue": [OUT_OF_RESOURCES, OUT_OF_HOST_MEMORY, NO_ALLOCATION],
                 "wait": [LOST_EVENT, OUT_OF_RESOURCES]}
DEVICE_STATUS, INPUT_STATUS = 4, 3
# Other tests have compiled kernels there.
COMPILED = {"POCL_CACHE_DIR": f"{os.environ.get('XDG_CACHE_HOME') or Path.home() / '.cache'}/pocl/kcache"}

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
    "retime": ("retime -f 50 clip.tik {}", "new.tik"),
    "background": ("background clip.tik {}", "new.png"),
    "join": ("join clip.tik packed.tik -o {}", "new.tik"),
    "thumbnail": ("thumbnail clip.tik {}", "new.png"),
    "noise": ("noise clip/*.pgm -o {}", "new.noise"),
}

# The same, of those that a device computes.
DEVICE_COMMANDS = {
    "expose": ("--start 10ms --exposure 80ms clip.tik {}", "new.png"),
    "expose with a mask": ("-m mask.pgm -k two.fn --precision fixed packed.tik {}", "new.pfm"),
    "expose a clip": ("-f 100 --start 10ms --exposure 80ms clip/*.pgm {}", "new.png"),
    "series": ("--start 10ms --exposure 40ms --every 80ms --count 2 clip.tik -o new-%d.png", "new-0.png new-1.png"),
    "batch": ("batch list.txt packed.tik", "new-a.png new-b.pfm"),
    "series that takes sums over": ("--exposure 310ms --every 7ms --count 3 long.tik -o new-%d.png",
                                    "new-0.png new-1.png new-2.png"),
    "video": ("video --out-fps 25 clip.tik {}", "new.avi"),
    "contact": ("contact --every 120ms --exposure 40ms clip.tik {}", "new.png"),
    "sweep": ("sweep --start 10ms --exposure 40ms --shift 0..80ms/40ms clip.tik new.png --each new-%d.pgm",
              "new.png new-0.pgm new-1.pgm new-2.pgm"),
    "validate": ("validate --runs 1 --start 10ms --exposure 80ms clip.tik", ""),
    "mask": ("mask --moving --start 10ms --exposure 80ms --preview new.png clip.tik new.pgm", "new.png new.pgm"),
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
        self.run("encode --codec zstd --block-samples 6 -f 100 clip/*.pgm packed.tik".split(), {})
        # Of 25 blocks, of which a long exposure holds a group whose sums are kept.
        (folder / "long.raw").write_bytes(draw.randbytes(24 * 16 * 400))
        self.run("encode --raw 24x16:gray --block-samples 16 -f 1000 long.raw long.tik".split(), {})
        whole = (folder / "clip.tik").read_bytes()
        (folder / "cut.tik").write_bytes(whole[:-100])
        half = WIDTH * HEIGHT // 2
        (folder / "mask.pgm").write_bytes(b"P5 %d %d 255\n" % (WIDTH, HEIGHT) + bytes(half) + b"\x80" * half)
        (folder / "two.fn").write_text("M0 [0:1], [90000000:1], [90000001:0]\nM128 [50000000:0], [60000000:1]\n")
        (folder / "list.txt").write_text("--start 0s --exposure 60ms new-a.png\n-m mask.pgm -k two.fn new-b.pfm\n")

    def command(self, line):
        """Words of a command line, and what it writes."""
        text, outputs = line
        return over(text.format(outputs).split()), [self.folder / output for output in outputs.split()]

    def start(self, words, settings):
        environment = os.environ | {"NUTIK_SELF_TEST": "off", "XDG_CACHE_HOME": str(self.folder / "cache")} | settings
        return subprocess.Popen([self.program, *words], cwd=self.folder, env=environment, stdin=subprocess.DEVNULL,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE)

    def run(self, words, settings, limit=120):
        process = self.start(words, settings)
        out, err = process.communicate(timeout=limit)
        return process.returncode, err.decode(errors="replace")

    def right_outputs(self, line):
        words, outputs = self.command(line)
        for output in outputs:
            output.unlink(missing_ok=True)
        for settings in COMPILED, {}:
            status, err = self.run(words, settings)
            if status != 0:
                sys.exit(f"{line[0]} fails without any fault: {err}")
        return [output.read_bytes() for output in outputs]

    def parts(self):
        return sorted(str(path.relative_to(self.folder)) for path in self.folder.rglob("*.part"))

    def wait_for_parts(self, process):
        """Until there is a temporary file, or the process has ended."""
        while process.poll() is None and not self.parts():
            pass

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


class Faults:
    """What a library that is preloaded lets fail, one call after another."""

    def __init__(self, library, errors, needed, settings=None, status=None, hint="", to_text=str):
        self.library, self.errors, self.needed, self.settings = library, errors, needed, settings or {}
        self.status, self.hint, self.to_text = status, hint, to_text

    def flaw_of(self, status, err, outputs, right, parts):
        """What is wrong about how a run ended; empty where nothing is. outputs: the old one, and what there is."""
        if any(found not in (older(wanted), wanted) for found, wanted in zip(outputs, right)):
            return "an output is neither the old one nor the right one"
        if status == 0:
            return "" if outputs == right else "status 0 without the output"
        if status < 0:
            return f"ended by signal {-status}: {err[-200:]}"
        if self.status is not None and status != self.status:
            return f"status {status}: {err[-200:]}"
        if parts:
            return f"left {', '.join(parts)}"
        # Up to the loader's own, where a library could not be loaded.
        if "nutik-cl" not in err and "error" not in err:
            return f"no message: {err[-200:]!r}"
        return "" if self.hint in err else f"no word of a way out: {err[-300:]!r}"


def check_calls(report, bench, faults, commands, points):
    for name, line in commands.items():
        right = bench.right_outputs(line)
        words, outputs = bench.command(line)

        def run(settings):
            for output, wanted in zip(outputs, right):
                output.write_bytes(older(wanted))
            return bench.run(words, {"LD_PRELOAD": str(faults.library), **faults.settings} | settings)

        tried, told, wrong = 0, 0, []
        for call, errors in faults.errors.items():
            counted = bench.folder / "calls"
            counted.write_text("0")
            run({"NUTIK_FAIL_CALL": call, "NUTIK_FAIL_REPORT": str(counted), "NUTIK_FAIL_AT": "0"})
            count = int(counted.read_text())
            if count == 0 and call in faults.needed:
                wrong.append(f"it makes no call of the kind {call}: left out, or another function that is not seen")
            for at in spread(count, points):
                for goes_on in ("off", "on"):
                    error = errors[at % len(errors)]
                    status, err = run({"NUTIK_FAIL_CALL": call, "NUTIK_FAIL_AT": str(at),
                                       "NUTIK_FAIL_ERROR": str(error), "NUTIK_FAIL_AFTER": goes_on})
                    tried += 1
                    told += status > 0
                    found = [output.read_bytes() for output in outputs]
                    flaw = faults.flaw_of(status, err, found, right, bench.parts())
                    bench.clear_parts()
                    if flaw:
                        wrong.append(f"{call} {at} of {count} ({faults.to_text(error)}, then {goes_on}): {flaw}")
        # Where nothing fails nothing was tried.
        report.hold(not wrong and told > 0, f"{name}: {tried} faults, {told} of them errors" +
                    "".join(f"\n    {each}" for each in wrong[:12]))


def check_cut_inputs(report, bench, faults, commands):
    """An input that becomes shorter: told as long as it may have been read so, and no harm to an output that is right."""
    refused = 0
    for name, line in commands.items():
        [right] = bench.right_outputs(line)
        words, [output] = bench.command(line)
        [cut] = [bench.folder / word for word in words if word.endswith(".tik") and bench.folder / word != output][:1] \
            or [bench.folder / "clip/00.pgm"]
        whole, wrong = cut.read_bytes(), []
        for moment in ("fsync", "rename"):
            output.write_bytes(older(right))
            status, err = bench.run(words, {"LD_PRELOAD": str(faults.library), **faults.settings,
                                            "NUTIK_CUT_FILE": str(cut), "NUTIK_CUT_AT": moment})
            is_cut = cut.read_bytes() != whole
            cut.write_bytes(whole)
            found = output.read_bytes()
            if not is_cut:
                wrong.append(f"{moment}: there was none")
            elif moment == "fsync" and status == INPUT_STATUS:
                refused += 1
                if found != older(right) or bench.parts() or f"{cut.name} changed" not in err:
                    wrong.append(f"{moment}: not refused as it should be: {err[-200:]}")
            elif status != 0 or found != right:
                wrong.append(f"{moment}: status {status}, the output is {'' if found == right else 'not '}right: {err[-200:]}")
            bench.clear_parts()
        report.hold(not wrong, f"{name}: its input becomes shorter" + "".join(f"\n    {each}" for each in wrong))
    report.hold(refused > 0, f"{refused} inputs that became shorter before an output was whole were refused")


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


SIGNALS = {signal.SIGKILL: "", signal.SIGTERM: "terminated", signal.SIGINT: "interrupted"}


def flaw_of_end(kind, status, err):
    """Whether a process ended as a signal demands, or had ended before; or before it could know of signals."""
    if status in (0, -kind):
        return ""
    if kind == signal.SIGKILL or status != 128 + kind:
        return f"status {status}: {err[-200:]}"
    return "" if SIGNALS[kind] in err else f"no word of it: {err[-200:]!r}"


def check_kills(report, bench, kills):
    draw = random.Random(7)
    in_the_middle = Counter()
    for name, line in COMMANDS.items():
        [right] = bench.right_outputs(line)
        old = older(right)
        words, [output] = bench.command(line)
        began = time.monotonic()
        bench.run(words, {})
        whole = time.monotonic() - began
        wrong, finished = [], 0
        each = -(-kills // len(COMMANDS))
        for at in range(each):
            output.write_bytes(old)
            process = bench.start(words, {})
            kind = draw.choice(list(SIGNALS))
            if at % 2:
                # Writing is so short a part of the work that a random moment seldom falls into it.
                bench.wait_for_parts(process)
            else:
                time.sleep(draw.random() * whole)
            process.send_signal(kind)
            _, said = process.communicate(timeout=60)
            status, found, parts = process.returncode, output.read_bytes(), bench.parts()
            finished += status == 0
            # With its temporary file, or told by whoever had begun to look for signals.
            in_the_middle[kind] += status == 128 + kind or (status == -kind and bool(parts))
            flaw = flaw_of_end(kind, status, said.decode(errors="replace"))
            if flaw:
                wrong.append(f"{kind.name}: {flaw}")
            is_kept = output.suffix == ".avi" and kind != signal.SIGKILL and is_beginning(output, right)
            if found not in ((right,) if status == 0 else (old, right)) and not (is_kept and status != 0):
                wrong.append(f"{kind.name}, status {status}: the output is neither the old one nor the right one")
            if kind != signal.SIGKILL and parts:
                wrong.append(f"{kind.name}: left {', '.join(parts)}")
            bench.clear_parts()
        report.hold(not wrong, f"{name}: {each} signals, {finished} after its end" +
                    "".join(f"\n    {each}" for each in wrong[:12]))
    for kind in SIGNALS:
        report.hold(in_the_middle[kind] > 0, f"{kind.name} came {in_the_middle[kind]} times in the middle of the work")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=Path, required=True)
    parser.add_argument("--libraries", type=Path, required=True, help="folder of what is preloaded")
    parser.add_argument("--work", type=Path, required=True)
    parser.add_argument("--points", type=int, default=6, help="of the calls of a kind, that fail one by one")
    parser.add_argument("--kills", type=int, default=200)
    parser.add_argument("--only", choices=["calls", "device", "kills"])
    arguments = parser.parse_args()
    report = Report()
    work = (arguments.work / (arguments.only or "all")).resolve()
    bench = Bench(arguments.program.resolve(), work)
    libraries = arguments.libraries.resolve()
    if arguments.only in (None, "calls"):
        faults = Faults(libraries / "libfail_calls.so", ERRORS, NEEDED_CALLS, {"NUTIK_FAIL_FOLDER": str(bench.folder)},
                        to_text=os.strerror)
        check_calls(report, bench, faults, COMMANDS, arguments.points)
        check_cut_inputs(report, bench, faults, COMMANDS)
    if arguments.only in (None, "device"):
        faults = Faults(libraries / "libfail_device.so", DEVICE_ERRORS, DEVICE_ERRORS, status=DEVICE_STATUS, hint="the reference",
                        to_text=lambda error: f"OpenCL error {error}")
        check_calls(report, bench, faults, DEVICE_COMMANDS, arguments.points)
    if arguments.only in (None, "kills"):
        check_kills(report, bench, arguments.kills)
    report.end()


if __name__ == "__main__":
    main()
