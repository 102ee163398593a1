#!/usr/bin/env python3
"""NoisePlotter.py: that it draws, computes what docs/explanation/noise.md says, and names what is wrong with a file."""

import argparse
import math
import subprocess
import sys
from pathlib import Path

from report import Report

GREY = """nutik noise 0
white 255
transfer srgb
channel grey
read 0.002
shot 0.0001
curve sensor
point 10 1.5 100
point 20.5 2 50
"""


class Checks(Report):
    def __init__(self, plotter, work):
        super().__init__()
        self.plotter, self.work = plotter, work

    def holds(self, name, true, said=""):
        self.hold(true, name if true or not said else f"{name}: {said}")

    def run(self, text, *arguments, overwrite=True):
        (self.work / "a.noise").write_text(text)
        words = [*arguments, *["--overwrite"] * overwrite]
        return subprocess.run([sys.executable, self.plotter, "a.noise", *words], cwd=self.work, capture_output=True,
                              text=True)

    def refuses(self, name, text, said):
        output = self.work / "refused.png"
        run = self.run(text, "-o", output.name)
        right = run.returncode == 3 and said in run.stderr and not output.exists()
        self.holds(name, right, f"{run.returncode}: {run.stderr}")


def check_drawing(checks):
    for suffix, start in ((".png", b"\x89PNG"), (".svg", b"<?xml"), (".pdf", b"%PDF")):
        path = checks.work / f"plot{suffix}"
        path.unlink(missing_ok=True)
        colour = GREY + GREY.split("srgb\n")[1].replace("grey", "green") + GREY.split("srgb\n")[1].replace(
            "grey", "blue").replace("sensor", "points")
        run = checks.run(colour.replace("grey", "red"), "-o", path.name)
        drawn = run.returncode == 0 and path.read_bytes().startswith(start)
        checks.holds(f"draws {suffix}", drawn, run.stderr)
    run = checks.run(GREY, "-o", "plot.png", overwrite=False)
    checks.holds("replaces nothing unasked", run.returncode == 2 and "--overwrite" in run.stderr, run.stderr)
    checks.holds("refuses .jpg", checks.run(GREY, "-o", "a.jpg").returncode == 2)
    run = checks.run(GREY, "-o", "absent/a.png")
    checks.holds("says why it cannot write", run.returncode == 5 and "absent" in run.stderr, run.stderr)


def check_flat(checks):
    """One point, and a curve that is flat at the largest value there is."""
    from matplotlib.figure import Figure
    from noiseplot.noise_file import read_noise
    from noiseplot.page import draw

    path = checks.work / "flat.noise"
    flat = GREY.replace("0.002", "0").replace("0.0001", "0").replace("sensor", "points").replace("20.5 2", "20.5 1.5")
    path.write_text(flat)
    figure = Figure()
    draw(figure, read_noise(path), "flat")
    top = figure.axes[0].get_ylim()[1]
    checks.holds("a flat curve lies well below the frame", top >= 1.1 * 1.5, f"1.5 in {top}")
    run = checks.run(GREY[:GREY.index("point 20.5")], "-o", "one.svg")
    text = (checks.work / "one.svg").read_text() if run.returncode == 0 else ""
    checks.holds("one point is one point", "<!-- 1 point, measured -->" in text, run.stderr)


def check_standard_input(checks):
    run = subprocess.run([sys.executable, checks.plotter, "-", "-o", "piped.svg", "--overwrite"], cwd=checks.work,
                         input=GREY, capture_output=True, text=True)
    piped = run.returncode == 0 and "<!-- standard input -->" in (checks.work / "piped.svg").read_text()
    checks.holds("reads standard input", piped, run.stderr)
    run = subprocess.run([sys.executable, checks.plotter, "-"], cwd=checks.work, input="nutik", capture_output=True,
                         text=True)
    checks.holds("names standard input", run.returncode == 3 and "standard input:1: a noise file" in run.stderr,
                 run.stderr)


def check_numbers(checks):
    from noiseplot.noise_file import read_noise

    path = checks.work / "numbers.noise"
    path.write_text(GREY.replace("srgb", "linear"))
    noise = read_noise(path)
    (channel,) = noise.channels
    for code in (0, 51, 255):  # the slope is 255 codes for each unit of light
        want = math.sqrt(255**2 * (0.002**2 + 0.0001 * code / 255) + 1 / 12)
        checks.holds(f"sensor's curve at {code}", abs(noise.sensor_sd(channel, code) - want) < 1e-9)
    for code, want in ((0, 1.5), (10, 1.5), (15.25, 1.75), (20.5, 2), (255, 2)):
        checks.holds(f"line at {code}", abs(noise.points_sd(channel, code) - want) < 1e-9)


def check_mistakes(checks):
    checks.refuses("an empty file", "", "a.noise:1: a noise file starts with")
    checks.refuses("another version", GREY.replace("noise 0", "noise 1"), "a.noise:1: a noise file starts with")
    checks.refuses("an unknown key", GREY + "pont 1 2 3\n", "a.noise:10: 'pont' is no key")
    checks.refuses("a word for a number", GREY.replace("0.002", "few"), "a.noise:5: read 'few' is no number")
    checks.refuses("points in disorder", GREY + "point 4 1 1\n", "a.noise:10: code 4 is not above")
    checks.refuses("a point that lacks a number", GREY + "point 40 1\n", "a.noise:10: 'point' takes 3 values")
    checks.refuses("no channel", "nutik noise 0\nwhite 255\ntransfer srgb\n", "no channel")
    checks.refuses("no curve", GREY.replace("curve sensor\n", ""), "does not say which curve")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--plotter", type=Path, required=True)
    parser.add_argument("--work", type=Path, required=True)
    arguments = parser.parse_args()
    arguments.work.mkdir(parents=True, exist_ok=True)
    checks = Checks(arguments.plotter.resolve(), arguments.work)
    sys.path.insert(0, str(checks.plotter.parent))
    check_drawing(checks)
    check_flat(checks)
    check_standard_input(checks)
    check_numbers(checks)
    check_mistakes(checks)
    checks.end()


if __name__ == "__main__":
    main()
