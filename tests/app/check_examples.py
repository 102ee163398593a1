#!/usr/bin/env python3
"""Runs every example of every command's help, word for word, beside a scene that has the files they name.

Of an example is asked that it works (a shell runs it, and its exit status is 0), and that its pictures show something:
they are neither white nor black. So are those that a solved function exposes, by the command that solve prints.
"""
import argparse
import os
import re
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import cv2
import numpy

WIDTH, HEIGHT, COUNT, RATE = 640, 360, 65, 50

FUNCTIONS = {
    "trail.fn": "M0 [0:1], [1000000000:0]\n",
    "sharp.fn": "M0 [-1:0], [0:1], [10000000:1], [10000001:0]\n",
    "one.fn": "M0 [0:1], [1000000000:0]\n",
    "regions.fn": "M0 [0:1], [1000000000:1], [1000000001:0]\nM128 [0:1], [10000000:1], [10000001:0]\n"
                  "M255 [0:1], [20000000:1], [20000001:0]\n",
    "named.fn": "M0 [0:1], [1000000000:1], [1000000001:rest], [1010000000:rest], [1010000001:0]\n",
    "named-regions.fn": "M0 [0:1], [1000000000:1], [1000000001:rest], [1010000000:rest], [1010000001:0]\n"
                        "M128 [0:1], [10000000:1], [10000001:0]\nM255 [0:1], [20000000:1], [20000001:0]\n",
    "moved.fn": "M0 [when-1:0], [when:1], [when+100000000:1], [when+100000001:0]\n",
    "difference.fn": "M0 [0:1], [100000000:1], [100000001:-1], [200000000:-1], [200000001:0]\n"
                     "M128 [0:1], [10000000:1], [10000001:0]\nM255 [0:1], [20000000:1], [20000001:0]\n",
}
COPIES = {"file.fn": "regions.fn", "functions.fn": "regions.fn"}


def frame(k, level=0):
    """A square that moves over a ramp."""
    picture = numpy.empty((HEIGHT, WIDTH, 3), numpy.uint8)
    picture[:] = numpy.linspace(20, 140, WIDTH, dtype=numpy.uint8)[None, :, None]
    picture = numpy.clip(picture.astype(int) + level, 0, 255).astype(numpy.uint8)
    picture[150:210, 40 + 8 * k:100 + 8 * k] = (90, 160, 220)
    return picture


def write_clip(path, frames):
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter_fourcc(*"mp4v"), RATE, (WIDTH, HEIGHT))
    for picture in frames:
        writer.write(picture)
    writer.release()


def noisy(level, count):
    random = numpy.random.default_rng(7)
    for _ in range(count):
        base = numpy.linspace(30, 200, WIDTH)[None, :, None] + level
        yield numpy.clip(base + random.normal(0, 2, (HEIGHT, WIDTH, 3)), 0, 255).astype(numpy.uint8)


def make_scene(folder, program):
    write_clip(folder / "clip.mp4", (frame(k) for k in range(COUNT)))
    shutil.copy(folder / "clip.mp4", folder / "slowmotion.mp4")
    write_clip(folder / "still-scene.mp4", noisy(0, 40))
    mask = numpy.zeros((HEIGHT, WIDTH), numpy.uint8)
    mask[100:300, :320] = 128
    mask[100:300, 320:] = 255
    for name in ("regions.pgm", "mask.pgm"):
        cv2.imwrite(str(folder / name), mask)
    for name, columns in (("left.pgm", 80), ("right.pgm", 400)):
        side = numpy.where(numpy.arange(WIDTH) < columns, 128, 255).astype(numpy.uint8)
        cv2.imwrite(str(folder / name), numpy.broadcast_to(side, (HEIGHT, WIDTH)))
    (folder / "ramp.csv").write_text("0s,0.2s\n1s,0.7s\n1.2s,0.7s\n1.5s,0.4s\n")
    for name, text in FUNCTIONS.items():
        (folder / name).write_text(text)
    for name, of in COPIES.items():
        shutil.copy(folder / of, folder / name)
    (folder / "frames").mkdir()
    for k in range(6):
        cv2.imwrite(str(folder / "frames" / f"{k:04}.png"), frame(k).astype(numpy.uint16) * 16)
        cv2.imwrite(str(folder / f"frame{k:04}.tif"), frame(k))
    for name, level in (("dark", -10), ("middle", 0), ("bright", 20)):
        (folder / name).mkdir()
        for k, picture in enumerate(noisy(level, 12)):
            cv2.imwrite(str(folder / name / f"{k:03}.png"), picture.astype(numpy.uint16) * 16)
    cv2.imwrite(str(folder / "empty.png"), frame(0))
    cv2.imwrite(str(folder / "full.png"), frame(30))
    (folder / "exposures.txt").write_text("--start 0.1s --exposure 10ms first.png\n-k trail.fn second.png\n")

    def run(*words):
        subprocess.run([program, "-q", *words], cwd=folder, check=True)

    run("-f", str(RATE), "clip.mp4", "clip.tik")
    for number, (first, end) in enumerate(((0, 16), (16, 48), (48, COUNT)), 1):
        run("encode", "-f", str(RATE), "--from", f"{first}f", "--to", f"{end}f", "clip.mp4", f"part-{number}.tik")
    run("noise", "still-scene.mp4", "-o", "camera.noise")
    run("--start", "0s", "--exposure", "10ms", "clip.tik", "picture.png")
    (folder / "captures").mkdir()
    (folder / "masks").mkdir()
    whole = (folder / "clip.tik").read_bytes()
    (folder / "damaged.tik").write_bytes(whole[:len(whole) - 10])


def flaw_of_picture(path):
    """What is wrong with a picture; empty where something is to be seen."""
    picture = cv2.imread(str(path), cv2.IMREAD_UNCHANGED)
    if picture is None:
        return f"{path.name} cannot be read"
    if picture.ndim == 3 and picture.shape[2] == 4:
        picture = picture[:, :, :3]
    white = numpy.iinfo(picture.dtype).max if picture.dtype.kind == "u" else 1
    values = picture.reshape(picture.shape[0] * picture.shape[1], -1)
    shares = {"white": (values >= white).all(axis=1).mean(), "black": (values <= 0).all(axis=1).mean()}
    if path.suffix == ".pgm":  # a mask of one tag, or of nothing that is uncertain
        del shares["black"]
    return "".join(f"{path.name} is {name} in {100 * share:.0f} % of its pixels" for name, share in shares.items()
                   if share > 0.99)


def pictures_in(folder):
    """Pictures, and when they were written."""
    return {path: path.stat().st_mtime_ns for path in folder.rglob("*")
            if path.suffix in (".png", ".jpg", ".tif", ".pgm", ".pfm")}


def run_alone(line, folder, environment):
    """As if it were the first that is run there: of the files that it makes none stays from one before it."""
    while True:
        result = subprocess.run(["bash", "-o", "pipefail", "-c", line], cwd=folder, env=environment, text=True,
                                capture_output=True, stdin=subprocess.DEVNULL)
        taken = re.search(r"^nutik-cl: (.*) is there already and is not replaced;", result.stderr, re.M)
        if not taken:
            return result
        (folder / taken[1]).unlink()


def examples_of(page):
    """The lines below `Examples:`, some over several lines, as a shell takes them."""
    text = page.split("\nExamples:\n", 1)[1]
    return [line.strip() for line in re.split(r"\n(?=  \S)", text)]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", required=True)
    parser.add_argument("--work", required=True, type=Path)
    arguments = parser.parse_args()
    shutil.rmtree(arguments.work, ignore_errors=True)
    scene = arguments.work / "scene"
    scene.mkdir(parents=True)
    make_scene(scene, arguments.program)
    environment = dict(os.environ, COLUMNS="80",
                       PATH=f"{Path(arguments.program).parent}:{os.environ['PATH']}")

    def help_of(*words):
        return subprocess.run([arguments.program, *words], env=environment, text=True, check=True,
                              capture_output=True).stdout

    overview = help_of("--help")
    commands = re.findall(r"^  ([a-z]+) {2,}[A-Z]", overview, re.M) + re.search("Also: (.*), help", overview)[1].split(", ")
    assert len(commands) >= 18, commands

    seen = []  # pictures that were judged

    def failures_of(command):
        """How many of a command's examples ran, and what went wrong with others."""
        examples = [example for example in examples_of(help_of(command, "--help=all"))
                    if "man -l" not in example or shutil.which("man")]
        assert examples, command
        folder = arguments.work / command
        shutil.copytree(scene, folder)
        failures = []

        def run(line):
            result = run_alone(line, folder, environment)
            if result.returncode != 0:
                failures.append(f"{line}\n  {result.returncode}: {result.stderr.strip()}")
            return result

        for example in examples:
            before = pictures_in(folder)
            result = run(example)
            if command == "solve" and result.returncode == 0:
                run(re.search(r"^try: (.*)$", result.stdout, re.M)[1])
            made = [path for path, time in pictures_in(folder).items() if before.get(path) != time]
            seen.extend(made)
            failures.extend(f"{example}\n  {flaw}" for flaw in map(flaw_of_picture, made) if flaw)
        shutil.rmtree(folder)
        return len(examples), failures

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        results = list(pool.map(failures_of, commands))
    failures = [failure for _, failed in results for failure in failed]
    count = sum(number for number, _ in results)
    print("\n".join(failures) or f"{count} examples of {len(commands)} commands run, {len(seen)} pictures looked at")
    assert len(seen) > 50 or failures, seen
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
