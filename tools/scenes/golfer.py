"""A golfer's swing against a dark backdrop, lit from the side."""

import numpy as np

from .painting import PaintedScene, blend, cloud, ellipse, limb, light

GROUND = 512.0
SHOULDER = np.array([498.0, 238.0])
ARM, CLUB = 96.0, 172.0
BALL = np.array([578.0, GROUND - 5])
IMPACT_S = 0.62

# seconds, angle of the arms, angle of the club: degrees from straight down, positive towards the right, where the
# ball flies. Between them angles follow a smooth curve.
SWING = np.array([
    (0.00, -172, -298), (0.12, -172, -300), (0.30, -150, -272), (0.42, -108, -214), (0.50, -62, -140),
    (0.57, -16, -50), (0.62, 12, 16), (0.68, 58, 92), (0.76, 116, 186), (0.88, 160, 262), (1.10, 176, 292), (1.30, 178, 296)])
SHIRT, SKIN, TROUSERS, SHOE = light("#d9dde2"), light("#c98f6a"), light("#565f74"), light("#e8e4da")
STEEL, HEAD = light("#f4f7ff"), light("#ffffff")


class Golfer(PaintedScene):
    name = "golfer"
    summary = "a golf swing of a second; the club meets the ball at 0.62 s"
    fps = 240
    seconds = 1.25

    @staticmethod
    def angles(seconds):
        """Of arms and club at a time, in radians."""
        times = SWING[:, 0]
        slopes = np.gradient(SWING[:, 1:], times, axis=0)
        slopes[[0, -1]] = 0
        k = int(np.clip(np.searchsorted(times, seconds) - 1, 0, len(times) - 2))
        length = times[k + 1] - times[k]
        s = (seconds - times[k]) / length
        here, there = SWING[k, 1:], SWING[k + 1, 1:]
        value = ((1 + 2 * s) * (1 - s) ** 2 * here + s * (1 - s) ** 2 * length * slopes[k]
                 + s * s * (3 - 2 * s) * there + s * s * (s - 1) * length * slopes[k + 1])
        return np.radians(value)

    def joints(self, seconds):
        arms, club = self.angles(seconds)
        turn = np.clip(arms / np.pi, -1, 1)
        shoulder = SHOULDER + np.array([16 * turn, 6 * abs(turn)])
        hands = shoulder + ARM * np.array([np.sin(arms), np.cos(arms)])
        head = hands + CLUB * np.array([np.sin(club), np.cos(club)])
        return shoulder, hands, head, turn

    def ball(self, seconds):
        fly = max(0.0, seconds - IMPACT_S)
        return BALL + np.array([2300 * fly, -880 * fly + 400 * fly * fly])

    def box(self, seconds):
        right = self.ball(seconds)[0] + 12 if seconds > IMPACT_S - 0.01 else 620
        return 190, 4, min(1024, max(right, 800)), GROUND + 8

    def paint(self, canvas, seconds):
        shoulder, hands, head, turn = self.joints(seconds)
        hip = np.array([486 + 14 * turn, 356])
        lit = lambda colour: (lambda u, v: blend(colour * 0.05, colour, (u - hip[0] + 34) / 74))
        for side, foot_x, knee_x in ((-1, 450, 452), (1, 540, 528)):
            knee = np.array([knee_x + 9 * turn, 432])
            foot = np.array([foot_x, GROUND - 8])
            canvas.fill(limb(hip + (12 * side, 0), knee, 21, 15), lit(TROUSERS))
            canvas.fill(limb(knee, foot, 15, 10), lit(TROUSERS))
            canvas.fill(limb(foot + (-3, 2), foot + (20, 4), 8, 6), lit(SHOE))
        canvas.fill(limb(hip, shoulder + (-8, 4), 27, 33), lit(SHIRT))
        face = shoulder + np.array([10 - 4 * turn, -52])
        canvas.fill(limb(shoulder + (0, -14), face, 11, 11), lit(SKIN))
        canvas.fill(ellipse(*face, 20, 24), lit(SKIN))
        cap = [(face[0] - 22, face[1] - 4), (face[0] - 18, face[1] - 20), (face[0], face[1] - 28), (face[0] + 17, face[1] - 20),
               (face[0] + 38, face[1] - 5), (face[0] + 20, face[1] - 6)]
        canvas.fill(cap, lit(light("#b8402f")))
        elbow = (shoulder + hands) / 2
        for offset in (-10, 10):
            begin = shoulder + (offset * (1 - abs(turn)), 0)
            canvas.fill(limb(begin, elbow + (offset * 0.6, 0), 12, 9), light("#c3c9d1") * 0.7)
            canvas.fill(limb(elbow + (offset * 0.6, 0), hands, 8, 6.5), SKIN * 0.8)
        canvas.fill(limb(hands, head, 2.6, 1.5), STEEL)
        canvas.fill(ellipse(*hands, 9), SKIN)
        along = (head - hands) / CLUB
        across = np.array([-along[1], along[0]]) * -1
        canvas.fill([head - along * 4 - across * 2, head + along * 9 - across * 3, head + along * 10 + across * 15,
                     head + across * 17 - along * 1], HEAD)
        canvas.fill(ellipse(*self.ball(seconds), 5.5, corners=24), light("#ffffff"))

    def paint_background(self, canvas):
        x, y = canvas.points()
        base = light("#0a0c12") + np.zeros((*x.shape, 3), np.float32)
        base += light("#24406a") * (0.30 * np.exp(-((x - 640) / 330) ** 2 - ((y - 300) / 270) ** 2))[..., None]
        base *= (0.9 + 0.2 * cloud(x.shape, (x.shape[0] / 3, x.shape[1] / 5), 6, 5))[..., None]
        grass = blend(light("#123222"), light("#05100c"), (y - GROUND) / 60 + abs(x - 600) / 700)
        blades = cloud(x.shape, (10 * canvas.scale[1], 3 * canvas.scale[0]), 13, 3)
        grass = grass * (0.55 + 0.9 * blades)[..., None]
        edge = np.clip((y - GROUND + 8 * (blades - 0.5) * 2) / 2, 0, 1)
        canvas.cover(blend(base, grass, edge), np.ones(x.shape, np.float32))
        canvas.fill([(BALL[0] - 1.5, BALL[1] + 4), (BALL[0] + 1.5, BALL[1] + 4), (BALL[0] + 1.5, GROUND + 5),
                     (BALL[0] - 1.5, GROUND + 5)], light("#d8a35a"))
