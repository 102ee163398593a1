#!/usr/bin/env python3
"""Holds pages to what they point at: every relative link, every heading named in one, every file that they name, and
every docs/... path anywhere.

    check_links.py ROOT
"""

import re
import subprocess
import sys
from pathlib import Path

# Files that CONTRIBUTING.md has somebody add.
EXAMPLES = {"host/app/commands/times.cpp", "host/media/stills/farbfeld.cpp", "kernels/tile_kinds.cl"}


def without_code(page):
    return re.sub(r"^```.*?^```$", "", page, flags=re.DOTALL | re.MULTILINE)


def anchors_of(page):
    """As GitHub makes them of headings: lower case, blanks as hyphens, no other marks."""
    names = re.findall(r"^#+ (.*)$", without_code(page), re.MULTILINE)
    plain = (re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", name).lower() for name in names)
    return {re.sub(r"[^\w\- ]", "", name).replace(" ", "-") for name in plain}


def tracked(root):
    """Files that git knows; of a tree without git, all that are not built."""
    listed = subprocess.run(["git", "ls-files", "-co", "--exclude-standard"], cwd=root, text=True, capture_output=True)
    if listed.returncode == 0:
        names = (root / name for name in listed.stdout.splitlines())
    else:
        names = (path for path in root.rglob("*") if "build" not in path.relative_to(root).parts)
    return [path for path in names if path.is_file()]


def check_links(root, pages):
    for path, page in pages.items():
        for text, target in re.findall(r"\[((?:[^][]|\[[^]]*\])*)\]\(([^)\s]+)\)", re.sub(r"`[^`\n]*`", "``", without_code(page))):
            if re.match(r"[a-z]+:", target):
                continue
            name, _, anchor = target.partition("#")
            to = (path.parent / name).resolve() if name else path
            if not to.exists():
                yield f"{path.relative_to(root)}: [{text}] points to {target}, which is not there"
            elif anchor and to in pages and anchor not in anchors_of(pages[to]):
                yield f"{path.relative_to(root)}: [{text}] points to {target}, and {to.name} has no such heading"


def check_named_files(root, pages):
    for path, page in pages.items():
        for name in set(re.findall(r"`((?:host|kernels|tests|tools)/[\w./-]*\w)`", page)):
            if name not in EXAMPLES and not (root / name).exists():
                yield f"{path.relative_to(root)} names {name}, which is not there"


def check_paths(root, files):
    for path in files:
        try:
            text = path.read_text()
        except UnicodeDecodeError:
            continue
        for name in set(re.findall(r"(?<![\w./-])docs/[\w./-]*\w", text)):
            if not (root / name).exists():
                yield f"{path.relative_to(root)} names {name}, which is not there"


def main():
    root = Path(sys.argv[1]).resolve()
    files = tracked(root)
    pages = {path.resolve(): path.read_text() for path in files if path.suffix == ".md"}
    mistakes = [*check_links(root, pages), *check_named_files(root, pages), *check_paths(root, files)]
    print("\n".join(mistakes) or f"{len(pages)} pages, {sum(page.count('](') for page in pages.values())} links")
    return 1 if mistakes or not pages else 0


if __name__ == "__main__":
    sys.exit(main())
