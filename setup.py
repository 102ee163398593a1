"""Builds the Python package with CMake, in build-python/, and packs it into a wheel:

    pip wheel . --no-build-isolation --no-deps

CMAKE_ARGS are handed to CMake. NUTIK_BUILD_DIR=build takes a build folder that is there already, as it is configured,
and compiles only what is missing.
"""

import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = Path(__file__).resolve().parent
CMAKE_FOLDER = ROOT / "build-python"
OWN_FOLDER = CMAKE_FOLDER / "wheel"  # setuptools'
OWN_FOLDER.mkdir(parents=True, exist_ok=True)


def version():
    return re.search(r"^project\(nutik VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text(), re.MULTILINE).group(1)


def run_cmake(*words):
    """CMake itself has said what is wrong."""
    try:
        status = subprocess.run(["cmake", *words], cwd=ROOT).returncode
    except FileNotFoundError as error:
        raise SystemExit(f"cmake is missing: {error}")
    if status != 0:
        raise SystemExit(f"cmake failed, status {status}; what it needs: docs/how-to/install.md, tools/setup.sh")


class BuildWithCMake(build_ext):
    """The module and what decodes clips, as CMake makes them, and the Python files."""

    def run(self):
        stated = os.environ.get("NUTIK_BUILD_DIR")
        folder = Path(stated).resolve() if stated else CMAKE_FOLDER
        # CMake writes these at the end, where nothing was missing; its cache is there before.
        if not any((folder / made).exists() for made in ("build.ninja", "Makefile")):
            run_cmake("--preset", "release", "-S", ROOT, "-B", folder, "-DNUTIK_BUILD_TESTS=OFF",
                      "-DNUTIK_BUILD_BENCHMARKS=OFF", "-DNUTIK_BUILD_PYTHON=ON",
                      f"-DPython_EXECUTABLE={sys.executable}", *shlex.split(os.environ.get("CMAKE_ARGS", "")))
        run_cmake("--build", folder, "--target", "nutik_python_package")
        made, target = folder / "python" / "nutik", Path(self.build_lib) / "nutik"
        module = Path(self.get_ext_filename("_nutik")).name
        if not (made / module).exists():
            raise SystemExit(f"{folder} is configured for another Python: {made / module} is missing")
        shutil.rmtree(target, ignore_errors=True)
        target.mkdir(parents=True)
        for file in (made / module, *made.glob("nutik-*.so"), *(ROOT / "python/nutik").glob("*.py*"),
                     *(ROOT / "python/nutik" / name for name in ("py.typed", "napari.yaml"))):
            shutil.copy2(file, target)

    def get_outputs(self):
        return [str(file) for file in (Path(self.build_lib) / "nutik").iterdir()]


setup(
    version=version(),
    packages=[],
    ext_modules=[Extension("nutik._nutik", sources=[])],
    cmdclass={"build_ext": BuildWithCMake},
    options={"build": {"build_base": str(OWN_FOLDER)}, "egg_info": {"egg_base": str(OWN_FOLDER)}},
    zip_safe=False,
)
