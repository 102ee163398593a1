"""Docstrings in NumPy's style, made of those in the source, `Parameters:` and `name : what it is`, when the package is
imported: types come from annotations, and what a parameter is stands once, in the function's own docstring, in that of
another one that takes it, too, or in the program's schema."""

from __future__ import annotations

import inspect
import linecache
import re
from dataclasses import is_dataclass
from textwrap import fill, indent
from typing import Any, Callable, Iterable, Mapping

from . import _nutik
from ._captures import Capture
from ._sources import open
from ._words import in_python

_ORDER = "Parameters", "Attributes", "Returns", "Raises", "Notes", "Examples"
_SECTION = re.compile(rf"^({'|'.join(_ORDER)}):\n", re.MULTILINE)
_ENTRY = re.compile(r"^(\w+(?:, \w+)*) : (.*(?:\n[ \n].*)*)", re.MULTILINE)
_WORKS = ("Works without Python's lock: any number of threads may use one capture. Ctrl-C ends it within half a "
          "second, with KeyboardInterrupt, and leaves no file that was not finished.")
_COMMANDS = {"open": "encode", "join": "encode", "encode": "encode", "study": "study", "solve": "solve",
             "activity": "activity", "background": "background"}
_PLOTTED = {"ax": "axes of matplotlib, which are returned; None: the current ones.",
            "style": "what matplotlib's plot() takes: label='left'."}


def _sections(doc: str) -> dict[str, str]:
    parts = _SECTION.split(inspect.cleandoc(doc))
    return {"": parts[0].strip(), **{name: text.rstrip() for name, text in zip(parts[1::2], parts[2::2])}}


def _entries(function: Callable[..., object]) -> dict[str, str]:
    """What a docstring says of parameters, by name."""
    found = _ENTRY.findall(_sections(function.__doc__ or "").get("Parameters", ""))
    return {name: " ".join(text.split()) for names, text in found for name in names.split(", ")}


def _type_of(annotation: str) -> str:
    """`Union[str, float, None]`: `str, float`."""
    inside = re.fullmatch(r"(?:Optional|Union)\[(.*)\]", annotation)
    return re.sub(r", None$", "", inside[1]) if inside else annotation


def _parameters(function: Callable[..., object], told: Mapping[str, str]) -> str:
    """Those with the same type and the same text stand together."""
    lines: list[tuple[list[str], str, str]] = []
    for name, each in inspect.signature(function).parameters.items():
        if name in ("self", "cls"):
            continue
        default = each.default
        how = "" if default is each.empty else ", optional" if default is None else f", default {default!r}"
        kind = _type_of(str(each.annotation)) + how
        text = told.get(name, "")
        if lines and text and lines[-1][1:] == (kind, text):
            lines[-1][0].append(name)
        else:
            lines.append(([name], kind, text))
    return "\n".join(f"{', '.join(names)} : {kind}\n{indent(fill(text, 106, break_on_hyphens=False), '    ')}"
                     for names, kind, text in lines)


def complete(function: Any, told: Mapping[str, str]) -> None:
    """Gives a function its sections; `told` has the parameters that it does not explain itself."""
    has = _sections(function.__doc__ or "")
    arguments = _parameters(function, {**told, **_entries(function)})
    returned = str(inspect.signature(function).return_annotation)
    made = {"Parameters": arguments, "Returns": has.get("Returns", "" if returned == "None" else returned),
            "Raises": has.get("Raises", "UsageError where an argument makes no sense." if arguments else ""),
            "Notes": has.get("Notes", fill(_WORKS, 110) if "progress : " in arguments else ""),
            "Examples": has.get("Examples", "")}
    function.__doc__ = joined(has[""], made)


def joined(summary: str, sections: Mapping[str, str]) -> str:
    """NumPy's form."""
    return "\n\n".join([summary, *(f"{name}\n{'-' * len(name)}\n{text}" for name, text in sections.items() if text)])


def _complete_class(kind: type) -> None:
    """Where it is made of parameters, these; of figures what stands beside them in its source."""
    has = _sections(kind.__doc__ or "")
    if is_dataclass(kind):
        source = "".join(linecache.getlines(inspect.getfile(kind)))
        body = rf"^class {kind.__name__}:\n((?:    .*)?\n)+?(?=\n    (?:def|@)|\n\n\S)"
        fields = re.search(body, source, re.MULTILINE)
        found = re.findall(r"^    (\w+): (.+?)(?:  +# (.*))?$", fields[0] if fields else "", re.MULTILINE)
        has["Attributes"] = "\n".join(f"{name} : {_type_of(annotation)}" + (f"\n    {told}" if told else "")
                                      for name, annotation, told in found)
    elif "Parameters" in has:
        has["Parameters"] = _parameters(kind, _entries(kind))
    kind.__doc__ = joined(has.pop(""), {name: has[name] for name in _ORDER if name in has})


def complete_all(offered: Iterable[object]) -> None:
    """What the package offers, and the methods of its classes."""
    shared, exposed = _entries(open), _entries(Capture.render)
    for each in offered:
        members = {each.__name__: each} if inspect.isfunction(each) else vars(each) if inspect.isclass(each) else {}
        if inspect.isclass(each) and each.__module__.startswith("nutik._") and not issubclass(each, BaseException):
            _complete_class(each)
        for name, member in members.items():
            function = member.__func__ if isinstance(member, classmethod) else member
            if not inspect.isfunction(function) or name.startswith("_") or function.__name__ != name or hasattr(
                    function, "__signature__"):
                continue  # a second name of what is completed by its own; a command, which has it all
            is_of_capture = vars(Capture).get(name) is function
            told = dict(_PLOTTED) if name == "plot" else {}
            for command in ("expose", _COMMANDS.get(name, "expose")) if name in _COMMANDS or is_of_capture else ():
                told.update({argument: in_python(row[1]) for argument, row in _nutik.described(command)[2].items()})
            complete(function, {**told, **shared, **(exposed if is_of_capture else {})})
