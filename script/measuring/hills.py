"""Robots on hills: section of docs/performance.md, which can be updated separately."""

import pathlib

from measuring import sections
from measuring.table_text import NOTHING, SETTINGS, number
from measuring.results import Results, mark, shared
from validation.runs import fill, table

KIND = "hills"
NOT_MEASURED = "Not measured in this run."
TEMPLATE = pathlib.Path(__file__).with_name("hills.md.in")
TITLE = "### On hills"
GROUNDS = {"plane": "plane", "hills": "hills", "many": "10^7 cells"}
BALL = "ball@level"
COMPANY = "\nOther programs ran on the machine at the same time. Ratios are therefore more reliable than times; times and ratios have to be measured again on an idle machine."


def lanes_of(name, lanes):
    return f"{name}, {lanes} lane{'s' * (lanes > 1)}"


def robots(items):
    return sorted({item["robot"].split("@")[0] for item in items if item["robot"] != BALL})


def grounds(items):
    """Formats the time per step of a world in taut on a plane and on hills [us]."""
    results = Results(Results(items).of(kind=KIND, engine="taut"))
    lanes = sorted({item["lanes"] for item in results.items if item["robot"] != BALL})
    rows = []
    for robot in robots(results.items):
        us = {(ground, n): 1e6 / rate for ground in GROUNDS for n in lanes
              if (rate := results.rate(robot=f"{robot}@{ground}", lanes=n))}
        row = [robot]
        for n in lanes:
            for ground in GROUNDS:
                times = f" ({number(us[ground, n] / us['plane', n], 2)}x)" if ground != "plane" and {(ground, n), ("plane", n)} <= us.keys() else ""
                row.append(number(us[ground, n]) + times if (ground, n) in us else NOTHING)
        rows.append(row)
    return table(["robot", *(lanes_of(name, n) for n in lanes for name in GROUNDS.values())], rows)


class Beside:
    """Results of all engines, for cases that several engines ran."""

    def __init__(self, items):
        self.results = Results(Results(items).of(kind=KIND))
        self.robots = robots(item for item in self.results.items if item["engine"] != "taut")
        lanes = {item["lanes"] for item in self.results.items}
        self.rows = [(engine, setting, n) for engine, setting in SETTINGS for n in sorted(lanes)
                     if self.results.of(engine=engine, setting=setting, lanes=n)]

    def name(self, row):
        engine, setting, lanes = row
        return SETTINGS[engine, setting] if lanes == 1 else lanes_of(SETTINGS[engine, setting], lanes)

    def of(self, row, robot):
        engine, setting, lanes = row
        return self.results.one(engine=engine, setting=setting, lanes=lanes, robot=robot)

    def times(self):
        """Formats the time per step [us], and its ratio to taut's."""
        columns = [f"{robot}@{ground}" for robot in self.robots for ground in ("plane", "hills")]
        rows = []
        for row in self.rows:
            cells = [self.name(row)]
            for robot in columns:
                item, ours = self.of(row, robot), self.of(("taut", "default", 1), robot)
                ratio = f" ({number(ours['steps_per_s'] / item['steps_per_s'], 2)}x)" if item and ours and item is not ours else ""
                cells.append(number(1e6 / item["steps_per_s"]) + mark(item) + ratio if item else NOTHING)
            rows.append(cells)
        return table(["engine", *(robot.replace("@", ", ") for robot in columns)], rows)

    def worth(self):
        """Formats the remaining speed of the ball, and the penetrations of robots into the ground."""
        rows = []
        for row in self.rows:
            ball = self.of(row, BALL)
            deep = [self.of(row, f"{robot}@hills") for robot in self.robots]
            cells = [number(ball["speed_kept"]) if ball else NOTHING,
                     *(millimetres(item) + mark(item) if item and "deepest_m" in item else NOTHING for item in deep)]
            if set(cells) != {NOTHING}:
                rows.append([self.name(row), *cells])
        return table(["engine", "final speed of the ball, m/s", *(f"penetration of {robot}, mm" for robot in self.robots)], rows)


def millimetres(item):
    deep = 1e3 * item["deepest_m"]
    return number(deep, 2) if deep >= 1e-3 else "< 0.001"


def section(items):
    found = [item for item in items if item["kind"] == KIND]
    if not found:
        return NOT_MEASURED
    machine, beside = found[0]["machine"], Beside(found)
    return fill(TEMPLATE.read_text(), {
        "grounds": grounds(found), "engines": beside.times(), "worth": beside.worth(), "commit": machine["commit"],
        "repetitions": str(min(item["repetitions"] for item in found)), "load": f"{machine['load'][0]:.1f}",
        "company": COMPANY if shared(machine) else ""}).rstrip()


def replaced(page, items):
    """Returns the page with this section replaced."""
    return sections.replaced(page, TITLE, section(items))
