"""Every command of the paper on real clips, written as the paper writes it (file names apart from
clips are the paper's own), and the same exposures straight from the clip."""

import os
import shutil

import numpy as np

import figures
import functions as gain_functions
import pictures
import timeline as timelines
from expose import expose

# clip: file name. first: options of the paper's first command, which gives no rate; rate: the rate
# in use then. orange: options for OrangeFast.tik, at a rate that puts Figure 4's 1.5 s within the
# clip. The paper doesn't print that command.
CLIPS = [
    {"clip": "bicycle-wheel.mp4", "first": ["-f300"], "rate": "300",
     "orange": ["-f240", "-a180"], "orange_rate": ("240", "180")},
    {"clip": "BallTossOut.mp4", "first": [], "rate": "30",
     "orange": ["-f20"], "orange_rate": ("20", "360")},
    {"clip": "one-by-one-person-detection.mp4", "first": [], "rate": "10",
     "orange": ["-f720", "-a90"], "orange_rate": ("720", "90")},
]


def run(checks, media, wanted):
    """The clips whose section's name contains `wanted`."""
    for plan in CLIPS:
        if wanted in section_of(plan):
            one_clip(checks, media, plan)


def section_of(plan):
    return "paper-" + plan["clip"].split(".")[0]


def one_clip(checks, media, plan):
    section = section_of(plan)
    checks.begin(section, f"The paper's commands on {plan['clip']}")
    folder = checks.folder(section)
    for name in ("Clipname.mp4", "ClipName.mp4", "BallRollCrop.mp4"):
        link(media / plan["clip"], folder / name)
    clip = pictures.Clip(media / plan["clip"])
    before = checks.failures
    masks = write_masks(folder, clip[0].shape[:2])
    write_functions(folder)
    paper_commands(checks, folder, clip, masks, plan)
    straight_from_the_clip(checks, folder, clip, masks)
    with_tolerance(checks, folder, clip, masks)
    if checks.failures == before:  # hundreds of megabytes, wanted only to look into a failure
        shutil.rmtree(folder)


def link(target, name):
    """A link, replacing what an earlier run left."""
    if name.is_symlink() or name.exists():
        os.unlink(name)
    os.symlink(target, name)


def write_masks(folder, shape):
    """Mask files: {name: uint8 H x W}. Regions have edges that are no multiple of a power of 2."""
    height, width = shape
    regions = np.zeros(shape, np.uint8)
    regions[: height // 3, : width // 3] = 64
    regions[height // 5:, width // 2 + 3: width - 7] = 128
    regions[height // 2 + 1:, : width // 5] = 196
    regions[::7, 5::11] = 255
    masks = {"Mask.pgm": regions, "BallMask.pgm": regions[::-1, ::-1].copy(),
             "AllZero.pgm": np.zeros(shape, np.uint8), "1080128.pgm": np.full(shape, 128, np.uint8)}
    for name, mask in masks.items():
        pictures.write_pgm(folder / name, mask)
    return masks


def write_functions(folder):
    for name, text in (("FnFile.fn", figures.FIGURE_16), ("FeatureExtraction.fn", figures.FIGURE_4),
                       ("Ball12.fn", figures.FIGURE_7), ("BallComposite.fn", figures.FIGURE_14),
                       ("Restored.fn", figures.FIGURE_14_RESTORED)):
        (folder / name).write_text(text)


def expected_picture(folder, clip, rate, angle, functions, mask, tolerance=0):
    timeline = timelines.constant_rate(len(clip), rate, angle)
    read = gain_functions.read_functions(folder / functions)
    return expose(clip, timeline, read, mask, tolerance=tolerance)


def paper_commands(checks, folder, clip, masks, plan):
    """The seven commands, each exposure once to a PNG that the program names and once to a PFM."""

    def exposed(arguments, rate, angle, functions, mask):
        expected = expected_picture(folder, clip, rate, angle, functions, masks[mask])
        checks.expose_both(" ".join(arguments), folder, arguments, expected)

    def encoded(arguments, output):
        (folder / output).unlink(missing_ok=True)
        run = checks.run(folder, *arguments)
        checks.holds(" ".join(arguments), (folder / output).exists(), f"wrote {output}",
                     run.command)

    encoded([*plan["first"], "Clipname.mp4", "ClipName.tik"], "ClipName.tik")
    exposed(["-mMask.pgm", "-kFnFile.fn", "ClipName.tik"], plan["rate"], "360", "FnFile.fn",
            "Mask.pgm")
    encoded(["-f120", "-a180", "ClipName.mp4", "ClipName.tik"], "ClipName.tik")
    exposed(["-mMask.pgm", "-kFnFile.fn", "ClipName.tik"], "120", "180", "FnFile.fn", "Mask.pgm")
    encoded([*plan["orange"], "ClipName.mp4", "OrangeFast.tik"], "OrangeFast.tik")
    exposed(["-m./AllZero.pgm", "-k./FeatureExtraction.fn", "OrangeFast.tik"], *plan["orange_rate"],
            "FeatureExtraction.fn", "AllZero.pgm")
    encoded(["-f960", "-a200", "-oBallRoll.tik", "BallRollCrop.mp4"], "BallRoll.tik")
    for arguments, functions, mask in (
            (["-m1080128.pgm", "-kBall12.fn"], "Ball12.fn", "1080128.pgm"),
            (["-mBallMask.pgm", "-kBallComposite.fn"], "BallComposite.fn", "BallMask.pgm"),
            (["-mBallMask.pgm", "-kRestored.fn"], "Restored.fn", "BallMask.pgm")):
        exposed([*arguments, "BallRoll.tik"], "960", "200", functions, mask)


def straight_from_the_clip(checks, folder, clip, masks):
    """-f300 on the clip itself, with no .tik between."""
    for functions, mask in (("Ball12.fn", "1080128.pgm"), ("Restored.fn", "Mask.pgm")):
        expected = expected_picture(folder, clip, "300", "360", functions, masks[mask])
        arguments = [f"-m{mask}", f"-k{functions}", "-f300", "ClipName.mp4"]
        checks.expose_both(" ".join(arguments), folder, arguments, expected)


def with_tolerance(checks, folder, clip, masks):
    """Held codes on real pictures: tolerance 4, with gaps."""
    expected = expected_picture(folder, clip, "960", "180", "Ball12.fn", masks["1080128.pgm"], 4)
    options = ["-f960", "-a180", "--tolerance", "4"]
    arguments = ["-m1080128.pgm", "-kBall12.fn"]
    checks.expose_float("tolerance 4, the clip", folder, arguments + options + ["ClipName.mp4"],
                        expected)
    checks.run(folder, "-q", *options, "ClipName.mp4", "Tolerant.tik")
    checks.expose_float("tolerance 4, .tik", folder, arguments + ["Tolerant.tik"], expected)
