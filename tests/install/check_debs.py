#!/usr/bin/python3
"""The Debian packages of a build: what each holds and needs, what lintian and the checkers of desktop files say, and the
Python package as `cmake --install --component python` installs it. tools/packages --try installs and uses them.

    check_debs.py --build FOLDER --work FOLDER --program PROGRAM
"""

import argparse
import gzip
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

PACKAGING = Path(__file__).resolve().parents[2] / "packaging"

# What each package holds, below its prefix: patterns, each of at least one file.
HOLDS = {
    "nutik-cl": ("bin/nutik-cl", "share/man/man1/nutik-cl.1.gz", "share/bash-completion/completions/nutik-cl",
                 "share/zsh/.*/_nutik-cl", "share/fish/vendor_completions.d/nutik-cl.fish",
                 "share/mime/packages/nutik.xml", "share/thumbnailers/nutik.thumbnailer"),
    "nutik-modules": tuple(f"lib/.*nutik/nutik-{name}.so" for name in ("videos", "stills", "motion")),
    "nutik-studio": ("bin/nutik-studio", "share/man/man1/nutik-studio.1.gz", "share/applications/nutik-studio.desktop",
                     "share/metainfo/.*[.]studio[.]metainfo.xml", "share/icons/hicolor/scalable/apps/nutik-studio.svg",
                     "share/icons/hicolor/48x48/apps/nutik-studio.png"),
    "nutik-plotters": ("bin/FnPlotter.py", "bin/NoisePlotter.py", "share/nutik/fnplot/.*.py", "share/nutik/noiseplot/.*.py"),
    "python3-nutik": ("lib/python3.*/nutik/_nutik.*.so", "lib/python3.*/nutik/__init__.py", "lib/python3.*/nutik/py.typed",
                      "lib/python3.*/nutik/nutik-videos.so", "lib/python3.*/nutik-.*.dist-info/METADATA"),
    "libnutik-dev": ("include/nutik/session.hpp", "lib/.*libnutik_session.a", "lib/.*cmake/nutik/nutik-config.cmake",
                     "lib/.*pkgconfig/nutik.pc"),
}
DRIVER = r"pocl-opencl-icd \| opencl-icd"
NEEDS = {
    "nutik-cl": (r"nutik-modules \(= [\d.]+\)", DRIVER, "libc6 ", "ocl-icd-libopencl1|libopencl1"),
    "nutik-modules": ("libavcodec", "libopencv-core"),
    "nutik-studio": (r"nutik-modules \(= [\d.]+\)", DRIVER, "libqt6widgets6"),
    "nutik-plotters": (r"nutik-cl \(>= [\d.]+\)", "python3:any", "python3-matplotlib"),
    "python3-nutik": (r"python3 \(>= 3", r"python3 \(<< 3", "python3-numpy", DRIVER, "libavcodec"),
    "libnutik-dev": (r"nutik-modules \(= [\d.]+\)", "ocl-icd-opencl-dev", "opencl-clhpp-headers"),
}


def skip(why):
    print(f"SKIPPED: {why}")
    sys.exit(0)


def output_of(*words, **named):
    return subprocess.run([str(word) for word in words], check=True, text=True, stdout=subprocess.PIPE, **named).stdout


def check_package(deb, expected, mistakes):
    name = output_of("dpkg-deb", "-f", deb, "Package").strip()
    listed = [line.split(maxsplit=5)[5].removeprefix("./") for line in output_of("dpkg-deb", "-c", deb).splitlines()]
    files = [file for file in listed if not file.endswith("/")]
    for pattern in (*HOLDS[name], f"share/doc/{name}/copyright", f"share/doc/{name}/changelog.gz"):
        if not any(re.fullmatch(rf"(usr/)?(local/)?{pattern}", file) for file in files):
            mistakes.append(f"{name} lacks {pattern}")
    depends = output_of("dpkg-deb", "-f", deb, "Depends")
    for pattern in NEEDS[name]:
        if not re.search(pattern, depends):
            mistakes.append(f"{name} does not depend on {pattern}: {depends}")
    # No file is in two packages.
    for file in files:
        if file in expected:
            mistakes.append(f"{file} is in {name} and in {expected[file]}")
        expected[file] = name
    description = output_of("dpkg-deb", "-f", deb, "Description")
    if not description.strip() or any(len(line) > 80 for line in description.splitlines()):
        mistakes.append(f"{name}'s description has long lines:\n{description}")
    print(f"{name}: {len(files)} files, {deb.stat().st_size / 1e6:.1f} MB")
    return name


def check_desktop(tree, mistakes):
    """What desktops read, by those who define it, as far as they are installed."""
    checkers = (("desktop-file-validate", ("share/applications/nutik-studio.desktop",), ()),
                ("appstreamcli", ("share/metainfo/*.studio.metainfo.xml",), ("validate", "--no-net", "--pedantic")))
    for program, files, words in checkers:
        if shutil.which(program) is None:
            print(f"{program} is not installed")
            continue
        for file in files:
            (found,) = tree.rglob(file)
            done = subprocess.run([program, *words, found], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
            errors = [line for line in done.stdout.splitlines() if line.startswith(("E:", "W:"))]
            if done.returncode != 0 and (program != "appstreamcli" or errors):
                mistakes.append(f"{program}: {done.stdout}")


def check_type(tree, work, program, mistakes):
    """A .tik is recognized by its name and by its content, and no Netpbm picture is taken for one."""
    if shutil.which("update-mime-database") is None or shutil.which("gio") is None:
        print("update-mime-database or gio is not installed")
        return
    folder = work / "data"
    (folder / "mime/packages").mkdir(parents=True)
    for file in (*tree.rglob("share/mime/packages/nutik.xml"), Path("/usr/share/mime/packages/freedesktop.org.xml")):
        if file.exists():
            shutil.copy(file, folder / "mime/packages")
    subprocess.run(["update-mime-database", folder / "mime"], check=True, stderr=subprocess.DEVNULL)
    (work / "clip.raw").write_bytes(bytes(range(64)) * 3)
    for kind, pixels in (("gray", "8x8"), ("rgb24", "8x2")):
        subprocess.run([program, "-q", "--raw", f"{pixels}:{kind}", "-f", "25", work / "clip.raw", work / f"{kind}.tik"], check=True)
        shutil.copy(work / f"{kind}.tik", work / f"{kind}-unnamed")
    (work / "picture.pgm").write_bytes(b"P5\n# TIKI\n1 1\n255\nx")
    expected = {"gray.tik": True, "gray-unnamed": True, "rgb24.tik": True, "rgb24-unnamed": True, "picture.pgm": False}
    for name, is_capture in expected.items():
        told = output_of("gio", "info", "-a", "standard::content-type", work / name,
                         env=os.environ | {"XDG_DATA_HOME": str(folder), "XDG_DATA_DIRS": str(folder)})
        if ("image/x-nutik-capture" in told) != is_capture:
            mistakes.append(f"{name} is taken for {told.split()[-1]}")
    # The thumbnailer's command, as a file manager fills it in.
    (thumbnailer,) = tree.rglob("share/thumbnailers/nutik.thumbnailer")
    line = re.search(r"^Exec=nutik-cl (.*)$", thumbnailer.read_text(), re.MULTILINE)[1]
    words = line.replace("%s", "128").replace("%i", str(work / "gray.tik")).replace("%o", str(work / "thumb.png")).split()
    subprocess.run([program, *words], check=True, env={"PATH": "/usr/bin"})
    if not (work / "thumb.png").read_bytes().startswith(b"\x89PNG"):
        mistakes.append("the thumbnailer made no PNG")


def check_studio_page(tree, mistakes):
    """The studio's manual page has every option of its help."""
    (program,), (page,) = tree.rglob("bin/nutik-studio"), tree.rglob("man1/nutik-studio.1.gz")
    help_text = output_of(program, "--help", env=os.environ | {"QT_QPA_PLATFORM": "offscreen"})
    text = gzip.decompress(page.read_bytes()).decode().replace("\\", "")
    for option in re.findall(r"--[a-z][\w-]*", help_text):
        if option not in text:
            mistakes.append(f"nutik-studio's manual page lacks {option}")


def check_python(build, work, mistakes):
    """Installed only if it is asked for, and then complete."""
    prefix = work / "python"
    subprocess.run(["cmake", "--install", build, "--prefix", prefix, "--component", "python"], check=True,
                   stdout=subprocess.DEVNULL)
    (package,) = prefix.rglob("nutik/__init__.py")
    script = ("import nutik, numpy, importlib.metadata as m\n"
              "a = numpy.arange(96, dtype=numpy.uint8).reshape(2, 6, 8)\n"
              "c = nutik.encode(a, rate=25)\n"
              "assert (c.render(start='1f', exposure='1f', codes=True).array == a[1]).all()\n"
              "assert m.version('nutik') == nutik.__version__\n"
              "print(nutik.__file__)")
    told = output_of(sys.executable, "-c", script, cwd=work,
                     env=os.environ | {"PYTHONPATH": str(package.parents[1]), "PYTHONDONTWRITEBYTECODE": "1"})
    if not told.startswith(str(prefix)):
        mistakes.append(f"Python took {told}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("build", "work", "program"):
        parser.add_argument(f"--{name}", type=lambda text: Path(text).resolve(), required=True)
    arguments = parser.parse_args()
    for tool in ("cpack", "dpkg-deb", "dpkg-shlibdeps"):
        if shutil.which(tool) is None:
            skip(f"{tool} is not installed")
    work = arguments.work
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    subprocess.run(["cpack", "-G", "DEB", "--config", arguments.build / "CPackConfig.cmake", "-B", work / "debs",
                    "-D", "CPACK_DEBIAN_COMPRESSION_TYPE=gzip"], check=True, stdout=subprocess.DEVNULL)
    debs = sorted((work / "debs").glob("*.deb"))
    if "NUTIK_HAS_STD_FORMAT:INTERNAL=1" not in (arguments.build / "CMakeCache.txt").read_text():
        NEEDS["libnutik-dev"] += ("libfmt-dev",)
    mistakes, owners, tree = [], {}, work / "tree"
    names = {check_package(deb, owners, mistakes) for deb in debs}
    built = set(HOLDS) - ({"nutik-studio"} if not (arguments.build / "nutik-studio").exists() else set())
    if not (arguments.build / "python/nutik").exists():
        built.discard("python3-nutik")
    if names != built:
        mistakes.append(f"packages: {sorted(names)}, not {sorted(built)}")
    for deb in debs:
        subprocess.run(["dpkg-deb", "-x", deb, tree], check=True)
    if "nutik-studio" in names:
        check_desktop(tree, mistakes)
        check_studio_page(tree, mistakes)
    check_type(tree, work, arguments.program, mistakes)
    if "python3-nutik" in names:
        check_python(arguments.build, work, mistakes)
    if shutil.which("lintian"):
        # Packages of another prefix than /usr, as this build's may be, are not what tools/packages makes.
        if (tree / "usr/bin").exists():
            done = subprocess.run(["lintian", "--fail-on", "error", *debs], text=True, stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT)
            print(done.stdout)
            if done.returncode != 0:
                mistakes.append(f"lintian: {done.stdout}")
    shutil.rmtree(tree)
    shutil.rmtree(work / "debs")
    print("\n".join(mistakes) or f"{len(debs)} packages")
    return 1 if mistakes else 0


if __name__ == "__main__":
    sys.exit(main())
