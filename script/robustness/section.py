"""Parts of docs/robustness.md that commands write, each between two marks."""

import json

from robustness import campaign, kills
from validation.runs import ROOT, Problem, table

PAGE = ROOT / "docs/robustness.md"


def write(name, text):
    """Puts `text` where the page has the part `name`."""
    begin, end = f"<!-- {name}: begin -->\n", f"<!-- {name}: end -->\n"
    page = PAGE.read_text()
    if page.count(begin) != 1 or page.count(end) != 1:
        raise Problem(f"{PAGE.relative_to(ROOT)} has no part {name}")
    before, rest = page.split(begin)
    after = rest.split(end)[1]
    PAGE.write_text(f"{before}{begin}\n{text}\n\n{end}{after}")


def read(path):
    try:
        return json.loads(path.read_text())
    except (OSError, ValueError) as error:
        raise Problem(f"{path}: {error}; script/faults and script/fuzz write it") from error


def write_faults(folder):
    """What script/faults has found."""
    items = [item for path in sorted(folder.glob("*.json")) if path.stem != "kills" for item in read(path)]
    if not items:
        raise Problem(f"{folder} holds no results; script/faults writes them")
    write("faults", campaign.summary(items))
    if (folder / "kills.json").exists():
        write("kills", kills.summary(read(folder / "kills.json")))


def write_fuzz(path):
    """What script/fuzz has found."""
    items = read(path)
    write("fuzz", table(["target", "inputs", "found"],
                        [[name, f"{item['inputs']:,}".replace(",", " "), item["result"]] for name, item in items.items()]))
