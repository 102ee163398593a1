"""More than 8 bits, and times of their own: recorded stills and camera files, deep video and a clip
of variable frame rate, exposed with a mask and several functions by kernel, reference and script."""

import subprocess
from fractions import Fraction

import cv2
import numpy as np

import functions as gain_functions
import pictures
import sources
import timeline as timelines
from cases_small import random_samples
from expose import expose

MASK_VALUES = (0, 7, 128, 255)
WAYS = [("opencl", []), ("reference", ["--renderer", "reference"])]


def recorded(checks, media):
    """The cases that need the recorded files."""
    checks.begin("deep", "Recorded stills, camera files and video of more than 8 bits")
    ball = np.array([cv2.imread(str(media / "ball_12bit_png" / f"ball_{k:02}.png"),
                                cv2.IMREAD_UNCHANGED) for k in range(1, 16)])[..., None]
    check_mraw(checks, media, ball)
    constant(checks, "ball_12bit_png", ball, 4095, "linear", ("30000", "216"),
             ["--white", "4095"], media / "ball_12bit_png")
    constant(checks, "ball_12bit_png, srgb", ball, 4095, "srgb", ("30000", "216"),
             ["--white", "4095", "--transfer", "srgb"], media / "ball_12bit_png" / "ball_%02d.png")
    constant(checks, "stuck.tif", sources.read_tiff(media / "stuck.tif"), 65535, "linear",
             ("12.5", "360"), [], media / "stuck.tif")
    for name in ("cine_781.cine", "data_small_cine.cine"):
        samples, bits, _ = sources.read_cine(media / name)
        constant(checks, name, samples, 2**bits - 1, "linear", ("1000", "90"), [], media / name)
    camera_times(checks, media / "cine_781.cine")
    ten_bits(checks, media / "sparks_ref_480x270.yuv42010le.yuv")


def generated(checks):
    """The cases that generate their clips."""
    checks.begin("vfr", "Variable frame rate, and deep RGB")
    variable_rate(checks)
    deep_rgb(checks)


def check_mraw(checks, media, ball):
    """The PNGs, which OpenCV read here as in the program, hold what the camera wrote."""
    packed = np.fromfile(media / "ball_12bit.mraw", np.uint8).reshape(-1, 3).astype(np.uint16)
    first = packed[:, 0] << 4 | packed[:, 1] >> 4
    second = (packed[:, 1] & 15) << 8 | packed[:, 2]
    codes = np.stack([first, second], axis=1).reshape(ball.shape)
    checks.holds("ball_12bit_png holds the codes of ball_12bit.mraw", np.array_equal(codes, ball),
                 f"{ball.size} codes of 12 bits")


def constant(checks, name, samples, white, transfer, rate_angle, options, source):
    """A source at a stated rate and angle."""
    rate, angle = rate_angle
    timeline = timelines.constant_rate(len(samples), rate, angle)
    source_options = ["-f", rate, "-a", angle, *options]
    both_ways(checks, name, samples, white, transfer, timeline, source_options, source)


def both_ways(checks, name, samples, white, transfer, timeline, source_options, source):
    """Functions and mask, from a .tik and straight from the source; and single samples' codes."""
    folder = checks.folder("deep-" + name.split(".")[0].split(",")[0])
    text = function_file(timeline)
    (folder / "gains.fn").write_text(text)
    mask = stripes(samples.shape[1:3])
    pictures.write_pgm(folder / "mask.pgm", mask)
    expected = expose(samples, timeline, gain_functions.parse_functions(text), mask, transfer, white)
    exposure = ["-m", "mask.pgm", "-k", "gains.fn"]
    checks.expose_float(f"{name}: the source", folder, [*source_options, *exposure, source],
                        expected)
    (folder / "clip.tik").unlink(missing_ok=True)
    checks.run(folder, "encode", "-q", *source_options, source, "clip.tik")
    found = {}
    for way, options in WAYS:
        path = checks.expose_float(f"{name}: .tik, {way}", folder,
                                   [*exposure, *options, "clip.tik"], expected)
        found[way] = pictures.read_pfm(path) if path.exists() else np.zeros(0)
    kernel_is_reference(checks, name, found["opencl"], found["reference"])
    path = folder / "codes.png"
    path.unlink(missing_ok=True)
    for way, shown, most in (("source", transfer, white), ("srgb", "srgb", 65535)):
        run = checks.run(folder, *exposure, "--out-transfer", way, "clip.tik", "-o", path.name)
        if run.status == 0:
            checks.integer_picture(f"{name}: {way} codes", path, expected, shown, run.command, most, 16)
    for k in sorted({0, len(samples) // 2, len(samples) - 1}):
        one = ["--start", f"{k}f", "--exposure", "1f", "--out-transfer", "source"]
        checks.codes_are(f"{name}: sample {k} is the source", folder, [*one, "clip.tik"], samples[k])


def kernel_is_reference(checks, name, kernel, reference):
    """Both are right to 1e-12 S in double precision, which a file of single precision cannot show but
    for this: values are the same but for those few that lie that close to a rounding edge."""
    if kernel.shape != reference.shape or not kernel.size:
        return checks.failed(f"{name}: kernel and reference", "a picture is missing")
    other = kernel != reference
    step = np.spacing(np.maximum(np.abs(kernel), np.abs(reference)).astype(np.float32))
    small = np.abs(kernel - reference) <= np.maximum(step, 1e-12)
    # An edge within 1e-12 of a value is met once in 3e4 values of about 1, spaced by 2^-24.
    allowed = max(3, kernel.size // 10_000)
    return checks.holds(f"{name}: kernel and reference", small.all() and other.sum() <= allowed,
                        f"{other.sum()} of {kernel.size} single-precision values differ, by a step")


def function_file(timeline):
    """Functions whose points lie within samples, within gaps and beyond the capture."""
    def at(share):
        return int(timeline.end * share)

    start, end = timeline.starts[len(timeline.starts) // 2], timeline.end
    return (f"M0 [0:1], [{at(0.31)}:1], [{at(0.31) + 1}:0]\n"
            f"M7 [{at(0.1)}:0], [{at(0.45)}:2.5], [{at(0.83)}:-1.25], [{end + 100}:0.5]\n"
            f"M128 [{start - 1}:0], [{start}:1], [{at(0.9)}:1], [{at(0.9) + 1}:0]\n"
            f"M255 [0:-0.5], [{at(0.2)}:-0.5], [{at(0.2) + 1}:0.75], [{at(0.7)}:0.01], [{end}:0]\n")


def stripes(shape):
    """A mask of slanted stripes, so that neighbouring pixels have different functions."""
    rows, columns = np.indices(shape)
    return np.array(MASK_VALUES, np.uint8)[(rows // 3 + columns // 5) % len(MASK_VALUES)]


def camera_times(checks, path):
    """Without a stated rate a .cine's pictures lie where the camera says, which here is as even as
    whole nanoseconds are: every tenth picture of nominally 90 000 a second."""
    samples, bits, times = sources.read_cine(path)
    starts = [timelines.round_half_up(time) for time in times]
    # The program may take an even rate for times that it fits to the nanosecond. Then each start is
    # off by 1 ns at most, and a weight by 2 ns of 111 us: 2e-5 of one sample's share in S, which is
    # more than the tolerance. So the rate is taken from the first and the last time here, too.
    rate = Fraction(len(starts) - 1) / (starts[-1] - starts[0]) * 10**9
    timeline = timelines.constant_rate(len(samples), rate, "31.4")
    off = max(abs(a - b) for a, b in zip(timeline.starts, starts))
    checks.holds("cine_781.cine: its times are even", off <= 1, f"{float(rate):.3f} pictures a second, "
                 f"times off by {off} ns at most")
    both_ways(checks, f"{path.name}, the camera's times", samples, 2**bits - 1, "linear", timeline,
              ["-a", "31.4"], path)


def ten_bits(checks, path):
    """Raw 4:2:0 video. How the halved chroma is spread is no one's standard: the ffmpeg command does
    it here, from where samples lie in a file that says nothing, and what follows is the script's; with chroma left
    out everything is."""
    width, height = 480, 270
    luma, blue, red = sources.read_yuv420p10(path, width, height)
    raw = ["--raw", f"{width}x{height}:yuv420p10le"]
    spread = subprocess.run(
        ["ffmpeg", "-v", "error", "-f", "rawvideo", "-pix_fmt", "yuv420p10le", "-s", f"{width}x{height}",
         "-i", str(path), "-vf", "scale=in_h_chr_pos=0:in_v_chr_pos=128:flags=bicubic+accurate_rnd+full_chroma_int",
         "-f", "rawvideo", "-pix_fmt", "yuv444p10le", "-"], capture_output=True, check=True)
    planes = np.frombuffer(spread.stdout, "<u2").reshape(-1, 3, height, width)
    checks.holds("the 10-bit clip: spreading chroma leaves luma alone",
                 np.array_equal(planes[:, 0], luma), f"{luma.size} codes")
    samples = sources.rgb_of_yuv10(planes[:, 0], planes[:, 1], planes[:, 2])
    constant(checks, "sparks, 10 bits", samples, 65535, "srgb", ("24", "180"), raw, path)

    folder = checks.folder("deep-grey-sparks")
    grey = np.concatenate([luma.reshape(len(luma), -1), np.full_like(blue, 512).reshape(len(luma), -1),
                           np.full_like(red, 512).reshape(len(luma), -1)], axis=1)
    grey.astype("<u2").tofile(folder / "grey.yuv")
    middle = np.full_like(luma, 512)
    constant(checks, "grey sparks, 10 bits", sources.rgb_of_yuv10(luma, middle, middle), 65535,
             "bt709", ("24", "180"), [*raw, "--transfer", "bt709"], folder / "grey.yuv")


def variable_rate(checks):
    """12-bit pictures with times of their own, in Matroska (whole ms) and MP4."""
    folder = checks.folder("vfr")
    samples = random_samples(np.random.default_rng(31), (60, 23, 37, 1), 4095)
    pictures.write_lossless(folder / "even.mkv", samples, "50", "gray12le")
    for output, codec in (("vfr.mkv", ["-c:v", "ffv1", "-pix_fmt", "gray12le"]),
                          ("vfr.mov", ["-c:v", "ffv1", "-pix_fmt", "gray12le"])):
        # A camera that leaves pictures out where nothing moves.
        subprocess.run(["ffmpeg", "-v", "error", "-y", "-i", "even.mkv", "-vf",
                        "select='not(mod(n,7))+between(n,11,15)+eq(n,40)'", "-fps_mode", "vfr", *codec,
                        output], cwd=folder, check=True)
        decoded, seconds = sources.pipe(folder / output, "gray12le", 1)
        kept = [k for k in range(60) if k % 7 == 0 or 11 <= k <= 15 or k == 40]
        checks.holds(f"{output}: holds the pictures that were kept, at their times",
                     np.array_equal(decoded, samples[kept])
                     and seconds == [Fraction(k, 50) for k in kept], f"{len(kept)} pictures")
        starts = [timelines.round_half_up(time * 10**9) for time in seconds]
        for angle in ("360", "72"):
            both_ways(checks, f"{output}, {angle} degrees", decoded, 4095, "linear",
                      timelines.from_starts(starts, angle), ["-a", angle], folder / output)


def deep_rgb(checks):
    """16-bit RGB in FFV1, which loses nothing; and 10-bit RGB, spread over 16 bits."""
    folder = checks.folder("deep-rgb")
    random = np.random.default_rng(32)
    for pixels, bits in (("gbrp16le", 16), ("gbrp10le", 10)):
        codes = random.integers(0, 2**bits, (7, 19, 33, 3)).astype(np.uint16)
        planes = codes[..., [1, 2, 0]].transpose(0, 3, 1, 2)  # green, blue, red
        subprocess.run(["ffmpeg", "-v", "error", "-y", "-f", "rawvideo", "-pix_fmt", pixels, "-s",
                        "33x19", "-r", "25", "-i", "-", "-c:v", "ffv1", "-pix_fmt", pixels,
                        f"{pixels}.mkv"], cwd=folder, input=planes.astype("<u2").tobytes(), check=True)
        samples = codes if bits == 16 else codes << 6 | codes >> 4
        constant(checks, f"{pixels} video", samples, 65535, "linear" if bits == 16 else "srgb",
                 ("240", "180"), [], folder / f"{pixels}.mkv")
