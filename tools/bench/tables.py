"""What the benchmark scripts share."""

import csv
import subprocess
import sys
import time


def run(*command):
    """Runs a command to its end and returns its seconds; leaves with its messages where it fails."""
    start = time.perf_counter()
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, command))}\n{done.stderr}")
    return time.perf_counter() - start


def output_of(*command):
    """What a command prints on its standard output."""
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


def peak_megabytes(*command):
    """The most memory that a command held, by the system's count."""
    code = ("import resource, subprocess, sys; done = subprocess.run(sys.argv[1:], stdout=subprocess.DEVNULL);"
            "print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss); sys.exit(done.returncode)")
    return int(output_of(sys.executable, "-c", code, *map(str, command))) * 1024 / 1e6


def write_csv(path, rows):
    """Writes rows, dicts with the same keys, under a line with these."""
    with path.open("w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)
