"""A ball bounces through a room in the evening sun."""

import cv2
import numpy as np

from .painting import HEIGHT, WIDTH, PaintedScene, blend, cloud, ellipse, light

RADIUS = 34
FLOOR = 452.0             # where the ball's lowest point bounces
GRAVITY = 1500.0          # design units a second squared
SPEED = 560.0             # to the right
ENTERS_S = 0.10           # at the left border
SUN = np.array([-0.55, -0.62, 0.56], np.float32)


class BouncingBall(PaintedScene):
    name = "bouncing-ball"
    summary = "a ball bounces through a sunlit room, from 0.1 to 2.1 s"
    fps = 240
    seconds = 2.25

    def place(self, seconds):
        """(x, y) of the ball's centre. Each bounce rises to 0.62 times the height before."""
        x = -RADIUS + SPEED * (seconds - ENTERS_S)
        height, fallen = 300.0, np.sqrt(2 * 300.0 / GRAVITY)
        since = seconds - ENTERS_S - 0.02
        if since < fallen:
            return x, FLOOR - RADIUS - height + 0.5 * GRAVITY * max(since, 0.0) ** 2
        since -= fallen
        while True:
            height *= 0.66
            up = np.sqrt(2 * height / GRAVITY)
            if since < 2 * up:
                return x, FLOOR - RADIUS - height + 0.5 * GRAVITY * (since - up) ** 2
            since -= 2 * up

    def box(self, seconds):
        x, y = self.place(seconds)
        if not -2 * RADIUS < x < WIDTH + 2 * RADIUS:
            return None
        return x - 2.2 * RADIUS, y - RADIUS - 2, x + 2.2 * RADIUS, FLOOR + 40

    def paint(self, canvas, seconds):
        x, y = self.place(seconds)
        height = FLOOR - RADIUS - y
        wide, dark = RADIUS * (0.80 + height / 420), 0.62 / (1 + height / 90)
        px, py = canvas.points()
        apart = ((px - x - height * 0.06) / wide) ** 2 + ((py - FLOOR - 4) / (wide * 0.22)) ** 2
        canvas.cover(light("#2a1710"), dark * np.exp(-1.6 * apart))
        turn = seconds * SPEED / RADIUS * 0.45
        canvas.fill(ellipse(x, y, RADIUS), lambda u, v: self.skin((u - x) / RADIUS, (v - y) / RADIUS, turn))

    @staticmethod
    def skin(u, v, turn):
        """A beach ball's stripes, lit from the window."""
        w = np.sqrt(np.maximum(0, 1 - u * u - v * v))
        a = np.cos(turn) * u + np.sin(turn) * v
        b = np.cos(turn) * v - np.sin(turn) * u
        stripe = np.abs(0.82 * b + 0.57 * w - 0.12) < 0.23
        cap = 0.5 * a - 0.6 * b + 0.62 * w > 0.93
        colour = np.where((stripe | cap)[..., None], light("#fff3dc"), light("#e4472f"))
        shade = 0.30 + 0.78 * np.maximum(0, SUN[0] * u + SUN[1] * v + SUN[2] * w)
        gloss = np.maximum(0, SUN[0] * u + SUN[1] * v + SUN[2] * w) ** 40
        return colour * shade[..., None] + 0.35 * gloss[..., None]

    def paint_background(self, canvas):
        x, y = canvas.points()
        shape = x.shape
        wall = blend(light("#3d6468"), light("#274448"), (x / WIDTH) * 0.7 + 0.3 * y / HEIGHT)
        wall *= 0.92 + 0.16 * cloud(shape, (shape[0] / 6, shape[1] / 10), 3, 7)[..., None]
        sunny = np.zeros(shape, np.float32)
        for column in range(3):
            for row in range(2):
                left, top = 330 + 122 * column, 34 + 142 * row
                across = (x - left) - 0.10 * (y - top)
                down = (y - top) - 0.22 * (x - left)
                sunny = np.maximum(sunny, ((across > 0) & (across < 108) & (down > 0) & (down < 128)).astype(np.float32))
        scale = canvas.scale[0]
        sunny = cv2.GaussianBlur(sunny, (0, 0), 4.0 * scale)
        leaves = cv2.GaussianBlur(cloud(shape, (30 * scale, 34 * scale), 9, 2), (0, 0), 5 * scale)
        branch = np.clip((x - 330 + 0.8 * (260 - y)) / 420, 0, 1)
        sunny *= 1 - 0.62 * np.clip((leaves - 0.47) * 9 + 0.2, 0, 1) * branch
        wall = wall * (1 + 0.9 * sunny[..., None]) + sunny[..., None] * light("#ff9f4e") * 0.42
        floor = self.floor(x, y, shape)
        below = (y > 420)[..., None]
        picture = np.where(below, floor, wall)
        skirting = ((y > 398) & (y <= 420))[..., None]
        picture = np.where(skirting, blend(light("#d9d2c3"), light("#8d8676"), (y - 398) / 26 + x / WIDTH * 0.5), picture)
        picture = np.where(((y > 418) & (y <= 421))[..., None], picture * 0.35, picture)
        vignette = 1 - 0.34 * (((x - 470) / 700) ** 2 + ((y - 260) / 480) ** 2)
        canvas.cover(picture * vignette[..., None], np.ones(shape, np.float32))

    @staticmethod
    def floor(x, y, shape):
        """Boards that run to a point behind the wall."""
        depth = 60.0 / np.maximum(y - 372, 1)
        along = (x - 512) * depth
        board = np.floor(along / 52)
        tone = 0.82 + 0.30 * np.modf(np.abs(np.sin(board * 12.9898 + 3)) * 43758.5)[0]
        grain = cloud(shape, (shape[0] / 4, shape[1] / 3), 5, 7)
        streak = 0.90 + 0.2 * grain
        gap = np.abs(along / 52 - np.rint(along / 52)) < 0.014
        colour = blend(light("#b57a45"), light("#7a4a28"), (y - 420) / 190 + 0.3 * (x / WIDTH - 0.4))
        colour = colour * (tone * streak * 0.85)[..., None]
        return np.where(gap[..., None], colour * 0.35, colour)
