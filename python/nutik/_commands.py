"""Commands of the program, each as a function: in a process of its own, with the arguments that the schema has."""

from __future__ import annotations

import atexit
import inspect
import json
import re
import signal
import subprocess
import sys
from collections.abc import Mapping, Sequence
from errno import ENOENT
from fractions import Fraction
from functools import cache
from keyword import iskeyword
from os import PathLike
from os.path import dirname, exists
from threading import Event, current_thread, main_thread
from time import sleep
from typing import Any, Protocol, Union

from . import _nutik
from ._docs import joined
from ._nutik import DeviceError, Error, ImpreciseError, InputError, MemoryTooLittle, OutputError, UsageError
from ._told import Json
from ._words import (FileMissing, NutikNote, Path, Progress, WrongType, check_progress, in_python, is_list, is_stated,
                     path_of, refuse, shortened, warn, word_of)

# A value, several, or of a command's option that takes two words a list of pairs.
Value = Union[str, int, float, Fraction, "PathLike[str]"]
Option = Union[Value, Sequence[Union[Value, Sequence[Value]]], None]

_ERRORS = {2: UsageError, 3: InputError, 4: DeviceError, 5: OutputError, 6: MemoryTooLittle, 7: ImpreciseError}
_ANSWERED = 1, 3  # findings of a check, an arithmetic beyond its bound: what was asked for, and no failure
# A terminal sends SIGINT to it, too, at which a film would keep its frames: ending it is left to _end().
_MAIN = ("import signal as s, sys; s.signal(s.SIGPIPE, s.SIG_DFL); s.signal(s.SIGINT, s.SIG_IGN); "
         "sys.path.insert(0, sys.argv[1]); import _nutik; sys.exit(_nutik.run_program(sys.argv[2:]))")
_STOP_AFTER_S = 0.05
_END_WITHIN_S = 5.0

_running: set[subprocess.Popen[str]] = set()
_is_over = Event()


@cache
def _end_at_exit() -> None:
    """From the first command on."""
    atexit.register(_end_all)


def _end_all() -> None:
    """Ends what threads wait for, and leaves these asleep: a thread that wakes up while Python ends may crash."""
    _is_over.set()
    for _ in range(int(_END_WITHIN_S / _STOP_AFTER_S)):
        for process in list(_running):
            _end(process)
        sleep(_STOP_AFTER_S)  # at least once, for threads between two calls
        if not _running:
            break


def _end(process: subprocess.Popen[str]) -> None:
    """At once, without temporary files: nobody reads its answer. A Python that just begins does not hear SIGPIPE."""
    for number in (signal.SIGPIPE, signal.SIGTERM):
        process.send_signal(number)


def _sleep_at_the_end() -> None:
    if _is_over.is_set() and current_thread() is not main_thread():
        Event().wait()


def _words(kind: str, name: str, value: Any) -> list[str]:
    kinds = kind.split()
    return [word_of(name, each, part) for each, part in zip(kinds, [value] if len(kinds) < 2 else value)]


def _run(command: str, operands: Sequence[Path], progress: Progress, stated: Mapping[str, Any]) -> dict[str, Json]:
    _, _, arguments = _nutik.described(command)
    check_progress(progress)
    said: dict[str, list[list[str]]] = {"json": [[]]}
    if progress is not None and "progress" in arguments:
        said["progress"] = [[]]
    for argument, value in stated.items():
        refuse(isinstance(value, Mapping), f"{argument}= is {shortened(value)}; of a command it is a word, or names a "
               "file", WrongType)
        name = _nutik.argument_now(argument[:-1] if iskeyword(argument[:-1]) else argument)
        kind, _, is_repeated, _ = arguments.get(name, ("", "", False, False))
        if not is_stated(name, kind if name in arguments else None, value):
            continue
        said[name] = [_words(kind, name, each) for each in value] if is_repeated and is_list(value) else [
            _words(kind, name, value)]
    words = _nutik.command_words(command, said)
    _sleep_at_the_end()
    _end_at_exit()
    words += ["--", *map(path_of, operands)]
    process = subprocess.Popen([sys.executable, "-c", _MAIN, dirname(__file__), *words],
                               stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    _running.add(process)
    seen = 0

    def tell(told: str) -> None:
        nonlocal seen
        shares = re.findall(r"^Progress: (\d+)%", told, re.MULTILINE)
        for share in shares[seen:]:
            if progress is not None:
                progress(int(share), 100)
        seen = len(shares)

    try:
        while True:
            try:
                answer, told = process.communicate(timeout=_STOP_AFTER_S)
                break
            except subprocess.TimeoutExpired as so_far:
                tell((so_far.stderr or b"").decode(errors="replace"))
        tell(told)
    except BaseException:
        _end(process)
        process.communicate()
        raise
    finally:
        _running.discard(process)
    _sleep_at_the_end()
    return _answer(words, process.returncode, answer, [line for line in told.splitlines()
                                                       if not line.startswith("Progress:")])


def _answer(words: Sequence[str], status: int, text: str, told: Sequence[str]) -> dict[str, Json]:
    if status and not (text and status in _ANSWERED):
        message = in_python("\n".join(told).strip()).removeprefix("nutik-cl: ")
        missing = [word for word in words if message.startswith(f"{word} cannot be ") and not exists(word)]
        if status == 3 and missing:
            absent = FileMissing(message)
            absent.errno, absent.filename = ENOENT, missing[0]
            raise absent
        raise _ERRORS.get(status, Error)(message or f"{words[0]} ended with status {status}")
    found: dict[str, Any] = json.loads(text)
    warn(in_python(line.strip()) for line in told if status)  # what was wrong with a line of a list
    warn(map(in_python, found.get("warnings", [])))
    warn(map(in_python, found.get("notes", [])), NutikNote)
    return found


class Command(Protocol):
    def __call__(self, *files: Path, progress: Progress = None, **stated: Option) -> dict[str, Json]: ...


def _function_of(command: str, example: str) -> Command:
    example = f"{command}({example})"
    summary, operands, arguments = _nutik.described(command)

    def function(*files: Path, progress: Progress = None, **stated: Option) -> dict[str, Json]:
        return _run(command, files, progress, stated)

    offered = {name + "_" * iskeyword(name): row for name, row in arguments.items()
               if name not in ("json", "progress", "quiet", "verbose")}
    function.__name__ = function.__qualname__ = command
    function.__module__ = "nutik"
    rows = [f"*files : {operands}", "progress : called with a percentage and 100",
            *(f"{name} : {row[0] or 'True'}\n    {row[1]}" for name, row in offered.items())]
    function.__doc__ = in_python(joined(summary, {"Parameters": "\n".join(rows),
        "Returns": "dict, what the command answers to scripts; what it says besides comes as warnings.",
        "Raises": "The error of nutik's that its exit status stands for.",
        "Notes": "It runs in a process of its own, which Ctrl-C ends.", "Examples": f">>> answer = nutik.{example}"}))
    kinds = inspect.Parameter
    function.__annotations__.update(dict.fromkeys(offered, "Option"))
    signature = inspect.signature(function)
    function.__signature__ = signature.replace(parameters=[  # type: ignore[attr-defined]
        signature.parameters["files"], signature.parameters["progress"],
        *(kinds(name, kinds.KEYWORD_ONLY, default=None, annotation="Option") for name in sorted(offered))])
    return function


batch = _function_of("batch", '"list.txt", "clip.tik"')
check = _function_of("check", '"clip.tik"')
contact = _function_of("contact", '"clip.tik", "sheet.png", exposure=0.01')
noise = _function_of("noise", '"stills", transfer="linear", output="camera.noise"')
recover = _function_of("recover", '"cut.tik", "whole.tik"')
retime = _function_of("retime", '"clip.tik", rate=50, in_place=True')
validate = _function_of("validate", '"clip.tik", start=0, exposure=0.01')
video = _function_of("video", '"clip.tik", "film.mp4", out_fps=24')
