"""Reads masks: which mask values a picture has, and in how many pixels.

Masks are grey pictures of 8 bits, PGM (plain or raw) or PNG. Values are taken as they stand, never scaled.
"""

import re
from collections import Counter

from fnplot.errors import InputError

HEADER_NUMBER = re.compile(rb"(?:\s|#[^\r\n]*[\r\n])+([0-9]{1,9})")
COMMENT = re.compile(rb"#[^\r\n]*")
PNG_SIGNATURE = b"\x89PNG\r\n\x1a\n"
LARGEST_VALUE = 255


def read_mask(path):
    """Pixels per mask value, as a dictionary."""
    try:
        with open(path, "rb") as file:
            data = file.read()
    except OSError as error:
        raise InputError(f"{path}: {error.strerror}") from None
    if data.startswith(PNG_SIGNATURE):
        return Counter(png_values(path, data))
    if data[:2] in (b"P2", b"P5"):
        return Counter(pgm_values(path, data))
    raise InputError(f"{path} is neither a PGM nor a PNG; masks are 8-bit grey pictures of these kinds")


def pgm_values(path, data):
    """The values of a PGM, row by row."""
    numbers = []
    at = 2
    for _ in range(3):
        match = HEADER_NUMBER.match(data, at)
        if not match:
            raise InputError(f"{path}: its header is cut off; a PGM starts with width, height and maximum")
        numbers.append(int(match[1]))
        at = match.end()
    width, height, largest = numbers
    if largest > LARGEST_VALUE:
        raise InputError(f"{path} is a PGM with maximum {largest}; a mask has 8 bits (maximum 255 or less)")
    if data[:2] == b"P5":
        values = data[at + 1 : at + 1 + width * height]
    else:
        values = plain_values(path, data[at:], width * height)
    if len(values) < width * height or not values:
        raise InputError(f"{path} is cut off: {len(values)} of {width} x {height} pixels")
    return values


def plain_values(path, text, count):
    """The values of a plain PGM, which are numbers in digits."""
    words = COMMENT.sub(b" ", text).split()[:count]
    for word in words:
        if not word.isdigit() or len(word) > 9 or int(word) > LARGEST_VALUE:
            shown = word.decode("latin-1")
            raise InputError(f"{path}: {shown!r} is no mask value; they run from 0 to {LARGEST_VALUE}")
    return bytes(int(word) for word in words)


def png_values(path, data):
    """The values of a grey PNG of 8 bits, row by row."""
    from PIL import Image, UnidentifiedImageError  # comes with Matplotlib

    bits, colour_type = (data + bytes(26))[24:26]
    if bits != 8 or colour_type != 0:
        raise InputError(f"{path} is not a grey PNG of 8 bits; save it as such, or as PGM")
    try:
        with Image.open(path) as picture:
            return picture.tobytes()
    except (OSError, SyntaxError, UnidentifiedImageError) as error:
        raise InputError(f"{path}: {error}") from None


def ranges_text(values):
    """Mask values with runs of them shortened: `1…63, 65, 70…255`."""
    runs = []
    for value in sorted(values):
        if runs and value == runs[-1][1] + 1:
            runs[-1][1] = value
        else:
            runs.append([value, value])
    return ", ".join(f"{first}" if first == last else f"{first}…{last}" for first, last in runs)
