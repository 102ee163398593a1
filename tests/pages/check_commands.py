#!/usr/bin/env python3
"""Runs the commands that pages show, page by page, beside a scene that has the files they name.

    check_commands.py --program nutik-cl --work FOLDER

All that is asked of a command is that it works: a shell runs it, and its exit status is 0. Tutorials, the gallery and
the examples of help have tests of their own.
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

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests" / "app"), str(ROOT / "tools")]
import gallery  # noqa: E402
from check_examples import COUNT, HEIGHT, WIDTH, frame, make_scene, run_alone, write_clip  # noqa: E402

PAGES = [ROOT / "README.md", *sorted((ROOT / "docs" / "how-to").glob("*.md")),
         *sorted((ROOT / "docs" / "reference").glob("*.md"))]
# Commands whose clip the scene is not, each with the reason.
OTHER_CLIPS = {
    "--region 0,0,1920,500": "two subjects",
    "--difference 0f 1150f": "the demo's 1152 pictures",
}


def commands_of(page):
    """Indented lines that start with a program's name, with those that go on; a remark after three blanks is none of it."""
    text = re.sub(r"^```.*?^```$", "", page, flags=re.DOTALL | re.MULTILINE)
    found = re.findall(r"^    ((?:nutik-cl|ffmpeg) (?:.*[\\|]\n)*.*)$", text, re.MULTILINE)
    return [command if "\n" in command else re.sub(r"   +\S.*$", "", command) for command in found]


def make_more(folder, program):
    """What pages name beside the scene."""
    def run(*words):
        subprocess.run(words, cwd=folder, check=True, stdout=subprocess.DEVNULL)

    # Blocks of random brightness behind the square: what an alignment can hold on to.
    blocks = numpy.random.default_rng(1).integers(-40, 40, (HEIGHT // 8, WIDTH // 8)).repeat(8, 0).repeat(8, 1)
    write_clip(folder / "clip.mp4", (frame(k, blocks[..., None]) for k in range(COUNT)))
    shutil.copy(folder / "clip.mp4", folder / "tape.mov")
    # Two events each 100 us, of a pixel that goes up and down for 96 ms.
    words = [word for k in range(960) for word in
             (8 << 28 | (k * 100 >> 6), (k % 2) << 28 | (k * 100 & 63) << 22 | (k % 640) << 11 | 99)]
    (folder / "events.raw").write_bytes(b"% format EVT2;height=480;width=640\n% end\n" +
                                        numpy.array(words, "<u4").tobytes())
    run(program, "-q", "mask", "--size", "640x360", "--tag", "1", "--rectangle", "300,150,60,60", "-o", "marks.pgm")
    run(program, "-q", "mask", "--base", "regions.pgm", "--feather", "6px", "-o", "layer-%d.png")
    shades = numpy.tile(numpy.linspace(0, 65_535, WIDTH).astype(numpy.uint16), (HEIGHT, 1))
    cv2.imwrite(str(folder / "map.tif"), shades)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True)
    parser.add_argument("--work", required=True, type=Path)
    arguments = parser.parse_args()
    arguments.work = arguments.work.resolve()
    shutil.rmtree(arguments.work, ignore_errors=True)
    scene = arguments.work / "scene"
    scene.mkdir(parents=True)
    make_scene(scene, arguments.program)
    make_more(scene, arguments.program)
    in_path = gallery.commands_in_path(Path(arguments.program).resolve(), arguments.work / "bin", plots=True)
    environment = dict(os.environ, PATH=in_path, MPLBACKEND="agg")
    unused = set(OTHER_CLIPS)

    def failures_of(page):
        """How many of a page's commands ran, and what went wrong with others."""
        folder = arguments.work / page.stem
        count, failures = 0, []
        for command in commands_of(page.read_text()):
            other = [part for part in OTHER_CLIPS if part in command]
            unused.difference_update(other)
            if other:
                continue
            if count == 0:
                shutil.copytree(scene, folder)
            count += 1
            done = run_alone(command, folder, environment)
            if done.returncode != 0:
                failures.append(f"{page.name}: {command}\n  {done.returncode}: {done.stderr.strip()}")
        shutil.rmtree(folder, ignore_errors=True)
        return count, failures

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        results = list(pool.map(failures_of, PAGES))
    failures = [failure for _, failed in results for failure in failed]
    failures += [f"no page has a command with {part} any more" for part in unused]
    count = sum(number for number, _ in results)
    print("\n".join(failures) or f"{count} commands of {len(PAGES)} pages run")
    return 1 if failures or count == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
