#!/usr/bin/python3
"""Runs a notebook's cells, whose assertions hold its numbers; what comes of it is written to the folder, or with
--publish in its place.

    check_notebook.py NOTEBOOK --work FOLDER [--publish]
"""

import argparse
import importlib.util
from pathlib import Path


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("notebook", type=Path)
    parser.add_argument("--work", type=Path, required=True)
    parser.add_argument("--publish", action="store_true")
    arguments = parser.parse_args()
    for module in ("nbclient", "nbformat", "ipykernel", "matplotlib", "cv2"):
        if importlib.util.find_spec(module) is None:
            print(f"SKIPPED: Python's module {module} is not installed")
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
