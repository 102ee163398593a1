"""What the command lines of tools/compare_programs read: clips, stills, functions, masks, captures and pictures."""

import subprocess

import numpy as np

WIDTH, HEIGHT, SAMPLES, RATE = 60, 44, 30, 120  # no whole tiles
SIZE = f"{WIDTH}x{HEIGHT}"

TEXTS = {
    "one.fn": "M0 [0:0], [100000000:2], [100000001:0]\n",
    "regions.fn": "M0 [0:1], [60000000:1], [60000001:-0.5], [90000000:-0.5], [90000001:0]\n"
                  "M128 [16666666:0], [16666667:1], [33333333:1], [33333334:0]\nM255 [0:-1], [120000000:1.5], [120000001:0]\n",
    "later.fn": "M0 [0:1], [8333333:1], [8333334:0]\nM128 [0:0.5], [25000000:0.5], [25000001:0]\n"
                "M255 [0:1], [16666667:0]\n",
    "dark.fn": "M0 [0:-1], [50000000:-1], [50000001:1], [60000000:1], [60000001:0]\n",
    "suspicious.fn": "M0 [0:1], [10000000:1], [100000001:-3], [110000000:0]\nM7 [0:1]\nM128 [900000000:1]\n"
                     "M255 [0:0]\n",
    "wrong.fn": "M0 [0:1], [20:1], [10:0]\nM1 0:1\nM300 [0:1]\nM0 [5:x]\n",
    "flat.noise": "nutik noise 0\nwhite 255\ntransfer srgb\n" + "".join(
        f"channel {channel}\ncurve points\npoint 100 2.5 1\n" for channel in ("red", "green", "blue")),
    "list.txt": "# a comment\n--start 10ms --exposure 40ms plain.png\n\n-m mask.pgm -k regions.fn 'two words.tif' --depth 16\n"
                "-k one.fn one.pfm\n--start 2f --exposure 3f --shutter hann --normalize integral soft.ppm\n"
                "-k dark.fn --negative abs --depth 8 --no-recipe dark.png\n",
    "faulty.txt": "--start 10ms --exposure 40ms good.png\n--start 10ms\n-k missing.fn no.png\n--fps 30 -k one.fn no2.png\n"
                  "-k one.fn last.png\n--exposure 1s --start 10s after.png\n",
    "captures.txt": "--start 0s --exposure 20ms clip.tik a.png\n--start 0s --exposure 20ms grey.tik b.png\n"
                    "--start 0s --exposure 20ms deep.mkv c.tif\n--start 0s --exposure 20ms clip.tik d.png\n",
}


def light(k, channels):
    """Sample k [height, width, channels], shares of white: a ramp, a ball that crosses it, a lamp that blinks."""
    x, y, c = np.meshgrid(np.arange(WIDTH), np.arange(HEIGHT), np.arange(channels), indexing="xy")
    picture = 0.1 + 0.5 * (x + y) / (WIDTH + HEIGHT) + 0.05 * c
    ball = (x - 2 * k) ** 2 + (y - 20 - (k - 15) ** 2 / 20) ** 2 < 36
    picture = np.where(ball, 0.95 - 0.3 * c, picture)
    picture[3:6, 50:53] = 1 if k % 4 == 0 else 0.02
    return picture


def frames(channels, white, deviation=0.0, moving=True, level=0.0):
    """Codes of all samples [samples, height, width, channels]."""
    random = np.random.default_rng(7)
    clip = np.stack([light(k if moving else 0, channels) for k in range(SAMPLES)]) + level
    clip += random.normal(0, deviation, clip.shape) if deviation else 0
    return np.floor(np.clip(clip, 0, 1) * white + 0.5).astype(np.uint8 if white < 256 else "<u2")


def ffmpeg(path, clip, pixels, *options):
    """Codes as a video file."""
    subprocess.run(["ffmpeg", "-v", "error", "-y", "-f", "rawvideo", "-pix_fmt", pixels, "-s", SIZE, "-r", str(RATE),
                    "-i", "-", "-threads", "1", "-flags", "bitexact", "-fflags", "bitexact", *options, str(path)],
                   input=clip.tobytes(), check=True)


def netpbm(path, picture, white):
    """[height, width, channels] as PGM or PPM."""
    kind = "P5" if picture.shape[2] == 1 else "P6"
    raster = picture.astype(">u2" if white > 255 else np.uint8).tobytes()
    path.write_bytes(f"{kind} {picture.shape[1]} {picture.shape[0]} {white}\n".encode() + raster)


def write_clips(folder):
    colour, grey = frames(3, 255), frames(1, 255)
    ffmpeg(folder / "clip.mkv", colour, "rgb24", "-c:v", "ffv1", "-pix_fmt", "bgr0")
    ffmpeg(folder / "lossy.mp4", colour, "rgb24", "-c:v", "libx264", "-crf", "20", "-pix_fmt", "yuv420p")
    ffmpeg(folder / "grey.mkv", grey, "gray", "-c:v", "ffv1", "-pix_fmt", "gray")
    ffmpeg(folder / "deep.mkv", frames(1, 4095), "gray12le", "-c:v", "ffv1", "-pix_fmt", "gray12le")
    ffmpeg(folder / "wide.mkv", colour, "rgb24", "-c:v", "ffv1", "-pix_fmt", "yuv422p10le")
    # Every third picture left out: times that fit no constant rate.
    ffmpeg(folder / "uneven.mkv", colour, "rgb24", "-vf", "select=mod(n\\,3)", "-fps_mode", "vfr", "-c:v", "ffv1", "-pix_fmt",
           "bgr0")
    ffmpeg(folder / "noisy.mkv", frames(3, 255, 0.01), "rgb24", "-c:v", "ffv1", "-pix_fmt", "bgr0")
    ffmpeg(folder / "still.mkv", frames(3, 255, 0.01, moving=False), "rgb24", "-c:v", "ffv1", "-pix_fmt", "bgr0")
    (folder / "clip.yuv").write_bytes(
        np.concatenate([frames(1, 1023).reshape(SAMPLES, -1), np.full((SAMPLES, WIDTH * HEIGHT // 2), 512, "<u2")],
                       axis=1).astype("<u2").tobytes())


def write_stills(folder):
    for name in ("stills", "dim", "bright"):
        (folder / name).mkdir()
    table = "file,start_ns,exposure_ns\n"
    for k, picture in enumerate(frames(3, 4095)[:12]):
        netpbm(folder / "stills" / f"{k + 1}.ppm", picture, 4095)
        table += f"stills/{k + 1}.ppm,{5_000_000 * k + 100_000 * (k % 3)},{2_000_000 + 300_000 * (k % 4)}\n"
    (folder / "table.csv").write_text(table)
    (folder / "overlap.csv").write_text("stills/1.ppm,0,2000\nstills/2.ppm,1000,2000\n")
    for name, level in (("dim", 0.0), ("bright", 0.2)):
        for k, picture in enumerate(frames(1, 4095, 0.004, False, level)[:10]):
            netpbm(folder / name / f"{k}.pgm", picture, 4095)
    for k, picture in enumerate(frames(1, 255)[:6]):
        netpbm(folder / f"still{k:03}.pgm", picture, 255)


def write_masks(folder):
    x, y = np.meshgrid(np.arange(WIDTH), np.arange(HEIGHT))
    mask = np.where(x + y < 40, 0, np.where(y < 25, 128, 255))[..., None]
    netpbm(folder / "mask.pgm", mask, 255)
    netpbm(folder / "turned.pgm", mask.swapaxes(0, 1), 255)
    mask[10, 30] = 9
    netpbm(folder / "speck.pgm", mask, 255)
    netpbm(folder / "colour.ppm", mask.repeat(3, axis=2), 255)


def write_captures(folder, run):
    """Captures and pictures by the older program."""
    run("encode", "-q", "clip.mkv", "clip.tik", "--block-samples", "4")
    run("encode", "-q", "clip.mkv", "none.tik", "--codec", "none", "--block-samples", "7")
    run("encode", "-q", "grey.mkv", "grey.tik", "--codec", "lz4", "-a", "180")
    run("encode", "-q", "deep.mkv", "deep.tik", "-f", "30000/1001")
    run("encode", "-q", "table.csv", "irregular.tik", "--block-samples", "5")
    run("encode", "-q", "noisy.mkv", "quiet.tik", "--noise", "auto")
    run("encode", "-q", "lossy.mp4", "near.tik", "--tolerance", "5", "--tiles", "records")
    run("-q", "-m", "mask.pgm", "-k", "regions.fn", "clip.tik", "made.png")
    run("-q", "--start", "20ms", "--exposure", "30ms", "--ev", "-1", "deep.tik", "made.tif", "--precision", "fixed")
    run("-q", "--start", "0s", "--exposure", "10ms", "--every", "20ms", "--count", "3", "clip.tik", "-o", "made-%d.ppm")
    whole = (folder / "clip.tik").read_bytes()
    (folder / "cut.tik").write_bytes(whole[:len(whole) * 4 // 5])
    late = len(whole) * 7 // 10
    (folder / "flipped.tik").write_bytes(whole[:late] + bytes([whole[late] ^ 1]) + whole[late + 1:])
    (folder / "wrong.tik").write_bytes(b"P6\n# TIK 9 - of the future\n1 1\n255\n   ")


def write_inputs(folder, run):
    """All inputs in a folder. run: starts the older program there with words."""
    for name, text in TEXTS.items():
        (folder / name).write_text(text)
    write_clips(folder)
    write_stills(folder)
    write_masks(folder)
    write_captures(folder, run)
