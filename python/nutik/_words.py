"""Values as the engine's words: times, sizes, rates; and what it says, as warnings."""

from __future__ import annotations

import datetime
import re
import shutil
import sys
import tempfile
import warnings
from contextlib import contextmanager, suppress
from decimal import Decimal
from fractions import Fraction
from functools import cache
from os import PathLike, fsdecode
from os.path import dirname, join
from importlib import import_module
from inspect import signature
from typing import TYPE_CHECKING, Any, Callable, Iterable, Iterator, Mapping, Optional, Protocol, Union, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _nutik
from ._nutik import Error, InputError, UsageError

if TYPE_CHECKING:
    from builtins import ellipsis as ellipsis

    from matplotlib.axes import Axes as Axes
    from xarray import DataArray as DataArray
else:
    ellipsis, Axes, DataArray = type(...), object, object  # those are imported where they are used

Time = Union[str, float, int, "np.floating[Any]", "np.integer[Any]", Fraction, Decimal, np.timedelta64,
             datetime.timedelta]
DelayLike = Union[str, ArrayLike]
Index = Union[int, slice, ellipsis, tuple[Union[int, slice, ellipsis, None], ...]]
Number = Union[str, float, int, "np.floating[Any]", "np.integer[Any]", Fraction, Decimal]
Path = Union[str, "PathLike[str]"]
Array = Union[NDArray[np.uint8], NDArray[np.uint16], NDArray[np.float32], NDArray[np.float64]]  # codes, or light
Progress = Optional[Callable[[int, int], object]]  # progress(done, total); total is 0 where it is not known

_MAX_DIGITS = 10 ** 15 - 1  # that the engine reads above and below a fraction line
_SECOND_NS = 10 ** 9
LARGEST_NS = 4 * 10 ** 18  # that a time may have: 126 years


class HasArray(Protocol):
    """What NumPy makes an array of; of torch, jax and others those in this machine's memory."""

    def __array__(self) -> NDArray[np.generic]: ...


class NutikWarning(UserWarning):
    """What is doubtful about a result."""


class NutikNote(NutikWarning):
    """What should be known of a result, although nothing is doubtful."""


class FileMissing(InputError, FileNotFoundError):
    """A file that was to be read is not there."""

    def __str__(self) -> str:  # an OSError with a file's name makes another text of that
        return str(self.args[0])


class WrongType(UsageError, TypeError):
    """An argument is of a type that nothing can be made of."""


def refuse(is_wrong: Any, message: str, kind: type[Error] = UsageError) -> None:
    if is_wrong:
        raise kind(message)


def check_progress(progress: Any) -> None:
    try:
        progress is None or signature(progress).bind(0, 0)
    except TypeError:
        raise WrongType(f"progress= is {shortened(progress)}, which does not take (done, total)") from None
    except ValueError:
        pass  # some of C's functions do not tell what they take


def labelled(values: NDArray[np.generic], first: Mapping[str, Any], attributes: Mapping[str, object],
             corner: tuple[int, int] = (0, 0)) -> DataArray:
    """Pictures with the names of their axes, and coordinates: those of `first`, and pixels, whose x and y begin at
    `corner`. Attributes that are None are left out, for no file holds them."""
    refuse(len(first) > values.ndim - 2, f"{', '.join(first)}: pictures have one axis before their own")
    coordinates: dict[str, Any] = {}
    for name, each in first.items():
        refuse(name in ("y", "x", "channel"), f"{name}= names an axis of the pictures themselves; the first one is "
               "another: start=starts")
        if not is_list(each) or (coordinate := np.asarray(listed(each))).ndim != 1 or len(coordinate) != len(values):
            raise UsageError(f"{name}= is {shortened(each)}: give a list of {len(values)}, one coordinate for each "
                             "picture")
        seconds = name in ("start", "time") and coordinate.dtype.kind in "iuf"
        coordinates[name] = (name, coordinate, {"units": "s"} if seconds else {})
    axes = [*first, "y", "x", "channel"][:values.ndim]
    for name, begin in zip("xy", corner):
        coordinates[name] = begin + np.arange(values.shape[axes.index(name)])
    coordinates["channel"] = ["red", "green", "blue"]
    kind, unit = ("light", "1") if values.dtype.kind == "f" else ("codes", None)
    return cast(DataArray, import_module("xarray").DataArray(
        values, dims=axes, coords={name: coordinates[name] for name in axes}, name=kind,
        attrs={name: each for name, each in dict(attributes, units=unit).items() if each is not None}))


def shortened(value: Any) -> str:
    """As it is written, on one line and not without end."""
    if isinstance(value, np.ndarray):
        return f"an array of shape {value.shape}"
    text = " ".join(repr(value).split())
    count = f", {len(value)} in all" if hasattr(value, "__len__") else ""
    return text if len(text) <= 60 else f"{text[:50]} ...{count}"


def axes_of(ax: Optional[Axes], x: str, y: str) -> Axes:
    """The axes, or matplotlib's current ones, labelled where they are not yet."""
    if ax is None:
        ax = cast(Axes, import_module("matplotlib.pyplot").gca())
    ax.set_xlabel(ax.get_xlabel() or x)
    ax.set_ylabel(ax.get_ylabel() or y)
    return ax


@contextmanager
def as_file(source: Any, name: str) -> Iterator[str]:
    """The path of a source, or of a file with the bytes of one that is open to be read, which is gone afterwards."""
    if not hasattr(source, "read"):
        yield path_of(source)
        return
    with tempfile.TemporaryDirectory(prefix="nutik-") as folder:
        path = join(folder, name)
        with open(path, "wb") as file:
            try:
                shutil.copyfileobj(source, file)
            except TypeError:
                raise WrongType(f"{shortened(source)} is not open for bytes") from None
        yield path


def in_python(text: str) -> str:
    """Arguments for the command line's options, with the value that follows where it is none of the sentence's."""
    def argument(option: re.Match[str]) -> str:
        return option[1].replace("-", "_") + "=" + (f"'{option[2]}'" if option[2] else "")

    value = r"(?: ((?:[+-]?\d[\w.,:/+-]*|[\w-]+\.(?=\w)[\w.]*)(?<=\w)|(?:auto|zero|float|integral)\b))?"
    return re.sub(r"('[^' ]+') (?=\w+=')", r"\1, ", re.sub(r"--([a-z][a-z-]*)" + value, argument, text))


def is_list(value: Any) -> bool:
    """Whether it is several, and no word."""
    return not isinstance(value, str) and hasattr(value, "__iter__") and getattr(value, "ndim", 1) != 0


def scalar(value: Any) -> Any:  # of an array without axes what it holds
    return value[()] if isinstance(value, np.ndarray) and not value.ndim else value


def real(values: Any, what: str) -> NDArray[np.float64]:
    """An array of gains."""
    array = np.asarray(whole(values, what))
    with suppress(TypeError, ValueError, OverflowError):
        if array.dtype.kind in "biufO":
            return array.astype(np.float64)
    raise WrongType(f"{what} has dtype {array.dtype}; gains are real numbers")


def listed(values: Any, what: str = "the array") -> list[Any]:
    """Its values one by one; of what NumPy takes for an array, NumPy's."""
    refuse(not is_list(values), f"{what} is {shortened(values)}; give a list", WrongType)
    return list(np.asarray(whole(values, what)) if hasattr(values, "__array__") else values)


def text_of(value: Any, what: str) -> str:
    """A text."""
    refuse(not isinstance(value, str), f"{what} is {shortened(value)}, no text", WrongType)
    refuse(re.search("[\ud800-\udfff]", value), f"{what} is {shortened(value)}: it holds what is no UTF-8")
    return cast(str, value)


def flag_of(value: Any, what: str) -> bool:
    """True or False, or what is a number."""
    is_one = isinstance(scalar(value), (int, np.integer, np.bool_))
    refuse(not is_one, f"{what} is {shortened(value)}; it is True or False", WrongType)
    return bool(value)


def feather_word(feather: Union[str, float]) -> str:
    """How far edges reach, as the engine reads it."""
    return feather if isinstance(feather, str) else f"{float(exact(scalar(feather), 'feather')):g}px"


def path_of(path: Any) -> str:
    """A path as text."""
    try:
        text = fsdecode(path)
    except TypeError:
        raise WrongType(f"{shortened(path)} is no path") from None
    refuse(re.search("[\0\ud800-\udfff]", text), f"{shortened(path)} is no path: it holds a zero byte, or is not UTF-8")
    return text


def whole(array: Any, what: str) -> Any:
    """The same, unless it is an array with masked values."""
    if isinstance(array, np.ma.MaskedArray) and np.any(array.mask):
        raise UsageError(f"{what} has masked values, for which there is no place; fill them: .filled(0)")
    return array


def warn(messages: Iterable[str], kind: type[NutikWarning] = NutikWarning) -> None:
    """Warns at the line outside of this package that asked."""
    folder = dirname(__file__)
    level, frame = 2, sys._getframe().f_back
    while frame is not None and frame.f_code.co_filename.startswith(folder):
        frame, level = frame.f_back, level + 1
    for message in messages:
        warnings.warn(message, kind, stacklevel=level)


def exact(value: Any, what: str) -> Fraction:
    """A number exactly as it is printed: 0.1 is a tenth."""
    try:
        if isinstance(value, (float, np.floating)):
            return Fraction(str(value))  # in as many digits as its own width needs
        if isinstance(value, (int, np.integer, str, Fraction, Decimal)) and not isinstance(value, bool):
            return Fraction(int(value) if isinstance(value, np.integer) else value)
    except (ValueError, OverflowError, ZeroDivisionError):
        raise UsageError(f"{what} {value!r} is no finite number") from None
    raise WrongType(f"{what} {value!r} is no number")


def number_word(value: Number, what: str) -> str:
    """`30000/1001`, `960`; of a float with more digits than are read the simplest fraction that it may be, 1000/3."""
    if isinstance(value, str):
        return value
    number = exact(value, what)
    if isinstance(value, float) and max(abs(number.numerator), number.denominator) > _MAX_DIGITS:
        simple = (number.limit_denominator(10 ** digits) for digits in range(1, 15))
        number = next((each for each in simple if float(each) == value), number)
    if max(abs(number.numerator), number.denominator) > _MAX_DIGITS:
        raise UsageError(f"{what} {value!r} needs more than 15 digits; write it as a fraction, '30000/1001'")
    return f"{number.numerator}/{number.denominator}"


_UNITS_S = {"W": Fraction(604_800), "D": Fraction(86_400), "h": Fraction(3600), "m": Fraction(60),
            **{unit: Fraction(1, 1000 ** k) for k, unit in enumerate(("s", "ms", "us", "ns", "ps", "fs", "as"))}}


def seconds_of(time: Time, what: str) -> Fraction:
    """A time in seconds, exactly; of words only those that count no pictures."""
    time = scalar(time)
    if isinstance(time, np.timedelta64):
        unit, count = np.datetime_data(time.dtype)
        refuse(np.isnat(time), f"{what} is NaT, which is no time")
        refuse(unit not in _UNITS_S, f"{what} {time!r} has no unit of a fixed length; say numpy.timedelta64(10, 'ms')")
        return int(time.astype(np.int64)) * count * _UNITS_S[unit]
    if isinstance(time, datetime.timedelta):
        finer = getattr(time, "nanoseconds", 0)  # which pandas' have, besides
        return (time.days * 86_400 + time.seconds) + Fraction(time.microseconds * 1000 + finer, _SECOND_NS)
    if isinstance(time, str):
        return Fraction(_nutik.nanoseconds(time, what), _SECOND_NS)
    return exact(time, what)


def time_word(time: Time, what: str) -> str:
    """A time as the engine reads it, exactly; with more digits than it reads, to the nanosecond."""
    if isinstance(time, str):
        return time
    seconds = seconds_of(time, what)
    if max(abs(seconds.numerator), seconds.denominator) > _MAX_DIGITS:
        return f"{half_up(seconds * _SECOND_NS)}ns"
    return f"{seconds.numerator}/{seconds.denominator}s"


def half_up(value: Fraction) -> int:
    """To the nearest whole number, halves upward, as the engine rounds times."""
    return (2 * value.numerator + value.denominator) // (2 * value.denominator)


def time_ns(time: Time, what: str) -> int:
    """A time in whole nanoseconds."""
    nanoseconds = half_up(seconds_of(time, what) * _SECOND_NS)
    refuse(abs(nanoseconds) > LARGEST_NS, f"{what} lies further away than 126 years")
    return nanoseconds


def times_ns(times: Any, what: str) -> NDArray[np.int64]:
    """Times one after another in whole nanoseconds, int64."""
    return np.array([time_ns(time, f"{what}[{i}]") for i, time in enumerate(listed(times, what))], np.int64)


def array_ns(times: NDArray[Any], what: str) -> NDArray[np.int64]:
    """Times in an array of any shape in whole nanoseconds, int64."""
    different, place = np.unique(times, return_inverse=True)
    return times_ns(different, what)[place].reshape(times.shape)


def nanoseconds_of(times: NDArray[Any]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Numbers of seconds in nanoseconds, each in as many digits as it shows, whole ones exactly; and by how much the
    others may be off."""
    shown = times.astype(str) if times.dtype.kind == "f" and times.itemsize != 8 else times
    made = np.asarray(shown.astype(np.float64) * _SECOND_NS)
    is_long = (np.abs(made) > 2 ** 51) & (np.abs(made) <= LARGEST_NS)
    made[is_long] = array_ns(times[is_long], "times")
    error, nearest = np.abs(made) * 2 ** -51, np.rint(made)
    with np.errstate(invalid="ignore"):  # infinite ones
        return np.where(np.abs(made - nearest) <= error, nearest, made), error


def delays_ns(delays: Any) -> NDArray[np.int64]:
    """The delay of each pixel, of seconds or timedelta64, in whole nanoseconds, int64."""
    delays = np.asarray(whole(delays, "delay="))
    refuse(delays.dtype.kind not in "iufm", "delay= is 'rows:15ms', 'map.tif:0s..1s' or an array of seconds, and this "
           f"has dtype {delays.dtype}")
    if delays.dtype.kind == "m":
        return array_ns(delays, "delay=")
    made, error = nanoseconds_of(delays)
    if not (np.abs(made) <= LARGEST_NS).all():
        raise UsageError("delay=: some pixel's delay is no number of seconds, or further away than 126 years")
    rounded = np.asarray(np.floor(made + 0.5), np.int64)
    may_be_half = np.abs(made % 1 - 0.5) <= error
    rounded[may_be_half] = array_ns(delays[may_be_half], "delay=")
    return rounded


def count_of(value: Any, what: str) -> int:
    """A whole number that is not negative."""
    is_whole = isinstance(value, (int, np.integer)) and not isinstance(value, bool)
    if is_whole and 0 <= value < 2 ** 32:
        return int(value)
    raise (UsageError if is_whole else WrongType)(f"{what} is {value!r}, no whole number from 0 on")


def tag_of(value: Any) -> int:
    """A value of a mask."""
    tag = count_of(value, "a tag")
    refuse(tag > 255, f"{tag} is no tag: tags are 0 ... 255")
    return tag


def box_of(value: Any, what: str) -> list[int]:
    """(x, y, width, height)."""
    try:
        x, y, width, height = value
    except (TypeError, ValueError):
        raise UsageError(f"{what} is {value!r}; write whole pixels: (x, y, width, height)") from None
    box = [count_of(each, f"a side of {what}") for each in (x, y, width, height)]
    refuse(0 in box[2:], f"{what} is {value!r}, which holds no pixel: (x, y, width, height)")
    return box


def word_of(name: str, kind: str, value: Any) -> str:
    """A value as the program reads it; `kind` is what its help has in that place."""
    value = scalar(value)
    if isinstance(value, (str, bytes, PathLike)):
        return text_of(fsdecode(value), name)
    if kind == "SIZE":
        return str(int(exact(value, name)))
    if kind == "TIME" or "TIME" in kind and not is_list(value):
        return time_word(value, name)
    if kind == "CODE" and isinstance(value, (float, np.floating)) and value % 1 == 0:
        return str(int(value))
    if kind in ("RATE", "DEGREES", "W:H"):
        return number_word(value, name)
    if kind in ("K", "G", "E", "FILE|LIGHT"):
        return repr(float(exact(value, name)))
    if kind == "WxH+X+Y":
        x, y, width, height = box_of(value, name)
        return f"{width}x{height}+{x}+{y}"
    if is_list(value):
        refuse(getattr(value, "ndim", 1) > 1, f"{name} is {shortened(value)}; give one value or a list", WrongType)
        return ",".join(word_of(name, kind if "TIME" in kind else "", each) for each in value)
    refuse(kind == "FILE|auto", f"{name} is {value!r}, no path", WrongType)
    return feather_word(value) if name == "feather" else "1" if value is True else str(value)


@cache
def _kinds() -> dict[str, str]:
    """How the schema writes the value of each argument."""
    rows = [_nutik.described(command)[2] for command in ("study", "expose", "encode")]
    return {name: row[0] for each in rows for name, row in each.items()}


def is_stated(name: str, kind: Optional[str], value: Any) -> bool:
    """None and False are not, nor is whatever else says no of a flag, which is of kind ''."""
    return value is not None and value is not False and (kind != "" or flag_of(value, f"{name}="))


def settings_of(stated: Mapping[str, Any]) -> dict[str, str]:
    """What is stated, as words."""
    return {name: word_of(name, _kinds().get(name, ""), value) for name, value in stated.items()
            if is_stated(name, _kinds().get(name), value)}


def frozen(told: dict[str, Any]) -> dict[str, Any]:
    """The same, whose arrays nobody writes to."""
    for each in told.values():
        if isinstance(each, np.ndarray):
            each.flags.writeable = False
    return told
