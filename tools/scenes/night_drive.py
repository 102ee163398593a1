"""A car drives through a city at night, after rain."""

import cv2
import numpy as np

from .painting import WIDTH, PaintedScene, blend, cloud, ellipse, light, smooth_line

ROAD = 520.0             # where the wheels stand
KERB = 428.0
SPEED = 640.0            # design units a second
LENGTH = 270.0
ENTERS_S = 0.6           # the nose is at the left border
BODY = np.array([(2, -22), (3, -44), (28, -56), (70, -60), (98, -88), (150, -92), (190, -63), (244, -53), (266, -42),
                 (271, -24), (262, -12), (10, -12)])
WINDOWS = (((78, -61), (102, -83), (124, -86), (124, -61)), ((130, -61), (130, -86), (147, -85), (176, -61)))
WHEELS = (56, 212)


class NightDrive(PaintedScene):
    name = "night-drive"
    summary = "a car drives through a city at night, from 0.6 s on, its light from 0.2 s"
    fps = 120
    seconds = 2.0
    moments = 2

    @staticmethod
    def rear(seconds):
        return SPEED * (seconds - ENTERS_S) - LENGTH

    def box(self, seconds):
        rear = self.rear(seconds)
        if rear > WIDTH + 40 or rear + LENGTH < -260:
            return None
        return rear - 60, ROAD - 125, rear + LENGTH + 250, ROAD + 56

    def paint(self, canvas, seconds):
        rear = self.rear(seconds)
        x, y = canvas.points()
        self.shadow_and_mirror(canvas, rear, x, y)
        self.car(canvas, rear)
        self.lights(canvas, rear, x, y)

    @staticmethod
    def shadow_and_mirror(canvas, rear, x, y):
        under = np.exp(-((x - rear - 135) / 118) ** 4 - ((y - ROAD + 2) / 9) ** 2)
        canvas.cover(light("#020205"), 0.85 * under)
        body = smooth_line(BODY * (1, -0.5) + (rear, ROAD))
        canvas.fill(body, light("#5a0f16") * 0.5, 0.45)

    @staticmethod
    def car(canvas, rear):
        at = np.array([rear, ROAD])
        paint = lambda u, v: blend(light("#e04a40"), light("#3a0a14"), (v - ROAD + 86) / 66) * 0.8
        canvas.fill(smooth_line(BODY + at), paint)
        for window in WINDOWS:
            canvas.fill(np.array(window) + at, lambda u, v: blend(light("#56718f"), light("#131b2b"), (v - ROAD + 86) / 30))
        canvas.fill(np.array([(20, -36), (264, -34), (264, -31.5), (20, -33)]) + at, light("#ffd9c0") * 0.6)
        canvas.fill(np.array([(126, -58), (128, -58), (128, -16), (126, -16)]) + at, light("#2a060c"))
        for wheel in WHEELS:
            canvas.fill(ellipse(rear + wheel, ROAD - 17, 23), light("#14060a"))
            canvas.fill(ellipse(rear + wheel, ROAD - 17, 19), light("#0a0a0d"))
            canvas.fill(ellipse(rear + wheel, ROAD - 17, 10), light("#9aa0aa"))
            canvas.fill(ellipse(rear + wheel, ROAD - 17, 4), light("#33363c"))

    @staticmethod
    def lights(canvas, rear, x, y):
        head, tail = rear + LENGTH - 6, rear + 3
        canvas.fill(ellipse(head, ROAD - 38, 6, 7), light("#fff6dc"))
        canvas.fill(ellipse(tail, ROAD - 46, 4, 8), light("#ff2a1c"))
        white, red = light("#ffdfa6"), light("#ff1a10")
        glow = lambda u, v, wide, high: np.exp(-((x - u) / wide) ** 2 - ((y - v) / high) ** 2)
        canvas.shine(white, 0.75 * glow(head + 2, ROAD - 38, 13, 13) + 0.16 * glow(head + 14, ROAD - 38, 44, 30))
        ahead = np.clip((x - head) / 30, 0, 1) * np.exp(-np.maximum(x - head, 0) / 80)
        canvas.shine(white, 0.30 * ahead * np.exp(-((y - ROAD - 6) / 14) ** 2))
        canvas.shine(white, 0.10 * glow(head, ROAD + 34, 9, 24))
        canvas.shine(red, 0.85 * glow(tail - 1, ROAD - 46, 9, 11) + 0.14 * glow(tail - 8, ROAD - 44, 34, 24))
        canvas.shine(red, 0.22 * glow(tail - 2, ROAD + 36, 8, 24))

    def paint_background(self, canvas):
        x, y = canvas.points()
        sky = blend(light("#0d1230"), light("#513a63"), (y / KERB) ** 1.6)
        sky = blend(sky, light("#b8626a"), np.clip((y - 250) / 190, 0, 1) ** 2 * 0.55)
        haze = cloud(x.shape, (x.shape[0] / 4, x.shape[1] / 3), 31, 5)
        canvas.cover(sky * (0.75 + 0.5 * haze)[..., None], np.ones(x.shape, np.float32))
        random = np.random.Generator(np.random.PCG64(12))
        self.skyline(canvas, random, (60, 110), (150, 275), light("#2c2748"), 0.16)
        self.skyline(canvas, random, (70, 140), (70, 200), light("#14142a"), 0.34)
        self.lamps(canvas, x, y, random)
        self.street(canvas, x, y)

    @staticmethod
    def skyline(canvas, random, widths, heights, colour, lit):
        left = -20.0
        glass = [light(code) for code in ("#ffd98a", "#ffc163", "#ffe9bd", "#8fc7ff")]
        while left < WIDTH:
            width, height = random.uniform(*widths), random.uniform(*heights)
            top = KERB - height
            canvas.fill([(left, top), (left + width, top), (left + width, KERB), (left, KERB)],
                        lambda u, v: blend(colour * 0.75, colour * 1.7, (v - top) / (KERB - top)))
            if random.random() < 0.4:
                canvas.fill([(left + width * 0.5, top - 26), (left + width * 0.5 + 2, top - 26),
                             (left + width * 0.5 + 2, top), (left + width * 0.5, top)], colour)
            for row in np.arange(top + 9, KERB - 20, 13):
                for column in np.arange(left + 8, left + width - 10, 11):
                    if random.random() < lit * (0.5 + random.random()):
                        tone = glass[random.integers(len(glass))] * random.uniform(0.25, 0.9)
                        canvas.fill([(column, row), (column + 5, row), (column + 5, row + 7), (column, row + 7)], tone)
            left += width + random.uniform(0, 14)

    @staticmethod
    def lamps(canvas, x, y, random):
        colours = [light(code) for code in ("#ffb24d", "#ff7a4a", "#ffd890", "#6fd6ff", "#ff5a7a")]
        for _ in range(34):
            where, size = (random.uniform(0, WIDTH), random.uniform(KERB - 62, KERB - 6)), random.uniform(5, 15)
            canvas.fill(ellipse(*where, size), colours[random.integers(len(colours))] * 0.8, random.uniform(0.14, 0.42))
        for post in (150, 470, 790):
            canvas.fill([(post - 2, 214), (post + 2, 214), (post + 3, KERB + 6), (post - 3, KERB + 6)], light("#0a0a12"))
            canvas.fill([(post - 1, 214), (post + 52, 204), (post + 52, 208), (post, 219)], light("#0a0a12"))
            canvas.fill(ellipse(post + 54, 210, 13, 5), light("#fff0c8"))
            away = ((x - post - 54) / 1.0) ** 2 + (y - 212) ** 2
            canvas.shine(light("#ffb45a"), 0.40 * np.exp(-away / 900) + 0.12 * np.exp(-away / 9000))

    @staticmethod
    def street(canvas, x, y):
        """Wet asphalt: what stands above it, upside down, drawn out and rippled."""
        scale = canvas.scale[1]
        kerb = int(round(KERB * scale))
        height = canvas.layer.shape[0]
        above = canvas.layer[:kerb, :, :3][::-1]
        stretched = cv2.GaussianBlur(above, (0, 0), sigmaX=3 * scale, sigmaY=26 * scale)[:height - kerb]
        wet = cloud(x.shape, (26 * scale, 170 * scale), 17, 5)[kerb:]
        grain = cloud(x.shape, (3 * scale, 5 * scale), 19, 2)[kerb:]
        depth = ((np.arange(kerb, height) - kerb) / (height - kerb))[:, None]
        shine = np.clip((wet - 0.30) * 2.2, 0.12, 1) * (0.95 - 0.35 * depth)
        asphalt = light("#191a26") * (0.6 + 0.8 * grain)[..., None]
        canvas.layer[kerb:, :, :3] = asphalt * 0.7 + stretched * (0.85 * shine * (0.8 + 0.4 * grain))[..., None]
        for top, bottom, tone in ((KERB - 3, KERB + 6, "#4a4658"), (KERB + 6, KERB + 10, "#0c0b12")):
            canvas.fill([(0, top), (WIDTH, top), (WIDTH, bottom), (0, bottom)], light(tone))
        for dash in range(-40, WIDTH, 170):
            canvas.fill([(dash, 548), (dash + 84, 548), (dash + 78, 556), (dash - 8, 556)], light("#c8b98e"), 0.30)
