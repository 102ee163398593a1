#!/usr/bin/env python3
"""`--precision fixed` gives the same bytes on PoCL and on Oclgrind, a simulator that shares no code generation
with it and reports data races and accesses outside buffers.

    check_fixed_devices.py --program build/nutik-cl --work folder

Prints `SKIPPED: ` and why where Oclgrind is not installed.
"""

import argparse
import os
import pathlib
import random
import shutil
import subprocess
import sys

# Oclgrind does not know the intrinsic that clang makes of `restrict` in functions that are inlined.
OCLGRIND = ["oclgrind", "--data-races", "--build-options", "-Drestrict="]
FUNCTIONS = ("M0 [0:0], [100000000:1], [1500000000:1], [1500000001:-0.25], [2000000000:0]\n"
             "M9 [500000000:0], [700000000:-300], [700000001:302], [900000000:0]\n")
WIDTH, HEIGHT, SAMPLES = 21, 11, 90


def make_inputs(folder):
    draw = random.Random(4)
    (folder / "stills").mkdir(parents=True)
    codes = [draw.randrange(256) for _ in range(3 * WIDTH * HEIGHT)]
    for k in range(SAMPLES):
        # A third of the values never changes, a third at times, a third always.
        codes = [draw.randrange(256) if i % 3 == 2 or (i % 3 == 1 and draw.random() < 0.1) else code
                 for i, code in enumerate(codes)]
        (folder / f"stills/{k:03}.ppm").write_bytes(b"P6 %d %d 255\n" % (WIDTH, HEIGHT) + bytes(codes))
    mask = bytes(9 if x + y > 15 else 0 for y in range(HEIGHT) for x in range(WIDTH))
    (folder / "mask.pgm").write_bytes(b"P5 %d %d 255\n" % (WIDTH, HEIGHT) + mask)
    (folder / "functions.fn").write_text(FUNCTIONS)


def run(folder, command, name):
    environment = dict(os.environ, XDG_CACHE_HOME=str(folder / f"cache-{name}"))
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{name}: {' '.join(map(str, command))}\n{done.stdout}{done.stderr}")
    return done.stdout + done.stderr


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", type=pathlib.Path, required=True)
    parser.add_argument("--work", type=pathlib.Path, required=True)
    arguments = parser.parse_args()
    if shutil.which("oclgrind") is None:
        print("SKIPPED: oclgrind is not installed")
        return
    program, folder = arguments.program.resolve(), arguments.work.resolve()
    shutil.rmtree(folder, ignore_errors=True)
    make_inputs(folder)
    for kind in ("rows", "records"):
        run(folder, [program, "encode", "--fps", "45", "--tiles", kind, "stills", f"{kind}.tik"], "encode")
    for kind, output in (("rows", "png"), ("records", "pfm")):
        expose = [program, "expose", "-v", "--precision", "fixed", "-m", "mask.pgm", "-k", "functions.fn",
                  f"{kind}.tik"]
        run(folder, [*expose, f"pocl.{output}"], "pocl")
        report = run(folder, [*OCLGRIND, *expose, f"oclgrind.{output}"], "oclgrind")
        if "Oclgrind" not in report:
            sys.exit(f"the simulator was not used:\n{report}")
        for trouble in ("data race", "Invalid"):
            if trouble in report:
                sys.exit(f"{kind}, {output}: {report}")
        pocl, oclgrind = ((folder / f"{name}.{output}").read_bytes() for name in ("pocl", "oclgrind"))
        if pocl != oclgrind:
            sys.exit(f"{kind}.tik: the {output} of PoCL and of Oclgrind differ; see {folder}")
    print("codes of rows, light of records: the same bytes on both")


if __name__ == "__main__":
    main()
