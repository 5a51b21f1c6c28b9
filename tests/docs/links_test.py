"""Checks that every link of every page leads to a file of the project and, where given, to an existing heading.

Usage: links_test.py
"""

import sys

sys.dont_write_bytecode = True
from page import ROOT, Page  # noqa: E402

OUTSIDE = {".git", "build", "runs", "changes", "node_modules"}


def pages():
    for path in sorted(ROOT.rglob("*.md")):
        if not OUTSIDE & set(path.relative_to(ROOT).parts):
            yield Page(path)


def main():
    wrong, count = [], 0
    for page in pages():
        for line, target in page.links():
            count += 1
            file, _, anchor = target.partition("#")
            path = (page.path.parent / file).resolve() if file else page.path
            if not path.exists() or ROOT not in path.parents:
                wrong.append(f"{page.name}:{line}: there is no {target}")
            elif anchor and anchor not in Page(path).anchors():
                wrong.append(f"{page.name}:{line}: {file or page.name} has no heading #{anchor}")
    if count == 0:
        wrong.append("no links were found at all")
    print("\n".join(wrong) or f"{count} links: good")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
