"""Checks that each term of docs/glossary.md occurs in another document and in a header, so that a search finds both."""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
ROW = re.compile(r"^\| ([^|]+) \|", re.MULTILINE)


def texts(*patterns):
    paths = sorted(path for pattern in patterns for path in ROOT.glob(pattern) if path.name != "glossary.md")
    return re.sub(r"\s+(?:///?<?\s+)?", " ", "\n".join(path.read_text(encoding="utf8") for path in paths)).lower()


def main():
    documents = texts("README.md", "docs/**/*.md")
    headers = texts("include/**/*.h", "src/**/*.h", "src/**/*.inl")
    rows = ROW.findall((ROOT / "docs/glossary.md").read_text(encoding="utf8"))
    terms = [re.sub(r"\s*\(.*?\)", "", row).strip().lower() for row in rows if row.strip() not in ("term", "---")]
    lacking = [f"{term}: no {where}" for term in terms for where, text in (("document", documents), ("header", headers))
               if not all(word in text for word in term.split(", "))]
    assert len(terms) > 50, f"only {len(terms)} terms were read"
    if lacking:
        sys.exit("\n".join(lacking))


if __name__ == "__main__":
    main()
