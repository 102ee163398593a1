"""Reads a noise file, and says what noise it means.

in:      the file's name
out:     a Noise: white code, transfer function and channels, with the standard deviation at any code
always:  mistakes are reported as name:line: what is wrong; nutik-cl, which is stricter, adds the column
"""

import math
from bisect import bisect_left
from dataclasses import dataclass, field

from fnplot.errors import InputError
from fnplot.input import read_input, title_of

FIRST_LINE = "nutik noise 0"
CHANNELS = ("grey", "red", "green", "blue")
ROUNDING_VARIANCE = 1 / 12


def _powered(toe_light, slope, offset, exponent):
    """(light of a fraction, fraction of a light) of a power with a straight toe."""
    toe_fraction = toe_light * slope

    def light_of(fraction):
        return fraction / slope if fraction <= toe_fraction else ((fraction + offset) / (1 + offset))**exponent

    def fraction_of(light):
        return light * slope if light <= toe_light else (1 + offset) * light**(1 / exponent) - offset

    return light_of, fraction_of


def transfer_functions(text):
    """(light of a fraction, fraction of a light) by a transfer function's name; None where there is none."""
    if text == "srgb":
        return _powered(0.0031308, 12.92, 0.055, 2.4)
    if text == "bt709":
        return _powered(0.018053968510807, 4.5, 0.09929682680944, 1 / 0.45)
    if text == "linear":
        return (lambda fraction: fraction), (lambda light: light)
    if text.startswith("gamma:"):
        try:
            gamma = float(text[len("gamma:"):])
        except ValueError:
            return None
        return (lambda fraction: fraction**gamma), (lambda light: light**(1 / gamma))
    return None


@dataclass
class Channel:
    name: str
    read: float = 0.0
    shot: float = 0.0
    curve: str = ""
    points: list = field(default_factory=list)  # (code, sd, pixels)


@dataclass
class Noise:
    white: int = 0
    transfer: str = ""
    channels: list = field(default_factory=list)

    def sensor_sd(self, channel, code):
        """Standard deviation in codes by read and shot noise, over one of its own to either side."""
        light_of, fraction_of = transfer_functions(self.transfer)
        light = light_of(code / self.white)
        sd = math.sqrt(channel.read**2 + channel.shot * light)
        above = fraction_of(light + sd)
        below = math.copysign(fraction_of(abs(light - sd)), light - sd)
        return math.hypot((above - below) / 2 * self.white, math.sqrt(ROUNDING_VARIANCE))

    def points_sd(self, channel, code):
        """Standard deviation in codes by straight lines between the points."""
        codes = [point[0] for point in channel.points]
        after = bisect_left(codes, code)
        if after == 0 or after == len(codes):
            return channel.points[min(after, len(codes) - 1)][1]
        (code_a, sd_a, _), (code_b, sd_b, _) = channel.points[after - 1:after + 1]
        return sd_a + (sd_b - sd_a) * (code - code_a) / (code_b - code_a)


def _number(word, what, low, high, where):
    try:
        value = float(word)
    except ValueError:
        value = math.nan
    if not low <= value <= high:
        raise InputError(f"{where}: {what} '{word}' is no number of {low:g} … {high:g}")
    return value


def _take_line(noise, words, where):
    key, values = words[0], words[1:]
    wanted = {"white": 1, "transfer": 1, "channel": 1, "read": 1, "shot": 1, "curve": 1, "point": 3}
    if key not in wanted:
        raise InputError(f"{where}: '{key}' is no key; a line starts with {', '.join(wanted)}")
    if len(values) != wanted[key]:
        raise InputError(f"{where}: '{key}' takes {wanted[key]} values, not {len(values)}")
    if key == "white":
        noise.white = int(_number(values[0], "white code", 1, 65535, where))
    elif key == "transfer":
        if transfer_functions(values[0]) is None:
            raise InputError(f"{where}: transfer '{values[0]}' is not known; choose srgb, bt709, linear or gamma:G")
        noise.transfer = values[0]
    elif key == "channel":
        if values[0] not in CHANNELS:
            raise InputError(f"{where}: channel '{values[0]}' is not known; choose {', '.join(CHANNELS)}")
        if not noise.white or not noise.transfer:
            raise InputError(f"{where}: white and transfer must be stated before the first channel")
        noise.channels.append(Channel(values[0]))
    elif not noise.channels:
        raise InputError(f"{where}: '{key}' stands before the first channel")
    else:
        _take_line_of_channel(noise, key, values, where)


def _take_line_of_channel(noise, key, values, where):
    channel = noise.channels[-1]
    if key == "point":
        code = _number(values[0], "code", 0, noise.white, where)
        sd = _number(values[1], "standard deviation", 1e-3, noise.white, where)
        pixels = _number(values[2], "pixels", 0, 2.0**62, where)
        if channel.points and code <= channel.points[-1][0]:
            raise InputError(f"{where}: code {code:g} is not above the one before; codes must increase")
        channel.points.append((code, sd, pixels))
    elif key == "curve":
        if values[0] not in ("sensor", "points"):
            raise InputError(f"{where}: curve '{values[0]}' is not known; choose sensor or points")
        channel.curve = values[0]
    else:
        setattr(channel, key, _number(values[0], key, 0, 1, where))


def read_noise(name):
    data = read_input(name)
    name = title_of(name)
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        raise InputError(f"{name}: this is no text file") from None
    noise = Noise()
    lines = [(number, line.split("#")[0].split()) for number, line in enumerate(text.splitlines(), start=1)]
    lines = [(number, words) for number, words in lines if words]
    if not lines or " ".join(lines[0][1]) != FIRST_LINE:
        raise InputError(f"{name}:{lines[0][0] if lines else 1}: a noise file starts with the line '{FIRST_LINE}'")
    for number, words in lines[1:]:
        _take_line(noise, words, f"{name}:{number}")
    if not noise.channels:
        raise InputError(f"{name}: no channel; write 'channel grey', or red, green and blue")
    for channel in noise.channels:
        if not channel.curve:
            raise InputError(f"{name}: channel {channel.name} does not say which curve is used")
        if channel.curve == "points" and not channel.points:
            raise InputError(f"{name}: channel {channel.name} uses 'curve points' and has no point")
    return noise
