"""Structure of the website: parts of the sidebar, and the order of their pages, from docs/README.md."""

import pathlib
import posixpath
import re

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
# Pages that only the website has, and pages that docs/README.md need not list.
MORE = {
    "Learn": ["report.md", "demo.md"],
    "Reference": ["api/index.rst"],
    "Contribute": ["docs/README.md", "SECURITY.md"],
}
REST = "More"  # pages that no part lists


def read_parts():
    """Returns {heading: [page, ...]}: the sections of docs/README.md with the pages that they link to."""
    found, heading = {}, None
    for line in (ROOT / "docs/README.md").read_text(encoding="utf8").splitlines():
        if line.startswith("## "):
            heading = line[3:]
            found[heading] = []
        elif heading and (link := re.match(r"\| \[[^\]]*\]\(([^)]+\.md)\)", line)):
            found[heading].append(posixpath.normpath("docs/" + link[1]))
    return {part: pages + MORE.get(part, []) for part, pages in found.items()}


PARTS = read_parts()


def parts(pages):
    """Returns [(part, [page, ...]), ...] of the existing pages."""
    left, found = sorted(pages), []
    for part, names in PARTS.items():
        chosen = [name for name in names if name in left]
        found.append((part, chosen))
        left = [page for page in left if page not in chosen]
    return found + ([(REST, left)] if left else [])


def toctrees(pages):
    """Returns the sidebar: hidden lists for the end of the first page."""
    lines = []
    for part, chosen in parts(pages):
        lines += ["", "```{toctree}", ":hidden:", f":caption: {part}", ""]
        lines += [page.rsplit(".", 1)[0] for page in chosen] + ["```"]
    return "\n".join(lines) + "\n"
