"""An independent check of the whole program: it is run as a user runs it, and its pictures are
compared with expose.py, which was written from the mathematics alone, and with numbers by hand.

    check_program.py --program PATH [--media DIR] --work DIR [--only SECTION]

Exit status 0 where everything agrees, 1 otherwise.
"""

import argparse
import shlex
import shutil
import sys
import time
import traceback
from pathlib import Path

import cases_by_hand
import cases_decoding
import cases_deep
import cases_intervals
import cases_options
import cases_paper
import cases_small
from harness import TOLERANCE, Checks


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", required=True, type=Path, help="nutik-cl")
    parser.add_argument("--media", type=Path, help="folder of the sample clips")
    parser.add_argument("--work", required=True, type=Path, help="folder for files")
    parser.add_argument("--only", default="", help="sections whose name contains this: numbers, "
                        "by-hand, small, interval, options, vfr, decoding, deep, paper")
    return parser.parse_args()


def attempt(checks, name, run, *given):
    """Run a section. What it throws is a failure of it, and mustn't hide the others' results."""
    try:
        run(checks, *given)
    except Exception as error:  # of any kind, for the reason above
        checks.failed(name, f"broke off: {error!r}\n{traceback.format_exc()}")


def generated(checks, wanted):
    """The sections that generate their own clips."""
    sections = {"by-hand": cases_by_hand.run, "small": cases_small.run,
                "interval": cases_intervals.run, "options": cases_options.run,
                "vfr": cases_deep.generated}
    if wanted in "numbers":
        attempt(checks, "numbers", cases_by_hand.numbers)
    sections = {name: run for name, run in sections.items() if wanted in name}
    if sections and shutil.which("ffmpeg") is None:
        print(f"SKIPPED: {', '.join(sections)}: needs the ffmpeg command, to make clips that lose "
              "nothing")
        return
    for name, run in sections.items():
        attempt(checks, name, run)


def recorded(checks, media, wanted):
    """The sections that need the recorded clips."""
    names = ["decoding", "deep", *map(cases_paper.section_of, cases_paper.CLIPS)]
    names = [name for name in names if wanted in name]
    if names and (media is None or not media.is_dir()):
        print(f"SKIPPED: {', '.join(names)}: needs the recorded clips, and --media "
              f"{'is not given' if media is None else f'{media} is no folder'}")
        return
    if "decoding" in names:
        attempt(checks, "decoding", cases_decoding.run, media.resolve())
    if "deep" in names and shutil.which("ffmpeg") is None:
        print("SKIPPED: deep: needs the ffmpeg command, to read video a second way")
    elif "deep" in names:
        attempt(checks, "deep", cases_deep.recorded, media.resolve())
    if names:
        attempt(checks, "paper", cases_paper.run, media.resolve(), wanted)


def main():
    given = arguments()
    started = time.monotonic()
    given.work.mkdir(parents=True, exist_ok=True)
    again = [sys.executable, sys.argv[0], "--program", given.program, "--work", given.work]
    again += ["--media", given.media] if given.media else []
    checks = Checks(given.program.resolve(), given.work.resolve(), shlex.join(map(str, again)))
    generated(checks, given.only)
    recorded(checks, given.media, given.only)
    print(f"\n{checks.cases} checks, {checks.failures} failed, {time.monotonic() - started:.0f} s; "
          f"worst error {checks.worst[0]:.1e} S of {TOLERANCE:g} S allowed ({checks.worst[1]})")
    return 1 if checks.failures or not checks.cases else 0


if __name__ == "__main__":
    sys.exit(main())
