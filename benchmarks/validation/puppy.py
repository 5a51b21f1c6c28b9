"""A robot with four legs stands and trots: steadiness, distance, footfall pattern."""

import cmath
import csv
import json
import math
import pathlib
import time

from validation.push import machine
from validation.runs import Variant, fill, keep_picture, table, yaml_block

TEMPLATE = pathlib.Path(__file__).with_suffix(".md.in")
LEGS = ("front_left", "rear_right", "front_right", "rear_left")  # one diagonal, then the other
SLOTS = 8
FOOT_RADIUS_M = 0.015
GRAVITY = 9.81
FROM_S = 2.0        # start-up time
JOINTS = [(f"{leg}.{a}", f"{leg}.{b}") for leg in LEGS for a, b in (("socket", "hip"), ("knee", "shank_knee"))]
GIRDLES = ("vertebra_0.centre-left", "vertebra_3.centre-left")
RECORD = ("record: {{rate_hz: 500, contacts: {slots}, channels: ['system/*', 'body/*', 'contact/*/body_*', "
          "'contact/*/force_z_n', 'cable/*/tension_n', 'node/*/position_*'{more}]}}\n")


def record(more=""):
    return RECORD.format(slots=SLOTS, more=more)


class Trace:
    """Rows of a run as columns by name."""

    def __init__(self, folder):
        with open(folder / "trace.csv", newline="") as file:
            rows = csv.reader(file)
            head = next(rows)
            self.columns = dict(zip(head, map(list, zip(*[[float(x) for x in row] for row in rows]))))
        self.time_s = self["time_s"]
        # Contacts refer to bodies by their index in the model, which is the order of their channels.
        self.bodies = [name.split("/")[1] for name in head if name.startswith("body/") and name.endswith("/position_x_m")]

    def __getitem__(self, name):
        return self.columns[name]

    def vectors(self, name, unit):
        return list(zip(*(self[f"{name}_{axis}_{unit}"] for axis in "xyz")))

    def feet(self):
        """Returns the vertical force on each foot, row by row [N], and other pairs of bodies in contact."""
        shanks = {self.bodies.index(f"{leg}.spur-shank_knee"): leg for leg in LEGS}
        force = {leg: [0.0] * len(self.time_s) for leg in LEGS}
        others = set()
        for slot in range(SLOTS):
            a, b, up = (self[f"contact/{slot}/{name}"] for name in ("body_a", "body_b", "force_z_n"))
            for row in range(len(self.time_s)):
                if math.isnan(a[row]):
                    continue
                if b[row] == -1 and a[row] in shanks:
                    force[shanks[a[row]]][row] += up[row]
                else:
                    others.add((a[row], b[row]))
        return force, others

    def gap_m(self):
        """Returns the largest distance between two nodes that a joint connects [m]."""
        return max(math.dist(p, q) for a, b in JOINTS for p, q in
                   zip(self.vectors(f"node/{a}/position", "m"), self.vectors(f"node/{b}/position", "m")))

    def tensions_n(self):
        values = [self[name] for name in self.columns if name.startswith("cable/")]
        return min(map(min, values)), max(map(max, values))

    def tilt_rad(self):
        """Returns the largest tilt of a girdle [rad]."""
        return max(math.acos(min(1.0, 1 - 2 * (x * x + y * y))) for body in GIRDLES for x, y in
                   zip(self[f"body/{body}/orientation_x"], self[f"body/{body}/orientation_y"]))

    def yaw_rad(self):
        w, x, y, z = (self[f"body/{GIRDLES[0]}/orientation_{name}"][-1] for name in "wxyz")
        return math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))

    def torso_m(self):
        """Returns the minimum and maximum heights of the girdles' centers of mass [m]."""
        heights = [self[f"body/{body}/position_z_m"] for body in GIRDLES]
        return min(map(min, heights)), max(map(max, heights))

    def ahead_m(self):
        x = self["system/com_x_m"]
        return [value - x[0] for value in x]

    def slid_m(self, force, leg):
        """Returns the distance that a foot's contact point slides while loaded, from FROM_S on [m]."""
        body = f"body/{leg}.spur-shank_knee"
        # The foot is not at the body's center: its velocity is computed from its positions.
        place = self.vectors(f"node/{leg}.foot/position", "m")
        turns = self.vectors(f"{body}/angular_velocity", "rad_per_s")
        way = 0.0
        for row in range(1, len(place)):
            if self.time_s[row] <= FROM_S or force[leg][row] <= 0 or force[leg][row - 1] <= 0:
                continue
            step_s = self.time_s[row] - self.time_s[row - 1]
            wx, wy = ((turns[row][i] + turns[row - 1][i]) / 2 for i in (0, 1))
            way += math.hypot(place[row][0] - place[row - 1][0] - wy * FOOT_RADIUS_M * step_s,
                              place[row][1] - place[row - 1][1] + wx * FOOT_RADIUS_M * step_s)
        return way


def phase(on, time_s, frequency_hz):
    """Returns the phase of the first harmonic of a signal that is 1 while a foot carries load, in periods."""
    return cmath.phase(sum(cmath.exp(-2j * math.pi * frequency_hz * t) for o, t in zip(on, time_s) if o)) / (2 * math.pi)


def later(a, b):
    """Returns the delay of phase b after phase a, in periods: from -0.2 on, so that half a period is not minus half."""
    return (a - b + 0.2) % 1 - 0.2


def frequency_hz():
    text = yaml_block("share/gaits/puppy_trot.yaml", "sine")
    return float(text.split("frequency_hz:")[1].split()[0])


def work_j(summary):
    return sum(cable["actuator"]["energy_j"] for cable in summary["cables"] if "actuator" in cable)


def standing(trace, mass_kg):
    force, others = trace.feet()
    push_n = trace["push/nudge/force_n"]
    pushed = next(i for i, n in enumerate(push_n) if n > 0) - 1  # the last row before
    last = {leg: force[leg][pushed] for leg in LEGS}
    places = {body: trace.vectors(f"body/{body}/position", "m") for body in trace.bodies}
    speeds = {body: [math.hypot(*v) for v in trace.vectors(f"body/{body}/velocity", "m_per_s")] for body in trace.bodies}
    speed = max(v for body in trace.bodies for v in speeds[body][:pushed])
    moved = max(math.dist(p, places[body][0]) for body in trace.bodies for p in places[body][:pushed])
    low, high = (pick(pick(trace[name][:pushed]) for name in trace.columns if name.startswith("cable/")) for pick in (min, max))
    aside = [1000 * abs(p[1] - places["vertebra_1"][0][1]) for p in places["vertebra_1"]]
    return {
        "push_n": f"{max(push_n):.0f}", "push_mm": f"{max(aside):.0f}", "push_end": f"{aside[-1]:.0f}",
        "push_speed": f"{max(v[-1] for v in speeds.values()):.0e}",
        "push_least": str(min(sum(force[leg][i] > 0 for leg in LEGS) for i in range(1, len(push_n)))),
        "stand_forces": ", ".join(f"{last[leg]:.2f}" for leg in LEGS),
        "stand_sum": f"{sum(last.values()):.3f}", "weight": f"{mass_kg * GRAVITY:.3f}",
        "stand_speed": f"{speed:.0e}", "stand_moved": f"{moved:.0e}", "stand_gap": f"{trace.gap_m():.0e}",
        "stand_tensions": f"{low:.1f} to {high:.1f}", "stand_others": "none" if not others else "some",
    }


def variants():
    """Returns the name of each row and the keys of its experiment."""
    yield "as shipped", ""
    for step_s in (0.0005, 0.00025):
        yield f"step {1000 * step_s:g} ms", f"step_s: {step_s}\n"
    for quantity, factors in (("friction", (0.2, 0.7, 1.3)), ("mass", (0.9, 1.1, 1.3, 1.6)), ("stiffness", (0.9, 1.1)),
                              ("damping", (0.25, 0.7, 1.3))):
        for factor in factors:
            yield f"{quantity} x {factor}", f"scale: [{{{quantity}: {factor}}}]\n"
    for seed in (1, 2, 3, 4, 5):
        yield f"start {seed}", f"seed: {seed}\nstart_noise: {{position_m: 0.001, heading_rad: 0.05}}\n"


def row(name, trace, summary):
    ahead = trace.ahead_m()
    there = next((t for t, x in zip(trace.time_s, ahead) if x >= 1), None)
    force, others = trace.feet()
    walking = [i for i, t in enumerate(trace.time_s) if t >= FROM_S]
    one = sum(all((force[a][i] > 0) == (force[b][i] > 0) for a, b in (LEGS[:2], LEGS[2:])) for i in walking)
    aside = trace["system/com_y_m"][-1] - trace["system/com_y_m"][0]
    return [name, f"{ahead[-1]:.2f}", f"{aside:+.2f}", "never" if there is None else f"{there:.1f}",
            f"{1000 * trace.torso_m()[0]:.0f}", f"{math.degrees(trace.tilt_rad()):.0f}", f"{100 * one / len(walking):.0f}",
            f"{summary['system_max_tension_n']:.0f}", "no" if not others else "yes"]


def gait(trace, summary, mass_kg):
    """Describes the footfalls of the unperturbed run."""
    force, _ = trace.feet()
    hz = frequency_hz()
    walking = [i for i, t in enumerate(trace.time_s) if t >= FROM_S]
    # Whole periods only
    periods = math.floor((trace.time_s[-1] - FROM_S) * hz)
    window = [i for i in walking if trace.time_s[i] < FROM_S + periods / hz]
    times = [trace.time_s[i] for i in window]
    ahead = trace.ahead_m()
    way = ahead[-1] - ahead[walking[0]]
    phases, rows = {}, []
    for leg in LEGS:
        on = [force[leg][i] > 0 for i in window]
        phases[leg] = phase(on, times, hz)
        lift = max(trace[f"node/{leg}.foot/position_z_m"][i] for i in walking) - FOOT_RADIUS_M
        rows.append([leg, f"{sum(on) / len(on):.2f}", f"{later(phases[LEGS[0]], phases[leg]):.2f}", f"{1000 * lift:.0f}",
                     f"{sum(force[leg][i] for i in window) / len(window):.2f}", f"{max(force[leg][i] for i in walking):.0f}",
                     f"{trace.slid_m(force, leg) / way:.2f}"])
    count = [0] * 5
    for i in walking:
        count[sum(force[leg][i] > 0 for leg in LEGS)] += 1
    work = work_j(summary)
    low, high = trace.torso_m()
    return {
        "feet": table(["foot", "share of time with load", "delay after front left [periods]", "lift [mm]",
                       "mean force [N]", "largest force [N]", "sliding per distance [m/m]"], rows),
        "feet_down": "{}, {}, {}, {} and {} %".format(*(f"{100 * c / len(walking):.0f}" for c in count)),
        "hz": f"{hz:.2f}", "speed": f"{way / (trace.time_s[-1] - trace.time_s[walking[0]]):.2f}",
        "stride": f"{1000 * way / (trace.time_s[-1] - trace.time_s[walking[0]]) / hz:.0f}",
        "low": f"{1000 * low:.0f}", "high": f"{1000 * high:.0f}", "tilt": f"{math.degrees(trace.tilt_rad()):.0f}",
        "yaw": f"{math.degrees(trace.yaw_rad()):+.0f}", "gap": f"{trace.gap_m():.0e}",
        "work": f"{work:.0f}", "cost": f"{work / (mass_kg * GRAVITY * ahead[-1]):.1f}",
        "power": f"{max(cable['actuator']['max_power_w'] for cable in summary['cables'] if 'actuator' in cable):.1f}",
        "tensions": "{:.0f} to {:.0f}".format(*trace.tensions_n()),
        "slack": str(sum(min(trace[name]) <= 0 for name in trace.columns if name.startswith("cable/"))),
    }


def picture(trace):
    """Draws a bar for each stance phase of a foot, for two seconds from FROM_S; one row per foot, one shade per
    diagonal."""
    force, _ = trace.feet()
    left, top, width, high = 100, 20, 720, 28

    def across(time_s):
        return left + width * (time_s - FROM_S) / 2

    rows = [i for i, t in enumerate(trace.time_s) if FROM_S <= t <= FROM_S + 2]
    out = ['<svg xmlns="http://www.w3.org/2000/svg" width="860" height="190" viewBox="0 0 860 190" '
           'font-family="sans-serif" font-size="13">', '<rect width="860" height="190" fill="white"/>']
    for number, leg in enumerate(LEGS):
        y = top + number * (high + 6)
        out.append(f'<text x="{left - 8}" y="{y + high / 2 + 4:g}" text-anchor="end">{leg.replace("_", " ")}</text>')
        begin = None
        for i in rows:
            carries = force[leg][i] > 0
            if carries and begin is None:
                begin = trace.time_s[i]
            if begin is not None and (not carries or i == rows[-1]):
                out.append(f'<rect x="{across(begin):.1f}" y="{y}" width="{across(trace.time_s[i]) - across(begin):.1f}" '
                           f'height="{high}" fill="{"#2171b5" if number < 2 else "#e08a1e"}"/>')
                begin = None
    for tenth in range(0, 21, 5):
        time_s = FROM_S + tenth / 10
        out.append(f'<text x="{across(time_s):.1f}" y="{top + 4 * (high + 6) + 14}" text-anchor="middle">{time_s:g} s</text>')
    return "\n".join(out + ["</svg>", ""])


def page(taut):
    started = time.monotonic()
    mass_kg = json.loads(taut("check", "models/puppy.yaml", "--json"))["total_mass_kg"]
    stand = Variant("puppy_stand", "puppy_stand", record(", 'push/*'"), full_trace=True)
    trots = {name: Variant("puppy_" + name.replace(" ", "_"), "puppy_trot", keys + record(), full_trace=True,
                           any_status=True)
             for name, keys in variants()}
    results = taut.run([stand, *trots.values()])
    rows, values = [], {}
    for name, variant in trots.items():
        trace, summary = Trace(taut.folder / variant.name), results[variant.name].summary
        rows.append(row(name, trace, summary))
        if name == "as shipped":
            values |= gait(trace, summary, mass_kg)
            keep_picture(taut, "docs/validation/puppy_feet.svg", picture(trace))
            values["duration"] = f"{trace.time_s[-1]:g}"
    values |= standing(Trace(taut.folder / stand.name), mass_kg)
    values |= {
        "variants": table(["change", "forward [m]", "left [m]", "time to 1 m [s]", "smallest height of a girdle [mm]",
                           "largest tilt [degrees]", "both feet of each diagonal with load, or both without [% of time]",
                           "largest tension [N]", "other contacts"], rows),
        "version": taut("--version").split()[-1], "runs": str(len(trots) + 1),
        "seconds": f"{time.monotonic() - started:.0f}", "machine": machine(),
    }
    return fill(TEMPLATE.read_text(), values)
