"""The shape of a function as it is drawn: stretches of one sign."""

from dataclasses import dataclass

from fnplot.gain_function import Piece


@dataclass(frozen=True)
class Run:
    """A stretch over which a function is positive (sign 1), negative (-1) or zero (0)."""

    sign: int
    vertices: list  # (time in ns, gain), in time order; the first and the last may have gain 0


def split_at_zero(piece):
    """A piece in one part, or in two where it crosses zero."""
    if piece.begin_gain * piece.end_gain >= 0:
        return [piece]
    share = piece.begin_gain / (piece.begin_gain - piece.end_gain)
    crossing_ns = piece.begin_ns + share * piece.length_ns
    zero = piece.begin_gain * 0
    return [
        Piece(piece.begin_ns, crossing_ns, piece.begin_gain, zero),
        Piece(crossing_ns, piece.end_ns, zero, piece.end_gain),
    ]


def sign_runs(pieces):
    """Pieces without gaps, joined to runs."""
    runs = []
    for piece in (part for whole in pieces for part in split_at_zero(whole)):
        total = piece.begin_gain + piece.end_gain
        sign = (total > 0) - (total < 0)
        if not runs or runs[-1].sign != sign:
            runs.append(Run(sign, [(piece.begin_ns, piece.begin_gain)]))
        runs[-1].vertices.append((piece.end_ns, piece.end_gain))
    return runs
