"""Pictures, as NumPy arrays that nobody writes to."""

from __future__ import annotations

from copy import deepcopy
from dataclasses import dataclass
from functools import partial
from io import BytesIO
from os.path import join
from shutil import copyfileobj
from tempfile import TemporaryDirectory
from typing import Any, BinaryIO, Callable, Mapping, Optional, Sequence, Union, cast

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from . import _nutik
from ._nutik import UsageError
from ._told import Plan, Statistics, Uncertainty
from ._words import Array, DataArray, Index, Path, frozen, labelled, path_of, refuse, settings_of


def _bounds(light: Union[float, NDArray[np.float64]], pictures: Array) -> NDArray[np.float64]:
    """[pictures] of what is handed over: of float32 with half a step of the largest light of each."""
    if pictures.dtype != np.float32:
        return np.broadcast_to(np.asarray(light, np.float64), (len(pictures),))
    axes = tuple(range(1, pictures.ndim))
    largest: NDArray[np.float64] = np.abs(pictures).max(axis=axes, initial=0.0).astype(np.float64)
    return np.asarray(light + largest * 2.0 ** -24 + 2.0 ** -150, np.float64)  # the second: where floats are subnormal


class _HasArray:
    """What NumPy takes for its `array`."""

    array: Array

    def __array__(self, dtype: DTypeLike = None, copy: Optional[bool] = None) -> NDArray[np.generic]:
        array = self.array
        refuse(copy is False and dtype not in (None, array.dtype), f"{array.dtype} becomes {dtype} only in a copy")
        return array if dtype is None and not copy else array.astype(dtype or array.dtype, copy=bool(copy))

    @property
    def shape(self) -> tuple[int, ...]:
        """The shape of `array`."""
        return self.array.shape


@dataclass(frozen=True, eq=False, repr=False)
class Pictures(_HasArray):
    """Many pictures of a capture."""

    array: Array         # [pictures, height, width] or [pictures, height, width, 3]: light or codes
    error_bounds: NDArray[np.float64]  # [pictures] float64: as error_bound of a Picture; NaN of the reference
    saturated: Optional[NDArray[np.uint64]]  # [pictures, 2]: as saturated of a Picture; None where light is kept
    corner: tuple[int, int] = (0, 0)   # x, y of their first pixel in the capture, of region=
    bounds: Optional[dict[str, NDArray[np.float32]]] = None  # each [pictures, height, width]: as bounds of a Picture
    _uncertainties: Callable[[], list[Uncertainty]] = list

    @classmethod
    def _of(cls, array: Array, errors: NDArray[np.float64], saturated: NDArray[np.uint64], corner: tuple[int, int],
            maps: Sequence[Mapping[str, _nutik.Picture]], told: Callable[[], list[Uncertainty]]) -> Pictures:
        bounds: Any = {term: np.stack([each[term].values() for each in maps]) for term in maps[0]} if maps else None
        return cls(array, _bounds(errors, array), saturated if array.dtype.kind == "u" else None, corner, bounds, told)

    def __post_init__(self) -> None:
        frozen(vars(self))
        frozen(self.bounds or {})

    @property
    def uncertainty(self) -> list[Uncertainty]:
        """The `uncertainty` of each picture, as a Picture has it."""
        return self._uncertainties()

    def __getstate__(self) -> dict[str, object]:
        return {**vars(self), "_uncertainties": partial(deepcopy, self.uncertainty)}

    def __setstate__(self, state: dict[str, object]) -> None:
        vars(self).update(state)
        self.__post_init__()

    def __len__(self) -> int:
        return len(self.array)

    def __getitem__(self, key: Index) -> Array:
        return self.array[key]

    def __repr__(self) -> str:
        return f"<nutik.Pictures {' x '.join(map(str, self.shape))}, {self.array.dtype}>"

    def to_xarray(self, **first: ArrayLike) -> DataArray:
        """An xarray.DataArray [picture, y, x(, channel)], no copy; its attribute `error_bounds` has a bound for each
        picture.

        Parameters:
        first : of the first axis its name and its coordinate, start=starts; without it numbers. `start` and `time` are
            seconds.
        Raises:
        UsageError where a coordinate is not a list with an entry for each picture.
        """
        refuse(len(first) > 1, f"{', '.join(first)}: the first axis has one name and one coordinate")
        bounds = None if np.isnan(self.error_bounds).any() else self.error_bounds
        return labelled(self.array, first or {"picture": range(len(self))}, {"error_bounds": bounds}, self.corner)


class Picture(_HasArray):
    """A picture that was exposed, and what is known of it.

    `array` is the picture itself: numpy.asarray(picture) and matplotlib's imshow(picture) take it without a copy. Light
    is not clipped: it may be negative, and above 1.

    Examples:
    >>> picture = capture.render(start=0, exposure="5f")
    >>> picture, picture.error_bound < 1e-6
    (<nutik.Picture 32 x 24 grey, light, float32>, True)
    """

    def __init__(self, held: _nutik.Picture, corner: tuple[int, int] = (0, 0)) -> None:
        self._held = held
        self._corner = corner
        self._array = held.values()

    @property
    def array(self) -> Array:  # type: ignore[override]
        """[height, width] or [height, width, 3]: light (float32, float64) or codes (uint8, uint16). Read-only; it
        keeps the picture's memory alive by itself."""
        return self._array

    @property
    def dtype(self) -> np.dtype[np.generic]:
        """The type of `array`."""
        return self.array.dtype

    @property
    def corner(self) -> tuple[int, int]:
        """x, y of its first pixel in the capture, of region=."""
        return self._corner

    @property
    def precision(self) -> Optional[str]:
        """The arithmetic that computed it: 'single', 'compensated', 'double' or 'fixed'; None of a background."""
        return self._held.figures.get("precision")

    @property
    def error_bound(self) -> Optional[float]:
        """How far the light of any pixel may lie from the exact integral, in light: of codes before it is rounded to
        them, of float32 with half a step of that for the largest light. All else was known before anything was computed
        (docs/explanation/accuracy.md). None of a background, of the reference, and of combine='lighten', 'darken' and
        'median', which add nothing up: `uncertainty` has what bounds their light."""
        bound = self._held.figures.get("error_bound")
        return None if bound is None else float(_bounds(bound["light"], self.array[None])[0])

    @property
    def error_bound_in_codes(self) -> Optional[float]:
        """How far they may lie from it on the scale of the picture's codes, before they are rounded; of light in the
        steps that docs/explanation/uncertainty.md has."""
        bound = self._held.figures.get("error_bound")
        return None if bound is None else bound["steps"]

    @property
    def bounds(self) -> Optional[dict[str, Array]]:
        """What each pixel may be off by, of render(..., bounds=True), else None: 'all_bounds' and each of its terms,
        [height, width] float32, in light, or in the picture's codes (docs/explanation/uncertainty.md, "A map")."""
        held = self._held.figures.get("bounds_maps")
        return None if held is None else {term: each.values() for term, each in held.items()}

    @property
    def uncertainty(self) -> Uncertainty:
        """What the light of the picture may be off by, term by term (docs/explanation/uncertainty.md). Empty of a
        background."""
        return deepcopy(self._held.figures.get("uncertainty", {}))

    @property
    def saturated(self) -> Optional[tuple[int, int]]:
        """How many pixels hold light below the first code, and above the last; None where light is kept."""
        return self._held.figures.get("saturated")

    @property
    def plan(self) -> Plan:
        """What the exposure touched, with `functions`, those that the mask uses. Empty of a background."""
        return deepcopy(self._held.figures.get("plan", {}))

    @property
    def statistics(self) -> Statistics:
        """What the rendering took. Empty of a background."""
        return deepcopy(self._held.figures.get("statistics", {}))

    def to_xarray(self) -> DataArray:
        """An xarray.DataArray [y, x(, channel)], no copy. Where there is an `error_bound`, it is an attribute."""
        return labelled(self.array, {}, {"error_bound": self.error_bound}, self._corner)

    def write(self, path: Union[Path, BinaryIO], *, kind: Optional[str] = None, quality: Optional[int] = None,
              keep_pixels: bool = False) -> None:
        """Writes a file of the kind that its name says: .png of codes, .exr of light, or another of
        docs/reference/picture.md; float64 as .tif or .npy.

        Parameters:
        path : or a file that is open for bytes, as io.BytesIO.
        kind : of an open file which one it becomes, '.png'.
        quality : of .jpg, 1 ... 100.
        keep_pixels : a .png or .jpg has the pixels of `array` also where they are not square; without it they are made
            so, for eyes. Other files keep them.
        Raises:
        UsageError where such a file cannot hold the picture, OutputError where it cannot be written.
        Examples:
        >>> capture.render(start=0, exposure="5f").write("light.exr")
        """
        if hasattr(path, "write"):
            refuse(kind is None or not kind.startswith("."), "which kind of file? An open one has no name: kind='.png'")
            with TemporaryDirectory(prefix="nutik-") as folder:
                self.write(join(folder, f"picture{kind}"), quality=quality, keep_pixels=keep_pixels)
                with open(join(folder, f"picture{kind}"), "rb") as file:
                    copyfileobj(file, cast(BinaryIO, path))
            return
        refuse(kind is not None, f"kind={kind!r} is said of an open file; {path_of(path)} says by its name what it is")
        name, is_light = path_of(path), self.dtype.kind == "f"
        if name.lower().endswith(".npy") and not is_light:
            made = BytesIO()
            np.save(made, self.array)
            _nutik.write_text(name, made.getvalue(), True)
            return
        try:
            self._held.write(name, settings_of({"quality": quality, "keep_pixels": keep_pixels}))
        except UsageError as error:
            if "cannot hold the values" not in str(error):
                raise
            way = ("light: expose it with codes=True, or write .tif or .npy, of float32 also .exr or .pfm" if is_light
                   else "codes: write .png, .tif or .npy; a .jpg holds those of dtype=np.uint8, and light comes without "
                        "codes=True")
            raise UsageError(f"{error}, {self.dtype} {way}") from None

    def _repr_png_(self) -> bytes:
        """As notebooks show it: light as sRGB codes of 8 bits."""
        file = BytesIO()
        (self if self.dtype.kind == "u" else Picture(self._held.for_eyes())).write(file, kind=".png")
        return file.getvalue()

    def __reduce__(self) -> tuple[object, ...]:
        return Picture, (self._held, self._corner)

    def __repr__(self) -> str:
        size = " x ".join(str(side) for side in self.shape[1::-1])
        colour = "colour" if len(self.shape) == 3 else "grey"
        values = f"light, {self.dtype}" if self.dtype.kind == "f" else f"codes, {self.dtype}"
        return f"<nutik.Picture {size} {colour}, {values}>"
