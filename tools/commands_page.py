#!/usr/bin/python3
"""Writes docs/reference/commands.md from the manual page, which the program makes from its table of options.

    tools/commands_page.py --program build/nutik-cl            writes the page
    tools/commands_page.py --program build/nutik-cl --check    says whether the page is what would be written
"""

import argparse
import difflib
import re
import subprocess
import sys
import textwrap
from collections import Counter
from pathlib import Path

PAGE = Path(__file__).resolve().parents[1] / "docs" / "reference" / "commands.md"

USUAL = 4  # commands that take the same options of a heading
EXAMPLES = 2  # of a command; its help has three, and its page others

# The page that goes on where a command's help ends, where it is not one of the command's name, ../how-to/NAME.md.
FURTHER = {
    "activity": "../how-to/find-the-moment.md", "batch": "../how-to/many-pictures.md",
    "check": "../how-to/check-a-picture.md#checking-before-exposing", "contact": "../how-to/find-the-moment.md",
    "devices": "environment.md#devices", "info": "input.md#colour-shape-and-rate", "encode": "input.md", "expose": "picture.md", "mask": "masks.md",
    "noise": "../how-to/reduce-noise.md", "recover": "tik-format.md#damage", "reproduce": "recipes.md",
    "join": "../how-to/farm.md#encoding-in-parts", "retime": "input.md#colour-shape-and-rate", "shutter": "shutters.md",
    "sweep": "../how-to/find-the-moment.md", "thumbnail": "../how-to/install.md#file-managers", "completion": "environment.md#shells",
    "trace": "../how-to/check-a-picture.md#following-a-pixel", "man": "environment.md#shells",
    "validate": "../how-to/check-a-picture.md#how-right-a-picture-is",
}

PREFACE = """\
# Commands

<!-- Written by tools/commands_page.py from `nutik-cl man`. -->

`nutik-cl COMMAND --help` shows the same in a terminal.

Without a command, these mean

- `encode`: `nutik-cl clip.mp4 clip.tik`, `nutik-cl -o clip.tik clip.mp4`
- `expose`: `nutik-cl -m mask.pgm -k functions.fn clip.tik`, `nutik-cl --start 0.4s --exposure 10ms clip.tik`
- `info`, and a command to try: `nutik-cl clip.tik`

Options and operands come in any order; a short option's value may be attached (`-f120`). A file with a command's name
is written `./info`, or after `--`.
"""


def plain(troff):
    """Text as troff would print it."""
    text = re.sub(r"\\f[BIR]", "", troff)
    text = re.sub(r"\\\[u([0-9A-F]+)\]", lambda match: chr(int(match[1], 16)), text)
    for name, mark in ((r"\-", "-"), (r"\(aq", "'"), (r"\(ha", "^"), (r"\(ti", "~"), (r"\&", ""), (r"\e", "\\")):
        text = text.replace(name, mark)
    return text


def section(man, title):
    return re.search(rf"^\.SH {title}\n(.*?)(?=^\.SH |\Z)", man, re.DOTALL | re.MULTILINE)[1]


def groups(text):
    """Of each subsection its title and its lines."""
    parts = re.split(r"^\.SS (.*)\n", text, flags=re.MULTILINE)
    return [(plain(title), body) for title, body in zip(parts[1::2], parts[2::2])]


def items(text):
    """Of each item its term and what is said of it, unescaped."""
    return [(plain(term), plain(said)) for term, said in re.findall(r"^\.TP\n(.*)\n(.*)\n", text, re.MULTILINE)]


def anchor(heading):
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


def long_name(term):
    """--fps of `-f, --fps RATE`."""
    return re.search(r"--[\w-]+", term)[0]


def folded(text, indent=""):
    return textwrap.fill(text, 120, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False)


def listed(pairs):
    return "".join(folded(f"- `{term}`: {said}", "  ") + "\n" for term, said in pairs)


def named(options):
    """Options by their names; two of one name (--tag) count once."""
    return list(dict.fromkeys(f"`{long_name(term)}`" for term, _, _ in options))


def taken_by(command, options):
    return named(option for option in options if command in option[2])


def usual_options(names, option_groups):
    """For each heading the options that commands mostly take of it, if at least USUAL commands take just these."""
    for heading, options in option_groups:
        counts = Counter(filter(None, (tuple(taken_by(name, options)) for name in names)))
        taken, count = counts.most_common(1)[0]
        if count >= USUAL and len(taken) > 1:
            yield heading, list(taken)


def link(heading):
    """A heading's name, without what it says behind a comma."""
    return f"[{heading.split(',')[0]}](#{anchor(heading)})"


def without(options, left):
    return [option for option in options if option not in left]


def of_heading(heading, every, taken):
    """The options that a command takes of a heading, or those that it does not, if these are fewer."""
    left = without(every, taken)
    if len(taken) > 1 and not left:
        return f"all of {link(heading)}"
    if 2 + len(left) < len(taken):
        return f"all of {link(heading)} but {', '.join(left)}"
    return f"{link(heading)}: {', '.join(taken)}"


def options_of(command, option_groups, usual):
    """How a command differs from what is usual; then its options of the other headings."""
    taken_of = {heading: taken_by(command, options) for heading, options in option_groups}
    if sum(taken_of[heading] == taken for heading, taken in usual.items()) > 2:
        unused, less, more = [], [], []
        for heading, taken in usual.items():
            own = taken_of.pop(heading)
            left = without(taken, own)
            if own and len(left) <= len(own) + 1:
                less += left
                more += without(own, taken)
            elif left:
                unused.append(f"*{heading}*")
                more += own
        less = ", ".join(unused + less)
        more = ", ".join(more)
        yield "[as usual](#usual-options)" + (f" without {less}" if less else "") + (f", with {more}" if more else "")
    for heading, options in option_groups:
        if taken_of.get(heading):
            yield of_heading(heading, named(options), taken_of[heading])


def page_of(man):
    option_groups = []
    command_groups = [(title, items(body)) for title, body in groups(section(man, "COMMANDS"))]
    names = [term.split()[0] for _, commands in command_groups for term, _ in commands]
    for heading, body in groups(section(man, "OPTIONS")):
        options = []
        for term, said in items(body):
            text, takers = re.fullmatch(r"(.*) \[(.*)\]", said).groups()
            options.append((term, text, names if takers == "all commands" else takers.split(", ")))
        option_groups.append((heading, options))
    examples = {title: plain(re.sub(r"^\.(nf|fi)\n", "", body, flags=re.MULTILINE))
                for title, body in groups(section(man, "EXAMPLES"))}
    usual = dict(usual_options(names, option_groups))
    parts = [(title, [term.split()[0] for term, _ in commands]) for title, commands in command_groups]
    parts += [("Options", [heading for heading, _ in option_groups]), ("Exit status", []), ("Environment", [])]
    text = PREFACE + "\n" + folded(" · ".join(": ".join(filter(None, (link(title), ", ".join(map(link, below)))))
                                              for title, below in parts)) + "\n"
    text += "\n## Usual options\n\n"
    text += "*As usual* stands for all of these:\n\n"
    text += "".join(folded("- " + of_heading(heading, named(options), usual[heading]), "  ") + "\n"
                    for heading, options in option_groups if heading in usual)
    for title, commands in command_groups:
        text += f"\n## {title}\n"
        for term, summary in commands:
            name, _, operands = term.partition(" ")
            further = FURTHER.get(name, f"../how-to/{name}.md")
            if not (PAGE.parent / further.split("#")[0]).exists():
                sys.exit(f"which page goes on with {name}? {further}, or one that is named in FURTHER")
            text += f"\n### {name}\n\n`{f'nutik-cl {name} {operands}'.strip()}`\n\n"
            text += folded(f"{summary} ([more]({further}))") + "\n"
            text += "\n```sh\n" + "".join(examples[name].splitlines(keepends=True)[:EXAMPLES]) + "```\n"
            text += "\n" + folded(f"Options: {'; '.join(options_of(name, option_groups, usual))}.") + "\n"
    text += "\n## Options\n"
    for heading, options in option_groups:
        text += f"\n### {heading}\n\n" + listed((term, said) for term, said, _ in options)
    for title in ("EXIT STATUS", "ENVIRONMENT"):
        text += f"\n## {title.capitalize()}\n\n" + listed(items(section(man, title)))
    return text


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default="build/nutik-cl")
    parser.add_argument("--check", action="store_true")
    options = parser.parse_args()
    written = page_of(subprocess.run([options.program, "man"], check=True, text=True, capture_output=True).stdout)
    if not options.check:
        PAGE.write_text(written)
        return
    difference = list(difflib.unified_diff(PAGE.read_text().splitlines(), written.splitlines(),
                                           "the page", "the program", lineterm="", n=1))
    if difference:
        sys.exit("\n".join([*difference, "tools/commands_page.py writes it anew"]))
    print(f"{PAGE.name}: {written.count(chr(10))} lines, as the program has them")


if __name__ == "__main__":
    main()
