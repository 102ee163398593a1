#!/usr/bin/python3
"""Which way includes go in host/: a room includes itself and the rooms that its CMakeLists.txt uses, and the folders of a
room include each other one way. Only the command line and the schema name an option with its dashes. Lines of all C++
and OpenCL sources lie within ColumnLimit of .clang-format.

    check_includes.py --host FOLDER
"""

import argparse
import re
import sys
from collections import defaultdict
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
from house import reached_from, uses_of_rooms  # noqa: E402

OPTION = re.compile(r'"(?:[^"\\\n]|\\.)*--[a-z](?:[^"\\\n]|\\.)*"')  # within a text
INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.MULTILINE)
PROGRAMS = {"app": "nutik-cl", "studio": "nutik-studio"}


def folder_of(place):
    """The folder within a room; of a file that lies in none, nothing."""
    parts = Path(place).parts
    return parts[1] if len(parts) > 2 else ""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--host", type=Path, required=True)
    host = parser.parse_args().host
    uses = uses_of_rooms()
    mistakes, arrows = [], defaultdict(lambda: defaultdict(set))
    files = [path for path in sorted(host.glob("*/**/*.[ch]pp")) if path.parent.name != "nutik"]
    if not files:
        sys.exit(f"{host} holds no source")
    for path in files:
        place = path.relative_to(host)
        room, text = place.parts[0], path.read_text(encoding="utf-8")
        known = reached_from(uses, PROGRAMS.get(room, room))
        for name in INCLUDE.findall(text):
            other = name.split("/")[0]
            if other == room:
                arrows[room][folder_of(place)].add(folder_of(name))
            elif other not in known and "/" in name:
                mistakes.append(f"{place} includes {name}: {room} does not use {other}")
        if room != "app" and place.parent != Path("features/schema"):
            mistakes += [f"{place} says {option}" for option in OPTION.findall(text)]
    for room, within in arrows.items():
        try:
            TopologicalSorter({folder: others - {folder, ""} for folder, others in within.items() if folder}).prepare()
        except CycleError as error:
            mistakes.append(f"{room}: folders include each other in a circle: {' <- '.join(error.args[1])}")
    root = host.resolve().parent
    limit = int(re.search(r"^ColumnLimit: (\d+)$", (root / ".clang-format").read_text(), re.MULTILINE)[1])
    sources = [path for place in ("host", "kernels", "tests") for path in (root / place).rglob("*")
               if path.suffix in (".cpp", ".hpp", ".inl", ".cl", ".clh")]
    for path in sorted(sources):
        lines = path.read_text(encoding="utf-8").split("\n")
        mistakes += [f"{path.relative_to(root)}:{number} has {len(line)} columns, more than {limit}"
                     for number, line in enumerate(lines, 1) if len(line) > limit]
    for mistake in mistakes:
        print(mistake)
    print(f"{len(files)} files, {len(mistakes)} mistakes")
    return 1 if mistakes else 0


if __name__ == "__main__":
    sys.exit(main())
