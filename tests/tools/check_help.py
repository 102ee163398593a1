#!/usr/bin/env python3
"""Every script in tools/ says what it does when it is asked with --help, and does nothing else.

    check_help.py PROJECT
"""

import subprocess
import sys
import tempfile
from pathlib import Path

ANSWER_S = 60


def mistake_of(script: Path, folder: str) -> str | None:
    said = subprocess.run([script, "--help"], cwd=folder, capture_output=True, text=True, timeout=ANSWER_S)
    if said.returncode != 0 or said.stderr:
        return f"tools/{script.name} --help: exit status {said.returncode}, {said.stderr!r}"
    if script.name not in said.stdout or any(Path(folder).iterdir()):
        return f"tools/{script.name} --help does not tell of itself alone: {said.stdout!r}"
    return None


def main():
    tools = Path(sys.argv[1]).resolve() / "tools"
    scripts = [path for path in sorted(tools.iterdir())
               if path.is_file() and path.read_text().startswith("#!/usr/bin/env bash")]
    with tempfile.TemporaryDirectory() as folder:
        mistakes = [mistake for script in scripts if (mistake := mistake_of(script, folder))]
    print("\n".join(mistakes) or f"{len(scripts)} scripts tell of themselves")
    return 1 if mistakes or not scripts else 0


if __name__ == "__main__":
    sys.exit(main())
