"""The hand-tuned sine with larger amplitudes, up to the robot's: toppling and friction of the ground."""

import csv
import itertools
import math
import pathlib
import textwrap
import time

from validation.push import machine
from validation.runs import ROOT, Variant, fill, keep_picture, replaced, table, yaml_block

TEMPLATE = pathlib.Path(__file__).with_suffix(".md.in")
EXPERIMENT, GAIT, MODEL = "sine_hand_tuned", "gaits/hand_tuned_sine.yaml", "models/tetraspine3.yaml"
FACTORS = (1, 2, 3, 5, 7, 10)                   # factors on the gait's amplitudes; 10: the robot's
FRICTIONS = (0.075, 0.15, 0.3, 0.5, 0.8, 1.2)   # effective coefficient of a segment on the ground; 0.075: NTRT's
ROBOT_FRICTION = 0.15                           # coefficient of the robot, multiplied by the ground's coefficient
OTHERS = (           # further experiments: friction of the robot, effective coefficient on the ground
    ("NTRT's laws", EXPERIMENT + "_ntrt", 0.15, 0.075),
    ("0.5 between segments", EXPERIMENT, math.sqrt(0.5), 0.075),
    ("0.5 between segments", EXPERIMENT, math.sqrt(0.5), 0.5),
    ("0.5 between segments", EXPERIMENT, math.sqrt(0.5), 1.2),
    ("1 between segments", EXPERIMENT, 1, 1),
)
OTHER_FACTORS = (5, 10)
STARTS = ((0.0, 0.0), (0.02, 0.004), (-0.05, 0.01))   # initial roll [rad], and height above the floor [m]
COARSE_S, FINE_S = 0.001, 0.0005
DURATION_S = 40
FORCE_N, LEAST_M, SPEED_M_PER_S = 50, 0.01, 0.07   # limits of a motor: force, shortest rest length, speed
RATE_HZ = 25
GAP_EVERY = 5        # rows
EDGE_M, RADIUS_M = 0.38, 0.003175
TIP_Z_M = EDGE_M / 2 * math.tan(math.pi / 6)
NODES = ((0, -EDGE_M / 2, 0), (0, EDGE_M / 2, 0), (0, 0, math.sqrt(3) / 2 * EDGE_M), (0.25, 0, TIP_Z_M))
FRONT_M, SPACING_M = (0.77, 0, 0.005), 0.23     # origin of the node coordinates of segment 0
SEGMENTS = 3
START_M = 0.21       # distance of neighboring centers of mass at the start
TOUCH_M = 0.0002


def scaled_gait(folder, factor):
    """Writes the gait with all amplitudes, and the offsets that depend on them, multiplied by a factor."""
    text = (ROOT / "share" / GAIT).read_text()
    for name in ("inner_front", "inner_back", "outer_front", "outer_back"):
        text = replaced(text, f"  {name}_m_per_s: ", f"  {name}_m_per_s: {factor} * ")
    folder.mkdir(parents=True, exist_ok=True)
    (folder / f"gait_{factor}.yaml").write_text(text)


def rough_model(folder, robot_friction):
    text = replaced((ROOT / "share" / MODEL).read_text(), f"  friction: {ROBOT_FRICTION} ", f"  friction: {robot_friction:.9g} ")
    (folder / f"model_{robot_friction:.3f}.yaml").write_text(text)


def variant(factor, friction, start, step_s, experiment=EXPERIMENT, robot_friction=ROBOT_FRICTION):
    controllers = replaced(yaml_block(f"share/experiments/{experiment}.yaml", "controllers"),
                           "../" + GAIT, f"../gait_{factor}.yaml")
    other, model = "", ""
    if robot_friction != ROBOT_FRICTION:
        other, model = f"_robot{robot_friction:.3f}", f"model: ../model_{robot_friction:.3f}.yaml\n"
    if experiment != EXPERIMENT:
        other += "_" + experiment
    keys = (f"step_s: {step_s}\nduration_s: {DURATION_S}\ntimeline: {{}}\n"
            f"place: {{at_m: [0, 0, {STARTS[start][1]}], rotate: {{axis: x, angle_rad: {STARTS[start][0]}}}}}\n"
            f"record: {{rate_hz: {RATE_HZ}, channels: ['body/*/position_*', 'body/*/orientation_*', "
            "'cable/*/tension_n', 'cable/*/length_m', 'cable/*/rest_length_m', 'system/com_*']}\n")
    return Variant(f"x{factor}_mu{friction:g}_{start}_{1e6 * step_s:.0f}us{other}", experiment,
                   model + keys + controllers, {"ground_friction": f"{friction / robot_friction:.9g}"},
                   full_trace=True, any_status=True)


# --- evaluation of a run --------------------------------------------------------------------------


def turned(q, p):
    """Rotates the vector p by the quaternion q = (w, x, y, z)."""
    w, x, y, z = q
    tx, ty, tz = 2 * (y * p[2] - z * p[1]), 2 * (z * p[0] - x * p[2]), 2 * (x * p[1] - y * p[0])
    return (p[0] + w * tx + y * tz - z * ty, p[1] + w * ty + z * tx - x * tz, p[2] + w * tz + x * ty - y * tx)


def minus(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def apart_m(a, b, c, d):
    """Returns the distance between the segments from a to b and from c to d."""
    u, v, w = minus(b, a), minus(d, c), minus(a, c)
    uu, uv, vv, uw, vw = dot(u, u), dot(u, v), dot(v, v), dot(u, w), dot(v, w)
    wide = uu * vv - uv * uv
    s = min(max((uv * vw - vv * uw) / wide, 0), 1) if wide > 1e-12 else 0
    t = min(max((uv * s + vw) / vv, 0), 1)
    s = min(max((uv * t - uw) / uu, 0), 1)
    return math.sqrt(sum((w[k] + s * u[k] - t * v[k]) ** 2 for k in range(3)))


class Outcome:
    """Displacement, tilt, least distance between segments, and motor activity of a run. Shares refer to all recorded
    moments, for motors also to all twelve motors."""

    def __init__(self, folder, result, roll_rad, lift_m):
        self.status = result.summary["status"]
        with open(folder / "trace.csv", newline="") as file:
            rows = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
        cables = [key[:-len("tension_n")] for key in rows[0] if key.endswith("/tension_n")]
        self.distance_m = math.dist(*([row["system/com_x_m"], row["system/com_y_m"]] for row in (rows[0], rows[-1])))
        self.forward_m = rows[-1]["system/com_x_m"] - rows[0]["system/com_x_m"]
        pose = [[self._pose(row, i) for i in range(SEGMENTS)] for row in rows]
        # Orientations are relative to the start, which is rolled; so are the nodes and the upward direction.
        roll = (math.cos(roll_rad / 2), math.sin(roll_rad / 2), 0, 0)
        upright = turned(roll, (0, 0, 1))
        levers = []   # positions of the nodes, relative to the center of mass
        for i, (at, _) in enumerate(pose[0]):
            middle = minus(at, (0, 0, lift_m))
            front = (FRONT_M[0] - i * SPACING_M, *FRONT_M[1:])
            levers.append([minus(turned(roll, tuple(map(sum, zip(front, node)))), middle) for node in NODES])
        self.tilt_deg, self.toppled_s = 0, None
        for row, poses in zip(rows, pose):
            tilt = max(math.degrees(math.acos(max(-1, min(1, turned(q, upright)[2])))) for _, q in poses)
            self.tilt_deg = max(self.tilt_deg, tilt)
            if tilt > 90 and self.toppled_s is None:
                self.toppled_s = row["time_s"]
        self.near_m = min(math.dist(p[i][0], p[i + 1][0]) for p in pose for i in range(SEGMENTS - 1))
        gaps = [self._gap(poses, levers) for poses in pose[::GAP_EVERY]]
        self.gap_m, self.touching = min(gaps), sum(gap < TOUCH_M for gap in gaps) / len(gaps)
        count = len(rows) * len(cables)
        self.at_force = sum(row[c + "tension_n"] > 0.999 * FORCE_N for row in rows for c in cables) / count
        self.at_length = sum(min(row[c + "rest_length_m"], row[c + "length_m"]) < 1.01 * LEAST_M
                             for row in rows for c in cables) / count
        self.at_speed = sum(abs(b[c + "rest_length_m"] - a[c + "rest_length_m"]) > 0.99 * SPEED_M_PER_S / RATE_HZ
                            for a, b in zip(rows, rows[1:]) for c in cables) / count
        self.most_n = max(row[c + "tension_n"] for row in rows for c in cables)

    @staticmethod
    def _pose(row, i):
        name = f"body/segment_{i}/"
        return (tuple(row[name + f"position_{k}_m"] for k in "xyz"),
                tuple(row[name + f"orientation_{k}"] for k in "wxyz"))

    @staticmethod
    def _gap(poses, levers):
        """Returns the least distance between the surfaces of neighbors' rods."""
        points = [[tuple(at[k] + p[k] for k in range(3)) for p in (turned(q, lever) for lever in own)]
                  for (at, q), own in zip(poses, levers)]
        rods = list(itertools.combinations(range(4), 2))
        return min(apart_m(a[i], a[j], b[k], b[m]) for a, b in zip(points, points[1:])
                   for i, j in rods for k, m in rods) - 2 * RADIUS_M


# --- the page -------------------------------------------------------------------------------------


def span(values, form):
    low, high = form(min(values)), form(max(values))
    return low if low == high else f"{low} to {high}"


def cell_table(outcomes, show):
    """Formats one row per friction, one column per factor."""
    return table(["friction", *(f"x {factor}" for factor in FACTORS)],
                 [[f"{friction:g}", *(show(outcomes[factor, friction]) for factor in FACTORS)]
                  for friction in FRICTIONS])


def picture(outcomes):
    """Draws the least distance of segments against the factor, one line per run."""
    left, top, width, height = 70, 30, 620, 330
    shades = ["#08306b", "#2171b5", "#4aa3c7", "#74b266", "#e08a1e", "#b2182b"]
    most = 15

    def across(factor):
        return left + width * math.log(factor) / math.log(FACTORS[-1])

    def up(cm):
        return top + height * (1 - cm / most)

    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="860" height="420" viewBox="0 0 860 420" '
           'font-family="sans-serif" font-size="13">', '<rect width="860" height="420" fill="white"/>']
    for cm in range(0, most + 1, 5):
        out.append(f'<path d="M{left} {up(cm):.1f}h{width}" stroke="#ddd"/>'
                   f'<text x="{left - 8}" y="{up(cm) + 4:.1f}" text-anchor="end">{cm}</text>')
    for factor in FACTORS:
        out.append(f'<text x="{across(factor):.1f}" y="{top + height + 20}" text-anchor="middle">{factor}</text>')
    for shade, friction in zip(shades, FRICTIONS):
        for run in range(len(outcomes[FACTORS[0], friction])):
            points = " ".join(f"{across(f):.1f},{up(100 * outcomes[f, friction][run].near_m):.1f}" for f in FACTORS)
            out.append(f'<polyline points="{points}" fill="none" stroke="{shade}"/>')
        y = top + 20 * FRICTIONS.index(friction)
        out.append(f'<path d="M{left + width + 20} {y}h24" stroke="{shade}" stroke-width="2"/>'
                   f'<text x="{left + width + 50}" y="{y + 4}">friction {friction:g}</text>')
    out.append(f'<text x="{left + width / 2}" y="{top + height + 44}" text-anchor="middle">'
               "amplitude, times the simulation's of the paper</text>")
    out.append(f'<text x="20" y="{top + height / 2}" text-anchor="middle" '
               f'transform="rotate(-90 20 {top + height / 2})">smallest distance of neighbors, cm</text>')
    return "\n".join(out + ["</svg>", ""])


def answer(outcomes):
    """Compares the paper's observation with the results, for the top of the page."""
    runs = [run for cell in outcomes.values() for run in cell]
    down = sum(run.toppled_s is not None for run in runs)
    most = max(run.tilt_deg for run in runs)
    text = (f"No segment topples: none tilts by more than {most:.0f} degrees" if down == 0 else
            f"A segment topples in {down} of {len(runs)} runs; the largest tilt is {most:.0f} degrees")
    free = [f for f in FACTORS if all(run.touching == 0 for mu in FRICTIONS for run in outcomes[f, mu])]
    stuck = [f for f in FACTORS if all(run.touching > 0 for mu in FRICTIONS for run in outcomes[f, mu])]
    if stuck:
        text += f". From {min(stuck)} times the amplitude on, segments touch each other at every friction"
    if free:
        text += f"; up to {max(free)} times the amplitude, no segment touches another in any run"
    own = [run for mu in FRICTIONS for run in outcomes[FACTORS[-1], mu]]
    return textwrap.fill(
        f"{text}. At the robot's own amplitudes they touch for {span([100 * r.touching for r in own], '{:.0f}'.format)} % "
        f"of the time, and come as close as {span([100 * r.near_m for r in own], '{:.1f}'.format)} cm between centers "
        f"of mass (about {100 * START_M:.0f} cm at the start), at every friction.", 110)


def page(taut):
    started = time.monotonic()
    for factor in FACTORS:
        scaled_gait(taut.folder, factor)
    kinds = [(start, COARSE_S) for start in range(len(STARTS))] + [(0, FINE_S)]
    variants = {(factor, friction): [variant(factor, friction, *kind) for kind in kinds]
                for factor in FACTORS for friction in FRICTIONS}
    others = {}
    for (text, experiment, robot_friction, friction), factor in itertools.product(OTHERS, OTHER_FACTORS):
        rough_model(taut.folder, robot_friction)
        others[text, friction, factor] = variant(factor, friction, 0, COARSE_S, experiment, robot_friction)
    results = taut.run([v for cell in variants.values() for v in cell] + list(others.values()))
    other_runs = {key: Outcome(taut.folder / v.name, results[v.name], *STARTS[0]) for key, v in others.items()}
    outcomes = {key: [Outcome(taut.folder / v.name, results[v.name], *STARTS[start])
                      for v, (start, _) in zip(cell, kinds)] for key, cell in variants.items()}
    keep_picture(taut, "docs/validation/sine_amplitude.svg", picture(outcomes))
    coarse = {key: cell[:len(STARTS)] for key, cell in outcomes.items()}
    steps = [abs(cell[0].near_m - cell[-1].near_m) for cell in outcomes.values()]
    ways = [abs(cell[0].forward_m - cell[-1].forward_m) for cell in outcomes.values()]
    runs = [run for cell in outcomes.values() for run in cell]
    values = {
        "answer": answer(outcomes),
        "tilt": cell_table(coarse, lambda cell: span([run.tilt_deg for run in cell], "{:.0f}".format)),
        "near": cell_table(coarse, lambda cell: span([100 * run.near_m for run in cell], "{:.1f}".format)),
        "touching": cell_table(coarse, lambda cell: span([100 * run.touching for run in cell], "{:.0f}".format)),
        "forward": cell_table(coarse, lambda cell: span([100 * run.forward_m for run in cell], "{:.0f}".format)),
        "motors": table(["amplitude", "winding at full speed [%]", "at the minimum length [%]", "at 50 N [%]",
                         "largest tension [N]"],
                        [[f"x {factor}", *(span([form(run) for mu in FRICTIONS for run in coarse[factor, mu]],
                                                "{:.0f}".format)
                                           for form in (lambda r: 100 * r.at_speed, lambda r: 100 * r.at_length,
                                                        lambda r: 100 * r.at_force, lambda r: r.most_n))]
                         for factor in FACTORS]),
        "others": table(["run", "friction on the ground", "amplitude", "smallest distance [cm]", "touching [% of time]", "largest tilt [degrees]", "forward [cm]"],
                        [[text, f"{friction:g}", f"x {factor}", f"{100 * run.near_m:.1f}", f"{100 * run.touching:.0f}",
                          f"{run.tilt_deg:.0f}", f"{100 * run.forward_m:.0f}"]
                         for (text, friction, factor), run in other_runs.items()]),
        "other_down": str(sum(run.toppled_s is not None for run in other_runs.values())),
        "other_runs": str(len(other_runs)),
        "all_runs": str(len(runs) + len(other_runs)),
        "near_step": f"{1000 * max(steps):.2f}",
        "forward_step": f"{1000 * max(ways):.1f}",
        "down": f"{sum(run.toppled_s is not None for run in runs)}",
        "gap": f"{1e6 * max(-min(run.gap_m for run in runs), 0):.2f}",
        "warned": str(sum(run.status != "ok" for run in runs)),
        "duration": str(DURATION_S),
        "version": taut("--version").split()[-1],
        "runs": str(len(runs)),
        "seconds": f"{time.monotonic() - started:.0f}",
        "machine": machine(),
    }
    return fill(TEMPLATE.read_text(), values)
