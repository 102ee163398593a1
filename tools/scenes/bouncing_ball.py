"""A ball bounces through a room in the evening sun."""

import cv2
import numpy as np

from .painting import HEIGHT, WIDTH, PaintedScene, blend, cloud, ellipse, light

RADIUS = 34
FLOOR = 452.0             # where the ball's lowest point bounces
GRAVITY = 1500.0          # design units a second squared
SPEED = 420.0             # to the right
ENTERS_S = 0.10           # at the left border
SUN = np.array([-0.55, -0.62, 0.56], np.float32)


class BouncingBall(PaintedScene):
    name = "bouncing-ball"
    summary = "a ball bounces through a sunlit room, from 0.1 to 2.7 s"
    fps = 240
    seconds = 2.8

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
        wall = wall * (1 + 0.9 * sunny[..., None]) + sunny[..., None] * light("#ff9f4e") * 0.42
        floor = self.floor(x, y, shape)
        below = (y > 420)[..., None]
        picture = np.where(below, floor, wall)
        skirting = ((y > 398) & (y <= 420))[..., None]
        picture = np.where(skirting, blend(light("#d9d2c3"), light("#8d8676"), (y - 398) / 26 + x / WIDTH * 0.5), picture)
        picture = np.where(((y > 418) & (y <= 421))[..., None], picture * 0.35, picture)
        canvas.cover(picture, np.ones(shape, np.float32))
        self.plant(canvas)
        vignette = 1 - 0.34 * (((x - 470) / 700) ** 2 + ((y - 260) / 480) ** 2)
        canvas.layer[..., :3] *= vignette[..., None]

    @staticmethod
    def plant(canvas):
        """A rubber plant in a pot, before the wall at the right."""
        random = np.random.Generator(np.random.PCG64(23))
        pot_x, pot_y = 906.0, 430.0
        canvas.fill(ellipse(pot_x + 20, pot_y + 2, 62, 8), light("#24140c"), 0.5)
        for stem in (-26, -8, 6, 24):
            top = np.array([pot_x + 2.6 * stem, 210 + abs(stem) * 2.2])
            canvas.fill([(pot_x - 2, pot_y - 60), (pot_x + 2, pot_y - 60), top + (1.5, 0), top - (1.5, 0)], light("#3a3222"))
            for share in np.linspace(0.30, 1.0, 7):
                at = np.array([pot_x, pot_y - 60]) * (1 - share) + top * share
                for side in (-1, 1):
                    droop, length = random.uniform(-0.5, 0.45), random.uniform(26, 42)
                    turn = np.pi / 2 - side * (np.pi / 2 - droop) if side < 0 else droop
                    middle = at + length * 0.8 * np.array([np.cos(turn), np.sin(turn)])
                    green = blend(light("#17301f"), light("#4f8a52"), random.uniform(0.1, 0.9))
                    canvas.fill(ellipse(*middle, length * 0.8, 9, turn), green)
                    canvas.fill([at, middle + (middle - at) * 0.8, middle + (middle - at) * 0.8 + (0, 1.2), at + (0, 1.2)],
                                light("#86b07c"), 0.35)
        shape = [(pot_x - 42, pot_y - 66), (pot_x + 42, pot_y - 66), (pot_x + 31, pot_y + 6), (pot_x - 31, pot_y + 6)]
        canvas.fill(shape, lambda u, v: blend(light("#e9dfcb"), light("#8d7d66"), (u - pot_x + 30) / 70))
        canvas.fill([(pot_x - 44, pot_y - 68), (pot_x + 44, pot_y - 68), (pot_x + 42, pot_y - 58), (pot_x - 42, pot_y - 58)],
                    lambda u, v: blend(light("#f6eddb"), light("#a08e75"), (u - pot_x + 30) / 70))

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
