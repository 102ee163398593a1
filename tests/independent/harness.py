"""Running the program as a user would, and comparing what it writes with expose.py.

A float picture must agree within 1e-5 x S in light at every value, S = integral of |g| / D being
the natural scale of a pixel's error. An integer picture's codes must be the rounding of the light;
within the same bound of a rounding edge either code is right, and such pixels are counted.
"""

import shlex
import subprocess
import sys
from collections import namedtuple
from pathlib import Path

import numpy as np

import light as transfers
import pictures

sys.path[:0] = [str(Path(__file__).resolve().parent.parent / "tools")]
from words import over  # noqa: E402

TOLERANCE = 1e-5  # of S
SECONDS = 120  # longest that one run of the program may take


# What came of a run. command: for a shell, to run it again.
Run = namedtuple("Run", "status stderr command")


class Checks:
    """Runs the program, compares, prints each case with its worst error and counts failures."""

    def __init__(self, program, work, again):
        """again: the shell command that ran this script, for what a failure prints."""
        self.program, self.work, self.again = str(program), Path(work), again
        self.cases = self.failures = 0
        self.worst = (0.0, "")  # largest error / S of all float pictures, and its case
        self.section = ""

    def folder(self, name):
        """The folder of this name below the work folder."""
        folder = self.work / name
        folder.mkdir(parents=True, exist_ok=True)
        return folder

    def begin(self, section, title):
        self.section = section
        print(f"\n{title}", flush=True)

    def run(self, folder, *arguments, wanted=0):
        """Run the program in a folder: a Run. An exit status other than `wanted` is a failure; None
        wants any."""
        arguments = over([str(argument) for argument in arguments])
        command = f"cd {shlex.quote(str(folder))} && {shlex.join([self.program] + arguments)}"
        try:
            done = subprocess.run([self.program] + arguments, cwd=folder, capture_output=True,
                                  text=True, timeout=SECONDS, stdin=subprocess.DEVNULL)
            run = Run(done.returncode, done.stderr.strip(), command)
        except subprocess.TimeoutExpired:
            run = Run(-1, f"still running after {SECONDS} s", command)
        if wanted is not None and run.status != wanted:
            self.failed(shlex.join(["nutik-cl"] + arguments),
                        f"exit status {run.status}: {run.stderr}", command)
        return run

    def passed(self, name, said):
        self.cases += 1
        print(f"  ok   {name}: {said}", flush=True)

    def failed(self, name, said, command=""):
        self.cases += 1
        self.failures += 1
        print(f"  FAIL {name}: {said}", flush=True)
        if command:
            print(f"       again: {command}")
        print(f"       or the section: {self.again} --only {self.section}", flush=True)

    def holds(self, name, true, said, command=""):
        """A plain yes or no."""
        if true:
            self.passed(name, said)
        else:
            self.failed(name, said, command)

    def float_picture(self, name, path, expected, command):
        """Compare the PFM at a path with an Exposure, value by value."""
        try:
            got = pictures.read_pfm(path)
        except (OSError, ValueError, KeyError) as error:
            return self.failed(name, f"no float picture: {error}", command)
        want = expected.light
        if got.shape != want.shape:
            return self.failed(name, f"shape {got.shape}, expected {want.shape}", command)
        scale = np.broadcast_to(expected.scale[:, :, None], want.shape)
        error = np.abs(got - want)
        bad = ~(error <= TOLERANCE * scale)  # so that NaN is bad
        relative = np.divide(error, scale, out=np.zeros_like(error), where=scale > 0)
        if bad.any():
            at = tuple(int(i) for i in np.unravel_index(
                np.argmax(np.where(bad, np.nan_to_num(error, nan=np.inf), -1)), bad.shape))
            return self.failed(
                name, f"{bad.sum()} of {bad.size} values differ; row {at[0]} column {at[1]} "
                f"channel {at[2]}: program {got[at]!r}, expected {want[at]!r}, "
                f"allowed {TOLERANCE * scale[at]:.3g}", command)
        worst = float(relative.max())
        if worst >= self.worst[0]:
            self.worst = (worst, f"{self.section}, {name}")
        return self.passed(name, f"worst error {worst:.1e} S, light {want.min():.4g} … "
                                 f"{want.max():.4g}")

    def integer_picture(self, name, path, expected, transfer, command, white=255, bits=8):
        """Compare an integer picture's codes, 0 … white, with an Exposure's light, rounded."""
        try:
            codes = pictures.read_codes(path)
        except (OSError, ValueError) as error:
            return self.failed(name, f"no picture: {error}", command)
        kind = {8: np.uint8, 16: np.uint16}[bits]
        if codes.shape != expected.light.shape or codes.dtype != kind:
            return self.failed(name, f"{codes.shape} {codes.dtype}, expected "
                                     f"{expected.light.shape} {kind.__name__}", command)
        edges = np.concatenate([[-np.inf], transfers.code_edges(transfer, white), [np.inf]])
        allowed = TOLERANCE * expected.scale[:, :, None]
        codes = codes.astype(np.int64)
        bad = ~((edges[codes] - allowed <= expected.light) &
                (expected.light <= edges[codes + 1] + allowed))
        other = int((codes != transfers.codes_of(expected.light, transfer, white)).sum())
        if bad.any():
            at = tuple(int(i) for i in np.argwhere(bad)[0])
            want = transfers.codes_of(expected.light[at], transfer, white)
            return self.failed(
                name, f"{bad.sum()} of {bad.size} codes differ; row {at[0]} column {at[1]} "
                f"channel {at[2]}: program {codes[at]}, expected {want} "
                f"(light {expected.light[at]!r})", command)
        near = self._near_edges(expected.light, edges, allowed)
        return self.passed(name, f"{bits}-bit codes {codes.min()} … {codes.max()} all right; "
                                 f"{near} of {codes.size} within the bound of an edge, {other} "
                                 "rounded the other way")

    @staticmethod
    def _near_edges(light, edges, allowed):
        """How many values lie within `allowed` of a rounding edge."""
        above = np.clip(np.searchsorted(edges, light), 1, len(edges) - 1)
        distance = np.minimum(np.abs(edges[above] - light), np.abs(light - edges[above - 1]))
        return int((distance <= allowed).sum())

    def codes_are(self, name, folder, arguments, want):
        """Run a command with -o codes.png: its codes must be `want` (anything that broadcasts)."""
        path = folder / "codes.png"
        path.unlink(missing_ok=True)
        run = self.run(folder, *arguments, "-o", path.name)
        if run.status:
            return None
        codes = pictures.read_codes(path)
        wrong = np.argwhere(codes != want)
        if len(wrong):
            at = tuple(int(i) for i in wrong[0])
            return self.failed(
                name, f"{len(wrong)} of {codes.size} codes differ; row {at[0]} column {at[1]} "
                f"channel {at[2]}: program {codes[at]}, expected "
                f"{np.broadcast_to(want, codes.shape)[at]}",
                run.command)
        return self.passed(name, f"all {codes.size} codes right, {codes.min()} … {codes.max()}")

    def refused(self, name, folder, arguments, said):
        """Run a command that must fail, saying `said` on stderr and writing no picture."""
        path = folder / "refused.pfm"
        path.unlink(missing_ok=True)
        run = self.run(folder, *arguments, "-o", path.name, wanted=None)
        right = run.status > 0 and said in run.stderr and not path.exists()
        self.holds(f"refused: {name}", right, f"exit status {run.status}, {run.stderr!r}",
                   run.command)

    def new_picture(self, name, folder, before, command):
        """The one PNG in the folder that wasn't among `before`: the program chose its name."""
        new = sorted(set(folder.glob("*.png")) - before)
        if len(new) == 1:
            return new[0]
        self.failed(name, f"expected one new PNG, found {[path.name for path in new]}", command)
        return None

    def expose_both(self, name, folder, arguments, expected, transfer="srgb"):
        """Run a command as it stands (the program names a PNG), then with -o light.pfm."""
        before = set(folder.glob("*.png"))
        run = self.run(folder, *arguments)
        picture = None if run.status else self.new_picture(name, folder, before, run.command)
        if picture:
            self.integer_picture(f"{name} -> {picture.name}", picture, expected, transfer,
                                 run.command)
            picture.unlink()
        self.expose_float(name, folder, arguments, expected)

    def expose_float(self, name, folder, arguments, expected):
        """Run a command with -o light.pfm and compare. Returns the PFM's path."""
        path = folder / "light.pfm"
        path.unlink(missing_ok=True)  # the last run's must not pass for this one's
        run = self.run(folder, *arguments, "-o", path.name)
        if run.status == 0:
            self.float_picture(name, path, expected, run.command)
        return path
