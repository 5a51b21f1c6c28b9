"""Twelve segments over walls: height and frequency of success, with cables that pass through the walls or collide
with them, and with a gait with contact feedback."""

import csv
import pathlib
import random
import time

from validation.push import machine
from validation.runs import Variant, fill, table

TEMPLATE = pathlib.Path(__file__).with_suffix(".md.in")
HEIGHTS_M = (0.02, 0.04, 0.06, 0.08, 0.10)
STARTS = 20
DURATION_S = 70
FAR_SIDE_M = 1.20   # far side of the wall
REACH_M = 0.25      # largest distance of a segment's point from its center of mass
SEGMENTS = 12
ROBOT_CM = 33.0     # height of the standing robot
SIDE_M = 2.5        # half width: the wall reaches 3 m to either side


def start(number):
    """Returns position, heading and ground of a start; the first is the unchanged experiment."""
    if number == 0:
        return {}
    rng = random.Random(number)
    return {
        "start_x_m": f"{rng.uniform(-0.1, 0.0):.4f}",
        "start_yaw_rad": f"{rng.uniform(-0.05, 0.05):.4f}",
        "ground_friction": f"{rng.uniform(0.4, 0.6):.4f}",
        "wall_friction": f"{rng.uniform(0.8, 1.2):.4f}",
    }


# Heights per experiment.
KINDS = {"wall": HEIGHTS_M, "wall_touching": HEIGHTS_M,
         "wall_sensing_high": (0.02, 0.06, 0.10, 0.12, 0.14, 0.16, 0.18)}


def variant(kind, height_m, number):
    keys = (f"duration_s: {DURATION_S}\n"
            "record: {rate_hz: 4, channels: ['body/*/position_x_m', 'body/*/position_y_m']}\n")
    return Variant(f"{kind}_{1000 * height_m:.0f}mm_{number}", kind, keys,
                   {"wall_height_m": height_m, **start(number)}, full_trace=True, any_status=True)


def over_at_s(folder):
    """Returns the time at which the whole robot is first behind the wall (None if never), and the number of segments
    behind
    it then or at the end."""
    behind = 0
    with open(folder / "trace.csv", newline="") as file:
        for row in csv.DictReader(file):
            behind = 0
            for segment in range(SEGMENTS):
                x = float(row[f"body/segment_{segment}/position_x_m"])
                y = float(row[f"body/segment_{segment}/position_y_m"])
                behind += x > FAR_SIDE_M + REACH_M and abs(y) < SIDE_M
            if behind == SEGMENTS:
                return float(row["time_s"]), behind
    return None, behind


def walls(taut, kind, results):
    """Formats the table of one experiment; returns also the highest wall that the unperturbed robot passes."""
    rows, highest = [], 0.0
    for height_m in KINDS[kind]:
        names = [variant(kind, height_m, number).name for number in range(STARTS)]
        outcomes = [over_at_s(taut.folder / name) for name in names]
        times = [at_s for at_s, _ in outcomes if at_s is not None]
        stuck = [behind for at_s, behind in outcomes if at_s is None]
        highest = height_m if outcomes[0][0] is not None and height_m > highest else highest
        warned = sum(results[name].summary["status"] != "ok" for name in names)
        rows.append([f"{100 * height_m:.0f}", f"{len(times)} of {STARTS}",
                     f"{min(times):.1f} to {max(times):.1f}" if times else "",
                     f"{outcomes[0][0]:.1f}" if outcomes[0][0] is not None else "never",
                     f"{min(stuck)} to {max(stuck)}" if stuck else "", str(warned)])
    return table(["wall height [cm]", "starts that cross the wall", "time [s]", "unchanged experiment: time [s]",
                  "segments behind the wall at the end, if not crossed", "runs with a warning"], rows), highest


def page(taut):
    started = time.monotonic()
    variants = [variant(kind, height_m, number) for kind, heights_m in KINDS.items()
                for height_m in heights_m for number in range(STARTS)]
    results = taut.run(variants)
    values = {}
    for kind in KINDS:
        values[kind], highest = walls(taut, kind, results)
        values[kind + "_highest"] = f"{100 * highest:.0f}"
    values |= {
        "wall_sensing_high_share": f"{float(values['wall_sensing_high_highest']) / ROBOT_CM * 100:.0f}",
        "starts": str(STARTS - 1),
        "duration": str(DURATION_S),
        "version": taut("--version").split()[-1],
        "runs": str(len(variants)),
        "seconds": f"{time.monotonic() - started:.0f}",
        "machine": machine(),
    }
    return fill(TEMPLATE.read_text(), values)
