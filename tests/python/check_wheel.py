#!/usr/bin/python3
"""A wheel is built from a build folder and used from a fresh virtual environment with the system's NumPy, far away from
both: arrays, videos (which a module beside the package decodes), errors. The sources can be packed, too.

    check_wheel.py --build FOLDER --work FOLDER
"""

import argparse
import importlib.util
import os
import shutil
import subprocess
import sys
import textwrap
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

USED = textwrap.dedent("""
    import sys
    from pathlib import Path
    import numpy as np
    import nutik
    assert Path(nutik.__file__).is_relative_to(sys.prefix), nutik.__file__
    pictures = np.arange(4 * 16 * 16 * 3, dtype=np.uint8).reshape(4, 16, 16, 3)
    capture = nutik.encode(pictures, "clip.tik", rate=25)
    assert (capture.render(start="2f", exposure="1f", codes=True, transfer="source").array == pictures[2]).all()
    capture.render(start="2f", exposure="1f", codes=True).write("still.png")
    assert nutik.open("still.png", rate=1).shape == (1, 16, 16, 3)
    Path("broken.mp4").write_bytes(b"no video")
    try:
        nutik.open("broken.mp4")
    except nutik.InputError as error:
        assert "module" not in str(error) and "nutik-videos" not in str(error), error
    else:
        raise AssertionError("broken.mp4 was opened")
    print(nutik.__version__)
""")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("build", "work"):
        parser.add_argument(f"--{name}", type=Path, required=True)
    arguments = parser.parse_args()
    arguments.build, arguments.work = arguments.build.resolve(), arguments.work.resolve()
    for module in ("pip", "setuptools", "wheel", "ensurepip"):
        if importlib.util.find_spec(module) is None:
            print(f"SKIPPED: Python's module {module} is not installed")
            return
    shutil.rmtree(arguments.work, ignore_errors=True)
    arguments.work.mkdir(parents=True)
    environment = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "PYTHONHOME")}

    def run(*words, **named):
        return subprocess.run([str(word) for word in words], check=True, cwd=arguments.work, text=True, **named)

    run(sys.executable, "-m", "pip", "wheel", ROOT, "--no-build-isolation", "--no-deps", "--no-index", "-q", "-w",
        "wheels", env=environment | {"NUTIK_BUILD_DIR": str(arguments.build)})
    (wheel,) = (arguments.work / "wheels").glob("nutik-*.whl")
    # The sources as they are packed lack no file that a build begins with.
    subprocess.run([sys.executable, "setup.py", "-q", "sdist", "-d", arguments.work / "sources"], check=True, cwd=ROOT,
                   stderr=subprocess.DEVNULL)
    (packed,) = (arguments.work / "sources").glob("nutik-*.tar.gz")
    run("tar", "xf", packed, "-C", "sources")
    run("cmake", "--preset", "release", "-S", arguments.work / "sources" / packed.name.removesuffix(".tar.gz"),
        "-B", arguments.work / "configured", "-DNUTIK_BUILD_TESTS=OFF", "-DNUTIK_BUILD_BENCHMARKS=OFF",
        "-DNUTIK_BUILD_PYTHON=ON", f"-DPython_EXECUTABLE={sys.executable}", stdout=subprocess.DEVNULL)
    run(sys.executable, "-m", "venv", "--system-site-packages", "environment", env=environment)
    python = arguments.work / "environment/bin/python"
    run(python, "-m", "pip", "install", "--no-deps", "--no-index", "-q", wheel, env=environment)
    version = run(python, "-c", USED, env=environment, stdout=subprocess.PIPE).stdout.strip()
    assert wheel.name.startswith(f"nutik-{version}-"), (wheel.name, version)
    print(f"{wheel.name} works")


if __name__ == "__main__":
    main()
