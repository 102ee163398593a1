#!/usr/bin/env python3
"""Every place that opens, makes, empties, renames or removes a file by its name stands in the table of
tests/pages/calls.md, with these calls and with why it is safe.

    check_calls.py --root FOLDER
"""

import argparse
import re
import sys
from pathlib import Path

# Of the system, of the standard library, of Qt and of the libraries that read and write clips and pictures.
CALLS = (r"unlink", r"unlinkat", r"rmdir", r"(?:filesystem|fs)::remove", r"QFile::remove", r"remove_all",
         r"rename", r"renameat2?", r"QFile::rename", r"truncate", r"ftruncate", r"resize_file", r"openat2?", r"creat",
         r"fopen", r"mkdir", r"mkdirat", r"create_director(?:y|ies)", r"mkdtemp", r"mkostemp", r"mkstemp", r"mkfifo", r"link",
         r"linkat", r"symlink", r"create_(?:hard_link|symlink)", r"copy_file", r"chmod", r"fchmod", r"fs::permissions",
         r"dlopen", r"glob", r"avio_open2?", r"avformat_open_input", r"TIFFOpen(?:Ext)?", r"imread", r"imwrite")
CALL = re.compile(r"(?<![\w.>])((?:std::)?(?:%s))\s*\(" % "|".join(CALLS))
OPEN = re.compile(r"(?<![\w.>])open\s*\([^;]*?\bO_[A-Z]+")
OBJECT = re.compile(r"\b(QFile|QSaveFile|QLockFile|(?:std::)?[io]?fstream)\s+\w+\s*[({]")
COMMENT = re.compile(r"//[^\n]*")
TABLE_ROW = re.compile(r"^\| `((?:host|python)/[^`]+)` \| ([^|]*) \| ([^|]*) \|$", re.MULTILINE)


def calls_of(source):
    text = COMMENT.sub("", source)
    found = {name.replace("std::", "").replace("filesystem::", "").replace("fs::", "") for name in
             CALL.findall(text) + OBJECT.findall(text)}
    return found | ({"open"} if OPEN.search(text) else set())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--root", type=Path, required=True)
    root = parser.parse_args().root
    page = (root / "tests/pages/calls.md").read_text(encoding="utf-8")
    stated = {place: (set(re.findall(r"`([^`]+)`", calls)), why) for place, calls, why in TABLE_ROW.findall(page)}
    found = {}
    for folder in ("host", "python/src"):
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in (".cpp", ".hpp", ".inl"):
                calls = calls_of(path.read_text(encoding="utf-8"))
                if calls:
                    found[path.relative_to(root).as_posix()] = calls
    mistakes = [f"{place}: {', '.join(sorted(calls - stated.get(place, (set(), ''))[0]))} is not in the table"
                for place, calls in found.items() if calls - stated.get(place, (set(), ""))[0]]
    mistakes += [f"{place}: {', '.join(sorted(calls - found.get(place, set())))} is in the table, and not called"
                 for place, (calls, _) in stated.items() if calls - found.get(place, set())]
    mistakes += [f"{place}: the table does not say why" for place, (_, why) in stated.items() if not why.strip()]
    mistakes += [f"{place}: there is no such file" for place in stated if not (root / place).is_file()]
    for mistake in mistakes:
        print(mistake)
    print(f"{len(found)} files, {sum(map(len, found.values()))} calls, {len(mistakes)} mistakes")
    if mistakes or not found:
        sys.exit(1)


if __name__ == "__main__":
    main()
