"""A six-strut robot rolls to a goal: fifty random starts on each of several terrains."""

import math
import pathlib
import random
import statistics
import time

from validation import shares
from validation.push import machine
from validation.rolling import CHANNELS, Run
from validation.runs import Variant, fill, keep_picture, table
from validation.shares import HEIGHT, LEFT, TOP, WIDTH

TEMPLATE = pathlib.Path(__file__).with_suffix(".md.in")
STARTS, GOAL_M, LIMIT_S = 50, 3.0, 60
WITHIN_M = (0.5, 0.25)
COLOURS = ("#2471a3", "#1e8449", "#b9770e", "#c0392b")
TERRAINS = {  # experiment, parameters
    "flat ground": ("roll_to_goal", {}),
    "NTRT's hills": ("roll_to_goal_hills", {"times": 1}),
    "2.5 times as large": ("roll_to_goal_hills", {"times": 2.5}),
    "5 times as large": ("roll_to_goal_hills", {"times": 5}),
}
FRICTIONS = (0.25, 1.0)
OTHER = "models/six_strut.yaml"
FAR = 12   # number of starts towards a goal that is too far to reach


def bearing(number):
    return random.Random(number).uniform(-math.pi, math.pi)


def variant(name, experiment, parameters, number, rate_hz=20, channels=("system/com_*",), keys=""):
    record = f"record: {{rate_hz: {rate_hz}, channels: ['" + "', '".join(channels) + "']}\n"
    return Variant(f"{name}_{number}", experiment, f"seed: {number}\n{keys}{record}",
                   {**parameters, "goal_bearing_rad": f"{bearing(number):.6f}"}, full_trace=True, any_status=True)


class Arrival(Run):
    """Least distance of the robot's center of mass from the goal, and arrival times."""

    def __init__(self, folder, number, status):
        super().__init__(folder)
        self.status = status
        x, y = GOAL_M * math.cos(bearing(number)), GOAL_M * math.sin(bearing(number))
        self.from_goal = [math.hypot(at[0] - x, at[1] - y) for at in self.path]

    def _feet(self, rows, at, downhill):
        if "node/a.l/position_x_m" in at:  # the nodes of the other robot have other names
            super()._feet(rows, at, downhill)
        else:
            self.feet, self.slide_m = 0, math.nan

    def arrival_s(self, within_m):
        """Returns the time of arrival [s]; None if the robot does not arrive."""
        for i, distance in enumerate(self.from_goal):
            if distance <= within_m:
                return LIMIT_S * i / (len(self.from_goal) - 1)
        return None


def times(runs, within_m):
    """Returns the arrival times, ascending, without starts that do not arrive."""
    return sorted(at for at in (run.arrival_s(within_m) for run in runs) if at is not None)


def quantile(values, part):
    return values[min(len(values) - 1, int(part * len(values)))]


def share(count, of):
    return f"{100 * count / of:.0f} %"


def row(name, runs):
    cells = [name]
    for within_m in WITHIN_M:
        at = times(runs, within_m)
        cells += [share(len(at), len(runs)),
                  ", ".join(f"{x:.0f}" for x in (at[0], statistics.median(at), quantile(at, 0.9), at[-1]))]
    cells += [f"{statistics.median(min(run.from_goal) for run in runs):.2f}",
              f"{statistics.median(run.from_goal[-1] for run in runs):.2f}",
              f"{max(run.from_goal[-1] for run in runs):.1f}",
              f"{sum(run.status != 'ok' for run in runs)}"]
    return cells


HEAD = ["terrain", "arrived within 0.5 m", "time [s]: first, median, 90 %, last", "arrived within 0.25 m",
        "time [s]: first, median, 90 %, last", "smallest distance from the goal [m], median", "distance from the goal after 60 s [m], median", "distance from the goal after 60 s [m], maximum", "runs with a warning"]


def far_row(name, runs):
    def middle(of, digits):
        values = sorted(of(run) for run in runs)
        if any(math.isnan(value) for value in values):
            return "not counted"
        return ", ".join(f"{x:.{digits}f}" for x in (values[0], statistics.median(values), values[-1]))

    return [name, middle(lambda run: run.way_m, 1), middle(lambda run: run.length_m, 0),
            middle(lambda run: run.turns, 1), middle(lambda run: run.length_m / run.turns, 1),
            middle(lambda run: 100 * run.slide_m / run.length_m, 0), f"{max(run.most_n for run in runs):.0f}",
            middle(lambda run: run.power_w, 0)]


FAR_HEAD = ["model", "distance [m]", "path [m]", "turns", "path per turn [m]", "sliding of strut ends [% of path]",
            "largest tension [N]", "winding power [W]"]


def picture(outcomes):
    """Draws the share of starts that have arrived against time."""
    curves = {}
    for name, runs in outcomes.items():
        points, count = [f"{LEFT},{TOP + HEIGHT}"], 0
        for at in times(runs, WITHIN_M[0]):
            for step in (0, 1):
                count += step
                points.append(f"{LEFT + WIDTH * at / LIMIT_S:.1f},{TOP + HEIGHT * (1 - count / len(runs)):.1f}")
        points.append(f"{LEFT + WIDTH},{TOP + HEIGHT * (1 - count / len(runs)):.1f}")
        curves[name] = points
    return shares.picture("time to half a meter from the goal [s]", [f"{10 * i}" for i in range(7)],
                          [f'<path d="M{LEFT} {TOP + 0.1 * HEIGHT}h{WIDTH}" stroke="#ddd"/>'], curves,
                          COLOURS, 160)


def page(taut):
    started = time.monotonic()
    groups = {}

    def add(name, experiment, parameters, count=STARTS, **more):
        key = "".join(letter if letter.isalnum() else "_" for letter in name)
        groups[name] = [variant(key, experiment, parameters, number, **more) for number in range(1, count + 1)]

    for name, (experiment, parameters) in TERRAINS.items():
        add(name, experiment, parameters)
    frictions = [f"flat ground, friction {friction:g}" for friction in FRICTIONS]
    for name, friction in zip(frictions, FRICTIONS):
        add(name, "roll_to_goal", {"ground_friction": friction})
    model = f"model: ../../../../share/{OTHER}\nstart: settled_floating\n"   # path relative to the run's folder
    add("six_strut", "roll_to_goal_six_strut", {})
    add("six_strut_hills", "roll_to_goal_hills", {"drop_m": "0.02 * times"}, keys=model)
    add("six_strut_far", "roll_to_goal_six_strut", {"goal_m": 100}, FAR, rate_hz=50,
        channels=[name for name in CHANNELS if not name.startswith("node/")])
    add("far", "roll_to_goal", {"goal_m": 100}, FAR, rate_hz=50, channels=CHANNELS)
    results = taut.run([v for group in groups.values() for v in group])
    runs = {name: [Arrival(taut.folder / v.name, number, results[v.name].summary["status"])
                   for number, v in enumerate(group, 1)] for name, group in groups.items()}
    outcomes = {name: runs[name] for name in TERRAINS}
    keep_picture(taut, "docs/validation/roll_to_goal.svg", picture(outcomes))
    flat, hills = runs["flat ground"], runs["2.5 times as large"]
    version = taut("--version").split()[-1]
    return fill(TEMPLATE.read_text(), {
        "made_by": f"This page was made by `script/validate roll_to_goal` with taut {version}: "
                   f"{sum(len(group) for group in groups.values())} runs of 60 s took "
                   f"{time.monotonic() - started:.0f} s on {machine()}.",
        "starts": table(HEAD, [row(name, each) for name, each in outcomes.items()]),
        "frictions": table(HEAD, [row(name, runs[name]) for name in frictions]),
        "far": table(FAR_HEAD, [far_row("`models/superball.yaml`", runs["far"]),
                                far_row(f"`{OTHER}`", runs["six_strut_far"])]),
        "others": table(HEAD, [row("flat ground", runs["six_strut"]),
                               row("hills, 2.5 times as large", runs["six_strut_hills"])]),
        "flat_share": share(len(times(flat, WITHIN_M[0])), STARTS),
        "hills_share": share(len(times(hills, WITHIN_M[0])), STARTS),
    })
