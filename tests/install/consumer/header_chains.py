"""Writes sources that include every header such that each is compiled as if it stood alone, in as few as that takes.

    header_chains.py INCLUDE_FOLDER SOURCE_FOLDER

Headers that follow one another in a source include each other: what stands before a header is what that includes anyway.
"""

import re
import sys
from functools import cache
from pathlib import Path

folder, sources = (Path(text) for text in sys.argv[1:])
headers = sorted(str(path.relative_to(folder)) for path in (folder / "nutik").rglob("*.hpp"))
if not headers:
    sys.exit(f"no header is installed in {folder}")


@cache
def included_by(header):
    """All that it includes, before anything else, and what those include."""
    top = re.match(r"(?:(?://|#).*\n|\s)*", (folder / header).read_text())[0]
    named = re.findall(r'^#include [<"](.+?)[>"]', top, re.MULTILINE)
    direct = set(named) & set(headers)
    return direct.union(*(included_by(name) for name in direct))


after = {}  # of each header the one behind it: a largest matching gives the fewest chains


def follows(header, tried):
    """Whether a header finds one to stand behind, which may send others elsewhere."""
    for before in sorted(included_by(header) - tried, key=lambda name: (-len(included_by(name)), name)):
        if before in tried:
            continue
        tried.add(before)
        if before not in after or follows(after[before], tried):
            after[before] = header
            return True
    return False


for header in headers:
    follows(header, set())
sources.mkdir(parents=True, exist_ok=True)
for number, header in enumerate(sorted(set(headers) - set(after.values()))):
    chain = [header]
    while chain[-1] in after:
        chain.append(after[chain[-1]])
    (sources / f"{number:03}.cpp").write_text("".join(f'#include "{name}"\n' for name in chain))
