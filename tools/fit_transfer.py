#!/usr/bin/python3
"""Fits the polynomials that turn codes into light in single precision (host/opencl/light_source.cpp).

Above its straight toe a transfer function is a power of a straight line, ((x + a) / (1 + a))^p. Of all
polynomials of degree 10 in x = code / white code, the one printed has the least largest error in light,
which is what pictures are made of: the error is absolute, not relative. It is found by Remez' algorithm
with 60 digits.

    fit_transfer.py                 the coefficients as they stand in light_source.cpp
    fit_transfer.py --check         exits with 1 where light_source.cpp holds others
    fit_transfer.py --single        largest error of the kernel's arithmetic, over every code
"""

import argparse
import pathlib
import re
import sys

import mpmath as mp

DEGREE = 10
DIGITS = 20  # as written; a double holds 17
BY_LIGHT = 4
CURVE_FILE = pathlib.Path(__file__).parent.parent / "host/opencl/light_source.cpp"
WHITE_CODES = (255, 1023, 4095, 16383, 65535)

mp.mp.dps = 60


class TransferFunction:
    def __init__(self, constant, offset, exponent, toe_end, toe_slope):
        self.constant = constant  # its name in light_source.cpp
        self.offset, self.exponent = mp.mpf(offset), exponent
        self.toe_end, self.toe_slope = toe_end, toe_slope

    def light(self, x):
        return ((x + self.offset) / (1 + self.offset)) ** self.exponent

    def slope(self, x):
        return self.exponent * self.light(x) / (x + self.offset)


TRANSFER_FUNCTIONS = (
    TransferFunction("kSrgb", "0.055", mp.mpf("2.4"), mp.mpf("0.04045"), 1 / mp.mpf("12.92")),
    TransferFunction("kBt709", "0.09929682680944", 1 / mp.mpf("0.45"), mp.mpf("4.5") * mp.mpf("0.018053968510807"),
                     1 / mp.mpf("4.5")),
)


def remez(transfer):
    """Coefficients a_0 ... a_DEGREE and the largest error on [toe_end, 1]."""
    low, high = transfer.toe_end, mp.mpf(1)
    last = DEGREE + 1
    nodes = [(low + high - (high - low) * mp.cospi(mp.mpf(i) / last)) / 2 for i in range(last + 1)]
    while True:
        # The polynomial that errs alike, with alternating signs, at all nodes.
        rows = [[x**j for j in range(DEGREE + 1)] + [(-1) ** i] for i, x in enumerate(nodes)]
        *coefficients, level = mp.lu_solve(mp.matrix(rows), mp.matrix([transfer.light(x) for x in nodes]))

        def error(x):
            return mp.polyval(coefficients[::-1], x) - transfer.light(x)

        def error_slope(x):
            return mp.polyval([j * coefficients[j] for j in range(DEGREE, 0, -1)], x) - transfer.slope(x)

        # Its largest errors become the next nodes. A power's derivatives keep their signs, so that both
        # ends are among them and every other one lies between two zeros of the error.
        zeros = [mp.findroot(error, pair, solver="anderson") for pair in zip(nodes, nodes[1:])]
        peaks = [mp.findroot(error_slope, pair, solver="anderson") for pair in zip(zeros, zeros[1:])]
        nodes = [low, *peaks, high]
        largest = max(abs(error(x)) for x in nodes)
        if largest <= abs(level) * (1 + mp.mpf(10) ** -25):
            return coefficients, largest


def written(coefficients):
    return [mp.nstr(value, DIGITS) for value in coefficients]


def declaration(transfer, coefficients):
    """The constant as clang-format lays it out: three to a line, in columns."""
    numbers = [text + "," for text in written(coefficients)]
    widths = [max(map(len, numbers[column::3])) for column in range(3)]
    rows = [" ".join(text.ljust(width) for text, width in zip(numbers[i:i + 3], widths)).rstrip()
            for i in range(0, len(numbers), 3)]
    return f"constexpr Polynomial {transfer.constant}{{\n    " + "\n    ".join(rows).rstrip(",") + "};"


def in_file(transfer):
    found = re.search(rf"Polynomial {transfer.constant}{{([^}}]*)}}", CURVE_FILE.read_text())
    return found[1].replace(",", " ").split() if found else []


def single_errors(transfer, coefficients, fit_error, white, is_fused):
    """Largest error in light of kernels/light.clh in single precision over the codes 0 ... white, and what
    it cannot exceed: the fit's error and each rounding's, carried on through Horner's scheme. The last number
    is what that leaves beside BY_LIGHT roundings of the light itself (host/render/error_bound.cpp)."""
    import numpy as np
    single, double = np.float32, np.float64
    roundoff = 2.0**-24

    # As light_curve() in light_source.cpp.
    centre = (white + 1) // 2
    step = mp.mpf(2) ** -white.bit_length()
    moved = mp.taylor(lambda x: mp.polyval(coefficients[::-1], x), mp.mpf(centre) / white, DEGREE)
    curve = [single(value / (step * white) ** j) for j, value in enumerate(moved)]
    code = np.arange(white + 1, dtype=single)
    t = (code - single(centre)) * single(step)

    light = np.full_like(code, curve[DEGREE])
    bound = roundoff * abs(light)
    for coefficient in curve[DEGREE - 1::-1]:
        product = double(light) * double(t)  # exact
        bound = bound * abs(t) + roundoff * abs(coefficient)
        if not is_fused:
            product = single(product)
            bound += roundoff * abs(product)
        light = single(product + coefficient)
        bound += roundoff * abs(light)
    is_toe = code <= single(mp.floor(transfer.toe_end * white))
    light = np.where(is_toe, code * single(transfer.toe_slope / white), light)
    bound = np.where(is_toe, 2 * roundoff * light, bound + double(fit_error))

    x = np.arange(white + 1) / double(white)
    offset = double(transfer.offset)
    exact = np.where(is_toe, x * double(transfer.toe_slope),
                     ((x + offset) / (1 + offset)) ** double(transfer.exponent))
    return np.abs(light - exact).max(), bound.max(), (bound - BY_LIGHT * roundoff * exact).max()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="compare with light_source.cpp")
    parser.add_argument("--single", nargs="*", type=int, metavar="WHITE",
                        help="measure the kernel's arithmetic at these white codes "
                             f"({', '.join(map(str, WHITE_CODES))})")
    arguments = parser.parse_args()
    white_codes = () if arguments.single is None else arguments.single or WHITE_CODES

    differs = False
    for transfer in TRANSFER_FUNCTIONS:
        coefficients, fit_error = remez(transfer)
        print(declaration(transfer, coefficients))
        print(f"// largest error {mp.nstr(fit_error, 3)}")
        if arguments.check and in_file(transfer) != written(coefficients):
            differs = True
            print(f"{CURVE_FILE.name} holds other numbers for {transfer.constant}", file=sys.stderr)
        for white in white_codes:
            for is_fused in (True, False):
                largest, bound, beside = single_errors(transfer, coefficients, fit_error, white, is_fused)
                print(f"// white {white}, {'fused' if is_fused else 'not fused'}: "
                      f"{largest:.3g}, bound {bound:.3g}, {beside:.3g} + {BY_LIGHT} u light")
    return 1 if differs else 0


if __name__ == "__main__":
    sys.exit(main())
