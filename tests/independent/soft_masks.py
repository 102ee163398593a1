"""Soft masks from their definition (docs/reference/masks.md): which share of each pixel a mask value has."""

from fractions import Fraction

import numpy as np

from expose import Exposure, expose

WHOLE = 65535


def feathered(mask, radius):
    """Shares of a feather of so many whole pixels: {mask value: int H x W}, 65535 together."""
    height, width = mask.shape
    values = [int(value) for value in np.unique(mask)]
    # 1_m convolved with (r + 1 - |x|) (r + 1 - |y|), nothing lying beyond the border.
    tent = radius + 1 - np.abs(np.arange(-radius, radius + 1))
    parts = {}
    for value in values:
        inside = np.pad((mask == value).astype(np.int64), radius)
        rows = sum(tent[i] * inside[:, i:i + width] for i in range(2 * radius + 1))
        parts[value] = sum(tent[i] * rows[i:i + height] for i in range(2 * radius + 1))
    shares = {value: np.zeros((height, width), np.int64) for value in values}
    for y in range(height):
        for x in range(width):
            for value, share in _whole({v: int(parts[v][y, x]) for v in values}).items():
                shares[value][y, x] = share
    return shares


def _whole(parts):
    """Proportional to parts, rounded down; what is left goes to those that lost most, then to lower values."""
    exact = {value: Fraction(part * WHOLE, sum(parts.values())) for value, part in parts.items()}
    shares = {value: int(share) for value, share in exact.items()}
    losers = sorted(parts, key=lambda value: (shares[value] - exact[value], value))
    for value in losers[:WHOLE - sum(shares.values())]:
        shares[value] += 1
    return shares


def expose_soft(samples, timeline, functions, shares, **options):
    """Each function's exposure of the whole picture, by its shares."""
    light, scale, measures = 0.0, 0.0, {}
    for value, share in shares.items():
        alone = expose(samples, timeline, functions, np.full(share.shape, value, np.uint8), **options)
        light = light + alone.light * (share / WHOLE)[..., None]
        scale = scale + alone.scale * (share / WHOLE)
        measures |= alone.measures
    return Exposure(light, scale, measures)
