#!/usr/bin/env python3
"""Reads captures of every kind as earlier programs wrote them, and makes their pictures again.

    check_golden.py --program nutik-cl --work FOLDER

golden.json lists each capture beside it: what `info --json` tells of it, and exposures with the checksum of their
picture, of the capture's own codes. Exposures are computed in fixed precision on an OpenCL device, which gives the same codes on every machine.
"""

import argparse
import hashlib
import json
import os
import re
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
MANIFEST = HERE / "golden.json"


def info_of(program, capture):
    """What the program tells of a capture beside this script."""
    told = subprocess.run([program, "info", "--json", capture], cwd=HERE, capture_output=True, text=True)
    if told.returncode != 0:
        raise ValueError(f"info {capture}: exit status {told.returncode}: {told.stderr.strip()}")
    return json.loads(told.stdout)


def checksum_of(picture):
    """SHA-256 of a PNM's kind, size, maximum and raster. How its header is laid out does not matter."""
    data = picture.read_bytes()
    header = re.match(rb"(P[56])\s+(\d+)\s+(\d+)\s+(\d+)\s", data)
    if not header:
        raise ValueError(f"{picture}: no PNM without comments")
    return hashlib.sha256(b" ".join(header.groups()) + b"\n" + data[header.end():]).hexdigest()


def checksums_of(program, capture, exposures, work):
    """The checksum of each exposure's picture, in their order. Exposures are options in one line each."""
    pictures = [work / f"{Path(capture).stem}-{k}.pnm" for k in range(len(exposures))]
    for picture in pictures:
        picture.unlink(missing_ok=True)
    lines = "".join(f"{exposure} --out-transfer source --no-recipe '{picture}'\n" for exposure, picture in zip(exposures, pictures))
    done = subprocess.run([program, "batch", "-q", "--precision", "fixed", "-", capture], cwd=HERE,
                          input=lines, capture_output=True, text=True)
    if done.returncode != 0:
        raise ValueError(f"batch {capture}: exit status {done.returncode}: {done.stderr.strip()}")
    return [checksum_of(picture) for picture in pictures]


def differences(program, capture, golden, work):
    """What the program tells or makes of a capture otherwise than its entry of golden.json says."""
    told = info_of(program, capture)
    for key, value in golden["info"].items():
        if told.get(key) != value:
            yield f"info says {key} {told.get(key)!r}, not {value!r}"
    pictures = golden["pictures"]
    made = checksums_of(program, capture, list(pictures), work)
    for (exposure, wanted), found in zip(pictures.items(), made):
        if found != wanted:
            yield f"{exposure}: the picture's checksum is {found}, not {wanted}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True, type=os.path.abspath)
    parser.add_argument("--work", required=True, type=Path)
    arguments = parser.parse_args()
    work = arguments.work.resolve()
    work.mkdir(parents=True, exist_ok=True)
    manifest = json.loads(MANIFEST.read_text())
    present = {path.name for path in HERE.glob("*.tik")}
    failures = [f"{name}: listed in {MANIFEST.name}, but not there" for name in sorted(set(manifest) - present)]
    failures += [f"{name}: not listed in {MANIFEST.name}" for name in sorted(present - set(manifest))]
    for capture in sorted(present & set(manifest)):
        try:
            failures += [f"{capture}: {said}" for said in differences(arguments.program, capture, manifest[capture], work)]
        except (OSError, ValueError) as error:
            failures.append(f"{capture}: {error}")
    count = sum(len(golden["pictures"]) for golden in manifest.values())
    print("\n".join(failures) or f"{len(manifest)} captures read, {count} pictures the same")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
