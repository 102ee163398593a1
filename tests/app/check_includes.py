#!/usr/bin/python3
"""Arrows between the rooms of host/, and between the folders of a room, run one way, as real includes have them.

    check_includes.py --host FOLDER

A room includes those that its CMakeLists.txt names, and those that these name. The programs are clients of the session:
host/app and host/studio include the session's headers, the system's and their own. Options of the
command line are named in host/app and in the schema alone.
"""

import argparse
import re
import sys
from collections import defaultdict
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
from house import reached_from, uses_of_rooms  # noqa: E402

CLIENTS = {"app": {"session", "system"}, "studio": {"session", "system"}}
OPTION = re.compile(r'"(?:[^"\\\n]|\\.)*--[a-z](?:[^"\\\n]|\\.)*"')  # within a text
INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.MULTILINE)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--host", type=Path, required=True)
    host = parser.parse_args().host.resolve()
    uses = uses_of_rooms() | CLIENTS
    may_include = {room: rooms if room in CLIENTS else reached_from(uses, room) for room, rooms in uses.items()}
    mistakes = [f"the rooms {room} and {other} use each other" for room in uses for other in uses
                if room < other and other in reached_from(uses, room) and room in reached_from(uses, other)]
    arrows, examples = defaultdict(set), {}
    files = sorted(path.relative_to(host) for path in host.rglob("*") if path.suffix in (".cpp", ".hpp", ".inl"))
    for file in files:
        text = (host / file).read_text(encoding="utf-8")
        room, folder = file.parts[0], str(file.parent)
        for name in map(Path, INCLUDE.findall(text)):
            if not (host / name).exists():
                continue  # generated
            if name.parts[0] != room:
                if name.parts[0] not in may_include.get(room, {"session"}):
                    mistakes.append(f"{file} includes {name}, and {room} does not use that room")
            elif str(name.parent) != folder and room not in (folder, str(name.parent)):  # not the room's own files
                arrows[folder].add(str(name.parent))
                examples.setdefault((folder, str(name.parent)), f"{file} includes {name}")
        if room != "app" and folder != "session/schema":
            mistakes += [f"{file} says {said}" for said in OPTION.findall(text)]
    for folder in sorted(arrows):
        mistakes += [f"arrows run both ways: {examples[folder, other]}" for other in sorted(arrows[folder])
                     if folder in reached_from(arrows, other)]
    print(*mistakes, f"{len(files)} files, {len(mistakes)} mistakes", sep="\n")
    return 1 if mistakes or not files else 0


if __name__ == "__main__":
    sys.exit(main())
