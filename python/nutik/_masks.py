"""Masks: which gain function each pixel is exposed with."""

from __future__ import annotations

from functools import partial
from os import PathLike
from typing import Mapping, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _nutik
from ._nutik import UsageError
from ._words import Array, Path, Progress, feather_word, path_of, tag_of, whole


class Mask:
    """One tag for each pixel, or shares of several. Masks do not change.

    Parameters:
    tags : [height, width] whole numbers 0 ... 255; bool is 0 and 1.
    Examples:
    >>> nutik.Mask(np.eye(16, dtype=bool))
    <nutik.Mask 16 x 16, tags [0, 1]>
    """

    def __init__(self, tags: ArrayLike) -> None:
        tags = np.asarray(whole(tags, "a mask's array of tags"))
        if tags.dtype not in (bool, np.uint8) and not (
                tags.dtype.kind in "iu" and tags.size and tags.min() >= 0 and tags.max() <= 255):
            values = f" and values {tags.min()} ... {tags.max()}" if tags.size and tags.dtype.kind in "iuf" else ""
            raise UsageError(f"a mask's tags are whole numbers 0 ... 255, and this array has dtype {tags.dtype}{values}"
                             "; for shares of pixels see nutik.Mask.of_layers()")
        self._held = _nutik.Mask(tags.astype(np.uint8, copy=False))

    @classmethod
    def _of(cls, held: _nutik.Mask) -> Mask:
        mask = cls.__new__(cls)
        mask._held = held
        return mask

    @classmethod
    def of_layers(cls, alphas: Mapping[int, ArrayLike], *, rest: int = 0, progress: Progress = None) -> Mask:
        """A soft mask. Shares are kept in 65535ths.

        Parameters:
        alphas : for each tag [height, width], the share of each pixel that it has: float in [0, 1], uint8 of 255,
            uint16 of 65535, or bool.
        rest : the tag that gets what they leave.
        progress : called with rows done, of how many.
        Raises:
        InputError where they come to more than all of a pixel.
        Examples:
        >>> float(nutik.Mask.of_layers({128: np.full((4, 4), 0.2)}).share(128)[0, 0] / 65535)
        0.2
        """
        layers = {tag_of(tag): _shares(alpha, tag) for tag, alpha in alphas.items()}
        return cls._of(_nutik.Mask.of_layers(layers, tag_of(rest), progress))

    def feathered(self, feather: Union[str, float], *, progress: Progress = None) -> Mask:
        """A mask of tags, blended along its edges (docs/reference/masks.md).

        Parameters:
        feather : pixels to either side, 6 or '6px', or '2px,M255=6px' for a tag of its own.
        progress : called with steps done, of how many.
        Examples:
        >>> nutik.Mask(np.eye(16, dtype=np.uint8)).feathered(2).is_soft
        True
        """
        return Mask._of(self._held.feathered(feather_word(feather), progress))

    @property
    def tags(self) -> Array:
        """[height, width] uint8, read-only, no copy: of a pixel with several shares the tag with the largest."""
        return self._held.tags()

    def share(self, tag: int) -> Array:
        """[height, width] uint16: how much of each pixel a tag has, in 65535ths.

        Parameters:
        tag : any, also one that no pixel has.
        """
        return self._held.share(tag_of(tag))

    @property
    def tags_in_use(self) -> list[int]:
        """The tags that pixels have or share."""
        return self._held.tags_in_use()

    @property
    def is_soft(self) -> bool:
        """Whether some pixel has shares of several tags."""
        return self._held.is_soft()

    def __reduce__(self) -> tuple[object, ...]:
        if not self.is_soft:
            return Mask, (self.tags,)
        rest, *others = self.tags_in_use
        return partial(Mask.of_layers, rest=rest), ({tag: self.share(tag) for tag in others},)

    def __repr__(self) -> str:
        height, width = self.tags.shape
        return f"<nutik.Mask {width} x {height}, tags {self.tags_in_use}{', soft' if self.is_soft else ''}>"


MaskLike = Union[Mask, NDArray[np.uint8], NDArray[np.int64], NDArray[np.bool_], Mapping[int, ArrayLike], Path]


def read_mask(path: Path, *, rest: int = 0) -> Mask:
    """A mask from a grey picture whose values are tags, or from layers.

    Parameters:
    path : the picture; or, of a name with a number in it, 'layer-%d.png', layers.
    rest : the tag that gets what layers leave.
    Raises:
    FileMissing, InputError where it is no mask.
    Examples:
    >>> capture.render(start=0, exposure="1f", codes=True).write("tags.png")
    >>> nutik.read_mask("tags.png").tags.shape
    (24, 32)
    """
    return Mask._of(_nutik.Mask.read(path_of(path), tag_of(rest)))


def mask_of(given: Optional[MaskLike], rest: int = 0) -> Optional[Mask]:
    """A mask of what stands for one."""
    if given is None or isinstance(given, Mask):
        return given
    if isinstance(given, (str, PathLike)):
        return read_mask(given, rest=rest)
    if isinstance(given, Mapping):
        return Mask.of_layers(given, rest=rest)
    return Mask(given)


def _shares(alpha: ArrayLike, tag: int) -> NDArray[np.uint16]:
    alpha = np.asarray(whole(alpha, f"the alpha of tag {tag}"))
    most = _nutik.WHOLE_SHARE
    steps = {"bool": most, "uint8": most // 255, "uint16": 1}.get(alpha.dtype.name)
    if steps is not None:
        return np.asarray(alpha * np.uint16(steps))
    if alpha.dtype.kind == "f":
        if alpha.size and not (np.min(alpha) >= 0 and np.max(alpha) <= 1):
            raise UsageError(f"the alpha of tag {tag} lies outside 0 ... 1: {np.min(alpha)} ... {np.max(alpha)}")
        return np.asarray(np.rint(alpha.astype(np.float64) * most), np.uint16)
    raise UsageError(f"the alpha of tag {tag} has dtype {alpha.dtype}; give float in [0, 1], uint8, uint16 or bool")
