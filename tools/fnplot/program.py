"""Asks nutik-cl for what it reads: function files are parsed, and captures opened, by the program alone."""

import csv
import subprocess
from array import array

from fnplot.errors import InputError, OutputError, PlotterError
from fnplot.gain_function import GainFunction
from fnplot.input import title_of

BAD_INPUT = 3  # its exit status


def run_program(program, *words):
    """It, when it has ended; it reads our standard input."""
    try:
        command = [program, *words]
        return subprocess.run(command, capture_output=True, encoding="utf-8", errors="replace", check=False)
    except OSError as error:
        way_out = "say where nutik-cl is: --program build/nutik-cl"
        raise OutputError(f"{program} cannot be run ({error.strerror}); {way_out}") from None


def failure_of(run, what):
    """The error to raise where it failed: with its own words and exit status."""
    reason = run.stderr.strip() or f"exit status {run.returncode}"
    return PlotterError(f"{what} failed: {reason}", run.returncode)


def read_functions(name, program):
    """The gain functions of a file by mask value, and warnings of its text; all its mistakes are one error."""
    run = run_program(program, "check", "--points", f"--functions={name}")
    if run.returncode == BAD_INPUT:
        raise InputError(run.stderr.strip().removeprefix("nutik-cl: "))
    if run.returncode != 0:
        raise failure_of(run, f"{program} check {title_of(name)}")
    functions = {}
    try:
        for tag, time_ns, gain in list(csv.reader(run.stdout.splitlines()))[1:]:
            function = functions.setdefault(int(tag), GainFunction(array("q"), array("d")))
            function.times_ns.append(int(time_ns))
            function.gains.append(float(gain))
    except ValueError as error:
        raise InputError(f"what {program} says of {title_of(name)} cannot be understood ({error})") from None
    if not functions:
        raise InputError(f"{program} says nothing of the functions of {title_of(name)}")
    return functions, run.stderr.strip("\n")
