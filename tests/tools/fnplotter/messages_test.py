"""Exit statuses and messages."""

import sys
import unittest

from fnplotter.setting import expectations, many_functions, needs_matplotlib, paths, run, write


class Mistakes(unittest.TestCase):
    """Exit statuses and messages."""

    def check(self, arguments, status, words, **environment):
        result = run(*arguments, **environment)
        self.assertEqual(result.returncode, status, result.stderr)
        self.assertIn(words, result.stderr)
        self.assertNotIn("Traceback", result.stderr)
        return result

    def test_all_mistakes_of_a_file_are_reported(self):
        name = "invalid-several-functions.fn"
        path = paths.corpus / name
        result = self.check([path], 3, "a comma is missing")
        lines = [f"{path}:{line}:{column}: {words}" for line, column, words in expectations()[name]["errors"]]
        places = [line for line in result.stderr.splitlines() if line.startswith(f"{path}:")]
        self.assertEqual(places, lines)

    def test_messages_name_place_limit_and_way_out_and_show_the_line(self):
        source = write("order.fn", "M0 [0:1], [2000000:1],\nM1 [2000000:0], [1000000:1]\n")
        result = self.check([source], 3, "")
        self.assertEqual(
            result.stderr,
            f"FnPlotter.py: {source} has mistakes:\n"
            f"{source}:1:22: a comma with no control point after it; "
            "to go on over several lines write M0{ … }\n"
            "    M0 [0:1], [2000000:1],\n"
            "                         ^\n"
            f"{source}:2:18: time 1000000 is not after 2000000; control points must be in time order\n"
            "    M1 [2000000:0], [1000000:1]\n"
            "                     ^\n",
        )

    @needs_matplotlib
    def test_names_of_any_kind(self):
        for name in ("$x^$.fn", "ö ∫.fn", "a" * 200 + ".fn"):
            with self.subTest(name):
                self.check([write(name, "M0 [0:1], [5:0]\n"), "-o", paths.work / "named.png"], 0, "")

    @needs_matplotlib
    def test_warnings_do_not_stop_a_plot(self):
        source = write("warning.fn", "m1 [0:1]\nM0 [0:1], [5:0]\n")
        words = f"{source}:1:1: warning: taken as a comment: a function starts with a capital M\n    m1"
        self.check([source, "-o", paths.work / "warning.png"], 0, words)

    def test_usage(self):
        figure = paths.corpus / "figure04.fn"
        self.check([], 2, "FILE.fn")
        self.check([figure, "--colour"], 2, "--colour")
        self.check([figure, "-o", "plot.jpg"], 2, "'plot.jpg' is no .png, .svg or .pdf")
        self.check([figure, "--duration", "3"], 2, "duration '3' is no time; write a number and a unit")
        self.check([figure, "--duration", "0s"], 2, "not longer than nothing")
        self.check([figure, "--zoom", "3s"], 2, "no stretch of time")
        self.check([figure, "--zoom", "3s..1s"], 2, "ends before it starts")
        self.check([figure, "--duration", "2000000h"], 2, "'2000000h' is longer than 126 years")
        for per_page in ("0", "33", "x", "²"):
            self.check([figure, "--per-page", per_page], 2, f"'{per_page}' is no whole number 1 … 32")
        self.check([figure, "--duration", "3s", "--capture", "c.tik"], 2, "both say how long")

    @needs_matplotlib
    def test_no_page_replaces_an_input_or_anything_unasked(self):
        mask, page = write("pages-1.png", b"P5 3 3 255\n" + bytes(range(9))), paths.work / "pages-2.png"
        nine = [write("nine.fn", many_functions(9)), "-o", paths.work / "pages.png"]
        page.unlink(missing_ok=True)
        self.check([*nine, "--mask", mask], 2, f"'{mask}' is the input")
        self.check(nine, 2, f"{mask} is there already and is not replaced", overwrite=False)
        self.assertEqual((mask.stat().st_size, page.exists()), (20, False))
        self.check(nine, 0, "")
        mask.unlink()
        self.check(nine, 2, f"{page} is there already", overwrite=False)
        self.assertFalse(mask.exists())

    @needs_matplotlib
    def test_standard_input(self):
        output = paths.work / "piped.svg"
        result = run("-", "-o", output, stdin="M0 [0:1], [5:0]\n")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("<!-- standard input -->", output.read_text(encoding="utf-8"))
        result = run("-", stdin="M0 [0:1],\n")
        self.assertEqual(result.returncode, 3)
        self.assertIn("standard input:1:9: a comma", result.stderr)
        self.check(["-", "--mask", "-"], 2, "only the function file is read from standard input")

    def test_a_program_that_is_missing_or_another(self):
        figure = paths.corpus / "figure04.fn"
        self.check([figure, "--program", paths.work / "none"], 5, "say where nutik-cl is: --program")
        self.check([figure, "--program", "/bin/true"], 3, "/bin/true says nothing of the functions of")
        self.check([figure, "--program", "/bin/false"], 1, "/bin/false check")
        self.check([figure, "--program", "/bin/echo"], 3, "/bin/echo says nothing of the functions of")

    def test_missing_file(self):
        self.check([paths.work / "none.fn", "-o", paths.work / "none.png"], 3, "none.fn cannot be read: No such file")

    @needs_matplotlib
    def test_missing_folder(self):
        for suffix in ("png", "svg", "pdf"):
            output = paths.work / "no-such-folder" / f"plot.{suffix}"
            words = f"FnPlotter.py: {output} cannot be written: No such file"
            self.check([paths.corpus / "figure04.fn", "-o", output], 5, words)

    def test_missing_matplotlib(self):
        folder = paths.work / "without-matplotlib"
        folder.mkdir(exist_ok=True)
        (folder / "matplotlib.py").write_text("raise ImportError('it is not here')\n", encoding="utf-8")
        words = (f"Matplotlib cannot be loaded by {sys.executable} (it is not here); Debian has it for /usr/bin/python3: "
                 "apt install python3-matplotlib")
        arguments = [paths.corpus / "figure04.fn", "-o", paths.work / "none.png"]
        self.check(arguments, 5, words, PYTHONPATH=str(folder))

    def test_help_has_examples(self):
        result = run("--help")
        self.assertEqual(result.returncode, 0)
        for words in ("--duration 3s", "-o ball.pdf", "--mask ball.pgm", "exit status"):
            self.assertIn(words, result.stdout)
