#!/usr/bin/env python3
"""What each arithmetic and each tolerance costs, in time and in error, in one run.

    tools/bench/speed_vs_error.py --build build [--clips FOLDER [--only NAME ...]] [--size 640x360] [--frames 120]
                                  [--tolerances 0 2 4 8] [--runs 5] [--csv FILE] [--chart FILE.png]
                                  [--bounds-chart FILE.png]

Captures of different kinds, each encoded with tolerances of 0, 2, 4 and 8 codes, are exposed as a whole in every
arithmetic that the device has (nutik-cl validate). The error is the largest in light against the scalar reference of
the lossless capture: the arithmetic's, against the reference of the same capture, and the capture's own. The time
is a render's, the capture being on the device, by the host's clock, median; the scalar reference and a loop in Python
with OpenCV, on decoded frames, stand beside it.

Made up are a dense capture (noise everywhere), a sparse one (a ball over what does not move but slowly fades) and
a mixed one (noise in one half). The chart draws the Pareto front: what nothing else beats in both; and
the one of devices that have no double.

Lossless captures are also exposed to sRGB codes of 16 bits. The chart of bounds shows for each arithmetic what these are
off by, its bound, and the bound that any light would have, white or black: 12.92 · 65535 times that of light.
"""

import json
import pathlib
import statistics
import subprocess
import tempfile

import numpy as np

from peers import LOOPS, PYTHON
from tables import STEEPEST, command_line, output_of, pyplot, run_once, size_of, write_outputs

CLIPS = ("BallTossOut.mp4", "bicycle-wheel.mp4", "bikes.mp4")
TOLERANCES = (0, 2, 4, 8)
PRECISIONS = ("single", "double", "fixed", "compensated")
WHOLE = ("--start", "0s", "--exposure", "24h")
PAPER_MS = 6000  # the paper's own program for a picture, on its authors' machine
REFERENCE_BOUND = 30 * 2.0 ** -53  # of light, docs/explanation/accuracy.md
# Half a code where codes lie closest in light, the straight toe of sRGB.
HALF_CODES = {"half a code of 8 bits": 0.5 / 255 / STEEPEST, "half a code of 16 bits": 0.5 / 65535 / STEEPEST}


def scene(kind, width, height, frames):
    """Frames [height, width, 3] of codes."""
    random = np.random.default_rng(1)
    y, x = np.mgrid[:height, :width]
    ground = 60 + 120 * x / width + 20 * np.sin(y / 7) + random.normal(0, 12, (height, width))
    ground = np.stack([ground, 0.8 * ground + 20, 0.6 * ground + 50], axis=-1)
    noisy = {"dense": np.ones(width), "sparse": np.zeros(width), "mixed": np.arange(width) < width / 2}[kind]
    for number in range(frames):
        share = number / frames
        frame = ground * (1 - 0.04 * share)
        across = (x - width * (0.1 + 0.8 * share)) ** 2 + (y - height * (0.3 + 0.4 * share)) ** 2
        frame[across < (height / 10) ** 2] = (230, 120, 40)
        frame += random.normal(0, 3, frame.shape) * noisy[None, :, None]
        yield np.clip(np.rint(frame), 0, 255).astype(np.uint8)


def make_clip(path, kind, size, frames):
    """A clip of the scene without loss, so that everyone decodes the same codes."""
    width, height = map(int, size.split("x"))
    command = ["ffmpeg", "-v", "error", "-y", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", size, "-r", "240", "-i", "-",
               "-c:v", "ffv1", "-pix_fmt", "bgr0", path]
    with subprocess.Popen(command, stdin=subprocess.PIPE) as encoder:
        for frame in scene(kind, width, height, frames):
            encoder.stdin.write(frame.tobytes())
    if encoder.returncode:
        raise SystemExit(f"ffmpeg could not make {path}")


def read_pfm(path):
    """Light [height, width, channels] in double, top row first."""
    with path.open("rb") as file:
        channels = 3 if file.readline().strip() == b"PF" else 1
        width, height = map(int, file.readline().split())
        kind = "<f4" if float(file.readline()) < 0 else ">f4"
        return np.frombuffer(file.read(), kind).reshape(height, width, channels)[::-1].astype(float)


def light_of(program, folder, capture, *how):
    """A picture of the whole capture, in light."""
    run_once(program, "expose", "--overwrite", "-q", *how, *WHOLE, capture, folder / "light.pfm")
    return read_pfm(folder / "light.pfm")


def errors_between(light, wanted):
    """The largest error and the root of the mean square."""
    error = np.abs(light - wanted)
    return float(error.max()), float(np.sqrt(np.mean(error ** 2)))


def measure_loop(clip, folder, runs, lossless):
    """The loop in Python: its median time and its error."""
    light = folder / "loop.npy"
    seconds = [float(output_of(PYTHON, LOOPS, "loop", "--memory", clip, light)) for _ in range(runs)]
    frames = np.load(light)[..., ::-1].astype(float)  # OpenCV's channels are BGR
    worst, rms = errors_between(frames, lossless)
    return {"what": "Python and OpenCV", "tolerance": 0, "render_ms": statistics.median(seconds) * 1e3,
            "total_worst": worst, "total_rms": rms}


def measure_codes(program, capture, runs):
    """Rows of pictures of 16-bit codes."""
    report = json.loads(output_of(program, "validate", "-q", "--json", "--runs", str(runs), "--depth", "16", *WHOLE, capture))
    for variant in report["variants"]:
        yield {"what": f"{variant['precision']}, 16 bits", "tolerance": 0, "render_ms": variant["render_ms"],
               "codes_worst": variant["worst_16_bit_codes"], "codes_bound": variant["bound_steps"],
               "codes_bound_of_white": STEEPEST * 65535 * variant["bound_light"]}


def measure_tolerance(program, clip, folder, tolerance, runs, lossless):
    """Rows of one capture: a variant each, and the reference."""
    capture = folder / "capture.tik"
    run_once(program, "encode", "--overwrite", "-q", "--codec", "none", "--tolerance", str(tolerance), clip, capture)
    report = json.loads(output_of(program, "validate", "-q", "--json", "--runs", str(runs), *WHOLE, capture))
    held = light_of(program, folder, capture, "--precision", "double")
    own_worst, own_rms = errors_between(held, lossless)
    if tolerance == 0:  # what is left is the rounding of floats in a .pfm
        own_worst = own_rms = 0.0
    for variant in report["variants"]:
        total = variant["worst_light"], variant["rms_light"]
        if own_worst > 0:
            total = errors_between(light_of(program, folder, capture, "--precision", variant["precision"]), lossless)
        yield {"what": variant["precision"], "tolerance": tolerance, "render_ms": variant["render_ms"],
               "expose_ms": variant["expose_ms"], "read_mb": variant["payload_bytes"] / 1e6,
               "arithmetic_worst": variant["worst_light"], "arithmetic_rms": variant["rms_light"],
               "bound": variant["bound_light"], "capture_worst": own_worst, "capture_rms": own_rms,
               "total_worst": total[0], "total_rms": total[1]}
    if tolerance == 0:
        yield from measure_codes(program, capture, runs)
    yield {"what": "reference", "tolerance": tolerance, "render_ms": report["reference_render_ms"],
           "total_worst": own_worst, "total_rms": own_rms}
    capture.unlink()


def measure(program, clip, folder, runs, tolerances):
    """Rows of one clip."""
    exact = folder / "exact.tik"
    run_once(program, "encode", "--overwrite", "-q", "--codec", "none", clip, exact)
    lossless = light_of(program, folder, exact, "--renderer", "reference")
    exact.unlink()
    for tolerance in tolerances:
        yield from measure_tolerance(program, clip, folder, tolerance, runs, lossless)
    yield measure_loop(clip, folder, runs, lossless)


def pareto_front(points):
    """Of (time, error) those that no other beats in both, by increasing time."""
    front = []
    for point in sorted(points):
        if not front or point[1] < front[-1][1]:
            front.append(point)
    return front


def draw_panel(axes, rows, title, least):
    colours = dict(zip(PRECISIONS, ("#0072b2", "#d55e00", "#009e73", "#cc79a7")))
    markers = dict(zip(TOLERANCES, "os^D"))

    def place(row):
        return row["render_ms"], max(row["total_worst"], least)

    variants = [row for row in rows if row["what"] in PRECISIONS]
    without_double = [row for row in variants if row["what"] != "double"]
    for chosen, style in ((without_double, {"color": "#707070", "linestyle": "--"}), (variants, {"color": "black"})):
        axes.step(*zip(*pareto_front(map(place, chosen))), where="post", linewidth=1.2, zorder=1, **style)
    for row in variants:
        axes.plot(*place(row), marker=markers[row["tolerance"]], color=colours[row["what"]], markersize=8,
                  markeredgecolor="white", markeredgewidth=0.6, linestyle="none", zorder=2)
    for row in rows:
        if row["what"] == "Python and OpenCV":
            axes.plot(*place(row), marker="X", color="black", markersize=9, linestyle="none", zorder=3)
        elif row["what"] == "reference" and row["tolerance"] == 0:
            axes.plot(row["render_ms"], REFERENCE_BOUND, marker="*", color="black", markersize=11, linestyle="none")
    for light in HALF_CODES.values():
        axes.axhline(light, color="#a0a0a0", linestyle=":", linewidth=1, zorder=0)
    axes.axvline(PAPER_MS, color="#8a5a00", linestyle="-.", linewidth=1.2, zorder=0)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_ylim(least / 3, 1)
    axes.grid(color="#e4e4e4", linewidth=0.5)
    axes.set_title(title, fontsize=11)
    return colours, markers


def chart(path, rows):
    plt = pyplot()
    from matplotlib.lines import Line2D

    clips = list(dict.fromkeys(row["clip"] for row in rows))
    columns = min(3, len(clips))
    lines = -(-len(clips) // columns)
    figure, panels = plt.subplots(lines, columns, figsize=(4.3 * columns, 3.7 * lines + 1.2), sharex=True, sharey=True,
                                  squeeze=False, layout="constrained")
    for panel, clip in zip(panels.flat, clips):
        own = [row for row in rows if row["clip"] == clip]
        colours, markers = draw_panel(panel, own, f"{clip}, {own[0]['size']}", 1e-16)
    for place in range(len(clips), panels.size):
        panels.flat[place].set_visible(False)
        panels.flat[place - columns].tick_params(labelbottom=True)
        panels.flat[place - columns].set_xlabel("milliseconds a render")
    for name, light in HALF_CODES.items():
        panels[0][0].text(0.93, light, name, transform=panels[0][0].get_yaxis_transform(), ha="right", va="bottom",
                          fontsize=8, color="#606060")
    for panel in panels[-1]:
        panel.set_xlabel("milliseconds a render")
    for line in panels:
        line[0].set_ylabel("largest error in light")

    def point(marker, colour, name, size=8):
        return Line2D([], [], marker=marker, color=colour, linestyle="none", markersize=size, label=name)

    handles = [point("o", colour, name) for name, colour in colours.items()]
    handles += [point(marker, "#606060", f"tolerance {tolerance}") for tolerance, marker in markers.items()]
    handles += [Line2D([], [], color="black", label="Pareto front"),
                Line2D([], [], color="#707070", linestyle="--", label="front without double"),
                point("X", "black", "Python and OpenCV, a loop"), point("*", "black", "scalar reference (its bound)", 11),
                Line2D([], [], color="#8a5a00", linestyle="-.", label="6 s, the paper's program")]
    handles += [Line2D([], [], linestyle="none", label=" ")] * 3  # columns of four
    legend_share = 1.0 / figure.get_figheight()
    figure.get_layout_engine().set(rect=(0, legend_share, 1, 1 - legend_share))
    figure.legend(handles=handles, loc="lower center", ncols=4, fontsize=9, frameon=False)
    figure.savefig(path, dpi=100)


def chart_bounds(path, rows):
    """Error, bound and earlier bound of 16-bit codes against time, a panel for each clip."""
    plt = pyplot()
    from matplotlib.lines import Line2D

    rows = [row for row in rows if row["codes_bound"] is not None]
    clips = list(dict.fromkeys(row["clip"] for row in rows))
    columns = min(3, len(clips))
    figure, panels = plt.subplots(-(-len(clips) // columns), columns, sharex=True, sharey=True, squeeze=False,
                                  figsize=(4.3 * columns, 3.4 * -(-len(clips) // columns) + 0.8), layout="constrained")
    colours = dict(zip(PRECISIONS, ("#0072b2", "#d55e00", "#009e73", "#cc79a7")))
    marks = (("codes_worst", "o", "measured"), ("codes_bound", "_", "bound"),
             ("codes_bound_of_white", "x", "bound of any light"))
    for panel, clip in zip(panels.flat, clips):
        own = [row for row in rows if row["clip"] == clip]
        for row in own:
            colour = colours[row["what"].split(",")[0]]
            panel.plot([row["render_ms"]] * 2, [row["codes_worst"], row["codes_bound_of_white"]], color=colour, linewidth=0.8)
            for key, marker, _ in marks:
                panel.plot(row["render_ms"], row[key], marker=marker, color=colour, markersize=9, markeredgewidth=1.8)
        panel.axhline(0.5, color="#606060", linestyle=":", linewidth=1)
        panel.text(0.98, 0.6, "half a code: what auto takes lies below", fontsize=8, color="#606060", ha="right",
                   transform=panel.get_yaxis_transform())
        panel.set_xscale("log")
        panel.set_yscale("log")
        panel.grid(color="#e4e4e4", linewidth=0.5)
        panel.set_title(f"{clip}, {own[0]['size']}", fontsize=11)
        panel.set_xlabel("milliseconds a render")
    for place in range(len(clips), panels.size):
        panels.flat[place].set_visible(False)
    for line in panels:
        line[0].set_ylabel("16-bit sRGB codes")
    handles = [Line2D([], [], color=colour, linewidth=3, label=name) for name, colour in colours.items()]
    handles += [Line2D([], [], marker=marker, color="black", linestyle="none", markersize=9, label=name)
                for _, marker, name in marks]
    legend_share = 0.7 / figure.get_figheight()
    figure.get_layout_engine().set(rect=(0, legend_share, 1, 1 - legend_share))
    figure.legend(handles=handles, loc="lower center", ncols=4, fontsize=9, frameon=False)
    figure.savefig(path, dpi=100)


def main():
    parser = command_line(__doc__, runs=5, chart=True)
    parser.add_argument("--clips", type=pathlib.Path, help="folder of recorded clips; left out where it is missing")
    parser.add_argument("--only", nargs="*", default=CLIPS, metavar="NAME", help="of them")
    parser.add_argument("--tolerances", type=int, nargs="*", default=TOLERANCES, metavar="CODES")
    parser.add_argument("--bounds-chart", type=pathlib.Path, metavar="FILE.png")
    parser.add_argument("--size", default="640x360")
    parser.add_argument("--frames", type=int, default=120)
    arguments = parser.parse_args()
    program = arguments.build.resolve() / "nutik-cl"

    everything = []
    print(f"{'clip':20} {'what':18} {'tol.':>4} {'render ms':>9} {'MB read':>8} {'arithmetic':>10} {'bound':>8} "
          f"{'capture':>8} {'total':>8} {'RMS':>8}  of 16 bits: {'codes':>8} {'bound':>8} {'any':>8}")
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        clips = {}
        for kind in ("dense", "sparse", "mixed"):
            clips[kind] = folder / f"{kind}.mkv"
            make_clip(clips[kind], kind, arguments.size, arguments.frames)
        if arguments.clips and arguments.clips.is_dir():
            clips |= {pathlib.Path(name).stem: arguments.clips / name for name in arguments.only}
        for name, clip in clips.items():
            size = " × ".join(map(str, size_of(clip)))
            for row in measure(program, clip, folder, arguments.runs, arguments.tolerances):
                figures = " ".join(f"{row[key]:{width}.{digits}g}" if key in row else " " * width for key, width, digits in (
                    ("read_mb", 8, 4), ("arithmetic_worst", 10, 2), ("bound", 8, 2), ("capture_worst", 8, 2),
                    ("total_worst", 8, 2), ("total_rms", 8, 2), ("codes_worst", 22, 2), ("codes_bound", 8, 2),
                    ("codes_bound_of_white", 8, 2)))
                print(f"{name:20} {row['what']:18} {row['tolerance']:4} {row['render_ms']:9.2f} {figures}", flush=True)
                everything.append({"clip": name, "size": size, **row})
    columns = {key: None for row in everything for key in row}
    everything = [columns | row for row in everything]
    write_outputs(arguments, everything, chart)
    if arguments.bounds_chart:
        chart_bounds(arguments.bounds_chart, everything)


if __name__ == "__main__":
    main()
