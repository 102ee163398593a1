"""The parser agrees with the shared corpus, and functions come to what they must."""

import unittest
from fractions import Fraction

from fnplot.function_file import parse_functions
from fnplot.gain_function import GainFunction

from fnplotter.setting import CAPTURE_NS, expectations, needs_matplotlib, parsed, paths

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


def findings(file, is_warning):
    shown = file.diagnostics.shown
    return [[found.line, found.column, found.message] for found in shown if found.is_warning == is_warning]


class Parser(unittest.TestCase):
    """The plotter's parser agrees with expected.json on every file."""

    def test_every_file_has_its_expectations(self):
        self.assertEqual({path.name for path in paths.corpus.glob("*.fn")}, set(expectations()))

    def test_files_give_their_functions(self):
        for name, expected in expectations().items():
            with self.subTest(name, shows=expected["shows"]):
                file = parsed(name)
                points = {str(tag): list(map(list, f.points)) for tag, f in file.functions.items()}
                self.assertEqual(file.has_errors, not expected["valid"])
                self.assertEqual(points, expected.get("functions", {}))

    def test_mistakes_and_warnings_are_reported_at_their_places_in_the_expected_words(self):
        for name, expected in expectations().items():
            with self.subTest(name, shows=expected["shows"]):
                file = parsed(name)
                errors, warnings = findings(file, is_warning=False), findings(file, is_warning=True)
                self.assertEqual(errors, expected.get("errors", []))
                self.assertEqual(warnings, expected.get("warnings", []))
                more = {"mistake": len(errors) + expected.get("more_errors", 0)}
                more["warning"] = len(warnings) + expected.get("more_warnings", 0)
                self.assertEqual(file.diagnostics.counts, more)

    def test_messages_can_be_read_whatever_the_file_is_made_of(self):
        for name in expectations():
            with self.subTest(name):
                for line in parsed(name).diagnostics.report(name).splitlines():
                    self.assertTrue(line.replace("\t", " ").isprintable(), line)

    def test_long_numbers_are_read_to_their_last_digit(self):
        zeros = "0" * 10_000
        file = parse_functions(f"M{zeros}7 [-{zeros}5:1], [{zeros}5:0.5{zeros}]".encode())
        self.assertFalse(file.has_errors)
        self.assertEqual(file.functions[7].points, [(-5, 1.0), (5, 0.5)])

    def test_points_in_runs_are_those_that_are_read_one_by_one(self):
        count = 10_000  # more than two runs
        points = [(7 * i - 500, (i % 13 - 6) / 4) for i in range(count)]
        plain = ",\n".join(f"[{time}:{gain}]" for time, gain in points)
        # A gain that starts with its point is not what runs are made of.
        odd = "[-501:.5]," + plain.replace(":0.25]", ":.25]")
        for text in (f"M0{{{odd}}}", f"M0 {odd}".replace("\n", " ")):
            self.assertEqual(parse_functions(text.encode()).functions[0].points, [(-501, 0.5), *points])

    def test_times_out_of_order_are_found_in_runs(self):
        points = [f"[{time}:1]" for time in (*range(5000), 4990, *range(5000, 9000), 8999, 9000)]
        file = parse_functions(("M0 " + ",".join(points)).encode())
        words = [found.message for found in file.diagnostics.shown]
        self.assertEqual(
            words,
            [
                "time 4990 is not after 4999; control points must be in time order",
                "time 8999 stands twice; a jump takes 1 ns: write 9000 for the second",
            ],
        )


@needs_matplotlib
class Figures(unittest.TestCase):
    """D, integral, still gain and live interval are what they are by hand."""

    def summary(self, function, begin_ns, end_ns):
        from fnplot.gain_summary import summarize

        return summarize(function, begin_ns, end_ns)

    def test_summaries(self):
        for name, tag, integral_ns, support_ns in FIGURE_SUMMARIES:
            with self.subTest(name, tag=tag):
                summary = self.summary(parsed(f"{name}.fn").functions[tag], 0, CAPTURE_NS)
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
