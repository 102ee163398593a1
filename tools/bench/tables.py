"""What the benchmark scripts share."""

import argparse
import csv
import pathlib
import subprocess
import sys
import time


# The recorded clips that scripts measure unless told otherwise.
CLIPS = ("bicycle-wheel.mp4", "diabolo-cm-trajectory.mp4", "BallTossOut.mp4",
         "one-by-one-person-detection.mp4", "bottle-detection.mp4", "bulk-water.mov", "realshort.mp4",
         "bikes.mp4")

STEEPEST = 12.92  # of sRGB codes in their light: in the dark


def command_line(description, runs, chart=False, clips=False):
    """A parser with the options of every script: the build, how often, and where the figures go beside the terminal."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, required=True, help="folder with nutik-cl and benchmarks")
    parser.add_argument("--runs", type=int, default=runs)
    parser.add_argument("--csv", type=pathlib.Path, metavar="FILE")
    if clips:
        parser.add_argument("--clips", type=pathlib.Path, required=True, help="folder of recorded clips")
        parser.add_argument("--only", nargs="*", default=CLIPS, metavar="NAME", help="of them")
    if chart:
        parser.add_argument("--chart", type=pathlib.Path, metavar="FILE.png")
    return parser


def write_outputs(arguments, rows, chart=None):
    """Rows as CSV and, drawn by `chart` (path, rows), as a picture, where they were asked for."""
    if arguments.csv:
        write_csv(arguments.csv, rows)
    if chart and arguments.chart:
        chart(arguments.chart, rows)


def pyplot():
    """Matplotlib, to draw files; loaded only where a chart is asked for."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot

    return matplotlib.pyplot


def size_of(clip):
    """Width, height and number of pictures."""
    probe = output_of("ffprobe", "-v", "error", "-count_packets", "-select_streams", "v", "-show_entries",
                      "stream=width,height,nb_read_packets", "-of", "csv=p=0", clip)
    return tuple(map(int, probe.strip().strip(",").split(",")[:3]))


def run_once(*command):
    """Runs a command and returns its seconds; leaves with its messages where it fails."""
    start = time.perf_counter()
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, command))}\n{done.stderr}")
    return time.perf_counter() - start


def run(*command, makes=None):
    """Runs a command twice and returns the seconds of the second time, by run_once(). Virtual
    machines give free memory to their host and fetch it again at up to 2 s a gigabyte: what the first run held, the
    second finds at hand. `makes` is a file that is removed before each, which replacing it would write to disk first."""
    for _ in range(2):
        if makes:
            makes.unlink(missing_ok=True)
        seconds = run_once(*command)
    return seconds


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
