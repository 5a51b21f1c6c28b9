#!/usr/bin/env python3
"""Prints the changed files on which the tests of bitwise equality (target `bits_tests`) depend.

  script/bits_changed.py BUILD_FOLDER <FILES     FILES: paths from the root of the tree, one per line

BUILD_FOLDER must be built: the headers included by each source come from the compiler's dependency lists.
"""

import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
# Build settings, which affect every file.
OF_EVERY_BUILD = re.compile(r"CMakePresets\.json|CMakeLists\.txt|tests/determinism/golden\.txt"
                            r"|cmake/(layers|instruction_sets|aarch64-linux-gnu)\.cmake")
# Text, files and messages, without arithmetic of a step.
WITHOUT_ARITHMETIC = "src/base/"


def ninja(folder, *arguments):
    return subprocess.run(["ninja", "-C", folder, *arguments], capture_output=True, text=True, check=True).stdout


def sources_and_headers(folder):
    """Returns the files of the tree from which the tests are built, as paths from its root."""
    objects = {line for line in ninja(folder, "-t", "inputs", "bits_tests").splitlines()
               if line.endswith(".o") and not line.startswith(WITHOUT_ARITHMETIC)}
    found, wanted = set(), False
    for line in ninja(folder, "-t", "deps").splitlines():
        if line.startswith("    "):
            path = (folder / line.strip()).resolve()
            if wanted and path.is_relative_to(ROOT):
                found.add(path.relative_to(ROOT))
        else:
            wanted = line.split(":")[0] in objects
    return found


def main():
    folder = pathlib.Path(sys.argv[1]).resolve()
    needed = sources_and_headers(folder)
    lists = {path.parent / "CMakeLists.txt" for path in needed if path.parts[0] == "src"}
    for line in sys.stdin:
        path = pathlib.PurePosixPath(line.strip())
        if path in needed or path in lists or OF_EVERY_BUILD.fullmatch(str(path)):
            print(path)


if __name__ == "__main__":
    main()
