"""Exposes pictures after the scene was filmed.

A capture records for every pixel when and how its value changed. A picture is the integral of each pixel's light times
a gain function of time; each region of a mask has its own.

    >>> import numpy as np
    >>> import nutik
    >>> codes = np.arange(96 * 4 * 6, dtype=np.uint16).reshape(96, 4, 6)      # [samples, height, width]
    >>> capture = nutik.encode(codes, rate=960)                                # or nutik.open("clip.mp4")
    >>> picture = capture.render(start="10ms", exposure="20ms")                # light, float32
    >>> picture.array.shape                                                    # [height, width], read-only, no copy
    (4, 6)
    >>> bool(abs(picture.array - codes[10:30].mean(0) / 65535).max() < 0.01)
    True

Times are seconds, exactly as a float is printed (0.4 is 4/10 s), or words with a unit: "10ms", "250us", "1/300s", "37f"
for picture 37; or Fraction, Decimal, numpy.timedelta64, datetime.timedelta. What is returned as `..._ns` is whole
nanoseconds, int64. Light of white is 1. Pictures are [height, width] or [height, width, 3] (red, green, blue).

Everything raises nutik.Error: UsageError, InputError, DeviceError, OutputError, MemoryTooLittle, ImpreciseError. Ctrl-C
ends what takes long and raises KeyboardInterrupt. What is doubtful about a result comes as a warning of class
NutikWarning, what should be known of it besides as one of its subclass NutikNote. Work runs without Python's lock; any
number of threads may use one capture.
"""

from . import _docs
from ._captures import Capture, Trace
from ._commands import batch, check, contact, noise, recover, retime, validate, video
from ._finds import Activity, Plate, Solution, SolvedWish, Study
from ._functions import Function, boxcar, fit, parse_functions, read_functions, shutter, write_functions
from ._masks import Mask, read_mask
from ._nutik import (DeviceError, Error, ImpreciseError, InputError, MemoryTooLittle, OutputError, UsageError,
                     __version__)
from ._pictures import Picture, Pictures
from ._sources import Device, devices, encode, join, open
from ._words import FileMissing, NutikNote, NutikWarning, WrongType

__all__ = [
    "Activity", "Capture", "Device", "DeviceError", "Error", "FileMissing", "Function", "ImpreciseError",
    "InputError", "Mask", "MemoryTooLittle", "NutikNote", "NutikWarning", "OutputError", "Picture", "Pictures",
    "Plate", "Solution", "SolvedWish", "Study", "Trace", "UsageError", "WrongType", "__version__", "batch",
    "boxcar", "check", "contact", "devices", "encode", "fit", "join", "noise", "open", "parse_functions",
    "read_functions", "read_mask", "recover", "retime", "shutter", "validate", "video", "write_functions"]

_docs.complete_all(map(globals().get, __all__))
