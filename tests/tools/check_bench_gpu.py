"""The benchmark for bare GPU machines builds from the core alone, runs, and is right.

    check_bench_gpu.py --script tools/bench/gpu --work FOLDER

On whatever device there is; how fast it is does not matter here.
"""

import argparse
import csv
import os
import pathlib
import subprocess

# What every arithmetic keeps on these few samples, in S: single's bound (docs/explanation/accuracy.md).
LARGEST_ERROR = 4e-6

parser = argparse.ArgumentParser()
parser.add_argument("--script", type=pathlib.Path, required=True)
parser.add_argument("--work", type=pathlib.Path, required=True)
arguments = parser.parse_args()
arguments.work.mkdir(parents=True, exist_ok=True)

table = arguments.work / "kernels.csv"
done = subprocess.run(
    [arguments.script, "--quick", "--width", "200", "--height", "100", "--samples", "20", "--runs", "1", "--csv", table],
    env=os.environ | {"NUTIK_CORE_BUILD": str(arguments.work / "build"), "CMAKE_BUILD_TYPE": "None", "CXXFLAGS": "-O1"},
    text=True)
assert done.returncode == 0, done.returncode
rows = list(csv.DictReader(table.open()))
assert {row["precision"] for row in rows} >= {"single", "fixed"}, rows
for row in rows:
    assert float(row["worst"]) <= LARGEST_ERROR, row
print(f"{len(rows)} cases, worst {max(float(row['worst']) for row in rows):.3g} of S")
