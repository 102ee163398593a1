"""Captures: opened, encoded, exposed, looked into."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from html import escape
from os import PathLike
from operator import index
from typing import Any, Iterable, Iterator, Literal, cast, Mapping, Optional, Sequence, Union

import numpy as np
from numpy.typing import DTypeLike, NDArray

from . import _nutik
from ._finds import Activity, Plate, Solution, SolvedWish, Stretch, Study, freedom_word
from ._functions import Function, FunctionLike, function_of, parse_functions, read_functions
from ._masks import Mask, MaskLike, mask_of
from ._nutik import InputError, MemoryTooLittle, UsageError
from ._pictures import Picture, Pictures
from ._told import Figures
from ._words import (Axes, DataArray, DelayLike, HasArray, Index, NutikNote, Path, Progress, Time, WrongType, axes_of,
                     box_of, count_of, delays_ns, flag_of, frozen, is_list, labelled, listed, real, refuse, settings_of,
                     shortened, tag_of, text_of, time_word, warn, word_of)

Codes = Union[NDArray[np.uint8], NDArray[np.uint16]]
Functions = Union[FunctionLike, Mapping[int, FunctionLike], Path]

_SETTINGS = ("start", "exposure", "shutter", "shutter_error", "normalize", "gain", "unmapped", "precision", "strict",
             "combine")
_MOST_AT_ONCE = 4 << 30  # bytes of samples that one array takes


@dataclass(frozen=True, eq=False, repr=False)
class Trace:
    """How one function's light of a pixel came about, or the mean of a region: from edge to edge, where light and gain
    run straight in between. N steps, C channels."""

    tag: int                 # whose function it is
    share: float             # of the pixel's light that this function has
    pixels: int              # whose mean it is
    times_ns: NDArray[np.int64]       # [N, 2]: where each step begins and ends
    gain: NDArray[np.float64]         # [N, 2] at both
    light: NDArray[np.float64]        # [N, 2, C] at both
    integral_ns: NDArray[np.float64]  # [N, C] of light times gain over the step
    sum_ns: NDArray[np.float64]       # [N, C] of all integrals up to the step's end
    made: NDArray[np.bool_]           # [N]: whether the sample it begins with was made between two filmed ones
    exposed: NDArray[np.float64]      # [C] the exposure's light
    support_ns: int                   # D, by which the sum is divided

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Trace) and all(np.array_equal(value, getattr(other, name))
                                                for name, value in vars(self).items())

    def __repr__(self) -> str:
        return f"<nutik.Trace of M{self.tag}: {len(self.gain)} steps, light {self.exposed}>"

    def plot(self, ax: Optional[Axes] = None, **style: object) -> Axes:
        """Draws light over seconds with matplotlib, a line for each channel."""
        axes = axes_of(ax, "time, s", "light")
        for channel, colour in enumerate(("red", "green", "blue") if self.light.shape[2] == 3 else ("",)):
            named: dict[str, object] = {"color": colour} if colour and not {"c", "color"} & style.keys() else {}
            axes.plot(self.times_ns.ravel() / 1e9, self.light[:, :, channel].ravel(), **cast(Any, {**named, **style}))
        return axes

    @classmethod
    def _of(cls, told: dict[str, Any]) -> Trace:
        steps = told.pop("steps")
        values = steps["values"][:, :len(told["exposed"])]
        ends = {name: np.stack([of[f"begin_{name}"], of[f"end_{name}"]], 1)
                for name, of in (("ns", steps), ("gain", steps), ("light", values))}
        return cls(**frozen(dict(times_ns=ends["ns"], gain=ends["gain"], light=ends["light"],
                                 integral_ns=values["integral_ns"], sum_ns=values["sum_ns"], made=steps["is_made"],
                                 **told)))


def _warn_of_black(still_gains: Mapping[int, float], negative: Optional[str]) -> None:
    if negative in (None, "saturate"):
        warn(f"M{tag}: the still gain is {gain:.6g}: whatever does not move comes out black; negative='offset' shows "
             "light below 0, and light itself (codes=False) keeps it" for tag, gain in still_gains.items() if gain < 0)


class Capture:
    """A capture that is open: nutik.open() and nutik.encode() make one.

    Any number of threads may ask it. It is closed when nothing refers to it any more, or by `with`; pictures of it
    stay.
    """

    def __init__(self, held: _nutik.Capture, notes: Sequence[str] = ()) -> None:
        self._notes = list(notes)
        self._open_capture: Optional[_nutik.Capture] = held

    @property
    def _held(self) -> _nutik.Capture:
        if self._open_capture is None:
            raise UsageError("the capture is closed")
        return self._open_capture

    def close(self) -> None:
        """Gives back its memory and, of a temporary one, its file. Whatever is asked besides raises UsageError."""
        self._open_capture = None

    def __enter__(self) -> Capture:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def name(self) -> str:
        """What messages call it: its path."""
        return self._held.name

    @property
    def shape(self) -> tuple[int, ...]:
        """(samples, height, width) or (samples, height, width, 3)."""
        return (len(self), *self._held.shape)

    @property
    def ndim(self) -> int:
        """3, or 4 of colour."""
        return len(self.shape)

    @property
    def dtype(self) -> np.dtype[Union[np.uint8, np.uint16]]:
        """The type of its codes: uint8 or uint16."""
        return np.dtype(np.uint8 if self._held.code_bytes == 1 else np.uint16)

    def __len__(self) -> int:
        return self._held.sample_count

    def __getitem__(self, key: Index) -> Codes:
        """The codes that are held, exactly: `capture[3]` is [height, width] or [height, width, 3], `capture[10:20]` has
        samples before them; what follows picks pixels, `capture[:, 100:200, 50:60]`. A copy each time; raises
        IndexError, and MemoryTooLittle where the samples of a slice take more than 4 GiB.

        >>> capture[3].shape, capture[2:5, :10, 0].shape
        ((24, 32), (3, 10))
        """
        keys: list[Any] = [*key] if isinstance(key, tuple) else [key]
        for at in [number for number, each in enumerate(keys) if each is Ellipsis][:1]:
            keys[at:at + 1] = [slice(None)] * (self.ndim + 1 - sum(each is not None for each in keys))
        first = next((number for number, each in enumerate(keys) if each is not None), len(keys))
        made, picked, rest = [None] * first, [*keys, slice(None)][first], keys[first + 1:]
        numbers = np.arange(len(self))[picked if isinstance(picked, slice) else index(picked)]
        bytes_asked = numbers.size * int(np.prod(self.shape[1:])) * self.dtype.itemsize
        refuse(bytes_asked > _MOST_AT_ONCE, f"{numbers.size} samples are {bytes_asked / 1e9:.1f} GB; take fewer at a "
               "time, or expose them with render()", MemoryTooLittle)
        held = self._held.reader().samples(cast(Any, np.sort(numbers, axis=None)).tolist())
        if not isinstance(picked, slice):
            return cast(Codes, held[(*made, 0, *rest)])
        in_order = held if picked.step is None or picked.step > 0 else held[::-1]
        return cast(Codes, in_order[(*made, slice(None), *rest)])

    def __iter__(self) -> Iterator[Codes]:
        reader = self._held.reader()
        return (cast(Codes, reader.samples([number])[0]) for number in range(len(self)))

    def __array__(self, dtype: DTypeLike = None, copy: Optional[bool] = None) -> NDArray[np.generic]:
        """All samples, where they take no more than 4 GiB; a copy always."""
        if copy is False:
            raise ValueError("a capture holds no array: a copy of its codes is made")
        return self[:] if dtype is None else self[:].astype(dtype, copy=False)

    def to_xarray(self, samples: slice = slice(None)) -> DataArray:
        """The codes of samples as an xarray.DataArray [time, y, x(, channel)], a copy; `time` is when each begins, in
        seconds, and attributes are `figures` and `facts`.

        Parameters:
        samples : which, slice(10, 20) of those from 10 on and before 20; all without it.
        Raises:
        MemoryTooLittle where they take more than 4 GiB, UsageError where `samples` is no slice.
        """
        refuse(not isinstance(samples, slice), f"samples is {samples!r}; give a slice: slice(10, 20), or slice(10, 11) "
               "of one sample", WrongType)
        figures = {name: each if isinstance(each, str) else float(each) if isinstance(each, Fraction)
                   else int(cast(int, each))  # netCDF takes these
                   for name, each in self.figures.items() if name != "tiles"}
        return labelled(self[samples], {"time": self.times[samples]}, {"facts": "; ".join(self.facts), **figures})

    @property
    def times(self) -> NDArray[np.float64]:
        """[samples] float64: when each sample's exposure begins, in seconds; times_ns has it exactly."""
        return self.times_ns[:, 0] / 1e9

    def records(self, region: Optional[Sequence[int]] = None, *, first: int = 0, last: Optional[int] = None,
                progress: Progress = None) -> NDArray[np.void]:
        """What pixels hold, from one change to the next.

        Parameters:
        region : (x, y, width, height), only these pixels.
        first, last : only samples from `first` on and before `last`; what is held before or after is cut there.
        Returns:
        [records] with the fields x, y, start_ns, end_ns, code (of colour [3]); each pixel's in time order, row after
        row.
        Raises:
        UsageError where there are no such pixels or samples; MemoryTooLittle where records take more than `memory` of
        open() or encode(): ask for a region, or for fewer samples.
        Examples:
        >>> capture.records((3, 4, 1, 1), first=0, last=1)["end_ns"].tolist()
        [10000000]
        """
        height, width = self.shape[1:3]
        box = [0, 0, width, height] if region is None else box_of(region, "region")
        refuse(box[0] + box[2] > width or box[1] + box[3] > height,
               f"region is {tuple(box)}; the capture has {width} x {height} pixels")
        end = len(self) if last is None else count_of(last, "last")
        refuse(not count_of(first, "first") < end <= len(self), f"there are no samples from {first} to {end}; the "
               f"capture has {len(self)}")
        row = np.dtype([("x", np.uint32), ("y", np.uint32), ("start_ns", np.int64), ("end_ns", np.int64),
                        ("code", self.dtype, self.shape[3:])])
        return self._held.records(box, first, end, row, progress)

    @property
    def rate(self) -> Fraction:
        """Samples a second, exactly where constant, else on average."""
        return Fraction(*self._held.rate)

    @property
    def duration_ns(self) -> int:
        """How long it lasts."""
        return self._held.duration_ns

    @property
    def times_ns(self) -> NDArray[np.int64]:
        """[samples, 2] int64: when each sample's exposure begins and ends."""
        return self._held.times_ns()

    @property
    def facts(self) -> list[str]:
        """What the clip was taken for, and who said it: 'transfer srgb, assumed'."""
        return self._held.facts

    @property
    def notes(self) -> list[str]:
        """What should be known of the clip that it was made from; each was warned of as a NutikNote."""
        return list(self._notes)

    @property
    def figures(self) -> Figures:
        """What it comes to, from `samples` to `codec`."""
        figures: dict[str, Any] = self._held.figures()
        return cast(Figures, {name: Fraction(*of) if isinstance(of, tuple) else of for name, of in figures.items()})

    def render(self, functions: Optional[Functions] = None, mask: Optional[MaskLike] = None, *,
               start: Optional[Time] = None, exposure: Optional[Time] = None, shutter: Optional[str] = None,
               shutter_error: Optional[float] = None, feather: Union[str, float, None] = None,
               delay: Optional[DelayLike] = None, normalize: str = "support", gain: float = 1.0,
               unmapped: Optional[str] = None, precision: Optional[str] = None, codes: bool = False,
               dtype: DTypeLike = None, transfer: Optional[str] = None, negative: Optional[str] = None,
               region: Optional[Sequence[int]] = None, bounds: bool = False, strict: bool = False,
               combine: Optional[Literal["integral", "mean", "lighten", "darken", "median"]] = None,
               progress: Progress = None) -> Picture:
        """Exposes a picture: of an interval, or with gain functions.

        Parameters:
        functions : one for all of the picture (a nutik.Function, a list of (time, gain), an array with a gain for each
            sample, or a callable over the whole capture, fitted within 0.001 of its largest gain, as nutik.fit() does,
            whose error= is another), or one for each tag of `mask` ({0: ..., 128: ...}, or a function file).
        mask : [height, width] of tags, or {tag: alpha} of shares (the lowest tag gets what they leave), a
            nutik.Mask, or a file.
        start, exposure : the interval, in place of functions; 0 without a start. Of functions their time 0.
        delay : how much later each pixel is exposed (docs/how-to/delay.md): 'rows:15ms', 'columns:0s..0.5s',
            'radial:-20ms..20ms', 'map.tif:0s..1s', or [height, width] of seconds or timedelta64.
        unmapped : 'zero': pixels whose tag has no function are black; without it that is an error.
        precision : 'single', 'compensated', 'double' or 'fixed'; None: the fastest whose error bound is small enough.
        codes, dtype : float32 without them, or float64. With codes uint8 or uint16, the capture's own without dtype.
        transfer : of codes, sRGB without it; 'source': the capture's own.
        region : (x, y, width, height) in pixels, only these.
        bounds : also maps of what each pixel may be off by, Picture.bounds.
        strict : light that may err by more than half a code, or half a float's step, raises ImpreciseError, and is no
            warning.
        Returns:
        Picture, whose array is [height, width] or [height, width, 3]: light, of which 1 is white, or codes.
        Raises:
        UsageError where the request does not fit the capture, InputError where mask and functions do not or the capture
        is damaged, DeviceError; KeyboardInterrupt at Ctrl-C.
        Examples:
        >>> capture.render(start="5f", exposure=0.02, codes=True).dtype
        dtype('uint8')
        >>> halves = np.zeros((24, 32), np.uint8)
        >>> halves[:, 16:] = 128
        >>> picture = capture.render({0: nutik.boxcar(0, "10ms"), 128: [(0, 1), (0.05, 0)]}, mask=halves)
        >>> picture.array.shape, picture.error_bound < 1e-6
        ((24, 32), True)
        """
        asked, corner = self._exposure(locals())
        held = _nutik.render(self._held, asked, self._output(codes, dtype, transfer, negative),
                             flag_of(bounds, "bounds"), progress)
        picture = Picture(held, corner)
        warn(held.figures["warnings"])
        if picture.dtype.kind == "u":
            _warn_of_black({each["tag"]: each["still_gain"] for each in picture.plan["functions"]}, negative)
        return picture

    def render_many(self, functions: Union[Sequence[Functions], HasArray, None] = None,
                    mask: Optional[MaskLike] = None, *, starts: Union[Time, Iterable[Time], None] = None,
                    exposures: Union[Time, Iterable[Time], None] = None, shutter: Optional[str] = None,
                    shutter_error: Optional[float] = None, feather: Union[str, float, None] = None,
                    delay: Optional[DelayLike] = None, normalize: str = "support", gain: float = 1.0,
                    unmapped: Optional[str] = None, precision: Optional[str] = None, codes: bool = False,
                    dtype: DTypeLike = None, transfer: Optional[str] = None, negative: Optional[str] = None,
                    region: Optional[Sequence[int]] = None, bounds: bool = False, strict: bool = False,
                    combine: Optional[Literal["integral", "mean", "lighten", "darken", "median"]] = None,
                    progress: Progress = None) -> Pictures:
        """Exposes many pictures in one call. Small ones (16384 values) with one function each are added up on the
        processor, in double, in one pass over the capture; others are made one by one, as those with bounds=True.

        Parameters:
        functions : a list, of each picture those that render() takes; or [pictures, samples], gains.
        starts, exposures : one for all pictures, or one for each. What is a list has one length.
        progress : called with (pictures done, of how many).
        Returns:
        Pictures, whose array is [pictures, height, width] or [pictures, height, width, 3].
        Raises:
        UsageError where lists have different lengths or are empty; as render() does.
        Examples:
        >>> many = capture.render_many(starts=np.linspace(0, 0.05, 100), exposures="10ms")
        >>> many.array.shape, many.error_bounds.shape
        ((100, 24, 32), (100,))
        """
        is_one = getattr(functions, "ndim", 0) == 1 and getattr(functions, "dtype", None) != object
        each = "a dict {tag: function}" if isinstance(functions, Mapping) else "those of render()"
        refuse(is_one or isinstance(functions, Mapping) or not (functions is None or is_list(functions)),
               f"functions is {shortened(functions)}; render_many() takes a list with {each} for each picture, "
               "[{0: ..., 128: ...}, ...], or an array [pictures, samples] of gains")
        lists: dict[str, list[Any]] = {name: listed(each) if name == "functions" or is_list(each) else [each]
                 for name, each in (("functions", functions), ("starts", starts), ("exposures", exposures))
                 if each is not None}
        counts = {len(each) for each in lists.values()} - {1} or {1}
        said = ", ".join(f"{len(each)} {name}" for name, each in lists.items())
        refuse(len(counts) > 1 or 0 in counts, f"there are {said}: lists have one length, or one for all pictures")
        first = {name: lists.get(f"{name}s", [None])[0] for name in ("function", "start", "exposure")}
        asked, corner = self._exposure({**locals(), **first, "functions": first["function"]})
        starts, exposures = ([time_word(each, f"{name}[{i}]") for i, each in enumerate(lists.get(name, []))]
                             for name in ("starts", "exposures"))
        held = [{tag: function._held for tag, function in self._functions(each, mask is not None).items()}
                for each in lists.get("functions", [])]
        array, errors, saturated, doubts, still_gains, maps, told = _nutik.render_many(
            self._held, asked, counts.pop(), starts, exposures, held, self._output(codes, dtype, transfer, negative),
            flag_of(bounds, "bounds"), progress)
        warn(doubts)
        if array.dtype.kind == "u":
            _warn_of_black(still_gains, negative)
        return Pictures._of(array, errors, saturated, corner, maps, told)

    def trace(self, x: Optional[int] = None, y: Optional[int] = None, *, tag: Optional[int] = None,
              functions: Optional[Functions] = None, mask: Optional[MaskLike] = None, start: Optional[Time] = None,
              exposure: Optional[Time] = None, shutter: Optional[str] = None, shutter_error: Optional[float] = None,
              feather: Union[str, float, None] = None, delay: Optional[DelayLike] = None, normalize: str = "support",
              gain: float = 1.0, unmapped: Optional[str] = None, progress: Progress = None) -> list[Trace]:
        """How the light of a pixel came about, or the mean of all pixels of a tag.

        Parameters:
        x, y : the pixel, or
        tag : of the mask.
        Returns:
        A Trace for each function that has a share.
        Raises:
        UsageError where there is no such pixel or tag; as render() does.
        Examples:
        >>> trace, = capture.trace(3, 4, start=0, exposure="10ms")
        >>> bool(abs(trace.integral_ns.sum() / trace.support_ns - trace.exposed[0]) < 1e-12)
        True
        """
        refuse((x is None) != (y is None) or (x is None) == (tag is None),
               "what should be followed? Either a pixel, x and y, or a tag of the mask, tag=")
        refuse(tag is not None and mask is None, "tag= is a value of a mask; add mask=")
        asked, _ = self._exposure(locals())
        pixel = None if x is None else (count_of(x, "x"), count_of(y, "y"))
        traces, told = _nutik.trace(self._held, asked, pixel, None if tag is None else tag_of(tag), progress)
        warn(told)
        return [Trace._of(each) for each in traces]

    def background(self, *, by: Optional[int] = None, codes: bool = False, dtype: DTypeLike = None,
                   transfer: Optional[str] = None, progress: Progress = None) -> Plate:
        """The scene without what moves in it (docs/how-to/background.md).

        Parameters:
        dtype : float32 without codes. With codes uint8 or uint16, the capture's own without dtype.
        Returns:
        Plate: a picture, and [height, width] of where it is a guess.
        Raises:
        UsageError, InputError where there is one sample; KeyboardInterrupt at Ctrl-C.
        Examples:
        >>> int(nutik.encode(np.full((9, 8, 8), 7, np.uint8), rate=9).background(codes=True).picture.array[0, 0])
        7
        """
        output = self._output(codes, dtype, transfer, is_plate=True)
        picture, uncertain, is_noise_known = _nutik.plate(self._held, None if by is None else count_of(by, "by"),
                                                          output, progress)
        if not is_noise_known:
            warn(["nothing in the capture is still for long enough to tell its noise: codes that differ by up to 1/32 "
                  "of white were taken for the same light; by= states another difference"])
        return Plate(Picture(picture), Mask._of(uncertain).tags.view(np.bool_))

    plate = background  # its name in earlier versions

    def activity(self, mask: Optional[MaskLike] = None, *, tag: Optional[int] = None, by: int = 0,
                 count_redrawn: bool = False, progress: Progress = None) -> Activity:
        """When it changes, and where.

        Parameters:
        mask, tag : only pixels of the mask with this tag count, or with any tag but 0.
        Raises:
        UsageError, InputError where no pixel counts; KeyboardInterrupt at Ctrl-C.
        Examples:
        >>> capture.activity().changed_pixels.shape
        (10,)
        """
        refuse(tag is not None and mask is None, "tag= is a value of a mask; add mask=")
        made = mask_of(mask)
        told: dict[str, Any] = {"times": self.times, **_nutik.activity(
            self._held, None if made is None else made._held, None if tag is None else tag_of(tag), count_of(by, "by"),
            flag_of(count_redrawn, "count_redrawn"), progress)}
        warn(told.pop("notes"), NutikNote)
        told.update({name: told[name] and Stretch(**told[name]) for name in ("busiest", "quietest")})
        return Activity(**frozen(told))

    def study(self, style: str = "trail", *, moments: Union[int, Sequence[Time], None] = None,
              spacing: Optional[str] = None, trail: Optional[str] = None, slit_from: Optional[str] = None,
              regions: Sequence[Sequence[int]] = (), by: Optional[int] = None,
              feather: Union[str, float, None] = None, codes: bool = False, dtype: DTypeLike = None,
              transfer: Optional[str] = None, progress: Progress = None) -> Study:
        """A motion study that finds its subject by itself (docs/how-to/study.md).

        Parameters:
        moments : how many, or which times.
        regions : (x, y, width, height) each with a subject of its own.
        Raises:
        InputError where nothing moves or everything does: the camera must stand still (align='rigid' where it is
        encoded).
        Examples:
        >>> scene = np.full((40, 24, 96), 90, np.uint8)
        >>> for k in range(40):
        ...     scene[k, 8:16, 2 * k:2 * k + 8] = 250
        >>> sorted(nutik.encode(scene, rate=100).study("strobe", moments=3).functions)
        [0, 1, 2, 3]
        """
        moved = self._held.moved_camera()
        if moved:
            warn([f"{moved}; align='rigid' moves the clip's pictures back when it is encoded"])
        settings = settings_of({
            "style": style, "spacing": spacing, "trail": trail, "slit_from": slit_from, "feather": feather,
            "by": None if by is None else count_of(by, "by"), "moments": None if moments is None else
            (listed(moments) or "0") if is_list(moments) else str(count_of(moments, "moments"))})
        told: dict[str, Any] = _nutik.study(self._held, settings, [word_of("regions", "", box_of(each, "a region"))
                                                                   for each in regions],
                                            self._output(codes, dtype, transfer, is_plate=style == "clean"), progress)
        warn(told["notes"], NutikNote)
        if "picture" not in told:
            plate = self.background(codes=codes, dtype=dtype, transfer=transfer, progress=progress)
            return Study(plate.picture, None, {}, [])
        warn(told["picture"].figures["warnings"])
        return Study(Picture(told["picture"]), Mask._of(told["mask"]),
                     {tag: Function._of(held) for tag, held in told["functions"].items()}, told["moments"])

    def solve(self, functions: str, wishes: Sequence[str], *, free: Mapping[str, Union[str, Sequence[Time]]] = {},
              mask: Optional[MaskLike] = None, regions: Optional[MaskLike] = None, start: Optional[Time] = None,
              feather: Union[str, float, None] = None, normalize: str = "support", gain: float = 1.0,
              unmapped: Optional[str] = None, progress: Progress = None) -> Solution:
        """Gains and times that make a picture as it is wished (docs/how-to/solve.md).

        Parameters:
        functions : the text of a function file with names in place of numbers, 'M0{[0:0], [1:1], [1000000000:rest]}'.
        wishes : 'M0 = background', '500,120,80,60 gone', 'R1 <= 0.5'.
        free : of a gain (least, most), of a time (from, to) or (from, to, step).
        mask : whose tags M0 ... are.
        Examples:
        >>> wished = capture.solve("M0{[0:g], [50000000:g], [50000001:0]}", ["all = 0.25"], free={"g": (0, 9)})
        >>> wished.is_kept, bool(0 < wished.gains["g"] < 9)
        (True, True)
        """
        asked = self._asked(None, locals())
        functions = text_of(functions, "functions")
        refuse(not isinstance(free, Mapping), f"free= is {shortened(free)}; give a dict of names", WrongType)
        words = [freedom_word(name, each, functions) for name, each in free.items()]
        region_mask = mask_of(regions)
        told: dict[str, Any] = _nutik.solve(self._held, functions,
                                            [text_of(wish, "a wish") for wish in listed(wishes, "wishes")], words,
                                            asked, None if region_mask is None else region_mask._held, progress)
        told["wishes"] = [SolvedWish(**wish) for wish in told["wishes"]]
        at_ends = ", ".join(told["at_ends"])
        ends = f"; {at_ends} came to an end of free=: beyond it may be nearer" if at_ends else ""
        warn([*told.pop("warnings"), *([] if told["is_kept"] else [
            "not all wishes could be kept: the numbers are those with the least cost that was found, "
            f"{told['cost']:.2g}{ends}"])])
        return Solution(functions=parse_functions(told["text"], name="the solution"), **told)

    def _asked(self, functions: Optional[dict[int, Function]], stated: Mapping[str, Any],
               box: Optional[list[int]] = None) -> _nutik.Exposure:
        mask, feather, delay = (stated.get(name) for name in ("mask", "feather", "delay"))
        refuse(feather is not None and mask is None, "feather= blends along a mask's edges; add mask= and functions=")
        made = mask_of(mask, rest=min(functions) if functions else 0)
        if made is not None and feather is not None:
            made = made.feathered(feather)
        held = None if functions is None else {tag: each._held for tag, each in functions.items()}
        used = made._held.tags_in_use() if functions and made else []
        bare = ", ".join(str(tag) for tag in used if tag not in (functions or {}))
        if bare and not stated.get("unmapped"):
            raised = InputError(f"mask tags without a function: {bare}; give each one in functions=, or expose them to "
                                "black (unmapped='zero')")
            raised.settings = ("unmapped='zero'",)
            raise raised
        settings = settings_of({name: stated[name] for name in _SETTINGS if name in stated})
        if isinstance(delay, str):
            settings["delay"] = delay
        times = None if delay is None or isinstance(delay, str) else delays_ns(delay)
        return _nutik.Exposure(held, None if made is None else made._held, settings, times, box)

    def _exposure(self, stated: dict[str, Any]) -> tuple[_nutik.Exposure, tuple[int, int]]:
        """As the arguments of render() state it; and where its region begins."""
        box = None if stated.get("region") is None else box_of(stated["region"], "region")
        if stated.get("combine") == "mean" and stated["normalize"] == "support":
            stated = {**stated, "normalize": None}  # a mean says by what
        functions = None
        if stated["functions"] is not None:
            for name in ("exposure", "shutter", "shutter_error"):
                if stated[name] is not None:
                    raise UsageError(f"{name}= describes a plain interval, functions= say themselves how long; use one")
            functions = self._functions(stated["functions"], stated["mask"] is not None)
        elif stated["mask"] is not None:
            raise UsageError("a mask goes with functions=, not with a plain interval")
        elif stated["exposure"] is None:
            raise UsageError("an exposure needs a plain interval (start='0.4s', exposure='10ms') or functions=")
        for name, of in (("shutter_error", "shutter"), ("unmapped", "mask")):
            refuse(stated[name] is not None and stated[of] is None, f"{name}= says nothing without {of}=; leave it out")
        return self._asked(functions, stated, box), (box[0], box[1]) if box else (0, 0)

    def _functions(self, functions: Functions, has_mask: bool) -> dict[int, Function]:
        if isinstance(functions, (str, PathLike)):
            functions = read_functions(functions)
        if not isinstance(functions, Mapping):
            several = functions if isinstance(functions, (list, tuple)) else []
            if any(isinstance(each, Function) or callable(each) for each in several):
                raise UsageError(f"functions is a list of {len(several)} functions; " + (
                    "with mask= say which tag each is for, {tag: function}" if has_mask else
                    "render_many() makes a picture with each, and of one picture {tag: function} goes with mask="))
            return {0: self._function_of(functions, "functions")}
        refuse(not functions, "functions= is empty; an exposure has one at least")
        refuse(not has_mask and len(functions) > 1, f"{len(functions)} functions; mask= says where each one applies")
        return {tag_of(tag): self._function_of(each, f"functions[{tag}]") for tag, each in functions.items()}

    def _function_of(self, given: FunctionLike, what: str) -> Function:
        if hasattr(given, "__array__") and np.ndim(cast(Any, given)) == 1:
            of_samples = real(given, what)
            refuse(len(of_samples) != len(self), f"{what} has {len(of_samples)} gains for {len(self)} samples; of "
                   "other times say nutik.Function(times, gains)")
            # A gain of 0 at both ends: nothing is exposed there.
            edges = np.append(self.times_ns[:, 0], self.duration_ns)
            gains = np.concatenate([[0.0], np.repeat(of_samples, 2), [0.0]])
            return Function.from_ns(np.repeat(edges, 2), gains)
        return function_of(given, what, np.timedelta64(self.duration_ns, "ns"))

    def _output(self, codes: bool, dtype: DTypeLike, transfer: Optional[str], negative: Optional[str] = None, *,
                is_plate: bool = False) -> dict[str, str]:
        codes = flag_of(codes, "codes=")
        kinds = {"uint8": "8", "uint16": "16"} if codes else {"float32": "float", "float64": "double"}
        try:
            kind = np.dtype(dtype).name if dtype is not None else self.dtype.name if codes else "float32"
        except TypeError:
            kind = shortened(dtype)
        refuse(kind not in kinds, f"dtype={kind} holds no {'codes' if codes else 'light'}: light is float32 or "
               "float64, codes are uint8 or uint16 and come with codes=True")
        refuse(is_plate and kind == "float64", "the background's light is float32")
        return settings_of({"dtype": kinds[kind], "transfer": transfer, "negative": negative})

    def _repr_html_(self) -> str:
        if self._open_capture is None:
            return escape(repr(self))
        rows = {"shape": " x ".join(map(str, self.shape)), "codes": f"{self.dtype}, white {self.figures['white']}",
                "rate": f"{float(self.rate):g} a second", "lasts": f"{self.duration_ns / 1e9:g} s",
                "told": "; ".join(self.facts)}
        return f"<b>{escape(self.name)}</b><table>" + "".join(
            f"<tr><th>{name}</th><td>{escape(text)}</td></tr>" for name, text in rows.items()) + "</table>"

    def __repr__(self) -> str:
        if self._open_capture is None:
            return "<nutik.Capture, closed>"
        samples, height, width = self.shape[:3]
        return (f"<nutik.Capture {self.name}: {width} x {height} {'colour' if len(self.shape) == 4 else 'grey'}, "
                f"{samples} samples, {float(self.rate):g} a second>")
