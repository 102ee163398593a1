"""Gain functions of the paper's figures, times in nanoseconds, for tools/scenes/rolling_ball.py."""

FIGURE_4 = """\
The paper's Figure 4 (FeatureExtraction.fn): a difference picture. What was there just before and just after is taken
away from what is there between 633 and 667 ms. A still scene is left at a quarter of its light.
The paper's times are 0.9 s later; its gain rises along a ramp, as printed here, where its text speaks of a step.

M0{[0:0.0], [600000000:0.0], [600000001:-0.5], [616666000:-0.5], [633332000:1],
   [666665000:1], [666665001:-0.5], [683331000:-0.5], [683331001:0.0], [1200000000:0.0]}
"""

FIGURE_7 = """\
The paper's Figure 7 (BallMultiple.fn): a multiple exposure. The shutter opens four times, for 10 ms each.
For a mask that is 128 everywhere.

M128{[0:1], [10000000:1], [10000001:0], [399999999:0], [400000000:1], [410000000:1], [410000001:0],
     [799999999:0], [800000000:1], [810000000:1], [810000001:0], [999999999:0], [1000000000:1],
     [1010000000:1], [1010000001:0]}
"""

REGIONS = """\
M64{[0:1], [10000000:1], [10000001:0], [1000000000:0]}
M128{[0:0], [399999999:0], [400000000:1], [410000000:1], [410000001:0], [1000000000:0]}
M196{[0:0], [799999999:0], [800000000:1], [810000000:1], [810000001:0], [1000000000:0]}
M255{[0:0], [999999999:0], [1000000000:1], [1010000000:1], [1010000001:0]}
"""

FIGURE_14 = """\
The paper's Figure 14 (BallComposite.fn): a motion study with five regions. Four show the ball for 10 ms each;
around them, 0, the ball's whole way is exposed. The weight of -25 at its end takes away the ball where it lies.
The paper prints [100000000:1], a tenth of the time and surely a lost zero: the gain would fall from there on.

M0{[0:0], [1:1], [1000000000:1], [1000000002:-25], [1010000000:-25], [1010000001:0]}
""" + REGIONS

FIGURE_16 = """\
The paper's Figure 16 (BallCompositeOneBlur.fn): as Figure 14, but around the ball's pictures the gain rises from 0.6 s
on and ends at 0.8 s: a trail that grows into one of the pictures.

M0{[0:0], [600000000:0], [800000000:2], [800000001:0], [1000000000:0]}
""" + REGIONS

FUNCTIONS = {"difference": FIGURE_4, "strobe": FIGURE_7, "motion-study": FIGURE_14, "one-blur": FIGURE_16}
