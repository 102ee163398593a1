#!/usr/bin/env python3
"""Holds FnPlotter.py to what it must show of function files.

    check_fnplotter.py --plotter tools/FnPlotter.py --corpus tests/corpus/functions --work FOLDER
                       --program build/nutik-cl [--only plots]

Plots are left in FOLDER. Without Matplotlib most tests are skipped.
"""

import argparse
import os
import sys
import unittest
from pathlib import Path

from fnplotter.setting import paths

TESTS = ("figures", "plots", "layout", "capture", "masks", "messages")


def main():
    raw = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=raw)
    parser.add_argument("--plotter", type=Path, required=True)
    parser.add_argument("--corpus", type=Path, required=True)
    parser.add_argument("--work", type=Path, required=True)
    parser.add_argument("--program", type=Path, required=True)
    parser.add_argument("--only", choices=TESTS)
    options = parser.parse_args()
    paths.program = options.program.resolve()
    paths.plotter, paths.corpus = options.plotter.resolve(), options.corpus.resolve()
    paths.work = options.work.resolve() / (options.only or "all")
    paths.work.mkdir(parents=True, exist_ok=True)
    os.environ.setdefault("MPLCONFIGDIR", str(paths.work / "matplotlib"))
    os.environ["PATH"] = f"{paths.program.parent}{os.pathsep}{os.environ['PATH']}"
    sys.path.insert(0, str(paths.plotter.parent))
    names = [f"fnplotter.{name}_test" for name in ([options.only] if options.only else TESTS)]
    result = unittest.TextTestRunner().run(unittest.defaultTestLoader.loadTestsFromNames(names))
    return 0 if result.wasSuccessful() and result.testsRun else 1


if __name__ == "__main__":
    sys.exit(main())
