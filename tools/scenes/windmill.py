"""A windmill turns at a lake after sunset."""

import numpy as np

from .painting import HEIGHT, WIDTH, PaintedScene, blend, cloud, ellipse, light

HUB = np.array([512.0, 236.0])
LENGTH = 196.0                 # of a sail, from the hub
TURNS_PER_SECOND = 0.85
SHORE = 440.0
SAIL, FRAME = light("#e9d3ac"), light("#2a1c1a")


class Windmill(PaintedScene):
    name = "windmill"
    summary = "the sails of a mill turn 0.85 times a second"
    fps = 120
    seconds = 260 / 120

    def box(self, seconds):
        return HUB[0] - LENGTH - 8, HUB[1] - LENGTH - 8, HUB[0] + LENGTH + 8, HUB[1] + LENGTH + 8

    def paint(self, canvas, seconds):
        for sail in range(4):
            angle = 2 * np.pi * (TURNS_PER_SECOND * seconds + sail / 4) + 0.45
            self.sail(canvas, np.array([np.cos(angle), np.sin(angle)]))
        canvas.fill(ellipse(*HUB, 11), FRAME)
        canvas.fill(ellipse(HUB[0] - 1, HUB[1] - 1, 5), light("#8d6a4c"))

    @staticmethod
    def sail(canvas, along):
        across = np.array([-along[1], along[0]])

        def bar(from_along, to_along, from_across, to_across, colour):
            corners = [(from_along, from_across), (to_along, from_across), (to_along, to_across), (from_along, to_across)]
            canvas.fill([HUB + along * a + across * b for a, b in corners], colour)

        lit = 0.62 + 0.38 * max(0.0, -along[1] * 0.5 + across[0] * 0.6)
        bar(38, LENGTH, 3, 40, SAIL * lit)
        for rib in np.linspace(38, LENGTH, 11):
            bar(rib - 1.2, rib + 1.2, -3, 42, FRAME)
        for beam in (12, 26, 40):
            bar(38, LENGTH, beam - 1.0, beam + 1.0, FRAME)
        bar(0, LENGTH + 3, -3.2, 3.2, FRAME)

    def paint_background(self, canvas):
        x, y = canvas.points()
        self.sky(canvas, x, y)
        self.land(canvas)
        self.mill(canvas)
        self.mirror(canvas)
        vignette = 1 - 0.25 * (((x - 512) / 720) ** 2 + ((y - 270) / 460) ** 2)
        canvas.layer[..., :3] *= vignette[..., None]

    @staticmethod
    def sky(canvas, x, y):
        colours = [light(code) for code in ("#20305f", "#4c4a84", "#a9628a", "#ee8a6a", "#ffc27a")]
        place = np.clip(y / (SHORE - 20), 0, 0.999) ** 1.1 * 4
        colour = np.zeros((*y.shape, 3), np.float32)
        for k in range(4):
            inside = (place >= k) & (place < k + 1)
            colour[inside] = blend(colours[k], colours[k + 1], (place - k)[inside])
        away = np.hypot((x - 640) / 1.0, (y - 415) / 0.55)
        colour += light("#ffb45e") * (0.38 * np.exp(-(away / 190) ** 2))[..., None]
        high, wide = canvas.scale[1] * 26, canvas.scale[0] * 230
        bands = cloud(x.shape, (high, wide), 21, 5)
        share = np.clip((bands - 0.52) * 5, 0, 1) * np.clip(y / 90, 0.15, 1) * np.clip((SHORE - y) / 60, 0, 1)
        lit = blend(light("#c6607c"), light("#ffd59a"), np.clip((y - 90) / 260, 0, 1))
        canvas.cover(blend(colour, lit, 0.62 * share), np.ones(x.shape, np.float32))
        random = np.random.Generator(np.random.PCG64(8))
        for star_x, star_y, bright in zip(random.uniform(0, WIDTH, 70), random.uniform(0, 150, 70), random.random(70)):
            canvas.fill(ellipse(star_x, star_y, 0.5 + 0.5 * bright, corners=8), light("#fff1df"), 0.25 + 0.6 * bright ** 2)

    @staticmethod
    def land(canvas):
        far = np.arange(0, WIDTH + 1, 8)
        ridge = SHORE - 16 - 9 * np.sin(far / 97) - 6 * np.sin(far / 41 + 1)
        canvas.fill([*zip(far, ridge), (WIDTH, SHORE), (0, SHORE)], light("#7a4a63"))
        random = np.random.Generator(np.random.PCG64(4))
        for tree_x in np.concatenate([random.uniform(-10, 300, 26), random.uniform(700, 1034, 30)]):
            tall = random.uniform(12, 34)
            canvas.fill(ellipse(tree_x, SHORE - tall * 0.6, tall * 0.45, tall * 0.75), light("#33233a"))
        canvas.fill([(0, SHORE - 8), (WIDTH, SHORE - 7), (WIDTH, SHORE + 1), (0, SHORE + 1)], light("#241b2c"))

    @staticmethod
    def mill(canvas):
        x, y = HUB
        tower = [(x - 42, y + 6), (x + 42, y + 6), (x + 74, SHORE), (x - 74, SHORE)]
        canvas.fill(tower, lambda u, v: blend(light("#1d1620"), light("#80453c"), (u - x + 30) / 120))
        for course in np.arange(y + 24, SHORE, 14):
            half = 42 + 32 * (course - y) / (SHORE - y)
            canvas.fill([(x - half, course), (x + half, course), (x + half, course + 1), (x - half, course + 1)],
                        light("#120d14"), 0.5)
        cap = [(x - 50, y + 8), (x - 44, y - 22), (x - 20, y - 44), (x + 14, y - 46), (x + 40, y - 26), (x + 52, y + 8)]
        canvas.fill(cap, lambda u, v: blend(light("#1b1522"), light("#7c4038"), (u - x + 24) / 100))
        balcony = y + 118
        canvas.fill([(x - 92, balcony), (x + 92, balcony), (x + 92, balcony + 5), (x - 92, balcony + 5)], light("#160f16"))
        for post in np.linspace(-90, 90, 19):
            canvas.fill([(x + post - 1, balcony - 15), (x + post + 1, balcony - 15), (x + post + 1, balcony),
                         (x + post - 1, balcony)], light("#160f16"))
        canvas.fill([(x - 92, balcony - 16), (x + 92, balcony - 16), (x + 92, balcony - 13), (x - 92, balcony - 13)],
                    light("#160f16"))
        for left, top in ((-14, 62), (-14, 146)):
            canvas.fill([(x + left, y + top), (x + left + 22, y + top), (x + left + 22, y + top + 30),
                         (x + left, y + top + 30)], light("#ffcf70"))
            canvas.fill([(x + left + 10, y + top), (x + left + 12, y + top), (x + left + 12, y + top + 30),
                         (x + left + 10, y + top + 30)], light("#160f16"))

    @staticmethod
    def mirror(canvas):
        """The lake: what is above the shore, upside down, darker, and the further down the more ruffled."""
        shore = int(round(SHORE * canvas.scale[1]))
        height, width = canvas.layer.shape[:2]
        rows = np.arange(shore, height)
        depth = (rows - shore) / (height - shore)
        random = np.random.Generator(np.random.PCG64(2))
        phase = np.cumsum(random.uniform(0.2, 0.9, rows.size)) / canvas.scale[1] * 2
        shift = np.rint(np.sin(phase) * (1 + 9 * depth) * canvas.scale[0]).astype(int)
        for row, move, deep in zip(rows, shift, depth):
            source = max(0, shore - 1 - int((row - shore) * 1.35))
            tone = 0.80 - 0.35 * deep
            canvas.layer[row, :, :3] = np.roll(canvas.layer[source, :, :3], move, axis=0) * tone
        canvas.layer[shore:, :, :3] *= np.array([0.86, 0.92, 1.08], np.float32)
