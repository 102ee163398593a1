"""Codes and light: the transfer functions both ways, and the change records' held codes.

A transfer function is named as on the command line: srgb, bt709, linear or gamma:G. Light is
double, 0 … 1 for codes 0 … white.
"""

import numpy as np

# ITU-R BT.2020's constants, to more digits than the standard prints; BT.709 rounds them to
# 1.099 and 0.018, with which its two parts don't quite meet.
BT709_ALPHA = 1.09929682680944
BT709_BETA = 0.018053968510807


def light_of(signal, transfer):
    """Light of signals (code / white code, any array of doubles in 0 … 1)."""
    signal = np.asarray(signal, dtype=np.float64)
    if transfer == "linear":
        return signal.copy()
    if transfer.startswith("gamma:"):
        return signal ** float(transfer[len("gamma:"):])
    if transfer == "srgb":
        return np.where(signal <= 0.04045, signal / 12.92, ((signal + 0.055) / 1.055) ** 2.4)
    if transfer == "bt709":
        curve = ((signal + (BT709_ALPHA - 1)) / BT709_ALPHA) ** (1 / 0.45)
        return np.where(signal < 4.5 * BT709_BETA, signal / 4.5, curve)
    raise ValueError(f"no transfer function {transfer}")


def light_table(transfer, white):
    """Light of every code 0 … white, float64 [white + 1]."""
    return light_of(np.arange(white + 1) / white, transfer)


def code_edges(transfer, white):
    """The light at which rounding goes from code c to c + 1, c = 0 … white - 1; float64 [white]."""
    return light_of((np.arange(white) + 0.5) / white, transfer)


def codes_of(light, transfer, white):
    """Nearest codes of an array of light, saturated to 0 … white; int64, light's shape."""
    return np.searchsorted(code_edges(transfer, white), light, side="right")


def held_codes(samples, tolerance, white=255):
    """The codes that change records hold at each sample: yields arrays H x W x C, one a sample.

    A record is written where any channel differs from what the pixel holds by more than the
    tolerance T (in codes); it moves all channels, each by the number of steps of 2 T + 1 codes that leads
    nearest to the new code, but not below 0 or above white. samples: iterable of H x W x C integers.
    """
    held = None
    for codes in samples:
        if held is None or tolerance == 0:
            held = codes
        else:
            difference = codes.astype(np.int32) - held
            step = 2 * tolerance + 1
            moved = np.clip(held + (difference + tolerance) // step * step, 0, white).astype(codes.dtype)
            held = np.where((np.abs(difference) > tolerance).any(axis=2, keepdims=True), moved, held)
        yield held
