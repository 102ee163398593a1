"""The colours of plots: those of Okabe and Ito, which stay apart for every kind of colour vision.

What the colour says is also said by shape, for those who see none and for prints in grey: areas that take
light away are hatched, held ends dashed, the live interval is a bar.
"""

LINE_COLOURS = {1: "#0072b2", -1: "#d55e00", 0: "#505050"}  # blue, vermillion; by sign
AREA_OPACITY = 0.35
HATCHES = {1: None, -1: "////"}
LIVE_COLOUR = "#009e73"  # bluish green
ACTIVITY_COLOUR = "#cc79a7"  # reddish purple
ACTIVITY_OPACITY = 0.45
ACTIVITY_TEXT_COLOUR = "#8f4a72"  # the same, dark enough to read
EXPOSURE_COLOUR = "#fbf7cf"  # a tint of yellow
OUTSIDE_COLOUR = "#e6e6e6"
GRID_COLOUR = "#d4d4d4"
SAMPLE_COLOUR = "#b4b49c"
ZERO_COLOUR = "#b4b4b4"
NOTE_COLOUR = "#505050"
HELD_DASHES = (0, (4, 2.5))
