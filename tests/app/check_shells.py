#!/usr/bin/env python3
"""Completion scripts and the manual page, in the hands of those that read them: bash, zsh, fish, groff.

Prints SKIPPED with the reason where one of them is not there.
"""
import argparse
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

SECTIONS = {}


def section(name):
    def keep(function):
        SECTIONS[name] = function
        return function
    return keep


def output(*words, **more):
    return subprocess.run(words, text=True, check=True, capture_output=True, **more).stdout


def expect(is_true, message):
    if not is_true:
        sys.exit(message)


def complete_in_bash(script, folder, line):
    """What bash offers at the end of `line`."""
    words = line.split(" ")
    # As readline hands them over: = is a word of its own.
    words = [part for word in words for part in (re.split("(=)", word) if "=" in word else [word])]
    if words[-1] == "" and len(words) > 1 and words[-2] == "=":
        words.pop()
    quoted = " ".join("'" + word + "'" for word in words)
    result = output("bash", "--norc", "-c",
                    f"source {script}; COMP_WORDS=({quoted}); COMP_CWORD={len(words) - 1}; _nutik_cl; "
                    'printf "%s\\n" "${COMPREPLY[@]}"', cwd=folder)
    return set(result.split("\n")) - {""}


@section("bash")
def check_bash(program, work):
    script = work / "nutik-cl.bash"
    script.write_text(output(program, "completion", "bash"))
    for name in ("clip.tik", "clip.mp4", "a b.fn", "mask.pgm", "mask.png", "notes.txt"):
        (work / name).touch()
    (work / "masks").mkdir()

    def offers(line, expected, only=True):
        found = complete_in_bash(script, work, line)
        expect(found == expected if only else found >= expected, f"{line!r} offers {found}, not {expected}")

    offers("nutik-cl enc", {"encode"})
    offers("nutik-cl ", {"encode", "expose", "man", "clip.tik"}, only=False)
    offers("nutik-cl --expo", {"--exposure"})
    offers("nutik-cl expose --nega", {"--negative"})
    offers("nutik-cl expose --negative ", {"saturate", "offset", "abs"})
    offers("nutik-cl expose --negative=", {"saturate", "offset", "abs"})
    offers("nutik-cl expose --negative=o", {"offset"})
    offers("nutik-cl --renderer r", {"reference"})
    offers("nutik-cl --precision ", {"auto", "single", "compensated", "double", "fixed"})
    offers("nutik-cl -k ", {"a b.fn", "masks"})
    offers("nutik-cl -m m", {"mask.pgm", "mask.png", "masks"})
    offers("nutik-cl --delay ma", {"mask.pgm", "mask.png", "masks"})
    offers("nutik-cl info ", {"clip.tik", "masks"})
    offers("nutik-cl --start ", set())
    offers("nutik-cl -qo pic.png -k ", {"a b.fn", "masks"})
    offers("nutik-cl expose --nosuch 3 --nega", set())
    offers("nutik-cl mask --difference 0f mask.p", {"mask.pgm", "mask.png"})
    offers("nutik-cl shutter --gain 2 h", {"hann"})
    offers("nutik-cl shutter hann c", {"clip.tik", "clip.mp4"})
    offers("nutik-cl completion ", {"bash", "zsh", "fish"})
    offers("nutik-cl info --", {"--help", "--activity", "--json", "--overwrite", "--quiet"})
    offers("nutik-cl devices --json ", set())
    # What the table has, completion has: all options of all commands.
    overview = output(program, "--help")
    also = re.search("Also: (.*), help", overview)[1].split(", ")
    for command in re.findall(r"^  ([a-z]+) {2,}[A-Z]", overview, re.M) + also:
        page = output(program, command, "--help=all").split("\nSeldom needed:")[0]
        offers(f"nutik-cl {command} --", set(re.findall(r"^(?:  -., |      )(--[a-z-]+)", page, re.M)) | {"--help"})


def has_terminals():
    try:
        for end in os.openpty():
            os.close(end)
    except OSError:
        return False
    return True


@section("zsh")
def check_zsh(program, work):
    if not has_terminals():
        print("SKIPPED: there is no pseudo terminal here, which zsh is asked through")
        return
    script = work / "_nutik-cl"
    script.write_text(output(program, "completion", "zsh"))
    output("zsh", "-n", str(script))
    # Loaded as zsh loads it, and asked through a terminal.
    (work / "mask.pgm").touch()
    (work / "driver.zsh").write_text(f"""
zmodload zsh/zpty
zpty shell zsh -f -i
zpty -w shell 'PROMPT=; cd {work}; fpath=({work} $fpath); autoload -Uz compinit; compinit -u -D; PROMPT="READY>"'
zpty -r shell seen '*READY>*'
zpty -w -n shell $'nutik-cl expose --negative of\\t'
sleep 1; zpty -w -n shell $'\\n'
zpty -r shell seen '*offset*' && print FOUND
zpty -d shell
""")
    result = subprocess.run(["zsh", "-f", str(work / "driver.zsh")], text=True, capture_output=True, timeout=60,
                            stdin=subprocess.DEVNULL)
    expect("FOUND" in result.stdout, f"zsh does not complete: {result.stdout} {result.stderr}")


@section("fish")
def check_fish(program, work):
    script = work / "nutik-cl.fish"
    script.write_text(output(program, "completion", "fish"))
    output("fish", "--no-execute", str(script))
    (work / "clip.tik").touch()

    def offers(line, expected):
        found = output("fish", "--no-config", "-c", f"source {script}; complete -C '{line}'", cwd=work)
        found = {row.split("\t")[0] for row in found.splitlines()}
        expect(found >= expected, f"{line!r} offers {found}, not {expected}")

    offers("nutik-cl enc", {"encode"})
    offers("nutik-cl expose --nega", {"--negative"})
    offers("nutik-cl expose --negative ", {"saturate", "offset", "abs"})
    offers("nutik-cl expose --negative=o", {"--negative=offset"})
    offers("nutik-cl --precision ", {"auto", "single"})
    offers("nutik-cl info ", {"clip.tik"})
    offers("nutik-cl mask --threshold 0f 40..90 clip.tik --ta", {"--tag"})


@section("groff")
def check_man(program, work):
    page = work / "nutik-cl.1"
    page.write_text(output(program, "man"))
    page.read_text().encode("ascii")
    result = subprocess.run(["groff", "-man", "-ww", "-Tutf8", "-P-cbou", str(page)], text=True, check=True,
                            capture_output=True)
    expect(result.stderr == "", result.stderr)
    for part in ("NAME", "SYNOPSIS", "--negative HOW", "nutik-cl clip.mp4 clip.tik", "EXIT STATUS", "NO_COLOR",
                 "spline:0=G,…,1=G", "'frames/*.png'"):
        expect(part in result.stdout, f"{part} is not on the page")
    for name in re.findall(r"^(?:  -., |      )(--[a-z-]+)", output(program, "expose", "--help=all"), re.M):
        expect(name in result.stdout, f"{name} is not on the page")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", required=True)
    parser.add_argument("--work", required=True, type=Path)
    parser.add_argument("--only", required=True, choices=SECTIONS)
    arguments = parser.parse_args()
    if shutil.which(arguments.only) is None:
        print(f"SKIPPED: {arguments.only} is not installed")
        return
    work = (arguments.work / arguments.only).resolve()
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    # The scripts ask the program that is being completed.
    os.environ["PATH"] = f"{Path(arguments.program).parent}:{os.environ['PATH']}"
    SECTIONS[arguments.only](arguments.program, work)


if __name__ == "__main__":
    main()
