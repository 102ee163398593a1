#!/usr/bin/env python3
"""Commands among files that they did not make: nothing but the outputs that were named may change.

    check_foreign.py --program nutik-cl --libraries FOLDER --work FOLDER

Files, folders and links stand in TMPDIR, in the folder of the outputs and in the working folder, under all names that
the program ever gave to something temporary: as users' own, or as what a killed process left. Compared are names, bytes,
modes, times, and where links lead. At last programs write one output at a time where locks of files lock nothing, as on
network file systems: there is what one of them wrote, whole.
"""

import argparse
import hashlib
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tools"))
from report import Report  # noqa: E402
from words import over  # noqa: E402

WIDTH, HEIGHT, PICTURES = 64, 48, 24
WRITER_ROUNDS = 20
OLD_S = 1_000_000_000  # long before any minute that somebody may wait

# Command lines, what each writes into the folder `out`, and what comes by its pipe.
COMMANDS = (
    ("encode -f 100 clip/*.pgm {}", "new.tik"),
    ("--start 10ms --exposure 80ms clip.tik {}", "new.png"),
    ("--start 10ms --exposure 80ms clip.tik {}", "new.tif"),
    ("--start 10ms --exposure 80ms clip.tik {}", "new.exr"),
    ("--start 10ms --exposure 80ms clip.tik {}", "new.jpg"),
    ("-f 100 --start 10ms --exposure 80ms clip/*.pgm {}", "new.pgm"),
    ("--renderer reference --start 10ms --exposure 80ms out/.kept.png.nutik.part {}", "kept.png"),
    ("recover .big.tik.nutik.part {}", "big.tik"),
    ("recover .big.tik.nutik-0123456789abcdef.part {}", "big.tik"),
    ("recover out/.big.tik.nutik.part {}", "big.tik"),
    ("retime -f 50 .kept.tik.nutik.part {}", "kept.tik"),
    ("join clip.tik clip.tik -o {}", "new.tik"),
    ("batch list.txt clip.tik", "new.png new.pfm"),
    ("--start 10ms --exposure 40ms --every 80ms --count 2 clip.tik -o out/new-%d.png", "new-0.png new-1.png"),
    ("video clip.tik {}", "new.avi"),
    ("contact clip.tik {}", "new.png"),
    ("contact -f 100 clip/*.pgm {}", "new.png"),
    ("background clip.tik {}", "new.png"),
    ("study clip.tik {}", "new.png new.pgm new.fn new.txt"),
    ("activity clip.tik {}", "new.png"),
    ("mask --moving clip.tik {}", "new.pgm"),
    ("trace --start 10ms --exposure 80ms --pixel 20,20 clip.tik {}", "new.csv"),
    ("thumbnail clip.tik {}", "new.png"),
    ("noise clip/*.pgm -o {}", "new.noise"),
    ("info clip.tik", ""),
    ("--start 10ms --exposure 80ms clip.tik -", ""),
)


class Bench:
    """Inputs, and all around them what is none of the program's."""

    def __init__(self, program, folder):
        self.program, self.folder, self.out = program, folder, folder / "out"
        shutil.rmtree(folder, ignore_errors=True)
        for name in ("clip", "out", "tmp"):
            (folder / name).mkdir(parents=True)
        for k in range(PICTURES):
            picture = bytearray(60 + (x * 7 + x // WIDTH * 3) % 10 for x in range(WIDTH * HEIGHT))
            for y in range(10, 30):
                at = y * WIDTH + 2 * k
                picture[at:at + 12] = b"\xd0" * 12
            (folder / f"clip/{k:02}.pgm").write_bytes(b"P5 %d %d 255\n" % (WIDTH, HEIGHT) + picture)
        self.end_of("encode --block-samples 6 -f 100 clip/*.pgm clip.tik")
        (folder / "list.txt").write_text("--exposure 60ms out/new.png\n--exposure 30ms out/new.pfm\n")
        self.plant()

    def plant(self):
        """Folders, files and links under names as the program's, and captures that killed processes left."""
        whole = (self.folder / "clip.tik").read_bytes()
        for leftover in (".big.tik.nutik.part", ".big.tik.nutik-0123456789abcdef.part", "out/.big.tik.nutik.part",
                         "out/.big.tik.nutik-1.part"):
            (self.folder / leftover).write_bytes(whole[:-100])
        for leftover in (".kept.tik.nutik.part", "out/.kept.tik.nutik.part", "out/.kept.png.nutik.part"):
            (self.folder / leftover).write_bytes(whole)
        for place in (self.folder, self.out, self.folder / "tmp"):
            for name in ("nutik-photos", "nutik-abcdef", "nutik-Ab3xYz"):
                (place / name / "2019").mkdir(parents=True)
                (place / name / "2019/wedding.jpg").write_bytes(b"\xff\xd8\xff precious")
                (place / name / "capture.tik").write_bytes(whole[:500])
            (place / "precious").write_text("precious")
            os.link(place / "precious", place / "nutik-000000")
            (place / "nutik-111111").symlink_to("nutik-photos")
            (place / "nutik-222222").symlink_to("absent")
        outputs = sorted({output for _, outputs in COMMANDS for output in outputs.split()})
        of_earlier_versions = ["nutik-picture.png", "nutik-picture", "capture.tik"]
        for folder, names in ((self.out, outputs), (self.folder / "tmp", of_earlier_versions)):
            for name in names:
                for k, part in enumerate((".nutik.part", ".nutik-1.part", ".nutik-2.part", ".nutik-3.part")):
                    temporary = folder / f".{name}{part}"
                    if temporary.exists():
                        continue
                    if k == 0:
                        temporary.write_text("a user's own")
                    elif k == 1:
                        temporary.symlink_to("precious")
                    elif k == 2:
                        os.link(folder / "precious", temporary)
                    else:
                        temporary.mkdir()
                        (temporary / "kept").write_text("precious")
        for path in [*self.folder.rglob("*"), self.folder]:
            os.utime(path, (OLD_S, OLD_S), follow_symlinks=False)

    def start(self, words, settings=None):
        environment = os.environ | (settings or {}) | {"NUTIK_SELF_TEST": "off", "TMPDIR": str(self.folder / "tmp"),
                                    "XDG_CACHE_HOME": str(self.folder.parent / "foreign-cache"),
                                    "POCL_CACHE_DIR": str(self.folder.parent / "foreign-cache/pocl")}
        return subprocess.Popen([self.program, *words], cwd=self.folder, env=environment, stdin=subprocess.DEVNULL,
                                stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)

    def end_of(self, line):
        process = self.start(over(line.split()))
        _, said = process.communicate(timeout=120)
        if process.returncode != 0:
            sys.exit(f"{line}: status {process.returncode}: {said.decode(errors='replace')}")

    def found(self):
        """All there is: kind, mode, size, time, content. An output changes its folder's time."""
        def facts(path):
            status = path.lstat()
            content = (os.readlink(path) if path.is_symlink() else
                       hashlib.sha256(path.read_bytes()).hexdigest() if path.is_file() else "")
            time_ns = 0 if path == self.out else status.st_mtime_ns
            return status.st_mode, status.st_nlink, status.st_size if content else 0, time_ns, content
        return {str(path.relative_to(self.folder)): facts(path) for path in [self.folder, *self.folder.rglob("*")]}


def changes(before, after):
    return ([f"{name} is gone" for name in before if name not in after] +
            [f"{name} changed" for name in before if name in after and before[name] != after[name]] +
            [f"{name} is new" for name in after if name not in before])


def check_writers(report, bench, library):
    """Captures of one name, of different lengths, written at once. Which stays is chance."""
    lines = [f"encode --codec {codec} -f 100 --to {pictures}f clip/*.pgm out/new.tik"
             for codec, pictures in (("none", PICTURES), ("lz4", PICTURES // 2), ("none", PICTURES // 3))]
    output, whole, wrong = bench.out / "new.tik", [], []
    for line in lines:
        bench.end_of(line)
        whole.append(output.read_bytes())
    for _ in range(WRITER_ROUNDS):
        output.unlink(missing_ok=True)
        processes = [bench.start(over(line.split()), {"LD_PRELOAD": str(library), "NUTIK_NO_LOCKS": "1"}) for line in lines]
        for process in processes:
            _, said = process.communicate(timeout=120)
            if process.returncode != 0:
                wrong.append(f"status {process.returncode}: {said.decode(errors='replace')[-300:]}")
        if output.read_bytes() not in whole:
            wrong.append("the output is nobody's")
        wrong += [f"{left.name} is left" for left in bench.out.glob(".new.tik.nutik-" + 16 * "?" + ".part")]
    output.unlink()
    report.hold(not wrong, f"three write one capture, {WRITER_ROUNDS} times" +
                "".join(f"\n    {each}" for each in wrong[:12]))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=Path, required=True)
    parser.add_argument("--libraries", type=Path, required=True, help="folder of what is preloaded")
    parser.add_argument("--work", type=Path, required=True)
    arguments = parser.parse_args()
    report = Report()
    bench = Bench(arguments.program.resolve(), (arguments.work / "foreign").resolve())
    before = bench.found()
    for line, outputs in COMMANDS:
        named = [bench.out / output for output in outputs.split()]
        words = line.format(named[0] if named else "").split()
        own_name = re.compile("out/\\.(%s)\\.nutik-[0-9a-f]{16}\\.part" % "|".join(map(re.escape, outputs.split())))
        wrong, took = [], 0
        for ends in ("", "SIGTERM", "SIGKILL"):
            began = time.monotonic()
            process = bench.start(words)
            if ends:
                time.sleep(took / 2)
                process.send_signal(getattr(signal, ends))
            _, said = process.communicate(timeout=120)
            took = took or time.monotonic() - began
            if not ends and process.returncode != 0:
                wrong.append(f"status {process.returncode}: {said.decode(errors='replace')[-300:]}")
            for output in named:
                if not ends and not (output.is_file() and output.stat().st_size > 0):
                    wrong.append(f"{output.name} is not there")
                output.unlink(missing_ok=True)
            after = bench.found()
            new = [name for name in after if name not in before]
            if ends == "SIGKILL":  # its own temporary files stay, each under a name that is nobody else's
                for name in filter(own_name.fullmatch, new):
                    (bench.folder / name).unlink()
                    del after[name]
            found = changes(before, after)
            wrong += [f"{ends or 'to its end'}: {change}" for change in found]
            if found:
                break
        report.hold(not wrong, line + "".join(f"\n    {each}" for each in wrong[:12]))
        if wrong:  # the next line starts among the same files
            bench = Bench(bench.program, bench.folder)
            before = bench.found()
    check_writers(report, bench, arguments.libraries.resolve() / "libfail_calls.so")
    report.end()


if __name__ == "__main__":
    main()
