"""What the tests share: where things are, running the plotter, and looking at what it drew."""

import importlib.util
import io
import json
import os
import re
import subprocess
import sys
import unittest
import zlib
from contextlib import redirect_stderr, redirect_stdout
from types import SimpleNamespace

paths = SimpleNamespace(plotter=None, corpus=None, work=None, program=None)  # set by check_fnplotter.py

CAPTURE_NS = 3_000_000_000

needs_matplotlib = unittest.skipUnless(importlib.util.find_spec("matplotlib"), "Matplotlib is missing")


def run(*arguments, stdin=None, overwrite=True, **environment):
    """FnPlotter.py with arguments, as a user would run it, without a display; an earlier test's plots may be there."""
    absent = dict.fromkeys(("DISPLAY", "WAYLAND_DISPLAY"), "")
    command = [sys.executable, str(paths.plotter), *map(str, arguments), *["--overwrite"] * overwrite]
    how = {"capture_output": True, "encoding": "utf-8", "timeout": 300, "check": False, "input": stdin}
    return subprocess.run(command, env=os.environ | absent | {"PYTHONIOENCODING": "utf-8"} | environment, **how)


def draw(*arguments):
    """The same in this process, which loads Matplotlib once."""
    from FnPlotter import command_line, plot, status_of

    with redirect_stdout(io.StringIO()) as out, redirect_stderr(io.StringIO()) as err:
        status = status_of("FnPlotter.py", plot, command_line().parse_args([*map(str, arguments), "--overwrite"]))
    return SimpleNamespace(returncode=status, stdout=out.getvalue(), stderr=err.getvalue())


def write(name, content):
    """A file in the work folder."""
    path = paths.work / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


def many_functions(count):
    return "".join(f"M{tag} [0:0], [{tag + 1}:{tag}], [1000:0]\n" for tag in range(count))


def expectations():
    return json.loads((paths.corpus / "expected.json").read_text(encoding="utf-8"))


def functions_of(name):
    """Those of a file of the corpus, by mask value."""
    from fnplot.program import read_functions

    return read_functions(str(paths.corpus / name), str(paths.program))[0]


def colour_count(path, colour):
    """How many pixels of a picture have a colour."""
    import numpy as np
    from PIL import Image

    with Image.open(path) as picture:
        return int(np.all(np.asarray(picture.convert("RGB")) == colour, axis=-1).sum())


def pdf_contents(path):
    """The number of pages, and what they draw with."""
    data = path.read_bytes()
    streams = re.findall(rb"stream\r?\n(.*?)\r?\nendstream", data, re.DOTALL)
    drawing = b""
    for stream in streams:
        try:
            drawing += zlib.decompress(stream)
        except zlib.error:
            pass  # a stream that is not compressed
    return len(re.findall(rb"/Type /Page\b", data)), " ".join(drawing.decode("latin-1").split())
