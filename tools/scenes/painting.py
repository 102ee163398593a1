"""Paints scenes that are flat pictures in motion: shapes in light, smooth at their edges, blurred by their motion.

Lengths are design units, x to the right, y down: the picture is 1024 x 576 of them whatever its size in pixels.
Light is in [0, 1], RGB. A layer holds light times coverage, and coverage: [height, width, 4], float32.
"""

import cv2
import numpy as np

from .camera import srgb_light

WIDTH, HEIGHT = 1024, 576
FRACTION_BITS = 4      # of coordinates that OpenCV fills polygons with
STILL_GRID = 3         # sampling points a pixel in each direction, for what does not move
MOVING_GRID = 2        # for what does, at each moment of a picture, each with its own points
SHIFTS = ((-0.375, -0.125), (0.125, -0.375), (0.375, 0.125), (-0.125, 0.375))  # of a moment's sampling points


def light(hexadecimal):
    """'#ff8000' -> light, RGB."""
    return srgb_light([int(hexadecimal[k:k + 2], 16) for k in (1, 3, 5)]).astype(np.float32)


def blend(first, second, share):
    """From one colour to another; `share` is any array."""
    share = np.clip(np.asarray(share, np.float32), 0, 1)[..., None]
    return np.asarray(first, np.float32) * (1 - share) + np.asarray(second, np.float32) * share


def ellipse(x, y, radius_x, radius_y=None, turn=0.0, corners=48):
    """The corners of a polygon that passes for an ellipse, turned by `turn` radians, clockwise as seen."""
    angle = np.linspace(0, 2 * np.pi, corners, endpoint=False)
    along, across = radius_x * np.cos(angle), (radius_y or radius_x) * np.sin(angle)
    cosine, sine = np.cos(turn), np.sin(turn)
    return np.stack([x + cosine * along - sine * across, y + sine * along + cosine * across], axis=-1)


def limb(begin, end, begin_radius, end_radius):
    """The corners of a limb: two discs and what lies between them."""
    discs = np.concatenate([ellipse(*begin, begin_radius, corners=24), ellipse(*end, end_radius, corners=24)])
    return cv2.convexHull(discs.astype(np.float32))[:, 0]


def smooth_line(points, steps=12):
    """A closed curve through points (Catmull and Rom's), as the corners of a polygon."""
    points = np.asarray(points, float)
    before, after, behind = np.roll(points, 1, 0), np.roll(points, -1, 0), np.roll(points, -2, 0)
    pieces = [points + 0.5 * s * (after - before + s * (2 * before - 5 * points + 4 * after - behind
                                                        + s * (3 * (points - after) + behind - before)))
              for s in np.arange(steps) / steps]
    return np.stack(pieces, axis=1).reshape(-1, 2)


def cloud(shape, cell, seed, octaves=4):
    """Smooth noise in [0, 1] whose coarsest features are `cell` = (rows, columns) pixels large."""
    random = np.random.Generator(np.random.PCG64(seed))
    total, weight = np.zeros(shape, np.float32), 0.0
    for octave in range(octaves):
        rows, columns = (max(2, round(size / step * 2 ** octave) + 1) for size, step in zip(shape, cell))
        coarse = random.random((min(rows, shape[0]), min(columns, shape[1])), dtype=np.float32)
        total += cv2.resize(coarse, shape[::-1], interpolation=cv2.INTER_CUBIC) * 0.5 ** octave
        weight += 0.5 ** octave
    return np.clip(total / weight, 0, 1)


def endless(texture, axis):
    """A texture that goes on where it ends, along an axis; rolled, it shows no seam."""
    size = texture.shape[axis]
    share = np.abs(np.linspace(-1, 1, size, dtype=np.float32)) ** 2
    share = share.reshape([-1 if k == axis else 1 for k in range(texture.ndim)])
    other = np.roll(texture, size // 2, axis)
    mean = texture.mean()
    even = (1 - share) * (texture - mean) + share * (other - mean)
    return mean + even / np.sqrt((1 - share) ** 2 + share ** 2)


class Canvas:
    """A part of the picture, `grid` sampling points to a pixel, that shapes are painted on."""

    def __init__(self, size, rows, columns, grid, shift=(0.0, 0.0)):
        """`size`: (width, height) of the whole picture in pixels; `rows` and `columns`: slices of it; `shift`: of the
        sampling points, as a share of their distance."""
        self.scale = np.array([size[0] / WIDTH * grid, size[1] / HEIGHT * grid])
        self.corner = np.array([columns.start, rows.start]) * grid + np.array(shift)
        self.grid = grid
        height, width = (rows.stop - rows.start) * grid, (columns.stop - columns.start) * grid
        self.layer = np.zeros((height, width, 4), np.float32)

    def points(self, rows=slice(None), columns=slice(None)):
        """x and y, in design units, of the sampling points in a part of the canvas."""
        y, x = (np.arange(size, dtype=np.float32) for size in self.layer.shape[:2])
        x, y = np.meshgrid(x[columns], y[rows])
        return ((x + 0.5 + self.corner[0]) / self.scale[0]).astype(np.float32), \
               ((y + 0.5 + self.corner[1]) / self.scale[1]).astype(np.float32)

    def fill(self, corners, colour, opacity=1.0):
        """Paints a polygon. `colour` is light, or gives the light at points: colour(x, y) -> [..., 3]."""
        where = np.asarray(corners) * self.scale - self.corner - 0.5
        fixed = np.rint(where * 2 ** FRACTION_BITS).astype(np.int32)
        if not callable(colour) and opacity == 1:
            cv2.fillPoly(self.layer, [fixed], (*map(float, colour), 1.0), shift=FRACTION_BITS)
            return
        height, width = self.layer.shape[:2]
        first = np.maximum(np.floor(where.min(axis=0)).astype(int), 0)
        last = np.minimum(np.ceil(where.max(axis=0)).astype(int) + 1, (width, height))
        if (first >= last).any():
            return
        rows, columns = slice(first[1], last[1]), slice(first[0], last[0])
        inside = np.zeros((last[1] - first[1], last[0] - first[0]), np.float32)
        cv2.fillPoly(inside, [fixed - (first * 2 ** FRACTION_BITS).astype(np.int32)], opacity, shift=FRACTION_BITS)
        self.cover(colour(*self.points(rows, columns)) if callable(colour) else colour, inside, rows, columns)

    def cover(self, colour, coverage, rows=slice(None), columns=slice(None)):
        """Lays light over what is there, where `coverage` (0 … 1, an array of the part) is not 0."""
        part = self.layer[rows, columns]
        part *= 1 - coverage[..., None]
        part[..., :3] += np.asarray(colour, np.float32) * coverage[..., None]
        part[..., 3] += coverage

    def shine(self, colour, strength, rows=slice(None), columns=slice(None)):
        """Adds light and covers nothing: a glow."""
        self.layer[rows, columns, :3] += np.asarray(colour, np.float32) * strength[..., None]

    def picture(self):
        """[height, width, 4] of the part in pixels."""
        height, width = self.layer.shape[:2]
        return cv2.resize(self.layer, (width // self.grid, height // self.grid), interpolation=cv2.INTER_AREA)


class PaintedScene:
    """A scene that camera.film() can film. Derived classes have

        name, summary, fps, seconds
        paint_background(canvas)     all that does not move, on the whole picture
        box(seconds)                 (left, top, right, bottom) of what moves, or None where nothing does
        paint(canvas, seconds)       what moves
        moments                      how many moments of a picture's exposure are painted
    """

    moments = 4

    def __init__(self, width=WIDTH, height=HEIGHT):
        self.width, self.height = width, height
        self.frame_count = round(self.seconds * self.fps)
        canvas = Canvas((width, height), slice(0, height), slice(0, width), STILL_GRID)
        self.paint_background(canvas)
        self.background = np.ascontiguousarray(canvas.picture()[..., :3])

    def draw(self, frame):
        """What camera.film() asks for."""
        times = (frame + (np.arange(self.moments) + 0.5) / self.moments) / self.fps
        rows, columns = self.pixels_of([self.box(seconds) for seconds in times])
        behind = self.background[rows, columns]
        if behind.size == 0:
            return rows, columns, behind
        total = 0
        for moment, seconds in enumerate(times):
            shift = SHIFTS[moment % len(SHIFTS)]
            canvas = Canvas((self.width, self.height), rows, columns, MOVING_GRID, shift)
            self.paint(canvas, seconds)
            total = total + canvas.picture()
        total /= len(times)
        return rows, columns, total[..., :3] + (1 - total[..., 3:]) * behind

    def pixels_of(self, boxes):
        """Rows and columns that hold all boxes."""
        boxes = [box for box in boxes if box]
        if not boxes:
            return slice(0, 0), slice(0, 0)
        scale = np.array([self.width / WIDTH, self.height / HEIGHT] * 2)
        left, top, right, bottom = (np.array(boxes) * scale).T
        limits = np.array([self.width, self.height])
        first = np.clip(np.floor([left.min(), top.min()]).astype(int), 0, limits)
        last = np.clip(np.ceil([right.max(), bottom.max()]).astype(int), 0, limits)
        return slice(first[1], max(first[1], last[1])), slice(first[0], max(first[0], last[0]))

    def masks(self):
        """None: masks are the recipes' business."""
        return {}

    def functions(self):
        return {}

    def truth(self):
        return {"seconds": self.seconds}
