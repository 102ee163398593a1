#!/usr/bin/python3
"""Random arrays from Python against NumPy: dtypes, layouts, times, functions and transfer functions as they come; each
picture is held to the bound that it states, float32 included, and of floats that are light to all of its bounds together.
NumPy integrates in its widest floats, by itself.

    random_arrays.py [--cases 10000] [--first 0] [--build build]

The package is looked for in BUILD/python. Prints each failure with the case that repeats it, and the largest share of a
bound.
"""

import argparse
import sys
import warnings
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests/independent"))
import light  # noqa: E402

WIDE = np.longdouble


def random_codes(random):
    """Codes [samples, height, width(, 3)], some still, some with runs, some noise."""
    dtype = random.choice([np.uint8, np.uint16])
    # Few: kernels are built for each.
    white = int(random.choice([1, 200, 255] if dtype == np.uint8 else [255, 1000, 4095, 65535]))
    shape = (int(random.integers(1, 40)), int(random.integers(1, 20)), int(random.integers(1, 20)))
    shape += (3,) if random.random() < 0.4 else ()
    codes = random.integers(0, white + 1, shape).astype(dtype)
    kind = random.integers(3)
    if kind == 0:
        codes[:] = codes[0]
        codes[:, : shape[1] // 2] = random.integers(0, white + 1, (shape[0], *codes.shape[2:]))[:, None]
    elif kind == 1:
        codes = codes[np.sort(random.integers(0, shape[0], shape[0]))]
    return codes, white


def laid_out(random, codes):
    """The same values in some layout and order of bytes, as an array or as an iterable."""
    kind = random.integers(7)
    if kind == 0:
        return np.asfortranarray(codes)
    if kind == 1:
        return codes[::-1].copy()[::-1]
    if kind == 2:
        wide = np.zeros((*codes.shape[:2], 2 * codes.shape[2], *codes.shape[3:]), codes.dtype)
        wide[:, :, ::2] = codes
        return wide[:, :, ::2]
    if kind == 3:
        return codes.astype(codes.dtype.newbyteorder())
    if kind == 4:
        return iter([each.copy() for each in codes])
    if kind == 5:
        return codes.swapaxes(1, 2).copy().swapaxes(1, 2)
    return codes


def random_times(random, count):
    """How they are stated, and when samples are exposed: [count, 2] nanoseconds, and the capture's end."""
    if random.random() < 0.5:
        rate, angle = int(random.integers(1, 10 ** 5)), int(random.integers(1, 361))
        numbers = np.arange(count + 1, dtype=object)
        half_up = np.vectorize(lambda top, bottom: (2 * top + bottom) // (2 * bottom), otypes=[np.int64])
        starts = half_up(numbers * 10 ** 9, rate)
        ends = half_up((360 * numbers[:-1] + angle) * 10 ** 9, 360 * rate)
        return dict(rate=rate, shutter_angle=angle), np.stack([starts[:-1], ends], 1), int(starts[-1])
    starts = np.cumsum(random.integers(1, 10 ** 7, count))
    starts -= starts[0]
    steps = np.diff(starts, append=starts[-1] + 10 ** 7)
    lengths = np.maximum(1, (steps * random.random(count)).astype(np.int64))
    as_deltas = random.random() < 0.5
    times, exposures = ((starts.astype("m8[ns]"), lengths.astype("m8[ns]")) if as_deltas else
                        ([f"{each}ns" for each in starts], [f"{each}ns" for each in lengths]))
    return dict(times=times, exposures=exposures), np.stack([starts, starts + lengths], 1), int(starts[-1] + lengths[-1])


def random_points(random, end_ns):
    """Control points: whole nanoseconds, some equal in pairs, and gains of both signs over some orders of magnitude."""
    count = int(random.integers(2, 9))
    at = np.sort(random.integers(-end_ns // 8 - 1, end_ns + end_ns // 8 + 2, count))
    at = at[[k for k in range(count) if k < 2 or at[k] != at[k - 2]]]
    gains = random.normal(size=len(at)) * 10.0 ** random.integers(-3, 4)
    gains[random.random(len(at)) < 0.3] = 0.0
    return at, gains


def gain_pieces(at, gains, end_ns):
    """Straight pieces over the capture, (begin, end, gain at both), held before the first point and after the last."""
    points = [(min(0, int(at[0])), gains[0]), *zip(map(int, at), gains), (max(end_ns, int(at[-1])), gains[-1])]
    for (begin, first), (end, last) in zip(points, points[1:]):
        low, high = max(begin, 0), min(end, end_ns)
        if low < high:
            def gain(time, begin=begin, end=end, first=WIDE(first), last=WIDE(last)):
                return first + (last - first) * WIDE(time - begin) / WIDE(end - begin)
            yield low, high, gain


def weights_of(at, gains, exposed, end_ns):
    """The weight of each sample's light, and for how long the gain is not 0."""
    weights = np.zeros(len(exposed), WIDE)
    support = 0
    edges = np.append(exposed.ravel(), end_ns)
    for low, high, gain in gain_pieces(at, gains, end_ns):
        if gain(low) != 0 or gain(high) != 0:
            support += high - low
        cuts = np.unique(np.concatenate([[low, high], edges[(edges > low) & (edges < high)]]))
        for begin, end in zip(cuts[:-1].tolist(), cuts[1:].tolist()):
            first, last, length = gain(begin), gain(end), WIDE(end - begin)
            sample = int(np.searchsorted(exposed[:, 0], begin, "right")) - 1
            whole = length * (first + last) / 2
            if begin < exposed[sample, 1] or sample + 1 == len(exposed):
                weights[sample] += whole
                continue
            gap_begin, gap = int(exposed[sample, 1]), WIDE(exposed[sample + 1, 0] - exposed[sample, 1])
            rise = WIDE(begin - gap_begin) / gap, WIDE(end - gap_begin) / gap
            rising = length * (2 * first * rise[0] + first * rise[1] + last * rise[0] + 2 * last * rise[1]) / 6
            weights[sample + 1] += rising
            weights[sample] += whole - rising
    return weights, support


def check(nutik, number):
    """Share of its bound that a random picture is off by: of light in float32 or float64, in some arithmetic."""
    random = np.random.default_rng([44, number])
    codes, white = random_codes(random)
    transfer = str(random.choice(["linear", "srgb", "gamma:2.2", "bt709"]))
    shown = None
    stated, exposed, end_ns = random_times(random, len(codes))
    if random.random() < 0.15:
        given = codes / white if random.random() < 0.5 else (codes / white).astype(np.float32)
        shown = np.asarray(given, np.float64)  # light, of which the capture holds the nearest codes
        codes = light.codes_of(shown, transfer, 65535).astype(np.uint16)
        source, white, stated_white = given if random.random() < 0.5 else iter(list(given)), 65535, 1.0
    else:
        source, stated_white = laid_out(random, codes), white
    points = [random_points(random, end_ns) for _ in range(int(random.integers(1, 4)))]
    precision = [None, "single", "compensated", "double", "fixed"][int(random.integers(5))]
    dtype = random.choice([np.float32, np.float64])
    worst = 0.0
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        capture = nutik.encode(source, white=stated_white, transfer=transfer, block_samples=int(random.integers(1, 33)), **stated)
        functions = [nutik.Function.from_ns(at, gains) for at, gains in points]
        many = capture.render_many(functions, dtype=dtype, precision=precision)
        made = [(many.array[k], many.error_bounds[k], k) for k in range(len(functions))]
        picture = capture.render(functions[0], dtype=dtype, precision=precision)
        made.append((picture.array, picture.error_bound, 0))
    table = light.light_table(transfer, white)
    for array, bound, k in made:
        weights, support = weights_of(*points[k], exposed, end_ns)
        wanted = np.tensordot(weights, table[codes].astype(WIDE), 1) / (support or 1)
        # What NumPy's own table rounds, which the bound allows no place for.
        slack = 4 * 2.0 ** -53 * float(np.abs(weights).sum() / (support or 1))
        error = float(np.abs(array.astype(WIDE) - wanted).max())
        share = max(0.0, error - slack) / bound if bound > 0 else 0.0 if error <= slack else np.inf
        if shown is not None and k == 0 and array is picture.array:
            scene = np.tensordot(weights, shown.astype(WIDE), 1) / (support or 1)
            off = max(0.0, float(np.abs(array.astype(WIDE) - scene).max()) - slack)
            all_bounds = picture.uncertainty["bounds"]["light"]
            share = max(share, off / all_bounds if all_bounds > 0 else 0.0 if off == 0 else np.inf)
        if not share <= 1:
            print(f"case {number}: off by {error:.3g}, bound {bound:.3g}, {precision}, {np.dtype(dtype).name}, {transfer}, "
                  f"codes {codes.shape} {codes.dtype}, function {k}: {points[k]}")
        worst = max(worst, share)
    return worst


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cases", type=int, default=10_000)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--build", type=Path, default=Path("build"))
    arguments = parser.parse_args()
    sys.path.insert(0, str(arguments.build / "python"))
    import nutik
    shares = []
    for number in range(arguments.first, arguments.first + arguments.cases):
        shares.append(check(nutik, number))
        if sys.stderr.isatty() and number % 100 == 0:
            print(f"\r{number}", end="", file=sys.stderr)
    above = int(np.sum(np.array(shares) > 1))
    print(f"{len(shares)} cases, {above} above their bound; largest share {max(shares):.3f}")
    return 1 if above else 0


if __name__ == "__main__":
    sys.exit(main())
