"""Checks that docs/cli.md names all subcommands and flags of taut, and no others.

Usage: cli_page_test.py TAUT
"""

import re
import subprocess
import sys

sys.dont_write_bytecode = True
from page import ROOT, Page  # noqa: E402

PAGE = ROOT / "docs" / "cli.md"


def help_of(taut, *subcommand):
    done = subprocess.run([taut, *subcommand, "--help"], capture_output=True, text=True, check=True)
    return done.stdout


def part(text, title):
    """Returns the indented lines below a line "Title:"."""
    match = re.search(rf"^{title}:\n((?:  .*\n)+)", text, re.MULTILINE)
    return match[1] if match else ""


def flags_of_help(text):
    return set(re.findall(r"^  (?:-\w, )?(--[\w-]+)", part(text, "Flags"), re.MULTILINE)) - {"--help"}


def arguments_of_help(text):
    return re.findall(r"^  (\w+)", part(text, "Arguments"), re.MULTILINE)


def subcommands_of_help(text):
    """The commands, which are listed in groups before the flags."""
    groups = re.findall(r"^(?!Arguments:)\w[\w ]*:\n((?:  .*\n)+)", text.split("\nFlags:\n")[0], re.MULTILINE)
    return re.findall(r"^  (\w+)", "".join(groups), re.MULTILINE)


def sections_of_page():
    """Returns the names in the first cells of the tables under each heading "## taut ...". A cell may hold several."""
    sections, current = {}, None
    for _, line in Page(PAGE).prose:
        heading = re.match(r"## `?(taut.*?)`?$", line)
        if heading:
            current = sections.setdefault(heading[1], set())
        elif line.startswith("## "):
            current = None
        cell = re.match(r"\| ((?:`[^`]+`(?:, )?)+) \|", line)
        if cell and current is not None:
            current.update(re.findall(r"`([^`]+)`", cell[1]))
    return sections


def main():
    taut, wrong = sys.argv[1], []
    top = help_of(taut)
    subcommands = subcommands_of_help(top)
    expected = {"taut": flags_of_help(top)}

    def read(words):
        text = help_of(taut, *words)
        parts = subcommands_of_help(text)
        expected[" ".join(["taut", *words])] = (
            flags_of_help(text) | set(arguments_of_help(text)) | set(parts)
        )
        for inner in parts:
            read([*words, inner])

    for name in subcommands:
        read([name])
    if not subcommands or not all(expected.values()):
        wrong.append("the help texts cannot be read")
    found = {
        title: {cell.split()[0] for cell in cells if re.match(r"--|\w+$", cell)}
        for title, cells in sections_of_page().items()
    }
    for title in sorted(expected.keys() | found.keys()):
        of_help, of_page = expected.get(title), found.get(title)
        if of_help is None or of_page is None:
            wrong.append(f"`{title}` is {'not in the help' if of_help is None else 'not in docs/cli.md'}")
            continue
        wrong += [f"docs/cli.md, {title}: {x} is missing" for x in sorted(of_help - of_page)]
        wrong += [f"docs/cli.md, {title}: there is no {x}" for x in sorted(of_page - of_help)]
    print("\n".join(wrong) or f"{len(subcommands)} subcommands: good")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
