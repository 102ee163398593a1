"""Captures for napari, which finds this by napari.yaml: a .tik is opened as a layer, read as it is scrolled through."""

from __future__ import annotations

from collections.abc import Sequence
from os.path import basename
from typing import Callable, Optional, Union

from ._captures import Capture
from ._sources import open

Layer = tuple[Capture, dict[str, object], str]
Read = Callable[[Union[str, Sequence[str]]], list[Layer]]


def reader(path: Union[str, Sequence[str]]) -> Optional[Read]:
    """What reads these files, where all of them are captures."""
    paths = [path] if isinstance(path, str) else path
    return layers if paths and all(str(each).lower().endswith(".tik") for each in paths) else None


def layers(path: Union[str, Sequence[str]]) -> list[Layer]:
    """An image for each file, from black to white. Its first axis is time, in seconds; the others are pixels."""
    made = []
    for each in [path] if isinstance(path, str) else path:
        capture = open(each)
        is_colour = len(capture.shape) == 4
        named: dict[str, object] = {"name": basename(each), "rgb": is_colour, "metadata": dict(capture.figures),
                                    "scale": (float(1 / capture.rate), 1.0, 1.0)}
        if not is_colour:
            named["contrast_limits"] = (0, capture.figures["white"])
        made.append((capture, named, "image"))
    return made
