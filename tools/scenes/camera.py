"""The still camera that films scenes: sensor noise, sRGB codes, a lossless clip (HuffYUV in Matroska: a third of raw,
and several times as fast to write and to read as FFV1).

Light is in [0, 1], float32, RGB; codes are 0 ... 255. A scene holds

    fps, frame_count   pictures a second, and how many: picture k is open from k / fps to (k + 1) / fps seconds
    background         [height, width, 3] light where nothing moves
    draw(k)            (rows, columns, light): what picture k shows in a rectangle; elsewhere it is the background
"""

import os
from concurrent.futures import ThreadPoolExecutor
from itertools import islice

import cv2
import numpy as np

READ_VARIANCE = 6.4e-7  # of light where it is dark: 0.4 codes at a mid-grey
SHOT_VARIANCE = 1.6e-6  # times light: what photons add
LEVELS = 1 << 14        # steps of light that become codes
PROBE_FRAMES = 4        # read back from the file, to see that it is lossless


def srgb_codes(light):
    """Light -> 8-bit sRGB codes as real numbers (IEC 61966-2-1), not yet rounded; NaN stays NaN."""
    light = np.clip(np.asarray(light, np.float64), 0, 1)
    return 255 * np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)


def srgb_light(codes):
    """8-bit sRGB codes -> light."""
    value = np.asarray(codes, np.float64) / 255
    return np.where(value <= 0.04045, value / 12.92, ((value + 0.055) / 1.055) ** 2.4)


def noise_sigma(light):
    """Standard deviation in light of one sample: read noise and shot noise."""
    return np.sqrt(READ_VARIANCE + SHOT_VARIANCE * light)


CODE_OF_LEVEL = np.rint(srgb_codes(np.arange(LEVELS) / (LEVELS - 1))).astype(np.uint8)


def expose(light, seed, frame):
    """The codes [height, width, 3] of one picture. The noise depends on the seed and the frame's number only."""
    random = np.random.Generator(np.random.SFC64([seed, frame]))
    noisy = random.standard_normal(light.shape, dtype=np.float32)
    noisy *= noise_sigma(light)
    noisy += light
    noisy *= LEVELS - 1
    noisy += 0.5
    np.clip(noisy, 0, LEVELS - 1, out=noisy)
    return CODE_OF_LEVEL[noisy.astype(np.uint16)]


def picture(scene, seed, frame):
    """The codes of picture `frame` of a scene."""
    light = scene.background.copy()
    rows, columns, patch = scene.draw(frame)
    light[rows, columns] = patch
    return expose(light, seed, frame)


def film(scene, seed, path):
    """Writes the clip, under another name until it is complete and its first pictures came back code for code."""
    height, width = scene.background.shape[:2]
    unfinished = path.with_name("unfinished-" + path.name)
    clip = cv2.VideoWriter(str(unfinished), cv2.CAP_FFMPEG, cv2.VideoWriter_fourcc(*"HFYU"), scene.fps, (width, height))
    if not clip.isOpened():
        raise OSError(f"{unfinished} cannot be written: OpenCV has no HuffYUV encoder here, or the folder is missing")
    probes = []
    for codes in pictures_in_order(scene, seed, os.cpu_count() or 1):
        clip.write(np.ascontiguousarray(codes[..., ::-1]))  # OpenCV takes BGR
        if len(probes) < PROBE_FRAMES:
            probes.append(codes)
    clip.release()
    check_lossless(unfinished, probes)
    unfinished.replace(path)


def pictures_in_order(scene, seed, threads):
    """Yields the pictures, drawn a few ahead by a pool of threads."""
    with ThreadPoolExecutor(threads) as pool:
        frames = iter(range(scene.frame_count))
        waiting = [pool.submit(picture, scene, seed, frame) for frame in islice(frames, 2 * threads)]
        while waiting:
            yield waiting.pop(0).result()
            waiting += [pool.submit(picture, scene, seed, frame) for frame in islice(frames, 1)]


def check_lossless(path, expected):
    """Raises OSError where the clip's first pictures differ from those that were written."""
    clip = cv2.VideoCapture(str(path), cv2.CAP_FFMPEG)
    for frame, codes in enumerate(expected):
        found, stored = clip.read()
        if not found or not np.array_equal(stored[..., ::-1], codes):
            raise OSError(f"{path}: picture {frame} does not come back code for code: OpenCV converts it here")


def write_picture(path, codes):
    """An 8-bit picture, grey or RGB, in the format that the name says."""
    if not cv2.imwrite(str(path), codes if codes.ndim == 2 else codes[..., ::-1]):
        raise OSError(f"{path} cannot be written")
