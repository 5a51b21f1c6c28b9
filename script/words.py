#!/usr/bin/env python3
"""Counts the markers of stilted prose in documents and comments, per folder, against a ratchet.

  script/words.py              a table of rates per 1,000 words; status 1 if a folder has a higher rate than
                               script/words.txt allows
  script/words.py --update     writes lower rates into script/words.txt; rates there never rise
  script/words.py FILE...      each marker of these files with its line, and the rates

CONTRIBUTING.md names the rules behind the markers. Code, tables of numbers and quoted output do not count.
"""

import collections
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
RATCHET = ROOT / "script/words.txt"
MARKERS = {
    "what": re.compile(r"\bwhat\b(?![^.\n]{0,80}\?)", re.IGNORECASE),
    "speech": re.compile(r"\b(says?|said|tells?|told|asks?|asked)\b", re.IGNORECASE),
    "vague": re.compile(r"\b(beside|anew|by (?:itself|themselves)|go(?:es)? on|do(?:es)? so|as (?:it is|they are))\b",
                        re.IGNORECASE),
    "that of": re.compile(r"\b(that of|those of|those that|one that|ones that)\b", re.IGNORECASE),
    "whoever": re.compile(r"\b(whoever|somebody|nobody|everybody|one's own)\b", re.IGNORECASE),
}
# Rates that no folder needs to fall below, per 1,000 words of documents and of comments: twice the highest of
# Box2D, Jolt, MuJoCo, Newton, Drake, simdjson and DuckDB.
FLOOR = {"what": (1.8, 0.8), "speech": (0.9, 0.4), "vague": (1.0, 1.0), "that of": (0.3, 0.3), "whoever": (0.1, 0.1)}
WORD = re.compile(r"[A-Za-z']+")
SOURCES = ("*.md", "*.md.in", "*.h", "*.cpp", "*.inl", "*.py", "script/*")
# Words in quotation marks or backquotes are code, output or cited words.
QUOTED = re.compile(r"`[^`]*`|\"[^\"\n]*\"")


def blank(match):
    return re.sub(r"[^\n]", " ", match[0])


def prose(path, text):
    """Returns the prose of a file: other characters become blanks, so that positions stay the same."""
    if path.suffix in (".md", ".in"):
        text = re.sub(r"^```.*?^```|^<!--.*?-->|^(?: {4}|\t)[^\n]*$|\]\([^)]*\)", blank, text,
                      flags=re.DOTALL | re.MULTILINE)
        return QUOTED.sub(blank, text)
    if path.suffix in (".h", ".cpp", ".inl"):
        comment = re.compile(r"^(.*?)//[/!<]*(.*)$", re.MULTILINE)
        kept = "\n".join(" " * len(found[1]) + "   " + found[2] if (found := comment.match(line)) else ""
                         for line in text.split("\n"))
        return QUOTED.sub(blank, kept)
    # Python and shell: comments and docstrings
    kept = [""] * len(text.split("\n"))
    for number, line in enumerate(text.split("\n")):
        if not line.startswith("#!") and (found := re.match(r"^([^\"'#]*)#\s(.*)$", line)):
            kept[number] = " " * len(found[1]) + "  " + found[2]
    if path.suffix == ".py":
        for found in re.finditer(r'^\s*"""(.*?)"""', text, re.DOTALL | re.MULTILINE):
            for more, line in enumerate(found[1].split("\n"), text[:found.start(1)].count("\n")):
                kept[more] = line
    return QUOTED.sub(blank, "\n".join(kept))


def folder_of(name):
    parts = name.split("/")
    if parts[0] in ("src", "apps", "docs", "tests", "script") and len(parts) > 2:
        return "/".join(parts[:2])
    return parts[0]


def is_scored(name):
    return not name.startswith(("CHANGELOG", "tests/data/", "LICENSE"))


def tracked():
    listed = subprocess.run(["git", "-C", ROOT, "ls-files", "-co", "--exclude-standard", *SOURCES],
                            capture_output=True, text=True, check=True)
    return sorted({name for name in listed.stdout.split("\n") if name and is_scored(name) and (ROOT / name).is_file()})


def measure(names):
    """Returns the words and the markers of each folder."""
    folders = collections.defaultdict(collections.Counter)
    for name in names:
        path = ROOT / name
        try:
            text = prose(path, path.read_text(encoding="utf8"))
        except UnicodeDecodeError:
            continue
        count = folders[folder_of(name)]
        count["words"] += len(WORD.findall(text))
        for marker, pattern in MARKERS.items():
            count[marker] += len(pattern.findall(text))
    return folders


def rate(count, marker):
    return round(1000 * count[marker] / max(count["words"], 1000), 1)


def floor(folder, marker):
    documents = folder.startswith("docs") or folder.endswith(".md")
    return FLOOR[marker][0 if documents else 1]


def read_ratchet():
    if not RATCHET.exists():
        return {}
    rows = [line.split() for line in RATCHET.read_text().splitlines() if line and not line.startswith("#")]
    return {row[0]: dict(zip(MARKERS, map(float, row[1:]))) for row in rows}


def write_ratchet(folders, old):
    lines = ["# Highest rates per 1,000 words for script/words.py, in the order of its table."]
    for folder, count in sorted(folders.items()):
        allowed = old.get(folder, {})
        rates = [max(min(rate(count, marker), allowed.get(marker, 1e9)), floor(folder, marker)) for marker in MARKERS]
        lines.append(f"{folder} " + " ".join(f"{each:g}" for each in rates))
    RATCHET.write_text("\n".join(lines) + "\n")


def show_files(names):
    for name in names:
        path = pathlib.Path(name).resolve()
        text = prose(path, path.read_text(encoding="utf8"))
        shown = path.read_text(encoding="utf8").split("\n")
        count = collections.Counter(words=len(WORD.findall(text)))
        for marker, pattern in MARKERS.items():
            for found in pattern.finditer(text):
                count[marker] += 1
                line = text[:found.start()].count("\n")
                print(f"{name}:{line + 1}: {marker}: {shown[line].strip()}")
        print(f"{name}: {count['words']} words; per 1,000: " +
              ", ".join(f"{marker} {1000 * count[marker] / max(count['words'], 1):.1f}" for marker in MARKERS))


def main():
    arguments = sys.argv[1:]
    if arguments and arguments != ["--update"]:
        if arguments[0].startswith("-"):
            sys.exit(__doc__)
        show_files(arguments)
        return
    folders, allowed = measure(tracked()), read_ratchet()
    if arguments:
        write_ratchet(folders, allowed)
        return
    wrong = 0
    print("Markers of stilted prose per 1,000 words of documents and comments; rules: CONTRIBUTING.md")
    print(f"{'folder':22} {'words':>7} " + " ".join(f"{marker:>8}" for marker in MARKERS))
    for folder, count in sorted(folders.items()):
        cells = []
        for marker in MARKERS:
            limit = max(allowed.get(folder, {}).get(marker, 0), floor(folder, marker))
            over = rate(count, marker) > limit
            wrong += over
            cells.append(f"{rate(count, marker):7.1f}{'!' if over else ' '}")
        print(f"{folder:22} {count['words']:7d} " + " ".join(cells))
    if wrong:
        print(f"{wrong} rates (!) are higher than script/words.txt or the floor of a new folder allows; "
              "script/words.py FILE shows the places")
        sys.exit(1)


if __name__ == "__main__":
    main()
