#!/usr/bin/env python3
"""What more cores give: the share of each command that runs on one core alone, and what follows for more of them.

    tools/bench/cores.py --build build --clips FOLDER [--only NAME ...] [--runs 5] [--csv FILE]

Whole processes on one core and on two (taskset), in changing order, medians. With a share s that is serial, n cores take
s + (1 - s) / n of one core's time (Amdahl); the limit is a share of 10 %. On a machine that does nothing else.
"""

import os
import pathlib
import random
import statistics
import tempfile

from tables import command_line, run_once, write_outputs


def main():
    parser = command_line(__doc__, runs=5, clips=True)
    parser.set_defaults(only=["diabolo-cm-trajectory.mp4"])
    arguments = parser.parse_args()
    program = arguments.build.resolve() / "nutik-cl"
    cores = sorted(os.sched_getaffinity(0))[:2]
    rows = []
    print(f"{'':46} {'1 core: s':>9} {'2: s':>6} {'serial':>7} {'4: s':>6} {'8: s':>6} {'16: s':>6}   limit: 10 % serial")
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        for name in arguments.only:
            clip, capture, plain = arguments.clips / name, folder / "packed.tik", folder / "plain.tik"
            run_once(program, "encode", "-q", "--overwrite", clip, capture)
            run_once(program, "encode", "-q", "--overwrite", "--codec", "none", clip, plain)
            whole = ("expose", "--start", "0s", "--exposure", "24h")
            commands = {"expose, uncompressed": (*whole, plain, folder / "a.png"),
                        "expose, packed": (*whole, capture, folder / "a.png"),
                        "expose, clip": (*whole, clip, folder / "a.png"),
                        "encode": ("encode", clip, folder / "a.tik"),
                        "encode --align rigid": ("encode", "--align", "rigid", clip, folder / "a.tik"),
                        "video": ("video", capture, folder / "a.mp4"),
                        "study": ("study", "--between", "off", clip, "-o", folder / "a.png")}
            for label, words in commands.items():
                seconds = {1: [], 2: []}
                for _ in range(arguments.runs + 1):
                    for count in random.sample((1, 2), 2):
                        seconds[count].append(run_once("taskset", "-c", ",".join(map(str, cores[:count])), program,
                                                       words[0], "-q", "--overwrite", *words[1:]))
                one, two = (statistics.median(seconds[count][1:]) for count in (1, 2))
                serial = min(max(2 * two / one - 1, 0), 1)
                more = [one * (serial + (1 - serial) / count) for count in (4, 8, 16)]
                rows.append({"clip": name, "command": label, "one_s": one, "two_s": two, "serial": serial})
                print(f"{name[:22]:23}{label:23} {one:9.3f} {two:6.3f} {serial:7.0%} "
                      f"{more[0]:6.3f} {more[1]:6.3f} {more[2]:6.3f}", flush=True)
    write_outputs(arguments, rows)


if __name__ == "__main__":
    main()
