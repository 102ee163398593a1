"""A salmon leaps beside a waterfall."""

import cv2
import numpy as np

from .painting import HEIGHT, WIDTH, Canvas, PaintedScene, blend, cloud, ellipse, endless, light, smooth_line

FALL = 1050.0                  # design units a second that the water falls
POOL = 470.0
LEAP_S, LEAP_SECONDS = 1.30, 0.80
START, END, APEX = 130.0, 420.0, 205.0   # x at both ends, y at the top
OUTLINE = np.array([(86, 2), (70, -12), (34, -22), (-10, -21), (-50, -11), (-70, -5), (-70, 6), (-50, 11), (-8, 21),
                    (40, 21), (74, 12)])


class Waterfall(PaintedScene):
    name = "waterfall"
    summary = "water falls, and a salmon leaps beside it from 1.3 to 2.1 s"
    fps = 120
    seconds = 2.25
    moments = 2

    def __init__(self, width=WIDTH, height=HEIGHT):
        self.size = (width, height)
        self.prepare_water()
        super().__init__(width, height)

    def prepare_water(self):
        """Where water is and what runs through it: arrays of the picture's size, textures twice as high."""
        width, height = self.size
        sx, sy = width / WIDTH, height / HEIGHT
        y, x = np.mgrid[:height, :width].astype(np.float32)
        x, y = (x + 0.5) / sx, (y + 0.5) / sy
        wave = cloud((height, width), (60 * sy, 1e6), 41, 3) - 0.5
        left = 455 + 40 * wave + 22 * np.sin(y / 120) - 0.05 * y
        right = 905 - 44 * wave + 16 * np.sin(y / 90 + 1) + 0.06 * y
        veil = np.clip((x - left) / 26, 0, 1) * np.clip((right - x) / 30, 0, 1)
        strands = cv2.resize(cloud((1, width * 4), (1, 22 * sx), 42, 5), (width, height))
        strands = np.clip(0.15 + 1.5 * (strands - 0.25), 0.05, 1)
        self.fall = (np.sqrt(veil) * np.clip((y - 34 - 10 * np.sin(x / 60)) / 12, 0, 1) *
                     np.clip((POOL + 10 - y) / 24, 0, 1)).astype(np.float32)
        self.strands = strands.astype(np.float32)
        near = np.exp(-((x - 680) / 290) ** 2)
        self.pool = np.clip((y - POOL + 12 * (wave + 0.1)) / 8, 0, 1).astype(np.float32)
        self.foam = np.clip(near * np.exp(-np.maximum(y - POOL, 0) / 46) * 1.25, 0, 1).astype(np.float32)
        self.mist = (0.62 * np.exp(-((x - 680) / 270) ** 2 - ((y - POOL + 6) / 46) ** 2)).astype(np.float32)
        self.textures = [endless(cloud((2 * height, width), (70 * sy, 7 * sx), 50 + k, 4), 0) for k in range(2)]
        self.ripples = [endless(cloud((height, 2 * width), (5 * sy, 46 * sx), 60 + k, 4), 1) for k in range(2)]

    def water(self, seconds):
        """Light of the water and what it covers, at a moment: [height, width, 3] and [height, width]."""
        width, height = self.size
        first, second = (np.roll(texture, int(FALL * pace * seconds * height / HEIGHT), axis=0)[:height]
                         for texture, pace in zip(self.textures, (1.0, 0.72)))
        run = np.clip((first + second - 0.62) * 1.9, 0, 1)
        body = self.strands * (0.30 + 0.70 * run)
        falling = blend(light("#4b7d8f"), light("#f4fbff"), body) * (0.30 + 0.70 * body)[..., None]
        there, back = (np.roll(ripple, int(way * 90 * seconds * width / WIDTH), axis=1)[:, :width]
                       for ripple, way in zip(self.ripples, (1, -1)))
        ripple = np.clip((there + back - 0.66) * 2.2, 0, 1)
        deep = blend(light("#0c2f33"), light("#5fa3a4"), ripple * 0.55)
        pool = blend(deep, light("#eef8f8"), self.foam * (0.45 + 0.9 * ripple))
        cover = np.maximum(self.fall * (0.35 + 0.65 * body) * (1 - self.pool), self.pool)
        return blend(falling, pool, self.pool), cover

    def draw(self, frame):
        times = (frame + (np.arange(self.moments) + 0.5) / self.moments) / self.fps
        total = 0
        for seconds in times:
            colour, cover = self.water(seconds)
            total = total + self.background * (1 - cover[..., None]) + colour * cover[..., None]
        total = total / len(times)
        total += (light("#dff1f4") - total) * self.mist[..., None]
        if any(self.box(seconds) for seconds in times):
            rows, columns = self.pixels_of([self.box(seconds) for seconds in times])
            fish = 0
            for seconds in times:
                canvas = Canvas(self.size, rows, columns, 2)
                self.paint(canvas, seconds)
                fish = fish + canvas.picture() / len(times)
            total[rows, columns] = total[rows, columns] * (1 - fish[..., 3:]) + fish[..., :3]
        return slice(0, self.size[1]), slice(0, self.size[0]), total

    @staticmethod
    def place(seconds):
        """(x, y) of the fish and its heading in radians, clockwise as seen from rightwards; None in the water."""
        share = (seconds - LEAP_S) / LEAP_SECONDS
        if not 0 <= share <= 1:
            return None
        rise = POOL + 30 - APEX
        slope = np.arctan2(-rise * 4 * (1 - 2 * share), END - START)
        return START + (END - START) * share, POOL + 30 - rise * 4 * share * (1 - share), slope

    def box(self, seconds):
        return (30, 90, 500, POOL + 24) if LEAP_S <= seconds <= LEAP_S + LEAP_SECONDS + 0.12 else None

    def paint(self, canvas, seconds):
        self.drops(canvas, seconds)
        place = self.place(seconds)
        if place is None:
            return
        x, y, heading = place
        beat = 0.16 * np.sin(22 * seconds)

        def at(points):
            """From the fish's own coordinates, nose to the right, bent as it beats its tail."""
            points = np.asarray(points, float)
            along, across = points[..., 0], points[..., 1] + beat * (points[..., 0] - 30) ** 2 / 130
            cosine, sine = np.cos(heading), np.sin(heading)
            return np.stack([x + cosine * along - sine * across, y + sine * along + cosine * across], axis=-1)

        def skin(u, v):
            along = np.cos(heading) * (u - x) + np.sin(heading) * (v - y)
            across = np.cos(heading) * (v - y) - np.sin(heading) * (u - x) - beat * (along - 30) ** 2 / 130
            colour = blend(light("#33463f"), light("#a8b4b0"), (across + 15) / 13)
            colour = blend(colour, light("#c96a5a"), 0.85 * np.exp(-((across - 0.5) / 6) ** 2))
            colour = blend(colour, light("#f3f1e6"), (across - 5) / 8)
            spots = np.sin(along * 0.92 + 2 * np.sin(across * 0.7)) * np.sin(across * 1.05 + along * 0.35) > 0.62
            colour = np.where((spots & (across < -2))[..., None], light("#141c1a"), colour)
            return colour * (1.0 - 0.18 * np.abs(across) / 22)[..., None]

        fin = light("#4a5a52")
        canvas.fill(at([(-62, 0), (-104, -30), (-96, -4), (-104, 28)]), light("#5a6a60"))
        canvas.fill(at([(18, -19), (2, -38), (-14, -34), (-16, -18)]), fin)
        canvas.fill(at([(-42, -11), (-54, -22), (-58, -20), (-54, -9)]), fin)
        canvas.fill(at(smooth_line(OUTLINE)), skin)
        canvas.fill(at([(34, 14), (22, 34), (12, 33), (18, 17)]), light("#8c7f70"))
        canvas.fill(at([(-20, 17), (-30, 32), (-38, 30), (-34, 14)]), light("#8c7f70"))
        canvas.fill(at([(52, -16), (50, -4), (53, 10), (50, 11), (47, -4), (49, -16)]), light("#5a5048"), 0.7)
        canvas.fill(at([(86, 3), (66, 6), (66, 7.6), (84, 5)]), light("#2a2422"), 0.8)
        canvas.fill(at(ellipse(68, -4, 4.2)), light("#e8d48a"))
        canvas.fill(at(ellipse(68.5, -4, 2.4)), light("#0a0a0a"))

    @staticmethod
    def drops(canvas, seconds):
        """Thrown up where the fish left the water."""
        random = np.random.Generator(np.random.PCG64(77))
        since = seconds - LEAP_S - 0.06
        for _ in range(70):
            across, up, size = random.normal(70, 90), random.uniform(250, 900), random.uniform(1.0, 3.4)
            place = START + random.normal(16, 14) + across * since, POOL + 8 - up * since + 900 * since * since
            if since > 0 and place[1] < POOL + 8:
                canvas.fill(ellipse(*place, size, corners=16), light("#e6f4f6"), 0.85)

    def paint_background(self, canvas):
        x, y = canvas.points()
        sx, sy = canvas.scale
        coarse = cloud(x.shape, (90 * sy, 70 * sx), 71, 6)
        cracks = np.abs(cloud(x.shape, (34 * sy, 150 * sx), 72, 5) - 0.5)
        rock = blend(light("#0d1413"), light("#4c5450"), (coarse - 0.24) * 1.5)
        moss = np.clip((cloud(x.shape, (40 * sy, 60 * sx), 73, 5) - 0.52) * 6, 0, 1)
        rock = blend(rock, light("#44602a") * (0.35 + coarse)[..., None], 0.75 * moss)
        rock = rock * np.clip(0.25 + cracks * 9, 0.25, 1)[..., None]
        slope = np.gradient(cv2.GaussianBlur(coarse, (0, 0), 3 * sx), axis=0) * sy * 26
        rock = rock * np.clip(1 + 6 * slope, 0.5, 1.7)[..., None]
        shade = 0.42 + 0.75 * np.exp(-((x - 690) / 420) ** 2) * np.exp(-((y - 230) / 420) ** 2)
        canvas.cover(rock * shade[..., None], np.ones(x.shape, np.float32))
        self.leaves(canvas)

    @staticmethod
    def leaves(canvas):
        """Bushes above the rock, hanging over it; the further back the darker."""
        random = np.random.Generator(np.random.PCG64(75))
        for share in np.linspace(0, 1, 1700):
            x, reach = random.uniform(-10, WIDTH + 10), 40 + 16 * np.sin(random.integers(9) * 0.7)
            hang = reach + 26 * np.sin(x / 63) * np.sin(x / 29) - 30 * np.exp(-((x - 690) / 210) ** 4)
            y = hang * (1 - random.random() ** 0.6 * 1.3) * (1.25 - 0.45 * share)
            tone = blend(light("#0c160c"), light("#86a344"), share * random.uniform(0.45, 0.95))
            canvas.fill(ellipse(x, y, random.uniform(6, 13), random.uniform(2.4, 4.6), random.uniform(0.2, 2.6), 14), tone)
