#!/usr/bin/python3
"""The programs are clients of the session: host/app and host/studio include the session's headers, the system's and
their own. What writes the outputs of host/app knows nothing of its requests. What lies below names no option of a command line.

    check_includes.py --app FOLDER
"""

import argparse
import re
import sys
from collections import defaultdict
from pathlib import Path

ROOMS = {"app", "session", "system"}
OPTION = re.compile(r'"(?:[^"\\\n]|\\.)*--[a-z](?:[^"\\\n]|\\.)*"')  # within a text
INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.MULTILINE)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--app", type=Path, required=True)
    app = parser.parse_args().app
    mistakes = []
    arrows = defaultdict(set)
    files = sorted(path for path in app.rglob("*") if path.suffix in (".hpp", ".cpp"))
    if not files:
        sys.exit(f"{app} holds no source")
    for path in files:
        place = path.relative_to(app)
        for name in INCLUDE.findall(path.read_text(encoding="utf-8")):
            room, *rest = name.split("/")
            if room not in ROOMS:
                mistakes.append(f"{place} includes {name}, which is neither the session's, the system's nor the program's")
            if room == "app" and len(place.parts) > 1 and len(rest) > 1 and rest[0] != place.parts[0]:
                arrows[place.parts[0]].add(rest[0])
    if "requests" in arrows["output"]:
        mistakes.append("output includes requests")
    for path in sorted((app.parent / "studio").rglob("*.[ch]pp")):
        mistakes += [f"{path.relative_to(app.parent)} includes {name}, which is neither the session's, the system's nor the studio's"
                     for name in INCLUDE.findall(path.read_text(encoding="utf-8"))
                     if name.split("/")[0] not in {"studio", "session", "system"}]
    for path in sorted(app.parent.rglob("*.[ch]pp")):
        if app not in path.parents:
            mistakes += [f"{path.relative_to(app.parent)} says {text}" for text in OPTION.findall(path.read_text(encoding="utf-8"))]
    for mistake in mistakes:
        print(mistake)
    print(f"{len(files)} files, {len(mistakes)} mistakes")
    return 1 if mistakes else 0


if __name__ == "__main__":
    sys.exit(main())
