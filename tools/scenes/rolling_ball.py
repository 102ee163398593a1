"""The paper's scene: a ball starts from rest, rolls down a track and lies still against a block from 1 s on.

Along the track the ball's centre is at s(t) = a t^2 / 2 until STOP_S, with a = 2 s(STOP_S) / STOP_S^2, and it has
turned by s / radius: it rolls without slipping. With a = 5/7 g sin(slope), as for a solid ball, the picture is 0.94 m
wide and the ball 9.4 cm in diameter. Lengths are in pixels, x to the right, y down; pixel (column, row)
covers [column, column + 1) x [row, row + 1).

Motion within a picture is integrated: each of the points that a pixel is sampled at has its own time in the picture.
(Not so for the ball's shadow, which is soft; nothing moves by more than 1.1 pixels in a picture of the default size.)
"""

import cv2
import numpy as np

from . import figures

SLOPE = np.radians(12.0)
STOP_S = 1.0           # the ball reaches the block
SECONDS = 1.2
EXPOSURE_S = 0.010     # the length of the figures' pictures of the ball
REGIONS = {64: 0.0, 128: 0.4, 196: 0.8, 255: 1.0}  # mask value: start of the ball's picture in seconds
GRID = 4               # sampling points a pixel, in each direction
BACKGROUND_GRID = 3    # the same for what does not move

ORANGE = np.array([0.92, 0.36, 0.05], np.float32)
CREAM = np.array([0.90, 0.80, 0.58], np.float32)
DARK = np.array([0.030, 0.020, 0.018], np.float32)
LAMP = np.array([-0.45, -0.60, 0.66], np.float32)  # direction to the lamp; z towards the camera


class RollingBall:
    """See the top of the file. `width` x `height` is the picture; all lengths follow its width."""

    name = "rolling-ball"
    summary = "a ball rolls down a track and lies still from 1 s on (the paper's Figures 4, 7, 14 and 16)"
    fps = 960

    def __init__(self, width=640, height=360):
        self.width, self.height = width, height
        self.frame_count = round(SECONDS * self.fps)
        self.radius = 0.05 * width
        self.path_length = 0.775 * width
        self.acceleration = 2 * self.path_length / STOP_S ** 2
        self.start = np.array([0.105 * width, 0.5 * height - 0.095 * width])
        self.direction = np.array([np.cos(SLOPE), np.sin(SLOPE)])
        self.normal = np.array([np.sin(SLOPE), -np.cos(SLOPE)])  # out of the track
        self.background = self.draw_background()

    def distance(self, seconds):
        """How far along the track the ball's centre is, in pixels."""
        return 0.5 * self.acceleration * np.clip(seconds, 0, STOP_S) ** 2

    def speed(self, seconds):
        """In pixels a second; 0 from STOP_S on."""
        seconds = np.asarray(seconds, float)
        return np.where((seconds < 0) | (seconds >= STOP_S), 0.0, self.acceleration * seconds)

    def centre(self, seconds):
        """(x, y) of the ball's centre, [..., 2]."""
        return self.start + np.multiply.outer(self.distance(seconds), self.direction)

    def draw(self, frame):
        """The rectangle that the ball and its shadow touch in picture `frame`: (rows, columns, light)."""
        times = (frame + SAMPLE_TIMES) / self.fps
        middle = self.centre(times.mean())
        reach = self.radius * 1.15 + 2
        columns = slice(max(0, int(middle[0] - reach)), min(self.width, int(middle[0] + reach) + 1))
        rows = slice(max(0, int(middle[1] - reach)), min(self.height, int(middle[1] + reach) + 1))
        y, x = np.mgrid[rows, columns].astype(np.float32)
        colour, covered = self.ball(x[..., None] + SAMPLE_X, y[..., None] + SAMPLE_Y, times)
        ground = self.background[rows, columns] * self.shadow(x + 0.5, y + 0.5, times.mean())[..., None]
        share = covered.mean(axis=-1, dtype=np.float32)[..., None]
        return rows, columns, colour.sum(axis=-2) / covered.shape[-1] + (1 - share) * ground

    def ball(self, x, y, seconds):
        """Light of the ball at points at times, [..., 3], 0 outside of it; and whether it covers them."""
        centre = self.centre(seconds).astype(np.float32)
        x, y = (x - centre[:, 0]) / np.float32(self.radius), (y - centre[:, 1]) / np.float32(self.radius)
        squared = x * x + y * y
        z = np.sqrt(np.maximum(0, 1 - squared))
        turn = self.distance(seconds) / self.radius  # clockwise as seen, for y points down
        cosine, sine = np.cos(turn).astype(np.float32), np.sin(turn).astype(np.float32)
        colour = skin(cosine * x + sine * y, cosine * y - sine * x, z)
        shade = 0.38 + 0.62 * np.maximum(0, LAMP[0] * x + LAMP[1] * y + LAMP[2] * z)
        covered = squared <= 1
        return colour * (shade * covered)[..., None], covered

    def shadow(self, x, y, seconds):
        """What the ball leaves of the light where it touches the track: a factor for each point."""
        centre = self.centre(seconds)
        along = (x - centre[0]) * self.direction[0] + (y - centre[1]) * self.direction[1]
        below = -((x - centre[0]) * self.normal[0] + (y - centre[1]) * self.normal[1]) / self.radius - 1
        track = np.clip(below * self.radius + 0.5, 0, 1)  # the wall is too far away to be shaded
        return 1 - 0.6 * track * np.exp(-(along / (0.45 * self.radius)) ** 2 - (below / 0.09) ** 2)

    def along_track(self, x, y):
        """Distance along the track and height above the path of the ball's centre, of points in pixels."""
        x, y = x - self.start[0], y - self.start[1]
        return x * self.direction[0] + y * self.direction[1], x * self.normal[0] + y * self.normal[1]

    def draw_background(self):
        """[height, width, 3] light: a wall with a grid and test charts, the track and the block at its end."""
        fine_y, fine_x = np.mgrid[:self.height * BACKGROUND_GRID, :self.width * BACKGROUND_GRID].astype(np.float32)
        x, y = (fine_x + 0.5) / BACKGROUND_GRID, (fine_y + 0.5) / BACKGROUND_GRID
        light = self.wall(x, y)
        self.charts(x, y, light)
        self.track(x, y, light)
        return cv2.resize(light, (self.width, self.height), interpolation=cv2.INTER_AREA)

    def wall(self, x, y):
        """Grey-green paper with a grid of lines, lit from the upper left."""
        unit = self.width / 32
        uneven = np.sin(0.31 * x / unit + 1) * np.sin(0.53 * y / unit) + 0.6 * np.sin(0.83 * x / unit - 0.61 * y / unit)
        level = 0.125 * np.exp(-0.45 * (x / self.width) - 0.25 * (y / self.height)) * (1 + 0.07 * uneven) + 0.012
        line_x, line_y = (np.abs(value / unit - np.rint(value / unit)) < 0.025 for value in (x, y))
        level *= 1 - 0.28 * (line_x | line_y)
        return level[..., None] * np.array([0.92, 1.0, 0.97], np.float32)

    def charts(self, x, y, light):
        """Steps of grey, a few colours and a star, on which gains and sharpness can be judged."""
        unit = self.width / 32
        board = (np.abs(x - 24.5 * unit) < 4.75 * unit) & (np.abs(y - 3.75 * unit) < 2.25 * unit)
        light[board] = 0.025
        for step in range(6):
            inside = (np.abs(x - (20.75 + 1.5 * step) * unit) < 0.7 * unit) & (np.abs(y - 2.75 * unit) < 0.9 * unit)
            light[inside] = 0.04 * 2.0 ** (0.65 * step)
        for step, colour in enumerate(((0.25, 0.04, 0.04), (0.05, 0.18, 0.05), (0.04, 0.06, 0.25))):
            inside = (np.abs(x - (25.25 + 1.5 * step) * unit) < 0.7 * unit) & (np.abs(y - 4.75 * unit) < 0.9 * unit)
            light[inside] = colour
        star_x, star_y = x - 4.5 * unit, y - (self.height - 3.25 * unit)
        disc = star_x ** 2 + star_y ** 2 < (2.4 * unit) ** 2
        light[disc] = np.where(np.sin(18 * np.arctan2(star_y, star_x)) > 0, 0.20, 0.03)[disc][:, None]

    def track(self, x, y, light):
        """A wooden bar with a tick at every tenth of a second of the roll, and the block that the ball ends at."""
        along, above = self.along_track(x, y)
        depth = -above - self.radius
        bar = (along > -1.4 * self.radius) & (along < self.path_length + 1.8 * self.radius)
        bar &= (depth >= 0) & (depth < 0.5 * self.radius)
        u, v = along / self.radius, depth / self.radius
        grain = 1 + 0.10 * np.sin(67 * v + 1.5 * np.sin(0.86 * u)) + 0.06 * np.sin(2.9 * u + 32 * v)
        light[bar] = (np.array([0.150, 0.105, 0.065], np.float32) * grain[..., None])[bar]
        light[bar & (depth < 0.16 * self.radius)] *= 1.5
        ticks = self.distance(np.arange(11) / 10)
        near_tick = np.abs(along[..., None] - ticks).min(axis=-1) < self.radius / 64
        light[bar & near_tick & (depth > 0.2 * self.radius)] = 0.03
        beyond = (along - self.path_length) / self.radius - 1
        light[(beyond > 0) & (beyond < 0.5) & (depth < 0) & (depth > -1.3 * self.radius)] = (0.16, 0.05, 0.035)

    def masks(self):
        """The mask of the regions of Figure 14, and one that is 128 everywhere."""
        y, x = np.mgrid[:self.height, :self.width] + 0.5
        regions = np.zeros((self.height, self.width), np.uint8)
        for value, start in REGIONS.items():
            regions[self.swept(x, y, start)] = value
        return {"regions": regions, "whole": np.full_like(regions, 128)}

    def swept(self, x, y, start):
        """Whether the ball touches the pixels with these centres within EXPOSURE_S from `start`."""
        along, above = self.along_track(x, y)
        first, last = self.distance(start), self.distance(start + EXPOSURE_S)
        return np.hypot(along - np.clip(along, first, last), above) <= self.radius + 0.75

    def functions(self):
        """Text of the function files by name, without the ending."""
        return figures.FUNCTIONS

    def truth(self):
        """What tests may know, ready for JSON: lists have one value for each picture, at its start."""
        times = np.arange(self.frame_count) / self.fps
        centre = self.centre(times)
        return {
            "time_s": times.tolist(), "x_px": centre[:, 0].tolist(), "y_px": centre[:, 1].tolist(),
            "distance_px": self.distance(times).tolist(), "speed_px_per_s": self.speed(times).tolist(),
            "start_px": self.start.tolist(), "direction": self.direction.tolist(), "radius_px": self.radius,
            "path_length_px": self.path_length, "acceleration_px_per_s2": self.acceleration, "stop_s": STOP_S,
            "regions": {str(value): start for value, start in REGIONS.items()}, "exposure_s": EXPOSURE_S,
        }


def skin(u, v, w):
    """The ball's colour at points of the unit ball, [..., 3]: orange with dark seams, cream caps and dark spots."""
    axes = np.linalg.qr(np.array([[0.9, 0.2, 0.35], [-0.3, 0.8, 0.5], [-0.25, -0.5, 0.8]]))[0].astype(np.float32)
    a, b, c = (axis[0] * u + axis[1] * v + axis[2] * w for axis in axes)
    seams = np.minimum(np.minimum(np.abs(a), np.abs(b)), np.abs(np.abs(c) - 0.45 - 0.25 * a * a)) < 0.055
    caps = np.abs(a - 0.05) > 0.86
    spots = (a + b + c > 1.66) | (a - b + c > 1.66) | (b - a - c > 1.66) | (a - b - c > 1.66)
    colour = np.where(caps[..., None], CREAM, ORANGE)
    return np.where((seams | spots)[..., None], DARK, colour)


# A pixel's sampling points, [GRID * GRID]: place in the pixel, and time in the picture. The times are shuffled (fixed),
# so that they do not follow the place.
SAMPLE_X, SAMPLE_Y = ((axis.ravel() + 0.5).astype(np.float32) / GRID for axis in np.mgrid[:GRID, :GRID])
SAMPLE_TIMES = (np.random.Generator(np.random.PCG64(1)).permutation(GRID * GRID) + 0.5) / GRID ** 2
