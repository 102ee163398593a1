"""Gain functions of time: lists of points, shutters, callables fitted within an error."""

from __future__ import annotations

from typing import Any, Callable, Iterable, Mapping, Optional, Sequence, Union, cast, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _nutik
from ._nutik import UsageError
from ._words import (LARGEST_NS, Axes, HasArray, Path, Time, WrongType, array_ns, axes_of, listed, nanoseconds_of,
                     path_of, real, refuse, scalar, shortened, tag_of, text_of, time_ns, time_word, times_ns, warn,
                     whole)

_MIN_SAMPLES = 1024  # of a callable, evenly, before it is looked at more closely where it bends
_PROBES = 64         # in each stretch of these, unevenly: what repeats evenly may hide from even samples
_GOLDEN = (5 ** 0.5 - 1) / 2  # whose multiples' fractions lie nowhere close together
_MAX_SAMPLES = 1 << 20
_CHORD_SHARE = 0.1     # of the error, by which a callable may leave the chord of two samples
_THINNINGS = 8         # passes that share another tenth


class Function:
    """A gain function: straight between its control points, held before the first and after the last. Functions do not
    change, and are equal where all points are.

    Parameters:
    times : [points], in time order; two may be equal, where the function jumps from the first gain to the second.
    gains : [points], any finite numbers, negative ones too.
    Raises:
    UsageError where times are out of order or a gain is not finite.
    Examples:
    >>> ramp = nutik.Function([0, "100ms"], [0, 1])
    >>> ramp(0.05), (2 * ramp.shifted(0.1) - ramp)(0.15)
    (0.5, 0.0)
    """

    def __init__(self, times: Iterable[Time], gains: Iterable[float]) -> None:
        self._held = _nutik.Function(times_ns(times, "times"), real(listed(gains, "gains"), "gains"))

    @classmethod
    def _of(cls, held: _nutik.Function) -> Function:
        function = cls.__new__(cls)
        function._held = held
        return function

    @classmethod
    def from_ns(cls, times_ns: ArrayLike, gains: ArrayLike) -> Function:
        """The same of whole nanoseconds.

        Parameters:
        times_ns : [points] of integers, in time order.
        gains : [points] of finite numbers.
        Examples:
        >>> nutik.Function.from_ns([0, 100], [0, 1])
        <nutik.Function [0:0], [100:1]>
        """
        at = np.asarray(whole(times_ns, "times_ns"))
        refuse(at.size and at.dtype.kind not in "iu", f"times_ns has dtype {at.dtype}; whole nanoseconds are int64")
        refuse(at.dtype.kind == "u" and at.size and int(at.max()) > LARGEST_NS,
               "times_ns lies further away than 126 years")
        return cls._of(_nutik.Function(at.astype(np.int64), real(gains, "gains")))

    @property
    def times_ns(self) -> NDArray[np.int64]:
        """[points] int64: when the control points are, in nanoseconds."""
        return self._held.points()[0]

    @property
    def gains(self) -> NDArray[np.float64]:
        """[points] float64."""
        return self._held.points()[1]

    @overload
    def __call__(self, times: Time) -> float: ...
    @overload
    def __call__(self, times: NDArray[np.generic]) -> NDArray[np.float64]: ...

    def __call__(self, times: Union[Time, NDArray[np.generic]]) -> Union[float, NDArray[np.float64]]:
        """The gain at a time, or at each of an array of any shape; at a jump that of its later side."""
        at = np.asarray(whole(times, "times"))
        value = self._beside(nanoseconds_of(at)[0] if at.dtype.kind in "iuf" else array_ns(at, "times"))[1]
        return value if value.ndim else float(value)

    @property
    def times(self) -> NDArray[np.float64]:
        """[points] float64: when the control points are, in seconds; times_ns has them exactly."""
        return self.times_ns / 1e9

    def shifted(self, by: Time) -> Function:
        """The same function later.

        Parameters:
        by : how much; negative: earlier.
        """
        return Function._of(self._held.shifted_ns(time_ns(by, "by")))

    def scaled(self, factor: float) -> Function:
        """The same function with other gains.

        Parameters:
        factor : every gain is multiplied by it; f * 2 is the same.
        """
        return Function._of(self._held.scaled(cast(float, real(factor, "factor"))))

    __array_ufunc__ = None  # numpy's numbers leave f * 2 to it

    def plot(self, ax: Optional[Axes] = None, **style: object) -> Axes:
        """Draws gain over seconds with matplotlib."""
        axes = axes_of(ax, "time, s", "gain")
        axes.plot(self.times, self.gains, **cast(Any, style))
        return axes

    def __add__(self, other: Function) -> Function:
        """Both together: straight between all of their points. Gains are sums in float64."""
        if not isinstance(other, Function):
            return NotImplemented
        times = np.union1d(self.times_ns, other.times_ns)
        before, after = (a + b for a, b in zip(self._beside(times), other._beside(times)))
        jumps = before != after
        gains = np.stack([before, after], 1)[np.stack([jumps, np.ones_like(jumps)], 1)]
        return Function.from_ns(np.repeat(times, 1 + jumps), gains)

    def __radd__(self, other: int) -> Function:
        if not isinstance(other, int) or other:  # sum() begins with 0
            return NotImplemented
        return self

    def __sub__(self, other: Function) -> Function:
        return self + other * -1 if isinstance(other, Function) else NotImplemented

    def __mul__(self, factor: float) -> Function:
        factor = scalar(factor)
        return self.scaled(factor) if isinstance(factor, (int, float, np.number)) else NotImplemented

    __rmul__ = __mul__

    def __truediv__(self, divisor: float) -> Function:
        divisor = float(divisor)
        return Function.from_ns(self.times_ns, [gain / divisor for gain in self.gains.tolist()])

    def __neg__(self) -> Function:
        return self * -1

    def _beside(self, times: NDArray[Any]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """The gain just before and just behind each of these times in nanoseconds."""
        points, gains = self._held.points()
        # Halves, for between the largest gains of both signs the slope is none.
        at, known = (each.astype(np.float64) for each in (times - points[0], points - points[0]))
        value = 2 * np.interp(at, known, gains / 2)
        first, last = np.searchsorted(points, times, "left"), np.searchsorted(points, times, "right")
        is_point = first < last
        return (np.where(is_point, gains[np.minimum(first, len(gains) - 1)], value),
                np.where(is_point, gains[np.maximum(last - 1, 0)], value))

    def text(self, tag: int = 0) -> str:
        """Its line in a function file. Jumps become steps of 1 ns, for files have none.

        Parameters:
        tag : the mask value that it is for, M0.
        """
        return self._held.text(tag_of(tag))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Function) and bool(self._held == other._held)

    def __hash__(self) -> int:
        return hash((self.times_ns.tobytes(), (self.gains + 0.0).tobytes()))  # -0.0 equals 0.0

    def __reduce__(self) -> tuple[object, ...]:
        return Function.from_ns, (self.times_ns, self.gains)

    def __repr__(self) -> str:
        times, gains = self._held.points()
        if len(times) > 6:
            return f"<nutik.Function of {len(times)} points, {times[0]} to {times[-1]} ns>"
        points = ", ".join(f"[{time}:{gain:.9g}]" for time, gain in zip(times, gains))
        return f"<nutik.Function {points}>"


Gain = Union[Callable[[float], float], Callable[[NDArray[np.float64]], NDArray[np.float64]]]
FunctionLike = Union[Function, Sequence[tuple[Time, float]], HasArray, Gain]


def boxcar(start: Time, exposure: Time, gain: float = 1.0) -> Function:
    """A gain from a start for a length of time, 0 elsewhere.

    Parameters:
    start, exposure : when it begins, and how long it is.
    gain : in between.
    Examples:
    >>> function = nutik.boxcar("10ms", 0.02) + 0.5 * nutik.boxcar(0, "1s")
    >>> function(0.015), function(0.5)
    (1.5, 0.5)
    """
    begin, end = _nutik.interval_ns(time_word(start, "start"), time_word(exposure, "exposure"))
    return Function.from_ns([begin, begin, end, end], [0.0, gain, gain, 0.0])


def shutter(shape: str, start: Time, exposure: Time, *, error: float = 1e-3) -> Function:
    """A shutter's shape over an exposure: 'box', 'trapezoid:0.25', 'triangle', 'gaussian', 'hann', 'strobe:5',
    'spline:0=0,0.3=1,1=0' (docs/reference/shutters.md). Curves become the fewest straight pieces within `error`, a
    share of their largest gain.

    Parameters:
    shape : one of these.
    start, exposure : when it begins, and how long it is.
    error : as said above.
    Raises:
    UsageError where the shape is not known, or the exposure too short for it.
    Examples:
    >>> len(nutik.shutter("trapezoid:0.25", 0, "10ms").gains)
    4
    """
    begin, end = _nutik.interval_ns(time_word(start, "start"), time_word(exposure, "exposure"))
    return Function._of(_nutik.shutter(text_of(shape, "shape"), begin, end, error))


def fit(gain: Gain, start: Time, end: Time, *, error: float = 1e-3) -> Function:
    """The fewest straight pieces that stay near a callable, from `start` to `end`; 0 outside.

    Parameters:
    gain : called with an array of times in seconds, returns as many gains; one that takes single times only is called
        once for each.
    start, end : where it is not 0.
    error : how far the pieces may lie from it, a share of its largest |gain|. It holds at every time that was looked
        at: 1024 evenly, 64 unevenly between each two, and more wherever it lies off the line between these, down to
        single nanoseconds. What is shorter than 1/48000 of the whole may be missed: give such a function's points. A
        jump becomes a step of 1 ns.
    Raises:
    UsageError where a gain is not finite, where it is 0 everywhere, or where it bends in more places than can be looked
    at: give such a function's pieces as points.
    Examples:
    >>> wave = nutik.fit(lambda t: np.sin(40 * t) ** 2, 0, 0.3, error=1e-3)
    >>> bool(abs(wave(0.1) - np.sin(4.0) ** 2) <= 1e-3)
    True
    """
    refuse(not callable(gain), f"the function is {shortened(gain)}, which takes no times", WrongType)
    begin_ns, end_ns = time_ns(start, "start"), time_ns(end, "end")
    refuse(end_ns - begin_ns < 1, f"the function ends at {end!r}, which is not after its start at {start!r}")
    refuse(not 0 < error < 1, f"error={error} is no share between 0 and 1")

    def gains_at(times: NDArray[np.int64]) -> NDArray[np.float64]:
        seconds = times / 1e9
        try:
            values = real(cast(Any, gain)(seconds), "the function's gains")
        except (TypeError, ValueError):
            values = real([cast(Any, gain)(float(each)) for each in seconds], "the function's gains")
        values = np.broadcast_to(values, times.shape) if values.ndim == 0 else values
        refuse(values.shape != times.shape, f"it returns {values.shape} for {times.shape}: one gain for each time")
        if not np.all(np.isfinite(values)):
            raise UsageError(f"the function is not finite at {float(seconds[~np.isfinite(values)][0])} s")
        return values

    spread = begin_ns + np.linspace(0, end_ns - begin_ns, _MIN_SAMPLES, endpoint=False).round().astype(np.int64)
    even = times = np.unique(np.append(spread, end_ns))
    gains = gains_at(times)

    def look(at: NDArray[np.int64]) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:  # gains, and which lie off chords
        found = gains_at(at)
        off = np.abs(found - np.interp(at - begin_ns, times - begin_ns, gains))
        return found, off > _CHORD_SHARE * error * max(np.max(np.abs(gains)), np.max(np.abs(found), initial=0))

    def bisect() -> None:
        nonlocal times, gains
        bends = np.ones(len(times) - 1, bool)  # stretches whose middle is still to be looked at
        while len(begin := np.flatnonzero(bends & (np.diff(times) > 1))):
            middle = times[begin] + (times[begin + 1] - times[begin]) // 2
            refuse(len(times) + len(middle) > _MAX_SAMPLES, "the function bends in too many places to stay within "
                   f"{error} of it; give its pieces as points, or allow a larger error=")
            found, is_off = look(middle)
            times, gains = np.insert(times, begin + 1, middle), np.insert(gains, begin + 1, found)
            bends = np.zeros(len(times) - 1, bool)
            where = (begin + np.arange(len(begin)))[is_off]  # of each stretch's first half, now
            bends[where] = bends[where + 1] = True

    bisect()
    shares = (np.arange((len(even) - 1) * _PROBES) * _GOLDEN % 1).reshape(-1, _PROBES)
    probes = even[:-1, None] + (np.diff(even)[:, None] * shares).astype(np.int64)
    found, is_off = look(probes.ravel())
    hidden, allowed = np.any(is_off.reshape(probes.shape), axis=1), error
    if np.any(hidden):
        times, first = np.unique(np.append(times, probes[hidden]), return_index=True)
        gains = np.append(gains, found.reshape(probes.shape)[hidden])[first]
        bisect()
        allowed -= _CHORD_SHARE * error
        for _ in range(_THINNINGS):  # every second point, where it lies on the chord of its neighbours
            share = (times[1:-1] - times[:-2]) / (times[2:] - times[:-2])
            off = np.abs(gains[:-2] + (gains[2:] - gains[:-2]) * share - gains[1:-1])
            is_needed = np.ones(len(times), bool)
            is_needed[1:-1:2] = off[::2] > _CHORD_SHARE / _THINNINGS * error * np.max(np.abs(gains))
            times, gains = times[is_needed], gains[is_needed]
    largest = np.max(np.abs(gains))
    refuse(largest == 0, "the function is 0 everywhere; there is nothing to expose")
    fitted_times, fitted_gains = _nutik.fitted(times, gains, allowed * largest).points()
    opens, closes = int(fitted_gains[0] != 0), int(fitted_gains[-1] != 0)
    return Function.from_ns(np.pad(fitted_times, (opens, closes), "edge"), np.pad(fitted_gains, (opens, closes)))


def parse_functions(text: str, *, name: str = "functions") -> dict[int, Function]:
    """Functions by mask value, from the text of a function file (docs/reference/functions.md).

    Parameters:
    text : the file's.
    name : what messages call it.
    Raises:
    InputError with every mistake of the text, its line and column; what is suspicious is warned of.
    Examples:
    >>> nutik.parse_functions("M0{[0:1], [20ms:0]}")[0](0.01)
    0.5
    """
    return _told(_nutik.parse_functions(text_of(text, "text"), text_of(name, "name")))


def read_functions(path: Path) -> dict[int, Function]:
    """Functions by mask value, from a function file (docs/reference/functions.md).

    Parameters:
    path : the file.
    Raises:
    FileMissing, InputError with every mistake of the text, its line and column; what is suspicious is warned of.
    Examples:
    >>> nutik.write_functions("ramp.fn", {0: [(0, 0), (0.1, 1)]})
    >>> nutik.read_functions("ramp.fn")
    {0: <nutik.Function [0:0], [100000000:1]>}
    """
    return _told(_nutik.read_functions(path_of(path)))


def _told(read: tuple[dict[int, _nutik.Function], str]) -> dict[int, Function]:
    warn([read[1]] if read[1] else [])
    return {tag: Function._of(held) for tag, held in read[0].items()}


def write_functions(path: Path, functions: Mapping[int, FunctionLike]) -> None:
    """Writes a function file, which the command line reads, too.

    Parameters:
    path : the file, NAME.fn; a function file that is there is replaced.
    functions : by mask value.
    Raises:
    UsageError where another file is there, OutputError where it cannot be written.
    Examples:
    >>> nutik.write_functions("box.fn", {128: nutik.boxcar(0, "10ms")})
    """
    refuse(not functions, "functions is empty; a function file has one at least")
    lines = [function_of(function, f"functions[{tag}]").text(tag) for tag, function in sorted(functions.items())]
    _nutik.write_text(path_of(path), "".join(line + "\n" for line in lines), False)


def function_of(given: FunctionLike, what: str, duration: Time = 0) -> Function:
    """A function of what stands for one: a callable over all of `duration`."""
    if isinstance(given, Function):
        return given
    if callable(given):
        refuse(duration == 0, f"{what}: how long is it? nutik.fit(function, start, end) says")
        return fit(given, 0, duration)
    try:
        points = [(time, float(gain)) for time, gain in listed(given, what)]
    except (TypeError, ValueError):
        more = ", a callable, or an array with a gain for each sample; of an interval say start= and exposure="
        raise UsageError(f"{what} is {shortened(given)}, no function; give a nutik.Function, or a list of (time, gain)"
                         f"{more if duration else ''}") from None
    return Function([time for time, _ in points], [gain for _, gain in points])
