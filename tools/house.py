#!/usr/bin/python3
"""Draws docs/images/house.svg: the rooms of host/, what stands on them, and who uses whom, as CMakeLists.txt say.

    tools/house.py            draws it (needs graphviz: apt install graphviz)
    tools/house.py --check    says whether the picture has the rooms and arrows of today

Arrows that follow from others are left out: who uses render may use exposure too.
"""

import argparse
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PICTURE = ROOT / "docs" / "images" / "house.svg"
KEYWORDS = "SOURCES|HEADERS|USES|LINKS|PRIVATE_LINKS"
# What rooms call.
LIBRARIES = {"opencl": "OpenCL", "align": "OpenCV", "media": "OpenCV, FFmpeg", "plot": "Cairo", "solve": "Eigen", "tik": "zstd, LZ4"}


def uses_of_rooms():
    """Room or program: those it names."""
    uses = {}
    for path in [*sorted((ROOT / "host").glob("*/CMakeLists.txt")), ROOT / "python" / "CMakeLists.txt"]:
        text = re.sub(r"#.*", "", path.read_text())
        room = re.search(rf"nutik_room\((\w+)(.*?)\)\s*$", text, re.DOTALL | re.MULTILINE)
        if room:
            named = re.search(rf"\bUSES\b(.*?)(?:\b(?:{KEYWORDS})\b|\Z)", room[2], re.DOTALL)
            uses[room[1]] = set(named[1].split()) if named else set()
        links = re.findall(r"\bnutik::(\w+)", " ".join(re.findall(r"target_link_libraries\(([^)]*)\)", text)))
        for program in re.findall(r"(?:add_executable|pybind11_add_module)\(\s*(nutik[-_]\w+)", text):
            uses[program.replace("_", "-")] = set(links)
    return uses


def reached_from(uses, room):
    found, open_rooms = set(), [room]
    while open_rooms:
        for used in uses.get(open_rooms.pop(), ()):
            if used not in found:
                found.add(used)
                open_rooms.append(used)
    return found


def source_of(uses):
    lines = ['digraph house {', 'graph [rankdir=TB nodesep=0.25 ranksep=0.45 fontname="DejaVu Sans"]',
             'node [shape=box style="rounded,filled" fillcolor="#e8f1f8" color="#0072b2" fontname="DejaVu Sans" fontsize=12]',
             'edge [color="#606060" arrowsize=0.7]']
    for room in sorted(uses):
        below = f'\\n({LIBRARIES[room]})' if room in LIBRARIES else ""
        colour = ' fillcolor="#fbe3d0" color="#d55e00"' if room.startswith("nutik-") else ""
        lines.append(f'"{room}" [label="{room}{below}"{colour}]')
    for room in sorted(uses):
        implied = set().union(*(reached_from(uses, used) for used in uses[room]))
        lines += [f'"{room}" -> "{used}"' for used in sorted(uses[room] - implied)]
    return "\n".join([*lines, "}"]) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true")
    uses = uses_of_rooms()
    source = source_of(uses)
    # An XML comment must not hold two hyphens in a row.
    comment = source.replace("->", "to")
    if parser.parse_args().check:
        if comment not in PICTURE.read_text():
            sys.exit(f"{PICTURE.relative_to(ROOT)} has not the rooms of today; tools/house.py draws it anew")
        print(f"{len(uses)} rooms and programs")
        return
    try:
        drawn = subprocess.run(["dot", "-Tsvg"], input=source, text=True, check=True, capture_output=True).stdout
    except FileNotFoundError:
        sys.exit("graphviz draws the house: apt install graphviz")
    drawn = drawn[drawn.index("<svg"):]
    PICTURE.write_text(f'<?xml version="1.0" encoding="UTF-8"?>\n<!--\n{comment}-->\n{drawn}')


if __name__ == "__main__":
    main()
