#!/usr/bin/env python3
"""Prints the test programs that `ctest -R REGEX` runs, so that script/test builds only them.

  script/test_targets.py BUILD_FOLDER REGEX      prints their targets, or nothing if all are needed
"""

import collections
import pathlib
import re
import subprocess
import sys

TEST = re.compile(r"^(?:TYPED_)?TEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)", re.MULTILINE)


def names_of(source):
    """Returns the names of the tests in a file as GoogleTest lists them, without parameters."""
    text = pathlib.Path(source).read_text(encoding="utf8", errors="replace")
    return [f"{suite}.{name}" for suite, name in TEST.findall(text)]


def is_known(name, suites):
    """Returns whether a test of ctest (`Set/Suite.Name/parameter`, `Suite/0.Name`) belongs to one of `suites`."""
    return any(part.split(".")[0] in suites for part in name.split("/"))


def main():
    folder, wanted = pathlib.Path(sys.argv[1]), re.compile(sys.argv[2])
    sources = folder / "tests/sources.txt"
    if not sources.is_file():
        return
    targets, suites = set(), collections.defaultdict(set)
    for line in sources.read_text().splitlines():
        target, source = line.split("\t")
        for name in names_of(source):
            suites[name.split(".")[0]].add(target)
            if wanted.search(name) or wanted.search(f"/{name}/"):
                targets.add(target)
    listed = subprocess.run(["ctest", "--test-dir", folder, "-N", "-R", sys.argv[2]], capture_output=True, text=True)
    others = [name for name in re.findall(r"Test +#\d+: (.*)", listed.stdout)
              if not is_known(name, suites) and not name.endswith("_NOT_BUILT")]
    if targets and not others:  # other tests are commands, which may need any target
        print(*sorted(targets), sep="\n")


if __name__ == "__main__":
    main()
