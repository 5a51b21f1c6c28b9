"""Parts of docs/robustness.md that commands write, each between two marks."""

import collections
import json

from robustness import campaign, kills, replaced
from validation.runs import ROOT, Problem, table

PAGE = ROOT / "docs/robustness.md"
KILLING = {"kills": kills, "replaced": replaced}


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
    items = [item for path in sorted(folder.glob("*.json")) if path.stem not in KILLING for item in read(path)]
    if not items:
        raise Problem(f"{folder} holds no results; script/faults writes them")
    write("faults", campaign.summary(items))
    for name, kind in KILLING.items():
        if (folder / f"{name}.json").exists():
            write(name, kind.summary(read(folder / f"{name}.json")))


def part(name):
    """Returns the part `name` of the page."""
    _, _, rest = PAGE.read_text().partition(f"<!-- {name}: begin -->\n")
    return rest.partition(f"<!-- {name}: end -->\n")[0]


def write_fuzz(path):
    """Adds the runs of script/fuzz to the table of the page, and removes their list at `path`."""
    try:
        runs = [line.split() for line in path.read_text().splitlines()]
    except OSError as error:
        raise Problem(f"{path}: {error}; script/fuzz writes it") from error
    inputs, wrong, rates = collections.Counter(), collections.Counter(), {}
    for line in part("fuzz").splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if len(cells) < 3 or not cells[1].replace(" ", "").isdigit():
            continue
        inputs[cells[0]], wrong[cells[0]] = int(cells[1].replace(" ", "")), int(cells[-1])
        rates[cells[0]] = cells[2] if len(cells) > 3 else ""
    now_inputs, now_seconds = collections.Counter(), collections.Counter()
    for target, count, result, seconds in runs:
        now_inputs[target] += int(count)
        now_seconds[target] += float(seconds)
        wrong[target] += result == "WRONG"
    for target, count in now_inputs.items():
        inputs[target] += count
        rate = float(f"{count / max(now_seconds[target], 0.01):.2g}")  # two digits
        rates[target] = f"{rate:,g}".replace(",", " ") if rate < 1e5 else f"{rate:.0f}"
    write("fuzz", table(["target", "inputs", "inputs per processor second", "crashes, hangs, failed checks"],
                        [[name, f"{count:,}".replace(",", " "), rates[name], str(wrong[name])]
                         for name, count in inputs.items()]))
    path.unlink()
