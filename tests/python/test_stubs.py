"""The stubs of the module say what is there, names and arguments; the package is annotated and says what it takes."""

import ast
import doctest
import inspect
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import typing
import unittest
import warnings
from pathlib import Path

import numpy as np

import nutik
from nutik import _nutik

STUBS = ast.parse(Path(nutik.__file__).with_name("_nutik.pyi").read_text(encoding="utf-8"))
OURS = {"__init__", "__version__"}


def arguments_told(function):
    """`open(path: str, settings: ...) -> ...` at the head of the docstring: pybind11 writes it from the code."""
    head = function.__doc__.splitlines()[0]
    inside, depth, names = head[head.index("(") + 1:], 0, [""]
    for character in inside:
        depth += {"[": 1, "(": 1, "]": -1, ")": -1}.get(character, 0)
        if depth < 0:
            break
        if character == "," and depth == 0:
            names.append("")
        else:
            names[-1] += character
    return [name.split(":")[0].strip() for name in names if name.strip()]


def stubs_of(body):
    return {each.name if not isinstance(each, ast.AnnAssign) else each.target.id: each for each in body
            if isinstance(each, (ast.FunctionDef, ast.ClassDef, ast.AnnAssign))}


class Stubs(unittest.TestCase):
    def check_arguments(self, stub, function, name):
        stated = [each.arg for each in stub.args.args]
        self.assertEqual(stated, arguments_told(function), name)
        for each in stub.args.args:
            self.assertTrue(each.annotation or each.arg == "self", f"{name}: {each.arg} has no type")
        self.assertIsNotNone(stub.returns, name)

    def test_the_module(self):
        stubs = stubs_of(STUBS.body)
        there = {name for name in dir(_nutik) if not name.startswith("_") or name in OURS}
        self.assertEqual(set(stubs), there - {"__init__"})
        for name, stub in stubs.items():
            real = getattr(_nutik, name)
            if isinstance(stub, ast.FunctionDef):
                self.check_arguments(stub, real, name)
            elif isinstance(stub, ast.ClassDef):
                self.check_class(stub, real, name)

    def check_class(self, stub, real, name):
        if issubclass(real, Exception):
            self.assertEqual([ast.unparse(base) for base in stub.bases], [base.__name__ for base in real.__bases__],
                             name)
            return
        members = stubs_of(stub.body)
        there = {each for each in vars(real) if not each.startswith("_") or each == "__init__"}
        if real.__init__ is object.__init__ or "__init__" not in members:
            there.discard("__init__")
        self.assertEqual(set(members), there, name)
        for member, each in members.items():
            if isinstance(inspect.getattr_static(real, member), property):
                self.assertEqual([ast.unparse(one) for one in each.decorator_list], ["property"], f"{name}.{member}")
            else:
                self.check_arguments(each, getattr(real, member), f"{name}.{member}")

    def test_what_the_package_offers(self):
        for name in nutik.__all__:
            offered = getattr(nutik, name)
            if name == "__version__":
                self.assertRegex(offered, r"^\d+\.\d+\.\d+$")
                continue
            self.assertTrue(offered.__doc__, f"{name} has no docstring")
            self.assertNotRegex(offered.__doc__, "--[a-z]", name)
            for part, function in [(name, offered)] if inspect.isfunction(offered) else inspect.getmembers(
                    offered, inspect.isfunction):
                if part.startswith("_") and part != "__init__":
                    continue
                hints = typing.get_type_hints(function)
                for argument in inspect.signature(function).parameters:
                    self.assertTrue(argument in hints or argument == "self", f"{name}.{part}: {argument} has no type")
                self.assertIn("return", hints, f"{name}.{part}")
        public = {each for each in vars(nutik) if not each.startswith("_")
                  and not inspect.ismodule(getattr(nutik, each))}
        self.assertEqual(public, set(nutik.__all__) - {"__version__"})
        self.assertTrue(Path(nutik.__file__).with_name("py.typed").exists())

    def test_every_argument_of_open_and_encode_is_a_row_of_the_schema(self):
        stated = set()
        for function in (nutik.open, nutik.encode):
            stated |= set(inspect.signature(function).parameters)
        besides = {"path", "source", "output", "times", "exposures", "name", "device", "memory", "renderer", "progress",
                   "clip"}
        rows = _nutik.described("encode")[2]
        self.assertEqual(stated - besides, {name for name, row in rows.items() if row[3]})

    def test_examples_run(self):
        """Those of all docstrings, with a small capture at hand."""
        pictures = np.random.default_rng(1).integers(0, 256, (10, 24, 32), np.uint8)
        count = 0
        folder = tempfile.TemporaryDirectory(prefix="nutik-")
        self.addCleanup(folder.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(folder.name)
        nutik.encode(pictures, "clip.tik", rate=100)
        nutik.encode(pictures, "blocks.tik", rate=100, block_samples=4)
        whole = Path("blocks.tik").read_bytes()
        Path("cut.tik").write_bytes(whole[:-2000])
        Path("list.txt").write_text("--start 0s --exposure 10ms a.png\n", encoding="utf-8")
        os.mkdir("stills")
        for k in range(96):
            still = np.linspace(20, 230, 4096).reshape(64, 64) + np.random.default_rng(k).normal(0, 3, (64, 64))
            Path(f"stills/{k:02}.pgm").write_bytes(b"P5 64 64 255 " + still.astype(np.uint8).tobytes())
        for module in (nutik, *(each for name, each in sorted(vars(nutik).items())
                                if name.startswith("_") and inspect.ismodule(each) and each is not _nutik)):
            capture = nutik.encode(pictures, rate=100)
            found = doctest.testmod(module, extraglobs={"nutik": nutik, "np": np, "capture": capture})
            self.assertEqual(found.failed, 0, module.__name__)
            count += found.attempted
        self.assertGreater(count, 50)

    def test_docstrings_have_sections(self):
        """NumPy's: every parameter with its type and what it is; what comes back, what is raised, an example."""
        for name in nutik.__all__:
            offered = getattr(nutik, name)
            if name == "__version__" or inspect.isclass(offered) and issubclass(offered, BaseException):
                continue
            members = [(name, offered)] if inspect.isfunction(offered) else [
                (f"{name}.{part}", getattr(offered, part)) for part in vars(offered) if not part.startswith("_")
                and inspect.isroutine(getattr(offered, part))]
            for part, function in members:
                with self.subTest(part):
                    doc = inspect.cleandoc(function.__doc__)
                    parts = re.split(r"^(\w+)\n-+\n", doc, flags=re.MULTILINE)[1:]
                    self.assertEqual(len(set(parts[::2])), len(parts[::2]), parts[::2])
                    sections = dict(zip(*[iter(parts)] * 2))
                    signature = inspect.signature(function)
                    arguments = [each for each in signature.parameters if each not in ("self", "cls")]
                    for argument in arguments:
                        self.assertRegex(sections["Parameters"], rf"(?m)^\*?(\w+, )*{argument}(, \w+)* : .+", argument)
                    self.assertNotRegex(sections.get("Parameters", ""), r"(?m)^\w+(, \w+)* : [^\n]+\n *(\n|\Z)")
                    self.assertTrue("Raises" in sections or not arguments)
                    if signature.return_annotation not in ("None", None):
                        self.assertTrue(sections["Returns"].strip())
                        self.assertNotRegex(sections["Returns"], r"\b_\w+\.", "it names a module of the package's own")
                    if "progress" in arguments:
                        self.assertIn("Ctrl-C", sections["Notes"])
                    if part == name or arguments and part.startswith("Capture.") and part != "Capture.to_xarray":
                        self.assertIn(">>>", sections["Examples"])

    def test_nothing_is_typed_any(self):
        """What users call, and the engine's stubs."""
        self.assertNotRegex(Path(nutik.__file__).with_name("_nutik.pyi").read_text(), r"\bAny\b")
        for name in nutik.__all__:
            offered = getattr(nutik, name)
            functions = [(name, offered)] if inspect.isfunction(offered) else inspect.getmembers(
                offered, inspect.isfunction)
            for part, function in functions:
                if not part.startswith("_") or part in ("__init__", "__getitem__", "__call__", "__iter__", "__array__"):
                    for argument, kind in function.__annotations__.items():
                        self.assertNotRegex(str(kind), r"\bAny\b", f"{name}.{part}: {argument}")

    def test_mypy_finds_nothing(self):
        """In strict mode: in the package, and in scripts as the page and the notebook have them."""
        if shutil.which("mypy") is None:
            self.skipTest("mypy is not installed")
        root = Path(__file__).resolve().parents[2]
        page = (root / "docs/reference/python.md").read_text(encoding="utf-8")
        book = json.loads((root / "examples/array-to-figure.ipynb").read_text(encoding="utf-8"))
        with tempfile.TemporaryDirectory(prefix="nutik-") as folder:
            scripts = {"page.py": "\n".join(re.findall(r"^```python\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)),
                       "notebook.py": "\n".join("".join(cell["source"]) for cell in book["cells"]
                                                if cell["cell_type"] == "code"),
                       "typed.py": "import numpy as np, nutik\n"
                                   "capture = nutik.open('light.npy', rate=np.float32(12.5), white=1.0)\n"
                                   "capture.render_many(np.ones((3, len(capture))))\n"
                                   "capture.render(start=np.float32(0.5), exposure=np.int64(1))\n"}
            for name, text in scripts.items():
                (Path(folder) / name).write_text(text, encoding="utf-8")
            # matplotlib of Debian 12 has no types.
            (Path(folder) / "mypy.ini").write_text("[mypy]\n[mypy-matplotlib.*]\nignore_missing_imports = True\n")
            for checked in ([str(root / "python/nutik")], [str(Path(folder) / name) for name in scripts]):
                done = subprocess.run(["mypy", "--strict", "--python-executable", sys.executable, "--cache-dir",
                                       f"{folder}/cache", *checked], capture_output=True, text=True, cwd=folder,
                                      env={**os.environ, "MYPYPATH": str(root / "python")})
                self.assertEqual(done.returncode, 0, done.stdout + done.stderr)


if __name__ == "__main__":
    unittest.main()
