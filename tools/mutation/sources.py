"""Changes of host/ and kernels/ for the worse, drawn by a seed and spread over all rooms: do the tests notice?

Each is made in a copy of the tree, built, and tested by the tests of its room. What passes them goes through all tests
that can see it, in a second round, until one fails. What a build refuses is replaced by the next one.

Where build-coverage/reach.json (of tools/coverage) says which tests run the changed line, only these are run: those
that it does not know yet, then the quick ones. A test counts where it fails twice, and passes without the mutation.
"""

import contextlib
import itertools
import json
import math
import os
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path
from typing import NamedTuple

from mutation.reach import Reach, listed_tests

ROOT = Path(__file__).resolve().parent.parent.parent
EXPLAINED = Path(__file__).resolve().parent / "explained.txt"
MAX_BYTES = 6 << 30  # that a test may take: more is noticed, too
LONGEST_S = 1200  # that the tests of a room may take: a loop that never ends is noticed, too
LONGEST_CPU_S = 200  # the same for each process, so that it does not take the whole while
LONGEST_SCRIPT_S = 60
SLOW_S = 2  # a test that takes longer runs after the others
WHOLE_PROGRAM = ("app_tests", "faults_tests")
SCRIPT = "script"  # in place of a target
SURVIVED_ROOM = "?"  # the outcome of what has its second round before it

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
    """Targets of tests that can see a room: its own, which there may be none of, and the others, the nearest first."""
    known = set(re.findall(r"^nutik_test\((\w+)", (ROOT / "tests/CMakeLists.txt").read_text(), re.MULTILINE))
    of_room, reached = users(), [room]
    for each in reached:
        reached += [user for user in sorted(of_room.get(each, ())) if user not in reached]
    nearest, *others = [[f"{each}_tests"] if each in known and f"{each}_tests" not in WHOLE_PROGRAM else []
                        for each in reached]
    return nearest, [*itertools.chain(*others), *WHOLE_PROGRAM]


def limit():
    resource.setrlimit(resource.RLIMIT_DATA, (MAX_BYTES, MAX_BYTES))
    resource.setrlimit(resource.RLIMIT_CPU, (LONGEST_CPU_S, LONGEST_CPU_S))


class Selection:
    """Which tests are worth running for a mutation."""

    def __init__(self, path, build):
        self.reach = Reach(path, ROOT) if path.exists() else None
        if not self.reach:
            print(f"{path} is missing: every test runs for every mutation; tools/coverage makes it")
        self.filters_of = {}  # of each target's tests, by name
        self.scripts = []  # other tests' names
        for test in listed_tests(build):
            chosen = [word for word in test["command"][1:] if word.startswith("--gtest_filter=")]
            if chosen:
                target = self.filters_of.setdefault(Path(test["command"][0]).name, {})
                target[test["name"]] = chosen[0].removeprefix("--gtest_filter=")
            else:
                self.scripts.append(test["name"])

    def filters(self, mutation, target):
        """GoogleTest's filters, each for a run of its own; none where no test of the target runs the line."""
        if not self.reach:
            return ["*"]
        new, quick, slow = [], [], []
        for name, chosen in self.filters_of[target].items():
            if self.reach.may_run(name, mutation.path, mutation.line):
                seconds = self.reach.seconds(name)
                (new if seconds is None else slow if seconds > SLOW_S else quick).append(chosen)
        return [":".join(each) for each in (new, quick, slow) if each]

    def seconds(self, mutation):
        """How long all tests take that run the line, as far as it is known."""
        if not self.reach or mutation.room == "kernels":
            return math.inf
        return sum(self.reach.seconds(name) for name in self.reach.tests
                   if self.reach.may_run(name, mutation.path, mutation.line))

    def reaching_scripts(self, mutation):
        """Tests that are no programs of GoogleTest and are known to run the line."""
        known = [name for name in self.scripts if self.reach and self.reach.passes(name)]
        return [name for name in known if self.reach.seconds(name) < LONGEST_SCRIPT_S
                and self.reach.may_run(name, mutation.path, mutation.line)]


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
        return subprocess.run(["cmake", "--build", self.build, "--target", target], capture_output=True,
                              check=False).returncode == 0

    def first_failure(self, target, chosen, shards):
        """The first test that fails, by name; None where all pass. Shards run side by side."""
        running, end = {}, time.monotonic() + LONGEST_S
        for shard in range(shards):
            settings = {"GTEST_FAIL_FAST": "1", "GTEST_FILTER": chosen, "GTEST_SHARD_INDEX": str(shard),
                        "GTEST_TOTAL_SHARDS": str(shards)}
            out = tempfile.TemporaryFile()
            running[subprocess.Popen([self.build / "tests" / target], env=os.environ | settings, stdout=out,
                                     stderr=subprocess.DEVNULL, start_new_session=True, preexec_fn=limit)] = out
        try:
            while running:
                for tests in [tests for tests in running if tests.poll() is not None]:
                    out = running.pop(tests)
                    if tests.returncode != 0:
                        return failed_test(out) or f"ends with {tests.returncode}"
                if time.monotonic() > end:
                    return failed_test(next(iter(running.values()))) or "does not end"
                time.sleep(0.05)
            return None
        finally:
            for tests in running:
                with contextlib.suppress(ProcessLookupError):  # it may just have ended
                    os.killpg(tests.pid, signal.SIGKILL)  # with the programs that it runs
                tests.wait()

    def failing_test(self, target, chosen="*"):
        """A test that fails twice, the second time alone, as TARGET NAME; None where there is none."""
        passed_over = []
        while failed := self.first_failure(target, ":".join([chosen, *passed_over]), os.cpu_count()):
            if " " in failed or self.first_failure(target, failed, 1):
                return f"{target} {failed}"
            print(f"{target} {failed}: fails at times", flush=True)
            passed_over += [failed] if passed_over or "-" in chosen else [f"-{failed}"]
        return None

    def fails(self, script):
        return subprocess.run(["ctest", "--test-dir", self.build, "-R", f"^{re.escape(script)}$"], check=False,
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode != 0

    def failing_script(self, scripts):
        return next((f"{SCRIPT} {each}" for each in scripts if self.fails(each) and self.fails(each)), None)

    def outcome(self, mutation, targets, selection, is_last):
        """A test that notices it, "" where none does, None where it does not build."""
        self.apply(mutation)
        try:
            if not self.builds("nutik-cl"):
                return None
            for target in targets:
                filters = selection.filters(mutation, target)
                if filters and not self.builds(target):
                    return None
                for chosen in filters:
                    if failed := self.failing_test(target, chosen):
                        return failed
            return self.failing_script(selection.reaching_scripts(mutation) if is_last else ()) or ""
        finally:
            self.restore(mutation)

    def false_alarms(self, noticed_by):
        """Those of the tests that fail without a mutation."""
        found = []
        for each in sorted(noticed_by):
            target, name = each.split(" ", 1)
            if target == SCRIPT:
                found += [each] if self.fails(name) else []
                continue
            if not self.builds(target):
                sys.exit("the tree does not build without a mutation")
            if self.first_failure(target, "*" if " " in name else name, 1):
                found.append(each)
        return found


def failed_test(out):
    """The test that failed, or that was running when its program ended."""
    out.seek(0)
    text = out.read().decode(errors="replace")
    failed = re.search(r"^\[  FAILED  \] (\S+?),? ", text, re.MULTILINE)
    started = re.findall(r"^\[ RUN      \] (\S+)", text, re.MULTILINE)
    return failed[1] if failed else started[-1] if started else None


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


class Campaign:
    """The mutations that are drawn, and what is known of them."""

    def __init__(self, arguments):
        self.folder, self.count = arguments.work.resolve(), arguments.count
        self.folder.mkdir(parents=True, exist_ok=True)
        self.kept = self.folder / "outcomes.jsonl"
        lines = self.kept.read_text().splitlines() if self.kept.exists() else []
        self.known = dict(json.loads(line) for line in lines)
        self.drawn = drawn(arguments.seed)
        self.selection, self.copy = None, None

    def keep(self, mutation, outcome):
        self.known[mutation.key] = outcome
        with self.kept.open("a") as out:
            out.write(json.dumps([mutation.key, outcome]) + "\n")
        told = {None: "does not build", "": "UNNOTICED", SURVIVED_ROOM: "goes on"}.get(outcome, outcome)
        print(f"{mutation.path}:{mutation.line} ({mutation.operator}): {told}", flush=True)

    def prepare(self):
        self.copy = Copy(self.folder)
        if not self.copy.builds("all"):
            sys.exit("the tree does not build without a mutation")
        self.selection = Selection(ROOT / "build-coverage/reach.json", self.copy.build)

    def first_round(self):
        """The mutations that count: those that build."""
        taken = []
        for mutation in self.drawn:
            if len(taken) == self.count:
                break
            if mutation.key not in self.known:
                outcome = self.copy.outcome(mutation, tests_of(mutation.room)[0], self.selection, False)
                self.keep(mutation, SURVIVED_ROOM if outcome == "" else outcome)
            if self.known[mutation.key] is not None:
                taken.append(mutation)
        return taken

    def second_round(self, taken):
        survivors = [mutation for mutation in taken if self.known[mutation.key] == SURVIVED_ROOM]
        for mutation in sorted(survivors, key=self.selection.seconds):
            targets = itertools.chain(*tests_of(mutation.room))
            self.keep(mutation, self.copy.outcome(mutation, targets, self.selection, True))

    def results(self):
        known = [(mutation, self.known[mutation.key]) for mutation in self.drawn
                 if self.known.get(mutation.key, SURVIVED_ROOM) not in (None, SURVIVED_ROOM)]
        return known[:self.count]


def run(arguments):
    campaign = Campaign(arguments)
    if not arguments.table:
        campaign.prepare()
        taken = campaign.first_round()
        campaign.second_round(taken)
        for test in campaign.copy.false_alarms({campaign.known[mutation.key] for mutation in taken} - {""}):
            print(f"{test}: fails without a mutation, too; what it noticed counts for nothing until it is mended")
            for mutation in taken:
                if campaign.known[mutation.key] == test:
                    campaign.keep(mutation, "")
    return 1 if print_table(campaign.results()) else 0
