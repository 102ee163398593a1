#!/usr/bin/env python3
"""Which arithmetic pictures of 16 bits take, and how far single is off.

    tools/bench/sixteen_bits.py --build build --clips FOLDER [--only NAME ...] [--pictures 120] [--scale 1/2]
                                [--csv FILE]

The first pictures of each clip are exposed in several ways without negative gains, to sRGB codes of 16 bits, in every
arithmetic (nutik-cl validate). Ends with status 1 where less than nine of ten take single, or a code is off by half of
one more than its bound says.
"""

import json
import pathlib
import subprocess
import sys
import tempfile

from tables import STEEPEST, command_line, run_once, write_outputs

MOST = 0.9
CLIPS = ("BallTossOut.mp4", "ball_12bit.cihx", "bicycle-wheel.mp4", "bikes.mp4", "bottle-detection.mp4", "bulk-water.mov",
         "cine_781.cine", "data_small_cine.cine", "diabolo-cm-trajectory.mp4", "one-by-one-person-detection.mp4",
         "realshort.mp4")
WAYS = {
    "all of it": ("--start", "0s", "--exposure", "24h"),
    "a picture": ("--start", "3f", "--exposure", "1f"),
    "ten": ("--start", "2f", "--exposure", "10f"),
    "Hann": ("--start", "0f", "--exposure", "12f", "--shutter", "hann"),
    "a stop less": ("--start", "0f", "--exposure", "12f", "--ev", "-1"),
    "delays": ("--start", "0f", "--exposure", "8f", "--delay", "rows:0s..20ms"),
}


def measured(program, capture, how):
    """The row of one exposure."""
    done = subprocess.run((program, "validate", "-q", "--json", "--runs", "1", "--depth", "16", *how, capture),
                          capture_output=True, text=True)
    if not done.stdout:
        raise SystemExit(done.stderr)
    report = json.loads(done.stdout)
    variants = {each["precision"]: each for each in report["variants"]}
    single = variants["single"]
    return {"takes": next(each["precision"] for each in report["variants"] if each["is_chosen"]),
            "off": single["worst_16_bit_codes"], "bound": single["bound_steps"],
            "bound_of_white": STEEPEST * 65535 * single["bound_light"], "within": single["is_within_bound"]}


def main():
    parser = command_line(__doc__, runs=1)
    parser.add_argument("--clips", type=pathlib.Path, required=True, help="folder of recorded clips")
    parser.add_argument("--only", nargs="*", default=CLIPS, metavar="NAME", help="of them")
    parser.add_argument("--pictures", type=int, default=120, help="of each clip")
    parser.add_argument("--scale", default="1/2", help="of their pictures: the reference takes its time")
    arguments = parser.parse_args()
    program = arguments.build.resolve() / "nutik-cl"
    rows = []
    print(f"{'clip':32} {'exposure':12} {'takes':12} {'single off':>10} {'bound':>8} {'of white':>8}")
    with tempfile.TemporaryDirectory() as scratch:
        capture = pathlib.Path(scratch) / "clip.tik"
        for name in arguments.only:
            part = ("--to", f"{arguments.pictures}f")
            encode = (program, "encode", "--overwrite", "-q", "--scale", arguments.scale, arguments.clips / name, capture)
            if subprocess.run((*encode, *part), capture_output=True).returncode:
                run_once(*encode)  # it has fewer
            for way, how in WAYS.items():
                row = {"clip": name, "exposure": way, **measured(program, capture, how)}
                print(f"{name:32} {way:12} {row['takes']:12} {row['off']:10.2g} {row['bound']:8.2g} "
                      f"{row['bound_of_white']:8.2g}", flush=True)
                rows.append(row)
    single = sum(row["takes"] == "single" for row in rows)
    of_white = sum(row["bound_of_white"] <= 0.5 for row in rows)
    beyond = sum(row["off"] > row["bound"] + 0.5 or not row["within"] for row in rows)
    print(f"{single} of {len(rows)} take single, {of_white} would by a bound of white light alone; {beyond} are off by more than the bound")
    write_outputs(arguments, rows)
    sys.exit(single < MOST * len(rows) or beyond > 0)


if __name__ == "__main__":
    main()
