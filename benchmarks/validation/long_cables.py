"""A spine of six segments whose outer cables span two joints each, in comparison with cables between neighbors."""

import csv
import math
import pathlib
import random
import statistics
import time

from validation.push import machine
from validation.runs import Variant, fill, table

TEMPLATE = pathlib.Path(__file__).with_suffix(".md.in")
STARTS = 6          # the first is the unchanged experiment
CHANNELS = "record: {rate_hz: 50, channels: ['system/com_*', 'cable/*']}\n"
KINDS = {"short": ("short cables", "spine6", {}),
         "long": ("long outer cables", "spine6_long", {}),
         "long_friction": ("long, eyelets with mu 0.1", "spine6_long", {"eyelet_friction": 0.1}),
         "long_friction_3": ("long, eyelets with mu 0.3", "spine6_long", {"eyelet_friction": 0.3}),
         "long_fast": ("long, outer motors twice as fast, gait learned for them", "spine6_long_fast", {}),
         "long_slow": ("long, gait learned for faster motors, all motors 0.07 m/s", "spine6_long_fast",
                       {"outer_speed_m_per_s": 0.07})}


def variant(kind, number):
    _, experiment, parameters = KINDS[kind]
    keys = CHANNELS
    if number:
        friction = random.Random(number).uniform(0.4, 0.6)
        keys += f"seed: {number}\nstart_noise: {{position_m: 0.001}}\n"
        parameters = {**parameters, "ground_friction": f"{friction:.4f}"}
    return Variant(f"{kind}_{number}", experiment, keys, parameters, full_trace=True)


class Run:
    """Trace and summary of a run."""

    def __init__(self, folder, result):
        with open(folder / "trace.csv", newline="") as file:
            reader = csv.reader(file)
            at = {name: i for i, name in enumerate(next(reader))}
            rows = [[float(x) for x in row] for row in reader]
        path = [(row[at["system/com_x_m"]], row[at["system/com_y_m"]]) for row in rows]
        self.way_m = math.dist(path[0], path[-1])
        self.path_m = sum(math.dist(a, b) for a, b in zip(path[::50], path[50::50]))
        cables = result.summary["cables"]
        self.motors = len(cables)
        self.work_j = sum(cable["actuator"]["energy_j"] for cable in cables)
        self.net_j = sum(cable["actuator"]["net_energy_j"] for cable in cables)
        self.loss_j = sum(rows[-1][i] for name, i in at.items() if name.endswith("/friction_loss_j"))
        self.tension_n = {}
        for role in ("outer", "inner"):
            columns = [i for name, i in at.items() if name.startswith(f"cable/{role}") and name.endswith("/tension_n")]
            self.tension_n[role] = (statistics.mean(statistics.mean(row[i] for row in rows[250:]) for i in columns),
                                    max(row[i] for row in rows[250:] for i in columns))


def kinds_table(runs):
    out = []
    for kind, (words, _, _) in KINDS.items():
        some = [runs[kind, number] for number in range(STARTS)]
        ways, first = [run.way_m for run in some], some[0]
        out.append([words, str(first.motors), f"{first.way_m:.2f}",
                    f"{min(ways):.2f}, {statistics.median(ways):.2f}, {max(ways):.2f}", f"{first.path_m:.2f}",
                    *("{:.1f}, {:.1f}".format(*first.tension_n[role]) for role in ("outer", "inner")),
                    f"{first.work_j:.0f}", f"{first.net_j:.0f}", f"{first.work_j / first.way_m:.0f}",
                    f"{first.loss_j:.1f}" if first.loss_j else ""])
    return table(["spine", "motors", "displacement, first start [m]", f"displacement, {STARTS} starts: minimum, median, maximum [m]", "path [m]",
                  "tension of outer cables: mean, largest [N]", "tension of inner cables: mean, largest [N]",
                  "winding work [J]", "winding work minus returned work [J]", "winding work per meter [J/m]",
                  "energy lost in eyelets [J]"], out)


def page(taut):
    started = time.monotonic()
    variants = {(kind, number): variant(kind, number) for kind in KINDS for number in range(STARTS)}
    results = taut.run(list(variants.values()))
    runs = {key: Run(taut.folder / one.name, results[one.name]) for key, one in variants.items()}
    ways = {kind: statistics.median(runs[kind, number].way_m for number in range(STARTS)) for kind in KINDS}
    return fill(TEMPLATE.read_text(), {
        "kinds": kinds_table(runs), "share": f"{100 * ways['long'] / ways['short']:.0f}",
        "share_fast": f"{100 * ways['long_fast'] / ways['short']:.0f}",
        "version": next(iter(results.values())).summary["taut_version"], "runs": str(len(results)),
        "seconds": f"{time.monotonic() - started:.0f}", "machine": machine()})
