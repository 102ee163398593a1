"""Files that go in and out: float pictures (PFM), masks (PGM), PNG pictures and video clips.

Arrays are H x W x C, row 0 at the top, channels in the order red, green, blue (or one grey).
"""

import json
import subprocess

import cv2
import numpy as np


def read_pfm(path):
    """A PFM picture, float64 H x W x C. The file's first row is the bottom one."""
    with open(path, "rb") as file:
        data = file.read()
    kind, size, scale, rest = _pfm_header(data)
    channels = {b"PF": 3, b"Pf": 1}[kind]
    width, height = (int(text) for text in size.split())
    order = "<" if float(scale) < 0 else ">"
    if len(rest) != 4 * width * height * channels:
        raise ValueError(f"{path}: {len(rest)} bytes for {width} x {height} x {channels} floats")
    rows = np.frombuffer(rest, dtype=order + "f4").reshape(height, width, channels)
    return rows[::-1].astype(np.float64)


def _pfm_header(data):
    """Kind, size, scale and the bytes after the third line's end."""
    kind, rest = data.split(b"\n", 1)
    size, rest = rest.split(b"\n", 1)
    scale, rest = rest.split(b"\n", 1)
    return kind.strip(), size, scale, rest


def write_pfm(path, picture):
    """Write light, H x W x C, as a little-endian PFM."""
    height, width, channels = picture.shape
    with open(path, "wb") as file:
        file.write(f"{'PF' if channels == 3 else 'Pf'}\n{width} {height}\n-1.0\n".encode())
        file.write(picture[::-1].astype("<f4").tobytes())


def read_codes(path):
    """A PNG picture's codes as stored, integers H x W x C."""
    codes = cv2.imread(str(path), cv2.IMREAD_UNCHANGED)
    if codes is None:
        raise ValueError(f"{path}: no picture that can be read")
    return codes[:, :, None] if codes.ndim == 2 else codes[:, :, ::-1]


def read_mask(path):
    """A mask, uint8 H x W."""
    return read_codes(path)[:, :, 0]


def write_pgm(path, mask):
    """Write a mask, uint8 H x W, as a binary PGM."""
    height, width = mask.shape
    with open(path, "wb") as file:
        file.write(f"P5\n{width} {height}\n255\n".encode() + mask.tobytes())


# What red and blue weigh in luma.
LUMA_WEIGHTS = {"bt601": (0.299, 0.114), "bt709": (0.2126, 0.0722)}
MATRIX_NAMES = {"bt709": "bt709", "smpte170m": "bt601", "bt470bg": "bt601"}
LINES_OF_HIGH_DEFINITION = 720


def rgb_of_yuv(y, u, v, matrix, is_full):
    """8-bit RGB of planes of one size, as docs/explanation/model.md has it."""
    red, blue = LUMA_WEIGHTS[matrix]
    green = 1 - red - blue
    luma, chroma = (1, 1) if is_full else (255 / 219, 255 / 224)
    whole = lambda weight, bits: int(np.floor(weight * 2**bits + 0.5))
    of_chroma = lambda weight: whole(weight * chroma, 16)
    light = 64 * whole(luma, 14) * y.astype(np.int32) >> 14  # below 2^31, as all below
    black = 0 if is_full else 16 * 4 * whole(luma, 14)
    u, v = u.astype(np.int32) - 128, v.astype(np.int32) - 128
    parts = (v * of_chroma(2 * (1 - red)),
             -u * of_chroma(blue / green * 2 * (1 - blue)) - v * of_chroma(red / green * 2 * (1 - red)),
             u * of_chroma(2 * (1 - blue)))
    codes = (light + (64 * (part - black + 2**15) + 2**16 >> 16) >> 6 for part in parts)
    return np.stack([np.clip(code, 0, 255) for code in codes], axis=-1).astype(np.uint8)


class YuvVideo:
    """Decodes 4:2:0 of 8 bits with the ffmpeg command, and makes RGB of it here."""

    def __init__(self, path, stream):
        self._width, self._height = stream["width"], stream["height"]
        usual = "bt709" if self._height >= LINES_OF_HIGH_DEFINITION else "bt601"
        self._matrix = MATRIX_NAMES.get(stream.get("color_space"), usual)
        self._is_full = stream["pix_fmt"] == "yuvj420p" or stream.get("color_range") == "pc"
        self._decoder = subprocess.Popen(
            ["ffmpeg", "-v", "error", "-i", path, "-fps_mode", "passthrough", "-f", "rawvideo", "-pix_fmt",
             stream["pix_fmt"], "-"], stdout=subprocess.PIPE)

    @staticmethod
    def stream_of(path):
        """What ffprobe says of a file's pictures, where they are of this kind; else None."""
        wanted = "stream=width,height,pix_fmt,color_space,color_range"
        said = subprocess.run(["ffprobe", "-v", "error", "-select_streams", "v:0", "-show_entries", wanted, "-of",
                               "json", path], capture_output=True, check=True)
        stream = json.loads(said.stdout)["streams"][0]
        return stream if stream["pix_fmt"] in ("yuv420p", "yuvj420p") else None

    def read(self):
        """The next sample, or None."""
        across, down = (self._width + 1) // 2, (self._height + 1) // 2
        data = self._decoder.stdout.read(self._width * self._height + 2 * across * down)
        if not data:
            return None
        codes = np.frombuffer(data, np.uint8)
        y, chroma = codes[:self._width * self._height].reshape(self._height, self._width), codes[self._width * self._height:]
        u, v = (plane.reshape(down, across).repeat(2, 0).repeat(2, 1)[:self._height, :self._width]
                for plane in np.split(chroma, 2))
        return rgb_of_yuv(y, u, v, self._matrix, self._is_full)


class RgbVideo:
    """Decodes pictures that hold RGB."""

    def __init__(self, path):
        self._video = cv2.VideoCapture(path)

    def read(self):
        read, codes = self._video.read()
        return np.ascontiguousarray(codes[:, :, ::-1]) if read else None


class Clip:
    """A video file's samples, decoded as far as they are asked for and kept.

    `clip[k]` is sample k, uint8 H x W x 3; `len(clip)` decodes the whole file once to count, since
    what containers say about their length is not always so.
    """

    def __init__(self, path):
        self.path = str(path)
        self._opened = self._open()
        stream = YuvVideo.stream_of(self.path)
        self._video = YuvVideo(self.path, stream) if stream else RgbVideo(self.path)
        self._samples = []
        self._count = None

    def _open(self):
        video = cv2.VideoCapture(self.path)
        if not video.isOpened():
            raise ValueError(f"{self.path}: no video that can be read")
        return video

    def rate(self):
        """The rate that the file states, samples a second."""
        return self._opened.get(cv2.CAP_PROP_FPS)

    def __len__(self):
        if self._count is None:
            video = self._open()
            self._count = 0
            while video.grab():
                self._count += 1
        return self._count

    def __getitem__(self, k):
        while len(self._samples) <= k:
            codes = self._video.read()
            if codes is None:
                raise IndexError(k)
            self._samples.append(codes)
        return self._samples[k]


def write_lossless(path, samples, rate="25", deep="gray16le"):
    """Write samples, N x H x W x C of uint8 or one-channel uint16, as FFV1 in Matroska; uint16 as
    pixels of the kind `deep`.

    Nothing is lost and no colour is converted, so that the array is what the file holds. Needs
    the ffmpeg command.
    """
    count, height, width, channels = samples.shape
    if samples.dtype == np.uint16:
        raw, stored, data = deep, deep, samples.astype("<u2")
    elif channels == 1:
        raw, stored, data = "gray", "gray", samples
    else:
        blank = np.zeros((count, height, width, 1), np.uint8)
        raw, stored, data = "bgr0", "bgr0", np.concatenate([samples[..., ::-1], blank], axis=3)
    subprocess.run(["ffmpeg", "-v", "error", "-y", "-f", "rawvideo", "-pix_fmt", raw,
                    "-s", f"{width}x{height}", "-r", rate, "-i", "-", "-c:v", "ffv1",
                    "-pix_fmt", stored, str(path)], input=data.tobytes(), check=True)
