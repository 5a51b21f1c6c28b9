"""The two motion experiments with cables that run through eyelets with friction (gaits.md, section 5)."""

import csv
import math
import statistics

from validation.runs import Variant, table

FROM_S, TO_S, RATE_HZ = 30.0, 60.0, 50
FRICTIONS = ("plain", "0", "1e-6", "0.1", "0.2", "0.3", "0.5")
STARTS, APART_M = 3, 1e-6
GAITS = {"sine": "sine_hand_tuned", "cpg": "cpg_learned"}
GROUNDS = (0.5, 1, 2)
CHANNELS = "record: {rate_hz: 50, channels: ['system/com_*', 'cable/*']}\n"
WORDS = {"plain": "plain model", "0": "eyelets without friction", "1e-6": "mu 0.000001"}


def variant(gait, friction, start=0, ground=0.5):
    name = f"{gait}_eyelets_{friction}_{start}_{ground}"
    base, parameters = GAITS[gait], {"ground_friction": ground}
    if friction != "plain":
        base, parameters = base + "_eyelets", {**parameters, "eyelet_friction": friction}
    place = f"place: {{at_m: [0, 0, {start * APART_M:g}]}}\n"
    return Variant(name, base, place + CHANNELS, parameters, full_trace=True)


RUNS = {(gait, friction, start): variant(gait, friction, start)
        for gait in GAITS for friction in FRICTIONS for start in range(STARTS)}
GROUND_RUNS = {(friction, ground): variant("cpg", friction, 0, ground) for friction in ("0", "0.2") for ground in GROUNDS}


def variants():
    return list({run.name: run for run in (*RUNS.values(), *GROUND_RUNS.values())}.values())


class Walk:
    """Trace of a run. Spans: the first is at the motor, the last at the load cell."""

    def __init__(self, folder, result):
        with open(folder / "trace.csv", newline="") as file:
            reader = csv.reader(file)
            at = {name: i for i, name in enumerate(next(reader))}
            rows = [[float(x) for x in row] for row in reader]
        self.path = [(row[at["system/com_x_m"]], row[at["system/com_y_m"]]) for row in rows]
        self.work_j = sum(cable["actuator"]["energy_j"] for cable in result.summary["cables"])
        cables = [name.split("/")[1] for name in at if name.endswith("/rest_length_m")]
        self.loss_j = sum(rows[-1][at.get(f"cable/{c}/friction_loss_j", 0)] for c in cables
                          if f"cable/{c}/friction_loss_j" in at)
        walking = rows[round(FROM_S * RATE_HZ):round(TO_S * RATE_HZ) + 1]
        self.sides = {}
        for role in ("outer", "inner"):
            some = [c for c in cables if c.startswith(role)]
            self.sides[role] = [Side(walking, at, some, span) for span in (1, 2)]

    def distance_m(self, time_s):
        return math.dist(self.path[0], self.path[round(time_s * RATE_HZ)])

    def speed_m_per_s(self):
        return math.dist(self.path[round(FROM_S * RATE_HZ)], self.path[round(TO_S * RATE_HZ)]) / (TO_S - FROM_S)


class Side:
    """Tensions of some cables on one side of the eyelets: mean, mean oscillation, largest."""

    def __init__(self, rows, at, cables, span):
        columns = []
        for cable in cables:
            column = at.get(f"cable/{cable}/span_{span}_tension_n", at[f"cable/{cable}/tension_n"])
            columns.append([row[column] for row in rows])
        self.mean_n = statistics.mean(statistics.mean(values) for values in columns)
        self.swing_n = statistics.mean(max(values) - min(values) for values in columns)
        self.max_n = max(max(values) for values in columns)


def label(friction):
    return WORDS.get(friction, f"mu {friction}")


def ways_table(gait, walks):
    rows = []
    for friction in FRICTIONS:
        runs = [walks[gait, friction, start] for start in range(STARTS)]
        far = [100 * run.distance_m(TO_S) for run in runs]
        rows.append([label(friction), f"{100 * runs[0].distance_m(20):.2f}", f"{far[0]:.2f}",
                     f"{min(far):.2f} to {max(far):.2f}",
                     f"{10 * statistics.mean(100 * run.speed_m_per_s() for run in runs):.2f}",
                     f"{runs[0].work_j:.0f}", f"{runs[0].loss_j:.0f}"])
    return table(["eyelets", "distance in 20 s [cm]", "distance in 60 s [cm]", f"distance in 60 s, range of {STARTS} starts [cm]",
                  "speed from 30 to 60 s [mm/s]", "winding work [J]", "energy lost in eyelets [J]"], rows)


def tensions_table(gait, walks):
    rows = []
    for friction in FRICTIONS[1:]:
        cells = [label(friction)]
        for role in ("outer", "inner"):
            motor, cell = walks[gait, friction, 0].sides[role]
            cells += [f"{motor.mean_n:.1f}, {cell.mean_n:.1f}", f"{motor.swing_n:.1f}, {cell.swing_n:.1f}",
                      f"{motor.max_n:.1f}, {cell.max_n:.1f}"]
        rows.append(cells)
    return table(["eyelets", *(f"{role} cables: {what} [N]" for role in ("outer", "inner") for what in ("mean", "p-p", "largest"))], rows)


def ground_table(folder, results):
    rows = []
    for ground in GROUNDS:
        cells = [f"{0.15 * ground:.3f}"]
        for friction in ("0", "0.2"):
            run = GROUND_RUNS[friction, ground]
            cells.append(f"{100 * Walk(folder / run.name, results[run.name]).distance_m(TO_S):.2f}")
        rows.append(cells)
    return table(["friction of the ground (product of both coefficients)", "distance in 60 s [cm], eyelets without friction",
                  "distance in 60 s [cm], eyelets with mu 0.2"], rows)


def difference_mm(walks, gait):
    """Returns the largest difference in 5 s between the plain model and the model with frictionless eyelets [mm]."""
    a, b = (walks[gait, friction, 0].path for friction in ("plain", "0"))
    return 1000 * max(math.dist(p, q) for p, q in zip(a[:5 * RATE_HZ], b))


def values(folder, results):
    walks = {key: Walk(folder / run.name, results[run.name]) for key, run in RUNS.items()}
    out = {"eyelets_ground": ground_table(folder, results)}
    for gait in GAITS:
        out[gait + "_eyelets_ways"] = ways_table(gait, walks)
        out[gait + "_eyelets_tensions"] = tensions_table(gait, walks)
        out[gait + "_eyelets_apart"] = f"{difference_mm(walks, gait):.1e}"
    return out
