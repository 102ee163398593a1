#!/usr/bin/env python3
"""Compares FnPlotter.py's reading of function files with the program's, on the corpus and mutations of it.

    fuzz_functions.py --reader build/tests/read_functions --tools tools --corpus tests/corpus/functions
                      [--count 400] [--seed 1]

Compared are functions, control points, the whole report (places, words, excerpts, counts), and what each
function comes to over a capture: D and live interval exactly, the integral within what its own rounding
allows. A file on which they differ is printed, with the seed that makes it again.
"""

import argparse
import json
import random
import subprocess
import sys
from fractions import Fraction
from pathlib import Path

DURATIONS_NS = (1, 1000, 410_000_001, 3_000_000_000, 4_000_000_000_000_000_000)

# What people type, and what editors, web pages and other systems put there.
PIECES = (
    *("M0", "M7", "M128", "M255", "M256", "M", "m1", "[0:1]", "[5:0]", "[10:-0.5]", "[1000000000:1]"),
    *("[", "]", "{", "}", ",", ":", "#", " ", "\t", "\v", "\f", "\n", "\r", "\r\n", "\n\n", "\0", ";", "'"),
    *("-", "+", ".", "e", "E", "0", "9", "1e9", "1e400", "1e-400"),
    *("inf", "nan(1)", "0x10", "10ms", "0,5", "5%"),
    *("9223372036854775808", "4000000000000000000", "4000000000000000001", "-4000000000000000000", "1" * 50),
    *("# }", "# M1 [0:1]", "\ufeff", "\u00a0", "\u2212", "\u00b5s", "\u200b", "é", "€", "😀", "\U000e0001"),
    *(b"\xef\xbb", b"\xbf", b"\xff", b"\xe9", b"\xed\xa0\x80", b"\xf4\x90\x80\x80", b"\x85", b"\x1c"),
)


def encoded(piece):
    return piece if isinstance(piece, bytes) else piece.encode()


class Mutator:
    """Draws files that differ a little from those of the corpus, the same ones for the same seed."""

    def __init__(self, files, seed):
        self.files = files
        self.draw = random.Random(seed)

    def file(self):
        content = self.draw.choice(self.files)
        for _ in range(self.draw.choice((1, 1, 1, 2, 3, 8))):
            content = self.draw.choice(self.MUTATIONS)(self, content)
        return content[:50_000]

    def stretch(self, content, longest=12):
        begin = self.draw.randint(0, len(content))
        return begin, min(len(content), begin + self.draw.randint(0, longest))

    def insert(self, content):
        at = self.draw.randint(0, len(content))
        return content[:at] + encoded(self.draw.choice(PIECES)) + content[at:]

    def replace(self, content):
        begin, end = self.stretch(content, 4)
        return content[:begin] + encoded(self.draw.choice(PIECES)) + content[end:]

    def delete(self, content):
        begin, end = self.stretch(content)
        return content[:begin] + content[end:]

    def repeat(self, content):
        begin, end = self.stretch(content, 40)
        return content[:begin] + content[begin:end] * self.draw.choice((2, 3, 30)) + content[end:]

    def change_byte(self, content):
        if not content:
            return content
        at = self.draw.randrange(len(content))
        return content[:at] + bytes([self.draw.randrange(256)]) + content[at + 1 :]

    def change_digit(self, content):
        places = [at for at, byte in enumerate(content) if chr(byte).isdigit()]
        if not places:
            return content
        at = self.draw.choice(places)
        digit = b"" if self.draw.random() < 0.3 else b"%d" % self.draw.randrange(10)
        return content[:at] + digit + content[at + 1 :]

    def move_line(self, content):
        lines = content.splitlines(keepends=True)
        line = lines.pop(self.draw.randrange(len(lines))) if lines else b"\n"
        lines.insert(self.draw.randint(0, len(lines)), line)
        return b"".join(lines)

    def join_files(self, content):
        other = self.draw.choice(self.files)
        begin, end = self.stretch(other, len(other))
        at = self.draw.randint(0, len(content))
        return content[:at] + other[begin:end] + content[at:]

    def change_line_ends(self, content):
        return content.replace(b"\n", self.draw.choice((b"\r\n", b"\r", b" \n", b"\n\n")))

    MUTATIONS = (
        *(insert, replace, delete, repeat, change_byte, change_digit),
        *(move_line, join_files, change_line_ends),
    )


class ProgramReader:
    """What the program reads from files."""

    def __init__(self, path):
        how = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
        self.process = subprocess.Popen([str(path)], **how)

    def read(self, content, duration_ns):
        self.process.stdin.write(b"%d %d\n" % (len(content), duration_ns) + content)
        self.process.stdin.flush()
        answer = self.process.stdout.readline()
        if not answer:
            raise SystemExit(f"the program's reader ended with status {self.process.wait()} on {content!r}")
        return json.loads(answer)

    def close(self):
        self.process.stdin.close()
        return self.process.wait(timeout=60)


def summary_differences(summary, of_program):
    """What differs, in words; nothing where all agrees."""
    live = of_program["live"] if of_program["live"][0] < of_program["live"][1] else None
    if (list(summary.live_ns) if summary.live_ns else None) != live:
        yield f"live interval {summary.live_ns}, program {live}"
    if summary.support_ns != of_program["support_ns"]:
        yield f"D {summary.support_ns}, program {of_program['support_ns']}"
    scale = Fraction(2) ** of_program["exponent"]
    difference = abs(summary.integral_ns / scale - Fraction(of_program["integral_ns"]))
    # Of each piece the program rounds its ends, their sum, its length and the product; the sum over all
    # pieces is compensated. Together less than 8 roundings, each of at most 2^-53 of what it rounds.
    bound = Fraction(of_program["absolute_integral_ns"]) * 8 / 2**53
    if difference > bound:
        yield f"∫g differs by {float(difference):.3g} of {of_program['absolute_integral_ns']:.3g}"


def differences(content, duration_ns, program):
    """What the two readers do not agree on, in words."""
    from fnplot.function_file import parse_functions
    from fnplot.gain_summary import summarize

    of_program = program.read(content, duration_ns)
    file = parse_functions(content)
    report = file.diagnostics.report("FILE")
    if report != of_program["report"]:
        yield f"report\n{report}\nprogram's report\n{of_program['report']}"
    functions = {str(tag): function for tag, function in file.functions.items()}
    if functions.keys() != of_program["functions"].keys():
        yield f"functions {list(functions)}, program {list(of_program['functions'])}"
        return
    for tag, function in functions.items():
        points = of_program["functions"][tag]["points"]
        if repr([list(point) for point in function.points]) != repr(points):  # tells -0.0 from 0.0
            yield f"M{tag}: {function.points}, program {points}"
        summary = summarize(function, 0, duration_ns)
        for what in summary_differences(summary, of_program["functions"][tag]["summary"]):
            yield f"M{tag} over {duration_ns} ns: {what}"


def main():
    raw = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=raw)
    parser.add_argument("--reader", type=Path, required=True)
    parser.add_argument("--tools", type=Path, required=True)
    parser.add_argument("--corpus", type=Path, required=True)
    parser.add_argument("--count", type=int, default=400)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    sys.path.insert(0, str(options.tools))
    corpus = {path.name: path.read_bytes() for path in sorted(options.corpus.glob("*.fn"))}
    program = ProgramReader(options.reader)
    disagreements = 0

    def compare(name, content, duration_ns):
        nonlocal disagreements
        found = list(differences(content, duration_ns, program))
        disagreements += bool(found)
        for what in found:
            print(f"{name}: {content[:2000]!r}\n{what}\n")

    for name, content in corpus.items():
        for duration_ns in DURATIONS_NS:
            compare(name, content, duration_ns)
    small = [content for content in corpus.values() if len(content) < 4000]
    for number in range(options.count):
        mutator = Mutator(small, f"{options.seed}.{number}")
        content = mutator.file()
        compare(f"mutation {number} of seed {options.seed}", content, mutator.draw.choice(DURATIONS_NS))
    status = program.close()
    compared = f"{len(corpus)} files and {options.count} mutations of seed {options.seed}"
    print(f"{compared}: {disagreements} disagreements")
    return 1 if disagreements or status or not corpus else 0


if __name__ == "__main__":
    sys.exit(main())
