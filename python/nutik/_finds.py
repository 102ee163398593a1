"""What is found in a capture: its plate, its activity, motion studies, numbers that keep wishes."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any, Optional, cast

import numpy as np
from numpy.typing import NDArray

from ._functions import Function
from ._masks import Mask
from ._pictures import Picture
from ._words import Axes, axes_of, exact, is_list, refuse, time_word


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
    times: NDArray[np.float64]          # [samples]: when each begins, in seconds
    busiest: Optional[Stretch]  # a twentieth of the capture; None where nothing changes
    quietest: Optional[Stretch]

    def plot(self, ax: Optional[Axes] = None, **style: object) -> Axes:
        """Draws the share of pixels that change over seconds with matplotlib."""
        axes = axes_of(ax, "time, s", "share of pixels that change")
        axes.plot(self.times, self.changed_pixels / max(self.counted_pixels, 1), **cast(Any, style))
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
    at_ends: list[str]          # gains and times that came to an end of what free= allows
    open_count: int             # in how many ways gains could still change together
    tried: int                  # exposures
    cost: float                 # sum of what is missed, squared, by the wishes' weights
    is_kept: bool               # whether every wish is


def freedom_word(name: str, free: Any, functions: str) -> str:
    """`rest=-100..0`, `when=0.6s..0.8s/1f`."""
    if isinstance(free, str):
        return f"{name}={free}"
    is_range = is_list(free) and len(free) in (2, 3) and all(each is not None for each in free)
    refuse(not is_range, f"free[{name!r}] is {free!r}; give (least, most) of a gain, (from, to) or (from, to, step) of "
           "a time")
    refuse(type(free[0]) is type(free[1]) and not isinstance(free[0], str) and free[0] > free[1],
           f"free[{name!r}] is {free!r}: the first is above the second")
    if re.search(rf"\[\s*{re.escape(name)}\b", functions):  # in the place of a time
        words = [time_word(each, f"free[{name!r}]") for each in free]
        return f"{name}={words[0]}..{words[1]}" + (f"/{words[2]}" if len(words) == 3 else "")
    return f"{name}=" + "..".join(repr(float(exact(each, f"free[{name!r}]"))) for each in free[:2])
