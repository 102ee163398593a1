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


class BuildWithCMake(build_ext):
    """The module and what decodes clips, as CMake makes them, and the Python files."""

    def run(self):
        stated = os.environ.get("NUTIK_BUILD_DIR")
        folder = Path(stated).resolve() if stated else CMAKE_FOLDER
        if not (folder / "CMakeCache.txt").exists():
            subprocess.run(["cmake", "--preset", "release", "-S", ROOT, "-B", folder, "-DNUTIK_BUILD_TESTS=OFF",
                            "-DNUTIK_BUILD_BENCHMARKS=OFF", "-DNUTIK_BUILD_PYTHON=ON",
                            f"-DPython_EXECUTABLE={sys.executable}", *shlex.split(os.environ.get("CMAKE_ARGS", ""))],
                           check=True, cwd=ROOT)
        subprocess.run(["cmake", "--build", folder, "--target", "nutik_python_package"], check=True)
        made, target = folder / "python" / "nutik", Path(self.build_lib) / "nutik"
        module = Path(self.get_ext_filename("_nutik")).name
        if not (made / module).exists():
            raise SystemExit(f"{folder} is configured for another Python: {made / module} is missing")
        shutil.rmtree(target, ignore_errors=True)
        target.mkdir(parents=True)
        for file in (made / module, *made.glob("nutik-*.so"), *(ROOT / "python/nutik").glob("*.py*"),
                     ROOT / "python/nutik/py.typed"):
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
