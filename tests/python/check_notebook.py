#!/usr/bin/python3
"""Runs a notebook's cells, whose assertions hold its numbers; what comes of it is written to the folder, or with
--publish in its place. Where Jupyter is missing its code runs by itself, and nothing is written.

    check_notebook.py NOTEBOOK --work FOLDER [--publish]
"""

import argparse
import importlib.util
import json
import os
from pathlib import Path


def run_alone(notebook, path):
    """The code of all cells, one behind the other."""
    import matplotlib
    matplotlib.use("agg")
    os.chdir(path.parent)
    names = {}
    cells = ["".join(cell["source"]) for cell in notebook["cells"] if cell["cell_type"] == "code"]
    for cell in cells:
        exec(compile(cell, str(path), "exec"), names)
    assert "assert" in "".join(cells), "it asserts nothing"
    print(f"{path}: the code of {len(cells)} cells runs")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("notebook", type=Path)
    parser.add_argument("--work", type=Path, required=True)
    parser.add_argument("--publish", action="store_true")
    arguments = parser.parse_args()
    text = arguments.notebook.read_text(encoding="utf-8")
    for module in ("matplotlib", "cv2"):
        if module in text and importlib.util.find_spec(module) is None:
            print(f"SKIPPED: Python's module {module} is not installed")
            return
    if any(importlib.util.find_spec(module) is None for module in ("nbclient", "nbformat", "ipykernel")):
        run_alone(json.loads(text), arguments.notebook)
        return
    import nbformat
    from nbclient import NotebookClient

    notebook = nbformat.read(arguments.notebook, nbformat.NO_CONVERT)
    nbformat.validate(notebook)
    NotebookClient(notebook, kernel_name="python3", timeout=300, record_timing=False,
                   resources={"metadata": {"path": arguments.notebook.parent}}).execute()
    assertions = sum(cell.source.count("assert") for cell in notebook.cells if cell.cell_type == "code")
    assert assertions, "it asserts nothing"
    notebook.metadata.pop("widgets", None)
    target = arguments.notebook if arguments.publish else arguments.work / arguments.notebook.name
    target.parent.mkdir(parents=True, exist_ok=True)
    nbformat.write(notebook, target)
    print(f"{target}: {assertions} assertions hold")


if __name__ == "__main__":
    main()
