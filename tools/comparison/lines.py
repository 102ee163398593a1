"""The command lines of commands.txt, and what comes of one."""

import os
import re
import shutil
import signal
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

SECONDS = 600  # longest that one line may take; building kernels for a new program takes most


class Outcome(NamedTuple):
    status: int
    stdout: str
    stderr: str
    folder: Path
    files: frozenset  # names of those that the line wrote


def environment(program, folder):
    """Programs are started as `nutik-cl`, so that messages name them alike."""
    programs = folder / ".bin"
    programs.mkdir()
    (programs / "nutik-cl").symlink_to(program)
    (folder / ".temporary").mkdir()
    kept = {key: value for key, value in os.environ.items() if not key.startswith("NUTIK_")}
    return dict(kept, PATH=f"{programs}:{os.environ['PATH']}", TMPDIR=str(folder / ".temporary"), COLUMNS="80",
                LC_ALL="C.UTF-8")


def files_of(folder):
    """Files below a folder, links aside: name and inode."""
    return {str(path.relative_to(folder)): path.stat().st_ino for path in folder.rglob("*")
            if path.is_file() and not path.is_symlink()}


def run(line, program, inputs, folder, settings=None):
    """What comes of a line beside links to the inputs. settings: more of the environment."""
    shutil.copytree(inputs, folder, copy_function=os.link)
    before = files_of(folder)
    process = subprocess.Popen(["bash", "-o", "pipefail", "-c", line], cwd=folder, env=environment(program, folder) | (settings or {}),
                               stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                               start_new_session=True)
    try:
        streams = process.communicate(timeout=SECONDS)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)  # bash alone would leave its children
        process.communicate()
        return Outcome(-1, "", f"still running after {SECONDS} s", folder, frozenset())
    after = files_of(folder)
    written = frozenset(name for name, inode in after.items() if before.get(name) != inode)
    streams = [stream.decode(errors="backslashreplace") for stream in streams]
    return Outcome(process.returncode, *streams, folder, written | {f"{name} (removed)" for name in before.keys() - after})


def read_lines(only):
    """Those that match a regular expression, and their numbers."""
    text = (Path(__file__).resolve().parent / "commands.txt").read_text()
    lines = [line for line in text.splitlines() if line and not line.startswith("#")]
    if len(set(lines)) < len(lines):
        sys.exit("comparison/commands.txt has a line twice")
    return [(number, line) for number, line in enumerate(lines, 1) if re.search(only, line)]
