#!/usr/bin/env python3
"""Prints the files that include changed files, directly or not, and the changed files themselves.

  script/including.py CHANGED <FILES     CHANGED: a file with changed paths, FILES: paths to choose from; both one
                                         per line, from the root of the tree

Includes are matched by the end of their path, without regard to include folders. The script may therefore print too
many files, never too few.
"""

import pathlib
import re
import sys

INCLUDE = re.compile(r'^\s*#\s*include\s*["<](?:\.\.?/)*([^">]+)[">]', re.MULTILINE)


def names(path):
    """Returns the ends of a path, by which an include may name it: a/b/c.h, b/c.h, c.h."""
    parts = pathlib.PurePosixPath(path).parts
    return {"/".join(parts[first:]) for first in range(len(parts))}


def including(changed, files):
    """Returns the files that are changed or include one of these, in the order of `files`."""
    includes = {path: set(INCLUDE.findall(pathlib.Path(path).read_text(encoding="utf8"))) for path in files}
    found, new = set(), set(changed)
    while new:
        wanted = set().union(*map(names, new))
        new = {path for path in files if path not in found and (path in new or includes[path] & wanted)}
        found |= new
    return [path for path in files if path in found]


def main():
    changed = pathlib.Path(sys.argv[1]).read_text(encoding="utf8").split()
    print(*including(changed, sys.stdin.read().split()), sep="\n")


if __name__ == "__main__":
    main()
