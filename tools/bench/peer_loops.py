#!/usr/bin/env python3
"""What people write today to expose a clip, as programs of their own that tools/bench/peers.py times.

    peer_loops.py loop CLIP PICTURE          the mean of all frames in light: OpenCV, a table, an accumulator
    peer_loops.py regions CLIP PICTURE       16 regions of a mask, each with a gain of its own at each frame
    peer_loops.py decode CLIP                prints the seconds of decoding it with OpenCV, nothing else done
    peer_loops.py loop|regions --memory CLIP [LIGHT.npy]
                                             prints the seconds of the arithmetic alone, on decoded frames; may keep
                                             the light
"""

import argparse
import time

import cv2
import numpy as np

REGIONS = 16


def srgb_light():
    """Light of each 8-bit code, IEC 61966-2-1."""
    code = np.arange(256) / 255.0
    return np.where(code <= 0.04045, code / 12.92, ((code + 0.055) / 1.055) ** 2.4).astype(np.float32)


def srgb_codes(light):
    light = np.clip(light, 0.0, 1.0)
    code = np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
    return np.floor(code * 255.0 + 0.5).astype(np.uint8)


def frames_of(path):
    clip = cv2.VideoCapture(path)
    while True:
        there, frame = clip.read()
        if not there:
            return
        yield frame


def region_mask(height, width):
    """Vertical stripes, so that neighbouring pixels mostly share a region."""
    return np.broadcast_to(np.arange(width) * REGIONS // width, (height, width))


def expose(frames, kind, count):
    """The picture of a clip of `count` frames, in light."""
    table = srgb_light()
    total = None
    gains = np.random.default_rng(1).random((count, REGIONS), dtype=np.float32)
    gains /= gains.sum(axis=0)
    for number, frame in enumerate(frames):
        if total is None:
            total = np.zeros(frame.shape, np.float32)
            mask = region_mask(*frame.shape[:2])
        light = cv2.LUT(frame, table)
        if kind == "loop":
            cv2.accumulate(light, total)
        else:
            total += light * gains[number][mask][..., None]
    return total / count if kind == "loop" else total


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kind", choices=("loop", "regions", "decode"))
    parser.add_argument("--memory", action="store_true")
    parser.add_argument("clip")
    parser.add_argument("picture", nargs="?")
    arguments = parser.parse_args()
    if arguments.kind == "decode":
        start = time.perf_counter()
        for _ in frames_of(arguments.clip):
            pass
        print(time.perf_counter() - start)
        return
    count = int(cv2.VideoCapture(arguments.clip).get(cv2.CAP_PROP_FRAME_COUNT))
    if not arguments.memory:
        cv2.imwrite(arguments.picture, srgb_codes(expose(frames_of(arguments.clip), arguments.kind, count)))
        return
    frames = list(frames_of(arguments.clip))
    start = time.perf_counter()
    light = expose(frames, arguments.kind, count)
    print(time.perf_counter() - start)
    if arguments.picture:
        np.save(arguments.picture, light)


if __name__ == "__main__":
    main()
