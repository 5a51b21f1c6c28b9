"""Texts of a release: version and changes, and the files that contain them."""

import lzma
import pathlib
import re
import subprocess

from .stage import Problem

HEADER = "include/taut/version.h"
CHANGELOG = "CHANGELOG.md"
UNRELEASED = re.compile(r"^## (.*) \(not yet released\)$", re.MULTILINE)
SHOWN_IN = ["docs/cli.md", "docs/python.md"]  # pages with outputs of commands that contain the version


def numbers(version):
    if not re.fullmatch(r"(0|[1-9]\d*)(\.(0|[1-9]\d*)){2}", version):
        raise Problem(f"\"{version}\" is no version: three numbers, such as 1.2.0")
    return tuple(map(int, version.split(".")))


def current(root):
    return re.search(r'kVersion = "(.*)"', (pathlib.Path(root) / HEADER).read_text())[1]


def section(text, heading):
    """Returns the text below a heading of the second level."""
    after = text.split(heading + "\n", 1)[1]
    return re.split(r"^## ", after, maxsplit=1, flags=re.MULTILINE)[0].strip()


def unreleased(root):
    """Returns the heading of the unreleased section and its text."""
    text = (pathlib.Path(root) / CHANGELOG).read_text()
    found = list(UNRELEASED.finditer(text))
    first = re.search(r"^## .*$", text, re.MULTILINE)
    if len(found) != 1 or first[0] != found[0][0]:
        raise Problem(f"{CHANGELOG} has no section at its top, and there only, that says \"(not yet released)\"")
    changes = section(text, found[0][0])
    if not changes:
        raise Problem(f"{CHANGELOG} says nothing of what changes")
    return found[0][0], changes


def check(root, version):
    """Raises a Problem if `version` cannot be the next version."""
    now = current(root)
    if numbers(version) <= numbers(now):
        raise Problem(f"{version} does not come after {now}")
    unreleased(root)


def write(root, version, date):
    """Writes the version to its files, and the date to its changes; returns the changes."""
    root, now = pathlib.Path(root), current(root)
    heading, changes = unreleased(root)
    for name, old, new in [(HEADER, f'"{now}"', f'"{version}"'), (CHANGELOG, heading, f"## {version} ({date})"),
                           *((page, f"taut {now}", f"taut {version}") for page in SHOWN_IN)]:
        text = (root / name).read_text()
        if old not in text:
            raise Problem(f"{name} does not say {old}")
        (root / name).write_text(text.replace(old, new))
    return changes


def pack(source, name, seconds, folder):
    """Packs the folder `source` as NAME.tar.xz with the top folder `name`: the same bytes for the same files."""
    tar = subprocess.run(["tar", "-C", source, "--sort=name", f"--mtime=@{seconds}", "--owner=0", "--group=0", "--numeric-owner",
                          "--mode=go=rX,u+rw,a-s", f"--transform=s,^[.],{name},", "-cf", "-", "."], stdout=subprocess.PIPE, check=True)
    path = pathlib.Path(folder) / f"{name}.tar.xz"
    path.write_bytes(lzma.compress(tar.stdout, preset=9))
    return path
