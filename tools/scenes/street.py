"""People walk along a street of old houses in the sun; at no moment is it empty."""

from dataclasses import dataclass

import numpy as np

from .painting import HEIGHT, WIDTH, PaintedScene, blend, cloud, ellipse, limb, light

PAVEMENT = 428.0


@dataclass(frozen=True)
class Walker:
    """Someone who walks to the right (`speed` above 0) or to the left, and is at `x` at 0 s."""

    x: float
    speed: float
    ground: float    # y of the feet: who is nearer is further down, and larger
    coat: str
    trousers: str
    hair: str
    skirt: bool = False


WALKERS = (
    Walker(120, 88, 462, "#c8503c", "#2c3448", "#3a2418"),
    Walker(900, -102, 470, "#e6b94a", "#5a4636", "#1c1410", True),
    Walker(-120, 118, 486, "#3f6f8f", "#26262c", "#7a5230"),
    Walker(1110, -84, 492, "#f0ece2", "#7a3b3b", "#c89a5a"),
    Walker(480, 96, 506, "#5b7d4f", "#3a3f55", "#221814"),
    Walker(640, -124, 516, "#8c4a78", "#2a2230", "#4a2c1c", True),
    Walker(-420, 132, 522, "#d98a5a", "#3c4a5a", "#15100e"),
    Walker(1430, -138, 530, "#2f3d5c", "#8a7a5c", "#8a5a34"),
)


class Street(PaintedScene):
    name = "street"
    summary = "eight people walk along a street that is never empty"
    fps = 30
    seconds = 9.0

    @staticmethod
    def tall(walker):
        return 132 * (0.8 + 0.5 * (walker.ground - PAVEMENT) / 100)

    def box(self, seconds):
        return 0, PAVEMENT - 110, WIDTH, HEIGHT - 30

    def paint(self, canvas, seconds):
        for walker in sorted(WALKERS, key=lambda walker: walker.ground):
            if -90 < walker.x + walker.speed * seconds < WIDTH + 90:
                self.person(canvas, walker, seconds)

    def person(self, canvas, walker, seconds):
        x, size, way = walker.x + walker.speed * seconds, self.tall(walker) / 132, np.sign(walker.speed)
        phase = 2 * np.pi * (abs(walker.speed) * seconds / (86 * size) + walker.ground * 0.37)
        bob = 2.2 * np.cos(2 * phase)

        def at(dx, dy):
            return np.array([x + way * dx * size, walker.ground + (dy + bob * (dy < -20)) * size])

        shadow = [(x - 8 * size, walker.ground + 1), (x + 14 * size, walker.ground - 3), (x + 92 * size, walker.ground + 26 * size),
                  (x + 70 * size, walker.ground + 30 * size)]
        canvas.fill(shadow, light("#2a2030"), 0.42)
        coat, trousers, skin = light(walker.coat), light(walker.trousers), light("#d8a07a")
        for side, shade in ((np.pi, 0.6), (0.0, 1.0)):
            thigh = 0.46 * np.sin(phase + side)
            knee_bend = 0.12 + 0.62 * max(0.0, np.cos(phase + side)) ** 2
            knee = np.array([32 * np.sin(thigh), -66 + 32 * np.cos(thigh)])
            shin = thigh - knee_bend
            foot = knee + np.array([31 * np.sin(shin), 31 * np.cos(shin)])
            foot[1] = min(foot[1], -3.0)
            leg = skin if walker.skirt else trousers
            canvas.fill(limb(at(0, -66), at(*knee), 8 * size, 6.5 * size), leg * shade)
            canvas.fill(limb(at(*knee), at(*foot), 6 * size, 4 * size), leg * shade)
            canvas.fill(limb(at(*foot), at(foot[0] + 9, foot[1] + 1), 4 * size, 2.8 * size), light("#2a1c16") * shade)
            if side:
                self.arm(canvas, at, 0.5 * np.sin(phase), size, coat * 0.6, skin * 0.7)
        lit = lambda u, v: blend(coat * 0.55, coat * 1.05, (x - u + 11 * size) / (22 * size))
        if walker.skirt:
            canvas.fill([at(-8, -78), at(8, -78), at(17 + 3 * np.sin(phase), -40), at(-17 + 3 * np.sin(phase), -40)], lit)
        canvas.fill(limb(at(0, -66), at(1, -104), 10.5 * size, 12.5 * size), lit)
        canvas.fill(limb(at(2, -112), at(3, -120), 4.5 * size, 4.5 * size), skin * 0.8)
        canvas.fill(ellipse(*at(4, -127), 8.6 * size, 10 * size), skin)
        canvas.fill(limb(at(0, -131), at(2, -134), 8.2 * size, 7 * size), light(walker.hair))
        if walker.skirt:
            canvas.fill(limb(at(-5, -130), at(-8, -114), 6 * size, 4 * size), light(walker.hair))
        self.arm(canvas, at, -0.5 * np.sin(phase), size, coat * 0.88, skin)

    @staticmethod
    def arm(canvas, at, swing, size, sleeve, skin):
        elbow = np.array([24 * np.sin(swing), -106 + 24 * np.cos(swing)])
        bend = swing + 0.35
        hand = elbow + np.array([22 * np.sin(bend), 22 * np.cos(bend)])
        canvas.fill(limb(at(0, -106), at(*elbow), 5.6 * size, 4.8 * size), sleeve)
        canvas.fill(limb(at(*elbow), at(*hand), 4.6 * size, 3.6 * size), sleeve)
        canvas.fill(ellipse(*at(*hand), 4.2 * size), skin)

    def paint_background(self, canvas):
        x, y = canvas.points()
        canvas.cover(blend(light("#6fb2dd"), light("#cfe6ee"), y / 130), np.ones(x.shape, np.float32))
        houses = ((-10, 176, 74, "#e2a25c", "#3f6b5c"), (176, 372, 40, "#d9796a", "#f0e6d2"), (372, 540, 92, "#efdcae", "#4a7a9a"),
                  (540, 742, 54, "#9cb8a0", "#7a4436"), (742, 900, 30, "#e8c27e", "#51694a"), (900, 1040, 84, "#c98a86", "#dfe6e0"))
        for number, house in enumerate(houses):
            self.house(canvas, number, *house)
        plaster = cloud(x.shape, (x.shape[0] / 9, x.shape[1] / 14), 81, 6)
        walls = (y < PAVEMENT) & (y > 20)
        canvas.layer[..., :3] *= np.where(walls, 0.86 + 0.28 * plaster, 1)[..., None]
        self.ground(canvas, x, y)
        canvas.layer[..., :3] *= (1 - 0.22 * (((x - 480) / 700) ** 2 + ((y - 280) / 420) ** 2))[..., None]

    @staticmethod
    def box_of(left, top, right, bottom):
        return [(left, top), (right, top), (right, bottom), (left, bottom)]

    def house(self, canvas, number, left, right, top, wall, shutter):
        wall, shutter = light(wall), light(shutter)
        rect = lambda *sides: self.box_of(*sides)
        canvas.fill(rect(left, top, right, PAVEMENT), lambda u, v: blend(wall * 1.08, wall * 0.72, (v - top) / 420))
        canvas.fill(rect(left - 5, top - 10, right + 5, top), light("#8e4a34"))
        canvas.fill(rect(left - 5, top, right + 5, top + 4), light("#f3e6cf") * 0.85)
        canvas.fill(rect(left, top + 4, right, top + 13), light("#241812"), 0.35)
        canvas.fill(rect(left, top, left + 2, PAVEMENT), light("#241812"), 0.4)
        canvas.fill(rect(left, PAVEMENT - 26, right, PAVEMENT), light("#6d655c"), 0.75)
        count = 3 if right - left > 170 else 2
        for floor, sill in enumerate(np.arange(top + 92, PAVEMENT - 120, 92)):
            for column in range(count):
                centre = left + (right - left) * (column + 0.5) / count
                self.window(canvas, centre, sill, shutter, wall, (number + floor + column) % 3 == 0)
        door = left + (right - left) * (0.28 if number % 2 else 0.70)
        canvas.fill(rect(door - 21, PAVEMENT - 96, door + 21, PAVEMENT), wall * 0.45)
        canvas.fill(rect(door - 17, PAVEMENT - 92, door + 17, PAVEMENT), shutter * 0.55)
        canvas.fill(rect(door - 1, PAVEMENT - 92, door + 1, PAVEMENT), shutter * 0.25)
        shop = left + (right - left) * (0.68 if number % 2 else 0.28)
        canvas.fill(rect(shop - 34, PAVEMENT - 84, shop + 34, PAVEMENT - 24), light("#1d2a33"))
        canvas.fill([(shop - 30, PAVEMENT - 80), (shop - 4, PAVEMENT - 80), (shop - 24, PAVEMENT - 28), (shop - 30, PAVEMENT - 28)],
                    light("#7d97a3"), 0.5)
        for stripe in range(8):
            tone = light("#f5efe2") if stripe % 2 else (shutter if number % 2 == 0 else light("#b5453a"))
            a, b = shop - 40 + stripe * 10, shop - 30 + stripe * 10
            canvas.fill([(a + 4, PAVEMENT - 104), (b + 4 if b < shop + 40 else b - 4, PAVEMENT - 104), (b, PAVEMENT - 78), (a, PAVEMENT - 78)], tone)
        canvas.fill(rect(shop - 40, PAVEMENT - 78, shop + 40, PAVEMENT - 66), light("#181018"), 0.35)

    def window(self, canvas, x, sill, shutter, wall, flowers):
        rect = lambda *sides: self.box_of(*sides)
        canvas.fill(rect(x - 16, sill - 52, x + 16, sill), light("#f5ecda") * 0.9)
        canvas.fill(rect(x - 13, sill - 49, x + 13, sill - 2), lambda u, v: blend(light("#2b3d4c"), light("#7f9fb0"), (v - sill + 40) / 60))
        canvas.fill(rect(x - 1, sill - 49, x + 1, sill - 2), light("#f5ecda") * 0.9)
        canvas.fill(rect(x - 13, sill - 30, x + 13, sill - 28), light("#f5ecda") * 0.9)
        for a, b in ((x - 33, x - 16), (x + 16, x + 33)):
            canvas.fill(rect(a, sill - 53, b, sill + 1), shutter)
            for slat in np.arange(sill - 48, sill - 3, 5):
                canvas.fill(rect(a + 3, slat, b - 3, slat + 1.8), shutter * 0.55)
        canvas.fill(rect(x - 20, sill, x + 20, sill + 4), light("#efe4cf") * 0.8)
        canvas.fill([(x + 33, sill - 50), (x + 37, sill - 46), (x + 37, sill + 8), (x - 29, sill + 8), (x - 33, sill + 1), (x + 33, sill + 1)],
                    light("#2a1a14"), 0.28)
        if flowers:
            random = np.random.Generator(np.random.PCG64(int(x * 7 + sill)))
            for _ in range(34):
                tone = ("#3f6b34", "#4f8040", "#e0405a", "#f07a8a", "#f5d0d4")[random.integers(5)]
                canvas.fill(ellipse(x + random.uniform(-19, 19), sill - 2 + random.normal(0, 3.6), random.uniform(1.6, 3.4), corners=14), light(tone))

    @staticmethod
    def ground(canvas, x, y):
        below = (y >= PAVEMENT).astype(np.float32)
        depth = np.maximum(y - PAVEMENT + 26, 1)
        row = np.floor(26 * np.log(depth))
        along = (x - 512) / depth * 62 + 0.5 * (row % 2) * 9
        stone = np.floor(along / 9)
        tone = np.modf(np.abs(np.sin(row * 12.9898 + stone * 78.233)) * 43758.5)[0]
        part_x, part_y = np.abs(along / 9 - stone - 0.5) * 2, np.abs(26 * np.log(depth) - row - 0.5) * 2
        joint = np.clip((np.maximum(part_x, part_y) - 0.74) * 6, 0, 1)
        colour = blend(light("#a89a8a"), light("#cbbba4"), tone) * (0.74 + 0.002 * (y - PAVEMENT))[..., None]
        colour = blend(colour, colour * 0.42, joint)
        sun = np.clip((y - PAVEMENT - 26 - 0.05 * (x - 300)) / 5, 0, 1)
        colour = colour * (0.52 + 0.48 * sun)[..., None] * blend((0.86, 0.92, 1.12), (1.04, 1, 0.92), sun)
        canvas.cover(colour, below)
        canvas.fill([(0, PAVEMENT), (WIDTH, PAVEMENT), (WIDTH, PAVEMENT + 4), (0, PAVEMENT + 4)], light("#4c443c"), 0.8)
