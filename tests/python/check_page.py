#!/usr/bin/python3
"""Runs every Python example of a page, one behind the other, beside a small clip; and looks that the pages and pictures
that it links to are there.

    check_page.py --page docs/reference/python.md --work FOLDER
"""

import argparse
import importlib.util
import os
import re
import shutil
import sys
import warnings
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--page", type=Path, required=True)
    parser.add_argument("--work", type=Path, required=True)
    arguments = parser.parse_args()
    text = arguments.page.read_text(encoding="utf-8")
    for link in re.findall(r"\]\(([^)#]+)\)", text):
        assert (arguments.page.parent / link).exists(), f"{link} is not there"

    from scenes import RollingBall, camera
    shutil.rmtree(arguments.work, ignore_errors=True)
    arguments.work.mkdir(parents=True)
    camera.film(RollingBall(160, 90), 1, arguments.work / "clip.mkv")
    os.chdir(arguments.work)
    names = {}
    examples = list(re.finditer(r"^```python\n(.*?)^```$", text, re.MULTILINE | re.DOTALL))
    assert examples, "the page has no example"
    for example in examples:
        if "to_xarray" in example[1] and importlib.util.find_spec("xarray") is None:
            print("not run, for Python's module xarray is not installed:", example[1])
            continue
        line = text.count("\n", 0, example.start(1))
        with warnings.catch_warnings():
            warnings.simplefilter("always")
            exec(compile("\n" * line + example[1], str(arguments.page), "exec"), names)
    assert set(os.listdir()) == {"clip.mkv", "light.exr", "moment.png", "noise.tik", "part-0.tik", "part-1.tik",
                                 "whole.tik"}, os.listdir()
    print(f"{len(examples)} examples run")


if __name__ == "__main__":
    main()
