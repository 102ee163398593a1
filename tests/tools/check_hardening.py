"""Programs and modules are hardened as host/room.cmake says.

    check_hardening.py [--fortified] FILE … [--without-calls FILE …]
"""

import argparse
import re
import shutil
import subprocess

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("files", nargs="+")
parser.add_argument("--fortified", action="store_true", help="built with optimization and without sanitizers")
parser.add_argument("--without-calls", nargs="+", default=[], metavar="FILE",
                    help="files that call nothing of libc whose bounds a compiler could know")
arguments = parser.parse_args()

if shutil.which("readelf") is None:
    print("SKIPPED: readelf is not installed")
    raise SystemExit

mistakes = []
for file in arguments.files + arguments.without_calls:
    def told(option):
        return subprocess.run(["readelf", "-W", option, file], check=True, text=True, capture_output=True).stdout

    symbols = told("--dyn-syms")
    for what, is_so in {
        "position-independent": re.search(r"Type:\s+DYN", told("-h")),
        "relocations that are read-only": "GNU_RELRO" in told("-l"),
        "all of them from the start": re.search(r"BIND_NOW|Flags:.*NOW", told("-d")),
        "a stack that is not executable": re.search(r"GNU_STACK.*RW ", told("-l")),
        "a stack protector": "__stack_chk_fail" in symbols,
        "checked libc calls": not arguments.fortified or file in arguments.without_calls
                              or re.search(r"__\w+_chk\b", symbols),
    }.items():
        if not is_so:
            mistakes.append(f"{file} lacks: {what}")
print("\n".join(mistakes) or "all files are hardened")
raise SystemExit(1 if mistakes else 0)
