"""Parts of docs/robustness.md that commands write, each between two marks."""

import collections
import json

from robustness import campaign, kills
from validation.runs import ROOT, Problem, table

PAGE = ROOT / "docs/robustness.md"


def write(name, text):
    """Replaces the part `name` of the page by `text`."""
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
    """Writes the results of script/faults."""
    items = [item for path in sorted(folder.glob("*.json")) if path.stem != "kills" for item in read(path)]
    if not items:
        raise Problem(f"{folder} holds no results; script/faults writes them")
    write("faults", campaign.summary(items))
    if (folder / "kills.json").exists():
        write("kills", kills.summary(read(folder / "kills.json")))


def write_fuzz(path):
    """Writes the results of script/fuzz, summed over all its runs."""
    try:
        lines = [line.split() for line in path.read_text().splitlines()]
    except OSError as error:
        raise Problem(f"{path}: {error}; script/fuzz writes it") from error
    inputs, wrong = collections.Counter(), collections.Counter()
    for target, count, result in lines:
        inputs[target] += int(count)
        wrong[target] += result == "WRONG"
    write("fuzz", table(["target", "inputs", "crashes, hangs, failed checks"],
                        [[name, f"{count:,}".replace(",", " "), str(wrong[name])] for name, count in inputs.items()]))
