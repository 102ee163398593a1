"""Which tests run which lines: read from gcc's counters, to which each test adds when its programs end.

A line counts as run where its function ran, and a function where one of its counters grew.
"""

import hashlib
import json
import os
import pathlib
import struct
import subprocess
import time
from collections import defaultdict
from concurrent.futures import ThreadPoolExecutor

FUNCTION, LINES, COUNTERS = 0x01000000, 0x01450000, 0x01a10000
SUMMARY_BYTES = 32  # of a .gcda file, which count its programs
LONGEST_S = 1800  # that a test may take


def records(data, start):
    """Each record's tag, the length that it states (negative: that many bytes of zeros are left out), its bytes."""
    while start + 8 <= len(data):
        tag, length = struct.unpack_from("<Ii", data, start)
        if tag == 0:
            return
        start += 8
        yield tag, length, data[start:start + max(length, 0)]
        start += max(length, 0)


def functions_that_ran(counters):
    """How often the functions of a .gcda file ran: {ident: sum of its counters}."""
    sums, ident = {}, None
    for tag, length, data in records(counters, 16):
        if tag == FUNCTION:
            ident = struct.unpack_from("<I", data)[0]
        elif tag == COUNTERS and length > 0:
            sums[ident] = sum(struct.unpack(f"<{len(data) // 8}Q", data))
    return sums


def lines_of_functions(path):
    """The lines of the functions of a .gcno file, those of inlined ones too: {ident: {file: {line}}}."""
    data = path.read_bytes()
    folder_bytes = struct.unpack_from("<I", data, 16)[0]
    folder = data[20:20 + folder_bytes - 1].decode()
    functions, lines = {}, None
    for tag, _, record in records(data, 20 + folder_bytes + 4):
        if tag == FUNCTION:
            lines = functions[struct.unpack_from("<I", record)[0]] = defaultdict(set)
        elif tag == LINES:
            add_lines(record, folder, lines)
    return functions


def add_lines(record, folder, lines):
    """A LINES record: a block's number, then lines, and, after a 0, the name of the file of those that follow."""
    at, file = 4, None
    while at + 4 <= len(record):
        line = struct.unpack_from("<I", record, at)[0]
        at += 4
        if line:
            lines[file].add(line)
            continue
        name_bytes = struct.unpack_from("<I", record, at)[0]
        at += 4
        if not name_bytes:
            return
        file = os.path.normpath(os.path.join(folder, record[at:at + name_bytes - 1].decode()))
        at += name_bytes


class Worker:
    """Runs one test after another, with counters of its own in a folder."""

    def __init__(self, build, folder):
        self.build, self.folder, self.before = build, folder, {}

    def run(self, test):
        """The test's outcome, and the functions that it ran: {(.gcda file as if there were no folder, ident)}."""
        properties = {each["name"]: each["value"] for each in test.get("properties", ())}
        words = dict(word.split("=", 1) for word in properties.get("ENVIRONMENT", ()))
        settings = os.environ | words | {"GCOV_PREFIX": str(self.folder)}
        quiet = {each: subprocess.DEVNULL for each in ("stdin", "stdout", "stderr")}
        start, status = time.monotonic(), None
        try:
            status = subprocess.run(test["command"], cwd=properties.get("WORKING_DIRECTORY", self.build),
                                    timeout=LONGEST_S, env=settings, check=False, **quiet).returncode
        except subprocess.TimeoutExpired:
            pass
        seconds, ran = time.monotonic() - start, set()
        for path in self.folder.rglob("*.gcda"):
            data = path.read_bytes()
            before, sums = self.before.get(path, (b"", {}))
            if data[SUMMARY_BYTES:] != before[SUMMARY_BYTES:]:
                now = functions_that_ran(data)
                counters = pathlib.Path("/", path.relative_to(self.folder))
                ran.update((counters, ident) for ident, count in now.items() if count != sums.get(ident, 0))
                self.before[path] = data, now
        return {"seconds": round(seconds, 1), "status": status}, ran


def listed_tests(build, options=()):
    """CTest's tests: their names, commands and properties."""
    listed = subprocess.run(["ctest", "--test-dir", build, "--show-only=json-v1", *options], capture_output=True,
                            check=True)
    return [test for test in json.loads(listed.stdout)["tests"] if test.get("command")]


def measure(root, build, folders, options):
    """Runs CTest's tests, and says of each what it ran; counters are left in the folders, one for each worker."""
    tests = listed_tests(build, options)
    idle = [Worker(build, folder) for folder in folders]

    def run(test):
        worker = idle.pop()
        try:
            return worker.run(test)
        finally:
            idle.append(worker)

    numbers, functions, found, notes = {}, [], {}, {}

    def number_of(path, ident):
        if path not in notes:
            notes[path] = lines_of_functions(path.with_suffix(".gcno"))
        if (path, ident) not in numbers:
            lines = notes[path].get(ident, {})
            of_host = {os.path.relpath(file, root): sorted(each) for file, each in lines.items()
                       if file and file.startswith(f"{root}/host/")}
            numbers[path, ident] = len(functions) if of_host else None
            if of_host:
                functions.append(of_host)
        return numbers[path, ident]

    with ThreadPoolExecutor(len(folders)) as pool:
        for test, (outcome, ran) in zip(tests, pool.map(run, tests)):
            outcome["functions"] = sorted({number_of(*each) for each in ran} - {None})
            found[test["name"]] = outcome
            print(f"{test['name']}: {outcome['seconds']} s"
                  + ("" if outcome["status"] == 0 else f", ended with {outcome['status']}"), flush=True)
    sources = {file for each in functions for file in each}
    return {"tests": found, "functions": functions,
            "sources": {file: checksum(root / file) for file in sorted(sources)}}


def checksum(path):
    return hashlib.sha256(path.read_bytes()).hexdigest() if path.exists() else None


class Reach:
    """What `measure` found, for a tree that is as it was."""

    def __init__(self, path, root):
        known = json.loads(path.read_text())
        self.tests, self.sources, self.root = known["tests"], known["sources"], root
        self.functions_of = defaultdict(lambda: defaultdict(set))  # each file's lines
        for number, lines in enumerate(known["functions"]):
            for file, each in lines.items():
                for line in each:
                    self.functions_of[file][line].add(number)

    def may_run(self, test, file, line):
        """Whether a test may run a line: also where it is not known."""
        if test not in self.tests or self.sources.get(file) != checksum(self.root / file):
            return True
        lines = self.functions_of[file]
        # The middle of a statement may have no counter: what is above and below it has.
        above = max((each for each in lines if each <= line), default=None)
        below = min((each for each in lines if each >= line), default=None)
        functions = lines.get(above, set()) | lines.get(below, set())
        return not functions.isdisjoint(self.tests[test]["functions"])

    def passes(self, test):
        return test in self.tests and self.tests[test]["status"] == 0

    def seconds(self, test):
        """How long it took; None where it is not known."""
        return self.tests[test]["seconds"] if test in self.tests else None
