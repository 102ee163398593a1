"""Functions are read as they are, and come to what they must."""

import unittest
from fractions import Fraction

from fnplot.errors import InputError
from fnplot.gain_function import GainFunction

from fnplotter.setting import CAPTURE_NS, expectations, functions_of, needs_matplotlib

# Over 3 s, worked out by hand: file, mask value, integral of g in ns, D in ns.
FIGURE_SUMMARIES = (
    ("figure04", 0, Fraction("20833500.75"), 83331001),
    ("figure07", 128, Fraction("40000003.5"), 40000007),
    ("figure14", 0, Fraction("-10949999987"), 1010000001),
    ("figure14-restored", 0, Fraction("750000013"), 1010000001),
    ("figure14-restored", 64, Fraction("10000000.5"), 10000001),
    ("figure14-restored", 128, Fraction("10000001"), 10000002),
    ("figure16", 0, Fraction("200000001"), 200000001),
)


class Functions(unittest.TestCase):
    """They are what the program reads, to the last digit."""

    def test_files_give_their_functions(self):
        for name, expected in expectations().items():
            with self.subTest(name, shows=expected["shows"]):
                if expected["valid"]:
                    points = {str(tag): list(map(list, f.points)) for tag, f in functions_of(name).items()}
                    self.assertEqual(points, expected["functions"])
                else:
                    with self.assertRaises(InputError):
                        functions_of(name)


@needs_matplotlib
class Figures(unittest.TestCase):
    """D, integral, still gain and live interval are what they are by hand."""

    def summary(self, function, begin_ns, end_ns):
        from fnplot.gain_summary import summarize

        return summarize(function, begin_ns, end_ns)

    def test_summaries(self):
        for name, tag, integral_ns, support_ns in FIGURE_SUMMARIES:
            with self.subTest(name, tag=tag):
                summary = self.summary(functions_of(f"{name}.fn")[tag], 0, CAPTURE_NS)
                self.assertEqual(summary.integral_ns, integral_ns)
                self.assertEqual(summary.support_ns, support_ns)
                self.assertEqual(summary.still_gain, integral_ns / support_ns)

    def test_nothing_outside_the_interval_counts(self):
        function = GainFunction.from_points(((-10, 0.0), (10, 2.0), (30, 2.0)))
        summary = self.summary(function, 0, 20)  # a ramp from 1 to 2 over 10 ns, then 2 for 10 ns
        self.assertEqual((summary.integral_ns, summary.support_ns), (35, 20))
        self.assertEqual(self.summary(function, 30, 40).integral_ns, 20)  # held

    def test_live_intervals(self):
        # As docs/explanation/model.md has it, over 100 ns.
        cases = (
            (((10, 0.0), (20, 1.0), (30, 0.0), (40, 0.0)), (10, 30)),
            (((10, 1.0), (20, 0.0), (30, 0.0)), (0, 20)),  # held before
            (((10, 0.0), (20, 0.0), (30, 1.0)), (20, 100)),  # held after
            (((-50, 0.0), (20, 1.0), (300, 0.0)), (0, 100)),
            (((200, 0.0), (210, 1.0), (220, 0.0)), None),
            (((10, 0.0), (20, 0.0)), None),
        )
        for points, live_ns in cases:
            with self.subTest(points):
                self.assertEqual(self.summary(GainFunction.from_points(points), 0, 100).live_ns, live_ns)

    def test_integrals_of_any_size_are_exact(self):
        points = ((0, 1e300), (3, 1e-300), (7, -1e300), (9, 5e-324))
        exact = sum(
            (Fraction(before[1]) + Fraction(after[1])) * (after[0] - before[0]) / 2
            for before, after in zip(points, points[1:])
        )
        self.assertEqual(self.summary(GainFunction.from_points(points), 0, 9).integral_ns, exact)


class Times(unittest.TestCase):
    """Times are read exactly, and shown in the unit that fits."""

    def test_durations(self):
        from fnplot.times import parse_time

        seconds = {"3s": 3 * 10**9, "0.4s": 4 * 10**8, "1/3s": 333333333, "2/3s": 666666667}
        parts = {"10ms": 10**7, "250us": 250000, ".5us": 500, "7ns": 7, "-1ms": -(10**6)}
        for text, time_ns in (seconds | parts).items():
            self.assertEqual(parse_time(text, "duration"), time_ns)

    def test_lengths(self):
        from fnplot.times import exact_text, length_text

        texts = {0: "0 s", 7: "7 ns", 1500: "1.5 µs", 83331001: "83.331001 ms", -2 * 10**9: "-2 s"}
        for length_ns, text in texts.items():
            self.assertEqual((length_text(length_ns), exact_text(length_ns)), (text, text))
        self.assertEqual(length_text(Fraction(999999999999, 1000)), "1 s")  # not 1000 ms

    def test_axes(self):
        from fnplot.times import TimeAxis

        self.assertEqual(TimeAxis(0, 100).label, "time (ns)")
        self.assertEqual(TimeAxis(0, 5_000).label, "time (µs)")
        self.assertEqual(TimeAxis(0, 1_010_000_001).label, "time (ms)")
        self.assertEqual(TimeAxis(0, CAPTURE_NS).label, "time (s)")
        narrow = TimeAxis(399_999_995, 400_000_004)
        self.assertEqual((narrow.label, narrow.coordinate(400_000_001)), ("time from 400 ms (ns)", 1.0))
