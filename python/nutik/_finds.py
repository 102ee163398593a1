"""What is found in a capture: its plate, its activity, motion studies, numbers that keep wishes."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import NDArray

from . import _nutik
from ._functions import Function, parse_functions
from ._masks import Mask
from ._nutik import UsageError
from ._pictures import Picture
from ._words import Axes, NutikNote, Progress, axes_of, time_word, warn


@dataclass(frozen=True, eq=False)
class Plate:
    """The scene without what moves in it."""

    picture: Picture
    uncertain: NDArray[np.bool_]  # [height, width] bool: pixels whose light is a guess


@dataclass(frozen=True)
class Stretch:
    """Samples [first, last) of a capture, and when they are."""

    samples: tuple[int, int]
    times_ns: tuple[int, int]


@dataclass(frozen=True, eq=False)
class Activity:
    """When a capture changes, and where."""

    changed_pixels: NDArray[np.uint64]  # [samples]: how many of the counted pixels changed at each sample
    changes: NDArray[np.uint64]         # [height, width]: at how many samples each pixel changed
    counted_pixels: int
    redrawn: NDArray[np.uint64]         # samples that count as those beside them
    busiest: Optional[Stretch]  # a twentieth of the capture; None where nothing changes
    quietest: Optional[Stretch]

    def plot(self, ax: Optional[Axes] = None, **style: object) -> Axes:
        """Draws the share of pixels that change at each sample with matplotlib."""
        axes = axes_of(ax, "sample", "share of pixels that change")
        axes.plot(self.changed_pixels / max(self.counted_pixels, 1), **style)
        return axes


@dataclass(frozen=True, eq=False)
class Study:
    """A motion study, and what makes it by hand."""

    picture: Picture
    mask: Optional[Mask]            # of tags; its edges were blended over 2 pixels, but for a slit. None of 'clean'
    functions: dict[int, Function]  # by tag, for normalize='integral'
    moments: list[int]              # samples: of tags 1, 2, ...; of a slit of tags 0, 1, ...


@dataclass(frozen=True)
class SolvedWish:
    """What became of a wish. wanted, reached, missed: light by channel, of brightness its one number first."""

    wish: str
    wanted: list[float]
    reached: list[float]
    missed: list[float]
    is_kept: bool


@dataclass(frozen=True, eq=False)
class Solution:
    """The numbers that come nearest to wishes."""

    functions: dict[int, Function]
    text: str                   # the function file
    gains: dict[str, float]     # by name
    times_ns: dict[str, int]
    wishes: list[SolvedWish]
    untold: list[str]           # gains that no wish depends on
    open_count: int             # in how many ways gains could still change together
    tried: int                  # exposures
    cost: float                 # sum of what is missed, squared, by the wishes' weights
    is_kept: bool               # whether every wish is


def plate(capture: _nutik.Capture, by: Optional[int], output: dict[str, str],
          progress: Progress = None) -> Plate:
    if output["dtype"] == "float64":
        raise UsageError("a plate's light is float32")
    picture, uncertain, is_noise_known = _nutik.plate(capture, by, output, progress)
    if not is_noise_known:
        warn(["nothing in the capture is still for long enough to tell its noise: codes that differ by up to 1/32 of "
              "white were taken for the same light; by= states another difference"])
    uncertain.flags.writeable = False
    return Plate(Picture(picture), uncertain)


def activity(capture: _nutik.Capture, mask: Optional[Mask], tag: Optional[int], by: int,
             count_redrawn: bool, progress: Progress = None) -> Activity:
    if tag is not None and mask is None:
        raise UsageError("tag= is a value of a mask; add mask=")
    told: dict[str, Any] = _nutik.activity(capture, None if mask is None else mask._held, tag, by, count_redrawn, progress)
    warn(told.pop("notes"), NutikNote)
    for name in ("changed_pixels", "changes", "redrawn"):
        told[name].flags.writeable = False
    for name in ("busiest", "quietest"):
        told[name] = None if told[name] is None else Stretch(**told[name])
    return Activity(**told)


def study(capture: _nutik.Capture, settings: dict[str, str], moments: Union[int, list[str], None], regions: list[list[int]],
          output: dict[str, str], progress: Progress = None) -> Study:
    if settings["style"] == "clean" and output["dtype"] == "float64":
        raise UsageError("a plate's light is float32")
    told: dict[str, Any] = _nutik.study(capture, settings, moments, regions, output, progress)
    warn(told["notes"], NutikNote)
    picture = Picture(told["picture"])
    warn(picture._held.figures.get("warnings", []))
    return Study(picture, None if told["mask"] is None else Mask._of(told["mask"]),
                 {tag: Function._of(held) for tag, held in told["functions"].items()}, told["moments"])


def freedom_word(name: str, free: Any, functions: str) -> str:
    """`rest=-100..0`, `when=0.6s..0.8s/1f`."""
    if isinstance(free, str):
        return f"{name}={free}"
    if len(free) not in (2, 3):
        raise UsageError(f"free[{name!r}] is {free!r}; give (least, most) of a gain, (from, to) or (from, to, step) of a "
                         "time")
    if type(free[0]) is type(free[1]) and not isinstance(free[0], str) and free[0] > free[1]:
        raise UsageError(f"free[{name!r}] is {free!r}: the first is above the second")
    if re.search(rf"\[\s*{re.escape(name)}\b", functions):  # in the place of a time
        words = [time_word(each, f"free[{name!r}]") for each in free]
        return f"{name}={words[0]}..{words[1]}" + (f"/{words[2]}" if len(words) == 3 else "")
    return f"{name}={float(free[0])!r}..{float(free[1])!r}"


def solve(capture: _nutik.Capture, functions: str, wishes: list[str], free: list[str], asked: _nutik.Exposure,
          regions: Optional[_nutik.Mask], progress: Progress = None) -> Solution:
    told: dict[str, Any] = _nutik.solve(capture, functions, wishes, free, asked, regions, progress)
    told_wishes = [SolvedWish(**wish) for wish in told.pop("wishes")]
    warnings = told.pop("warnings")
    if not told["is_kept"]:
        warnings.append(f"not all wishes could be kept: the numbers are those with the least cost of all, "
                        f"{told['cost']:.2g}")
    warn(warnings)
    return Solution(functions=parse_functions(told["text"], name="the solution"), wishes=told_wishes, **told)
