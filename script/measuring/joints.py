"""Cost of joints: section of docs/performance.md, which can be updated separately."""

import pathlib

from measuring import sections
from measuring.table_text import number
from measuring.results import mark, shared
from validation.runs import fill, table

KIND = "joints"
NOT_MEASURED = "Not measured in this run."
TEMPLATE = pathlib.Path(__file__).with_name("joints.md.in")
TITLE = "### With joints"
COMPANY = "\nOther programs ran on the machine at the same time, so the times are too long and have to be measured again on an idle machine."


def costs(items):
    """Formats the cost of a step and of its solve stage; per joint, and per joint and linear system."""
    rows = []
    for item in sorted(items, key=lambda item: (item["robot"], item["lanes"])):
        step, solve = 1e9 / item["steps_per_s"], item["stages_ns"]["solve"]
        joints, systems = item["joints"], item["linear_solves"]
        rows.append([item["robot"] + mark(item), str(item["lanes"]), number(joints), number(systems), number(step / 1e3),
                     number(step / joints), number(solve / joints), number(solve / joints / systems)])
    return table(["robot", "lanes", "joints", "linear systems per step", "step, us", "step per joint, ns",
                  "`solve` per joint, ns", "`solve` per joint and linear system, ns"], rows)


def section(items):
    found = [item for item in items if item["kind"] == KIND]
    if not found:
        return NOT_MEASURED
    machine = found[0]["machine"]
    return fill(TEMPLATE.read_text(), {
        "costs": costs(found), "commit": machine["commit"], "repetitions": str(min(item["repetitions"] for item in found)),
        "load": f"{machine['load'][0]:.1f}", "company": COMPANY if shared(machine) else ""}).rstrip()


def replaced(page, items):
    """Returns the page with this section replaced."""
    return sections.replaced(page, TITLE, section(items))
