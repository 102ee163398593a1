"""Where captures come from: files, clips, arrays, iterables."""

from __future__ import annotations

import datetime
import inspect
from dataclasses import dataclass
from functools import wraps
from itertools import chain, count
from os import PathLike
from typing import Any, BinaryIO, Callable, Iterable, Iterator, Optional, Sequence, TypeVar, Union, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _nutik
from ._captures import Capture
from ._nutik import InputError, UsageError
from ._words import (Array, HasArray, NutikNote, Number, Path, Progress, Time, WrongType, as_file, half_up, is_list,
                     listed, path_of, refuse, scalar, seconds_of, settings_of, shortened, text_of, time_ns, times_ns,
                     warn, whole)


Source = Union[ArrayLike, HasArray, Iterable[ArrayLike], Path, BinaryIO]
_Opens = TypeVar("_Opens", bound=Callable[..., Capture])


def _by_old_names(function: _Opens) -> _Opens:
    """Takes arguments by their names in earlier versions, too."""
    @wraps(function)
    def called(*given: Any, **stated: Any) -> Capture:
        return function(*given, **{_nutik.argument_now(name): value for name, value in stated.items()})

    return cast(_Opens, called)


@_by_old_names
def open(path: Union[Path, BinaryIO], *, rate: Optional[Number] = None, shutter_angle: Optional[Number] = None,
         transfer: Optional[str] = None, white: Optional[float] = None, primaries: Optional[str] = None,
         pixel_aspect: Union[str, Number, None] = None, raw: Optional[str] = None, matrix: Optional[str] = None,
         range: Optional[str] = None, chroma_at: Optional[str] = None, begin: Optional[Time] = None,
         end: Optional[Time] = None, crop: Union[str, Sequence[int], None] = None, scale: Optional[str] = None,
         deinterlace: Optional[str] = None, ignore_errors: bool = False, align: Optional[str] = None,
         align_to: Optional[Time] = None, align_along: Optional[Path] = None, unseen: Optional[str] = None,
         deflicker: bool = False, between: Union[int, str, None] = None, tolerance: Optional[int] = None,
         noise: Optional[Path] = None, sigmas: Optional[float] = None, contrast: Union[str, Number, None] = None,
         start_picture: Union[Path, Number, None] = None, tick: Optional[Time] = None, device: Optional[str] = None,
         memory: Union[int, str, None] = None, renderer: Optional[str] = None, progress: Progress = None) -> Capture:
    """Opens a capture (.tik), or a clip, which is encoded into a temporary capture first: a video, a folder of stills,
    'frames/*.png', a table of stills (docs/reference/input.md); or what is open for bytes, as io.BytesIO.

    Parameters:
    path : a capture, a clip, or a file that is open for bytes.
    crop : (x, y, width, height) of pixels, or 'WxH+X+Y': only this part of the pictures.
    align_along : a .csv file, moves pictures along a path that is known (docs/how-to/align.md).
    progress : called with (steps done, of how many; 0: not known), by the thread that asked and at most 20 times a
        second. Study and solve do several things, each with steps of its own. What it raises ends the work, and comes
        through.
    Raises:
    FileMissing, InputError where it cannot be read, UsageError where what is stated does not fit, MemoryTooLittle.
    Examples:
    >>> capture = nutik.encode(np.zeros((30, 8, 8), np.uint8), "black.tik", rate=1000)
    >>> nutik.open("black.tik")
    <nutik.Capture black.tik: 8 x 8 grey, 30 samples, 1000 a second>
    """
    stated = {name: value for name, value in locals().items() if name not in (*_COMPUTING, "path", "progress")}
    computing = _computing(device, memory, renderer)
    with as_file(path, "clip") as name:
        return _told(_nutik.open(name, settings_of(stated), computing, progress))


@_by_old_names
def encode(source: Source, output: Optional[Path] = None, *, rate: Optional[Number] = None,
           times: Optional[Iterable[Time]] = None, exposures: Union[Time, Iterable[Time], None] = None,
           shutter_angle: Optional[Number] = None, transfer: Optional[str] = None, white: Optional[float] = None,
           primaries: Optional[str] = None, pixel_aspect: Union[str, Number, None] = None, deflicker: bool = False,
           between: Union[int, str, None] = None, align: Optional[str] = None, align_to: Optional[Time] = None,
           align_along: Optional[Path] = None, unseen: Optional[str] = None, tolerance: Optional[int] = None,
           noise: Optional[Path] = None, sigmas: Optional[float] = None, codec: Optional[str] = None,
           tiles: Optional[str] = None, block_samples: Optional[int] = None, device: Optional[str] = None,
           memory: Union[int, str, None] = None, renderer: Optional[str] = None, progress: Progress = None,
           name: Optional[str] = None, **clip: object) -> Capture:
    """Makes a capture of pictures, and opens it.

    Parameters:
    source : [samples, height, width] or [samples, height, width, 3] (red, green, blue) of uint8 or uint16 codes,
        however it is strided, or of floats that are light; or an iterable of such pictures, which this thread asks; or
        the path of a clip, or one that is open for bytes (nutik.open() says more of these). Codes in the machine's
        order of bytes are read where they lie. What has __dlpack__ is an array.
    output : a .tik to write; a capture that is there is replaced. None: a temporary one, gone when it is closed.
    rate : pictures a second.
    times : or when each picture's exposure begins, in seconds; of dates what lies between them counts.
    exposures : how long each was exposed, one time or one for each; with neither that nor shutter_angle, all the time
        to the next.
    transfer : what codes stand for, 'srgb', 'bt709', 'linear', 'gamma:G', 'hlg', 'pq' or a camera's curve ('slog3');
        without it 'srgb' of uint8, 'linear' of uint16.
    white : the code of white, 255 or 65535 without it (4095 of 12 bits); no code may be larger. Of floats the light of
        white, which must be stated: they become 16-bit codes, to the nearest of 65535 steps; none may be negative.
    codec : of output, 'rice' without it: 'none', 'lz4', 'zstd' (small), 'zstd:1' to 'zstd:19' (smaller, slower).
    name : what messages call pictures in memory, 'array'.
    clip : of a path what nutik.open() takes besides: begin, crop, raw, ...
    Raises:
    UsageError where arguments do not fit, InputError where pictures are unlike or times out of order, OutputError; what
    an iterable raises.
    Examples:
    >>> capture = nutik.encode(np.zeros((30, 8, 8, 3), np.uint8), times=np.arange(30) / 100, exposures="2ms")
    >>> capture.shape, capture.times_ns[1].tolist()
    ((30, 8, 8, 3), [10000000, 12000000])
    >>> len(nutik.encode((np.full((8, 8), k, np.uint8) for k in range(20)), rate="30000/1001"))
    20
    """
    given = locals()
    computing, path = _computing(device, memory, renderer), None if output is None else path_of(output)
    codec = None if codec is None else text_of(codec, "codec")
    of_clips = set(inspect.signature(open).parameters) - {"path", "progress", *_COMPUTING}
    stated = {argument: given[argument] for argument in given if argument in (*of_clips, "tiles", "block_samples")}
    is_clip = isinstance(source, (str, bytes, PathLike)) or hasattr(source, "read")
    for argument in clip:
        if argument not in of_clips:
            raise TypeError(f"encode() has no argument {argument!r}")
        refuse(not is_clip, f"{argument}= is said of a clip's files; these are pictures in memory")
    if is_clip:
        stated.update(clip)
        if times is not None or exposures is not None:
            raise UsageError("times= and exposures= are those of arrays; a table of stills lists those of files")
        refuse(name is not None, "name= is what pictures in memory are called; a clip has its own")
        with as_file(source, "clip") as clip_name:
            return _told(_nutik.encode_clip(clip_name, path, codec, settings_of(stated), computing, progress))
    name, white = text_of(name or "array", "name"), scalar(white)
    pictures, first, length, is_light = _pictures_of(source, white, transfer, name)
    if is_light:
        stated["white"] = None  # of the codes it is the last one
    starts, intervals, exposed = _timing(rate, times, exposures, shutter_angle, length)
    return _told(_nutik.encode_pictures(pictures, first, length or max(len(starts), len(intervals)), name, starts,
                                        intervals, exposed, float(white) if is_light and white else None, path, codec,
                                        settings_of(stated), computing, progress))


def join(captures: Iterable[Path], output: Path, *, device: Optional[str] = None,
         memory: Union[int, str, None] = None, renderer: Optional[str] = None, progress: Progress = None) -> Capture:
    """Makes one capture of captures of pictures that follow each other, and opens it (docs/how-to/farm.md).

    Parameters:
    captures : paths of two or more .tik that were encoded alike. Parts of a clip (begin= and end= of nutik.encode())
        know their place and may come in any order; others follow each other at once, as they are named, if they have
        one constant rate, which a note tells.
    output : the .tik to write; its blocks are copies of theirs.
    Raises:
    InputError where one is damaged or does not follow the one before it, UsageError where there are fewer than two or
    output is one of them, OutputError.
    Examples:
    >>> for part in (0, 1):
    ...     capture = nutik.encode(np.zeros((30, 8, 8), np.uint8), f"{part}.tik", rate=1000)
    >>> len(nutik.join(["0.tik", "1.tik"], "both.tik"))
    60
    """
    refuse(isinstance(captures, (str, PathLike)), f"captures= is {captures!r}: give a list of two captures or more")
    paths = [path_of(each) for each in captures]
    return _told(_nutik.join(paths, path_of(output), _computing(device, memory, renderer), progress))


@dataclass(frozen=True)
class Device:
    """An OpenCL device of this machine: device=index takes it."""

    index: int
    name: str
    platform: str
    driver: str                  # its version
    kind: str                    # 'GPU', 'accelerator', 'CPU' or 'other'
    compute_units: int
    memory_bytes: int
    precisions: tuple[str, ...]  # that it computes in, the fastest first


def devices() -> list[Device]:
    """The OpenCL devices of this machine, those first that are taken first.

    Raises:
    DeviceError where there are none.
    Examples:
    >>> [device.index for device in nutik.devices()][0]
    0
    """
    return [Device(index, *told) for index, told in enumerate(_nutik.devices())]


_ROUNDING = 1.01  # of a step, which times that were rounded are still exposed for
_COMPUTING = ("device", "memory", "renderer")


def _computing(device: Optional[str], memory: Union[int, str, None], renderer: Optional[str]) -> dict[str, str]:
    return settings_of({"device": device, "memory": memory, "renderer": renderer})


def _told(opened: tuple[_nutik.Capture, list[str], list[str]]) -> Capture:
    capture, doubts, notes = opened
    warn(doubts)
    warn(notes, NutikNote)
    return Capture(capture, notes)


def _pictures_of(source: Any, white: Optional[float], transfer: Optional[str],
                 name: str) -> tuple[Iterable[Array], Array, Optional[int], bool]:
    """Pictures of codes, one by one; the first; how many, of an array; whether they were light, which becomes codes."""
    kinds: set[bool] = set()

    def codes_of(picture: Array, what: str) -> Array:
        picture = np.asarray(whole(picture, what))
        is_light = picture.dtype.kind == "f"
        refuse(picture.dtype.newbyteorder("=") not in (np.uint8, np.uint16) and not is_light, f"{what} has dtype "
               f"{picture.dtype}; codes are uint8 or uint16, light is of floats: say which with .astype()")
        refuse(picture.ndim not in (2, 3) or (picture.ndim == 3 and picture.shape[2] not in (1, 3)) or not picture.size,
               f"{what} has shape {picture.shape}; pictures are [height, width] or [height, width, 3], not empty")
        kinds.add(is_light)
        refuse(len(kinds) > 1, f"{what} has dtype {picture.dtype}; some pictures are codes, some are light", InputError)
        if not is_light:
            return cast(Array, picture.astype(picture.dtype.newbyteorder("="), copy=False))
        if not isinstance(white, (int, float, np.number)) or not 0 < white < np.inf:
            wrong = "" if white is None else f"white={white!r} is no light above 0; "
            raise UsageError(f"{what} has dtype {picture.dtype}: {wrong}which value is white? white=1.0; light becomes "
                             "the nearest of 65535 steps up to it")
        share = np.asarray(picture, np.float64) / white
        # White as its type rounds it, for pictures were clipped to that.
        refuse(not (picture >= 0).all() or (picture > picture.dtype.type(white)).any(), "a value of light is none "
               f"between 0 and white={white:g}; clip it, or state a larger white", InputError)
        if transfer is None or transfer == "linear":
            return (share * 65535 + 0.5).astype(np.uint16)
        thresholds = _nutik.code_thresholds(text_of(transfer, "transfer"))
        return (np.searchsorted(thresholds, share, "right") - 1).astype(np.uint16)

    if isinstance(source, Capture):
        raise UsageError(f"{source.name} is a capture already; pictures of it are numpy.asarray(capture)")
    if hasattr(source, "__dlpack__") and not hasattr(source, "__array__"):
        try:
            source = np.from_dlpack(source)
        except (AttributeError, BufferError, RuntimeError) as error:
            raise UsageError(f"{type(source).__name__} is no array of this machine's memory: {error}") from None
    if isinstance(source, memoryview) or hasattr(source, "__array_interface__") or hasattr(source, "__array__"):
        pictures = np.asarray(whole(source, "the array"))
        refuse(pictures.ndim not in (3, 4) or not len(pictures), f"the array has shape {pictures.shape}; it is "
               "[samples, height, width] or [samples, height, width, 3], with one sample at least")
        if pictures.ndim == 3 and pictures.shape[2] in (1, 3):
            warn([f"the array of shape {pictures.shape} is {len(pictures)} grey samples, {pictures.shape[2]} wide; one "
                  "picture in colour is array[None]"], NutikNote)
        first, is_light = codes_of(pictures[0], "a picture of the array"), pictures.dtype.kind == "f"
        if pictures.dtype == first.dtype:
            return pictures, first, len(pictures), is_light

        class Codes:  # made anew each time that they are read
            def __iter__(self) -> Iterator[Array]:
                return (codes_of(picture, "a picture of the array") for picture in pictures)

        return Codes(), first, len(pictures), is_light
    try:
        iterator = iter(source)
    except TypeError:
        raise WrongType(f"{type(source).__name__} holds no pictures: give an array, an iterable of arrays, or a path") \
            from None
    try:
        given = next(iterator)
    except StopIteration:
        raise InputError("the iterable holds no picture") from None
    refuse(isinstance(given, (str, bytes, PathLike)), f"{shortened(given)} is a file's name: encode() takes one path, "
           "of a folder, 'frames/*.png', or a table of stills (.csv) that lists files", WrongType)
    first = codes_of(given, "the first picture")

    def alike(number: int, picture: Array) -> Array:
        codes = codes_of(picture, f"picture {number}")
        if (*codes.shape, 1)[:3] != (*first.shape, 1)[:3] or codes.dtype != first.dtype:
            raise InputError(f"{name}: picture {number} has shape {codes.shape} and dtype {codes.dtype}, the first one "
                             f"{first.shape} and {first.dtype}; all must be alike")
        return codes

    return chain([first], map(alike, count(1), iterator)), first, None, np.asarray(given).dtype.kind == "f"


def _lasting(length: Any, what: str, said: Any) -> Any:
    refuse(length <= 0, f"{what}= is {said!r}; an exposure lasts longer than 0")
    return length


def _timing(rate: Optional[Number], times: Optional[Iterable[Time]], exposures: Union[Time, Iterable[Time], None],
            shutter_angle: Optional[Number], count: Optional[int]
            ) -> tuple[list[int], list[tuple[int, int]], Optional[int]]:
    """Starts, exposures, and how long all were exposed, as the engine has them."""
    refuse((rate is None) == (times is None), "when were the pictures taken? Say rate=, pictures a second, or times=, "
           "when each begins; not both")
    refuse(exposures is not None and shutter_angle is not None, "both exposures= and shutter_angle=: leave one out")
    if times is not None:
        times = listed(times, "times")
        if times and isinstance(times[0], (np.datetime64, datetime.datetime)):
            times = [time - times[0] for time in times]  # dates: only what lies between them counts
    starts: list[int] = [] if times is None else cast(Any, times_ns(times, "times")).tolist()
    refuse(times is not None and count not in (None, len(starts)), f"{len(starts)} times for {count} pictures")
    if exposures is None:
        return starts, [], None
    if not is_list(exposures):
        exposed = _lasting(time_ns(cast(Time, exposures), "exposures"), "exposures", exposures)
        for number, (begin, end) in enumerate(zip(starts, starts[1:])):
            refuse(end > begin and exposed > _ROUNDING * (end - begin), f"exposures={exposures!r}: sample {number + 1} "
                   f"starts {end - begin} ns after sample {number}, which is still exposed then", InputError)
        return starts, [], exposed
    if times is None:
        raise UsageError("exposures= of each picture need times=, when each begins; with rate= give one for all")
    begins = [seconds_of(time, "times") for time in times]
    lengths = [_lasting(seconds_of(each, f"exposures[{i}]"), f"exposures[{i}]", each)
               for i, each in enumerate(listed(exposures, "exposures"))]
    refuse(len(lengths) != len(begins), f"there are {len(lengths)} exposures for {len(begins)} times")
    return [], [(start, half_up((begin + length) * 10 ** 9))
                for start, begin, length in zip(starts, begins, lengths)], None
