"""Changes of host/ and kernels/ for the worse, drawn by a seed and spread over all rooms: do the tests notice?

Each is made in a copy of the tree, built, and tested by the tests of its room, then by those of the rooms that use it,
then by those of the whole program, until one fails. What a build refuses is replaced by the next one.
"""

import json
import os
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
from collections import Counter
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parent.parent.parent
EXPLAINED = Path(__file__).resolve().parent / "explained.txt"
MOST_BYTES = 6 << 30  # that a test may take: more is noticed, too
LONGEST_S = 1200  # that the tests of a room may take: a loop that never ends is noticed, too

# Name, what a line has, what it gets instead.
OPERATORS = (
    ("bound", r" < ", " <= "), ("bound", r" <= ", " < "), ("bound", r" > ", " >= "), ("bound", r" >= ", " > "),
    ("equality", r" == ", " != "), ("equality", r" != ", " == "),
    ("sign", r"(?<=[\w)\]]) \+ (?=[\w(])", " - "), ("sign", r"(?<=[\w)\]]) - (?=[\w(])", " + "),
    ("product", r"(?<=[\w)\]]) \* (?=[\w(])", " / "), ("product", r"(?<=[\w)\]]) / (?=[\w(])", " * "),
    ("off by one", r" [+-] 1(?=[;,)\] ])", ""), ("off by one", r"(?<== )0(?=;)", "1"),
    ("logic", r" && ", " || "), ("logic", r" \|\| ", " && "), ("logic", r"(?<=if \()!", ""),
    ("dropped check", r"^\s*if \(.*\) (throw|return|fail|continue|break)\b.*;$", ";"),
    ("dropped check", r"(?<=^  )if \(.*\) \{$", "if (false) {"),
)


class Mutation(NamedTuple):
    room: str
    path: str
    line: int     # from 1 on
    operator: str
    old: str      # the line
    new: str

    @property
    def key(self):
        """What stays as it is when lines above are added."""
        return f"{self.path}: {self.old.strip()} -> {self.new.strip()}"


def mutations_of(path, room):
    text = (ROOT / path).read_text()
    for number, line in enumerate(text.splitlines(), 1):
        code = line.split("//")[0].rstrip()
        is_passed_over = re.match(r"\s*(#|static_assert|template|using|namespace|friend)", code) or "operator" in code
        if not code.strip() or is_passed_over:
            continue
        for operator, pattern, replacement in OPERATORS:
            for match in re.finditer(pattern, code):
                # Not within a text.
                if code[:match.start()].count('"') % 2 == 0:
                    new = code[:match.start()] + replacement + code[match.end():]
                    yield Mutation(room, str(path), number, operator, line, new)


def rooms():
    """Each room's sources, without headers, whose changes rebuild everything."""
    found = {}
    for path in sorted((ROOT / "host").rglob("*.cpp")):
        found.setdefault(path.relative_to(ROOT / "host").parts[0], []).append(path.relative_to(ROOT))
    found["kernels"] = sorted(path.relative_to(ROOT) for path in (ROOT / "kernels").glob("*.cl*"))
    return found


def drawn(seed):
    """All mutations, in an order that takes one of each room in turn."""
    draw = random.Random(seed)
    by_room = []
    for room, paths in rooms().items():
        every = [mutation for path in paths for mutation in mutations_of(path, room)]
        draw.shuffle(every)
        # One of each operator in turn: there are ten comparisons for a check.
        by_operator = {}
        for mutation in every:
            by_operator.setdefault(mutation.operator, []).append(mutation)
        by_room.append([mutation for group in in_turn(by_operator.values()) for mutation in group])
    return [mutation for group in in_turn(by_room) for mutation in group]


def in_turn(lists):
    """The first of each list, the second of each, and so on."""
    longest = max(map(len, lists))
    return [[each[i] for each in lists if i < len(each)] for i in range(longest)]


def users():
    """Which rooms use a room directly, as CMake has it."""
    found = {"kernels": ["opencl"], "session": ["app"]}
    for path in (ROOT / "host").glob("*/CMakeLists.txt"):
        uses = re.search(r"\bUSES ([\w\s]*?)(?:\n\s*[A-Z_]+ |\))", path.read_text())
        for room in uses[1].split() if uses else ():
            found.setdefault(room, []).append(path.parent.name)
    return found


def tests_of(room):
    """Targets of tests that can see a room, the nearest first."""
    known = set(re.findall(r"^nutik_test\((\w+)", (ROOT / "tests/CMakeLists.txt").read_text(), re.MULTILINE))
    of_room, order, reached = users(), [], [room]
    for each in reached:
        order += [each] if each in known else []
        reached += [user for user in sorted(of_room.get(each, ())) if user not in reached]
    return [f"{each}_tests" for each in dict.fromkeys([*(one for one in order if one != "app"), "app", "faults"])]


def limit_memory():
    resource.setrlimit(resource.RLIMIT_DATA, (MOST_BYTES, MOST_BYTES))


class Copy:
    """A copy of the tree, in which one mutation after another is built and tested."""

    def __init__(self, folder):
        self.source, self.build = folder / "source", folder / "source/build"
        listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
        for name in listed.split("\0"):
            if name and (ROOT / name).exists():
                self.write(name, (ROOT / name).read_bytes())
        if not (folder / "shared").exists() and (ROOT.parent / "shared").exists():
            (folder / "shared").symlink_to(ROOT.parent / "shared")
        words = ["cmake", "-S", self.source, "-B", self.build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                 "-DCMAKE_CXX_FLAGS_RELEASE=-O1", "-DNUTIK_BUILD_BENCHMARKS=OFF",
                 "-DPython3_EXECUTABLE=/usr/bin/python3"]
        if shutil.which("ccache"):
            words += ["-DCMAKE_C_COMPILER_LAUNCHER=ccache", "-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"]
        subprocess.run(words, check=True, stdout=subprocess.DEVNULL)

    def write(self, name, data):
        """Only what changed: the rest stays built."""
        path = self.source / name
        if path.exists() and path.read_bytes() == data:
            return
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)
        shutil.copymode(ROOT / name, path)

    def apply(self, mutation):
        lines = (ROOT / mutation.path).read_text().split("\n")
        assert lines[mutation.line - 1] == mutation.old
        lines[mutation.line - 1] = mutation.new
        self.write(mutation.path, "\n".join(lines).encode())

    def restore(self, mutation):
        self.write(mutation.path, (ROOT / mutation.path).read_bytes())

    def builds(self, target):
        # What is mutated is built once.
        done = subprocess.run(["cmake", "--build", self.build, "--target", target], capture_output=True, check=False,
                              env=os.environ | {"CCACHE_READONLY": "1"})
        return done.returncode == 0

    def failing_test(self, target):
        """The first test that fails, by name; None where all pass."""
        settings = os.environ | {"GTEST_FAIL_FAST": "1", "GTEST_BRIEF": "1"}
        with subprocess.Popen([self.build / "tests" / target], env=settings, stdout=subprocess.PIPE,
                              stderr=subprocess.DEVNULL, start_new_session=True, preexec_fn=limit_memory) as tests:
            try:
                out = tests.communicate(timeout=LONGEST_S)[0].decode(errors="replace")
            except subprocess.TimeoutExpired:
                os.killpg(tests.pid, signal.SIGKILL)  # with the programs that it runs
                return f"{target} does not end"
        if tests.returncode == 0:
            return None
        failed = re.search(r"^\[  FAILED  \] (\S+?),? ", out, re.MULTILINE)
        return failed[1] if failed else f"{target} ended with {tests.returncode}"

    def outcome(self, mutation):
        """A test that notices it, "" where none does, None where it does not build."""
        self.apply(mutation)
        try:
            for target in tests_of(mutation.room):
                if not self.builds(target):
                    return None
                if failed := self.failing_test(target):
                    return failed
            return ""
        finally:
            self.restore(mutation)


def explained():
    """Mutations that change nothing that could be noticed, with the reason: lines `MUTATION # reason`."""
    lines = EXPLAINED.read_text().splitlines() if EXPLAINED.exists() else []
    return dict(line.rsplit(" # ", 1) for line in lines if " # " in line)


def print_table(results):
    reasons = explained()
    noticed, missed, known = Counter(), Counter(), Counter()
    for mutation, outcome in results:
        if outcome:
            noticed[mutation.room] += 1
        elif mutation.key in reasons:
            known[mutation.room] += 1
        else:
            missed[mutation.room] += 1
    print(f"{'room':<10}{'mutations':>10}{'noticed':>9}{'explained':>11}{'unnoticed':>11}")
    for room in sorted(noticed | missed | known):
        count = noticed[room] + missed[room] + known[room]
        print(f"{room:<10}{count:>10}{noticed[room]:>9}{known[room]:>11}{missed[room]:>11}")
    print(f"{'all':<10}{len(results):>10}{noticed.total():>9}{known.total():>11}{missed.total():>11}")
    for mutation, outcome in results:
        if not outcome and mutation.key not in reasons:
            print(f"unnoticed: {mutation.path}:{mutation.line} ({mutation.operator})\n"
                  f"    {mutation.old.strip()}\n    {mutation.new.strip()}")
    return missed.total()


def run(arguments):
    folder = arguments.work.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    kept = folder / "outcomes.jsonl"
    known = dict(json.loads(line) for line in kept.read_text().splitlines()) if kept.exists() else {}
    copy, results = None, []
    for mutation in drawn(arguments.seed):
        if len(results) == arguments.count:
            break
        if mutation.key not in known and not arguments.table:
            if copy is None:
                copy = Copy(folder)
                if not copy.builds("all"):
                    sys.exit("the tree does not build without a mutation")
            known[mutation.key] = copy.outcome(mutation)
            with kept.open("a") as out:
                out.write(json.dumps([mutation.key, known[mutation.key]]) + "\n")
            told = {None: "does not build", "": "UNNOTICED"}.get(known[mutation.key], known[mutation.key])
            print(f"{mutation.path}:{mutation.line} ({mutation.operator}): {told}", flush=True)
        if known.get(mutation.key) is not None:
            results.append((mutation, known[mutation.key]))
    return 1 if print_table(results) else 0
