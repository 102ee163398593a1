"""Recorded clips' pictures one at a time: a boxcar over exactly sample k must give the codes that
OpenCV decodes, to the last one, wherever in the file the program starts to read."""

import pictures

# Clip -> samples. Late ones make the program seek; the neighbours of the middle catch one that
# lands a picture off.
CLIPS = {
    "bicycle-wheel.mp4": (0, 1, 208, 209, 417),
    "BallTossOut.mp4": (0, 15, 31),
    "bikes.mp4": (100, 124, 249),
    "bulk-water.mov": (0, 241, 479),
    "realshort.mp4": (0, 20, 35),
}


def run(checks, media):
    checks.begin("decoding", "One sample of a recorded clip gives its codes back")
    folder = checks.folder("decoding")
    for name, samples in CLIPS.items():
        clip = pictures.Clip(media / name)
        for k in samples:
            arguments = ["-f30", "--start", f"{k}f", "--exposure", "1f", media / name]
            checks.codes_are(f"{name}, sample {k}", folder, arguments, clip[k])
