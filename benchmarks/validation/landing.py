"""A six-strut robot with a payload in its middle, dropped: acceleration of the payload, loads of the members."""

import csv
import math
import pathlib
import time

from validation.push import machine
from validation.runs import Problem, Variant, fill, keep_picture, table

TEMPLATE = pathlib.Path(__file__).with_suffix(".md.in")
GRAVITY = 9.81
SPEEDS = (5, 10, 15)
# Landing orientation: direction of the model that points down, and distance of its lowest point from the middle, or a
# little more.
WAYS = {
    "a triangle of cables": ((-1, -1, -1), 0.78),
    "a cable": ((-1, -3, -2), 0.84),
    "two parallel struts' ends": ((0, 0, -1), 0.90),
    "one end of a strut": ((-1, -2, 0), 1.00),
}
SUSPENSIONS = (500, 1000, 2000, 4000, 8000, 16000)   # stiffness of a payload cable [N/m]; damping in proportion
DAMPING_S = 100 / 8000
COARSE_S, FINE_S = 0.0002, 0.0001
RATE_HZ = 5000
AFTER_S = 1.0        # duration of the run after the impact
FELT_S, LOAD_S = 0.001, 0.010
PAYLOAD_KG, RADIUS_M, BODIES = 4, 0.1, "abcdef"
STIFFNESS_N_PER_M = 3152.36   # stiffness of the robot's cables
TUBE_M, WALL_M, YOUNG_PA, STRUT_M = 0.050, 0.002, 69e9, 1.7   # diameter, wall, Young's modulus and length of a realistic strut


def euler_n():
    """Returns the Euler buckling load of a strut with hinged ends [N]."""
    second_moment = math.pi / 64 * (TUBE_M**4 - (TUBE_M - 2 * WALL_M)**4)
    return math.pi**2 * YOUNG_PA * second_moment / STRUT_M**2


def turn(down):
    """Returns the rotation that turns the direction `down` of the model downward, as YAML."""
    x, y, z = (k / math.hypot(*down) for k in down)
    if math.hypot(x, y) < 1e-9:
        return "{axis: x, angle_rad: 0}"
    return f"{{axis: [{-y:.12g}, {x:.12g}, 0], angle_rad: {math.acos(-z):.12g}}}"


def variant(way, speed, step_s=COARSE_S, stiffness=None):
    down, lowest_m = WAYS[way]
    keys = (f"step_s: {step_s}\nduration_s: {speed / GRAVITY + AFTER_S:.6f}\n"
            f"place: {{at_m: [0, 0, lowest_m + speed_m_per_s^2 / (2 * {GRAVITY})], rotate: {turn(down)}}}\n"
            f"record: {{rate_hz: {RATE_HZ}, contacts: 24, channels: ['body/payload/position_z_m', "
            "'body/payload/velocity_*', 'cable/*/tension_n', 'strut/*', 'system/contact_count', "
            "'contact/*/body_*']}\n")
    parameters = {"speed_m_per_s": speed, "lowest_m": lowest_m}
    name = f"{list(WAYS).index(way)}_{speed}_{1e6 * step_s:.0f}us"
    if stiffness:
        name += f"_k{stiffness}"
        parameters.update(payload_stiffness_n_per_m=stiffness, payload_damping_n_s_per_m=DAMPING_S * stiffness)
    return Variant(name, "land_six_strut", keys, parameters, full_trace=True)


class Landing:
    """Trace of a landing. Times count from the first contact."""

    def __init__(self, folder, speed):
        with open(folder / "trace.csv", newline="") as file:
            reader = csv.reader(file)
            head = next(reader)
            rows = [[float(x) for x in row] for row in reader]
        at = {name: i for i, name in enumerate(head)}
        touch = next(i for i, row in enumerate(rows) if row[at["system/contact_count"]] > 0)
        rows = rows[touch - 1:]
        self.speed = speed
        velocity = [[row[at[f"body/payload/velocity_{k}_m_per_s"]] for k in "xyz"] for row in rows]
        felt = round(FELT_S * RATE_HZ)
        self.deceleration = [math.dist(a, b) / FELT_S for a, b in zip(velocity, velocity[felt:])]
        self.most = max(self.deceleration)
        self.most_s = self.deceleration.index(self.most) / RATE_HZ
        height = [row[at["body/payload/position_z_m"]] for row in rows]
        self.stroke_m, self.gap_m = height[0] - RADIUS_M, min(height) - RADIUS_M
        self.rebound_m = max(height[height.index(min(height)):]) - RADIUS_M
        cables = {name: i for name, i in at.items() if name.endswith("/tension_n")}
        outer = [i for name, i in cables.items() if "payload" not in name]
        inner = [i for name, i in cables.items() if "payload" in name]
        self.outer_n = max(row[i] for row in rows for i in outer)
        self.inner_n = max(row[i] for row in rows for i in inner)
        self.outer_slack = sum(any(row[i] <= 0 for row in rows) for i in outer)
        self.inner_slack = sum(any(row[i] <= 0 for row in rows) for i in inner)
        self.push_n = max(self._mean_push(rows, at[f"strut/{body}/axial_n"]) for body in BODIES)
        self.pairs = set()
        slots = [(at[f"contact/{k}/body_a"], at[f"contact/{k}/body_b"]) for k in range(24)]
        for row in rows:
            for a, b in slots:
                if row[a] == row[a]:
                    self.pairs.add(frozenset((int(row[a]), int(row[b]))))

    @staticmethod
    def _mean_push(rows, column):
        """Returns the largest compression of a strut, averaged over LOAD_S, because the impact at its end is an
        impulse."""
        width = round(LOAD_S * RATE_HZ)
        total = most = sum(-row[column] for row in rows[:width])
        for old, new in zip(rows, rows[width:]):
            total += old[column] - new[column]
            most = max(most, total)
        return most / width

    def touches(self):
        """Returns unwanted contacts. The payload is the model's first body."""
        words = []
        if frozenset((0, -1)) in self.pairs:
            words.append("payload and ground")
        if any(0 in pair and -1 not in pair for pair in self.pairs):
            words.append("payload and strut")
        if any(0 not in pair and -1 not in pair for pair in self.pairs):
            words.append("struts")
        return ", ".join(words) or "none"


def g(deceleration):
    return f"{deceleration:.0f} ({deceleration / GRAVITY:.1f} g)"


def landings_table(runs):
    rows = []
    for (way, speed), run in runs.items():
        rows.append([way, str(speed), g(run.most), f"{1000 * run.most_s:.0f}",
                     g(speed**2 / (2 * run.stroke_m)), g(speed**2 / run.stroke_m),
                     f"{100 * run.gap_m:.0f}", f"{100 * run.rebound_m:.0f}"])
    return table(["lands on", "impact speed [m/s]", "largest deceleration [m/s^2]", "time of the peak [ms]",
                  "smallest possible, v^2 / (2 s) [m/s^2]", "one spring, v^2 / s [m/s^2]",
                  "smallest height of the payload [cm]", "rebound height [cm]"], rows)


def gives_table(runs):
    rows = []
    for (way, speed), run in runs.items():
        rows.append([way, str(speed), f"{run.outer_n:.0f}", f"{run.inner_n:.0f}",
                     f"{run.outer_slack} of 24", f"{run.inner_slack} of 12", f"{run.push_n:.0f}",
                     f"{100 * run.push_n / euler_n():.0f}", run.touches()])
    return table(["lands on", "impact speed [m/s]", "largest tension, robot's cables [N]", "largest tension, payload cables [N]",
                  "robot's cables slack at some time", "payload cables slack at some time", "largest compression of a strut [N]",
                  "% of Euler's load", "contacts besides strut ends and ground"], rows)


def picture(runs):
    left, top, width, height, span_s, most = 70, 20, 640, 330, 0.25, 350
    shades = ("#2171b5", "#74b266", "#b2182b")

    def across(at_s):
        return left + width * at_s / span_s

    def up(value):
        return top + height * (1 - min(value, most) / most)

    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="860" height="410" viewBox="0 0 860 410" '
           'font-family="sans-serif" font-size="13">', '<rect width="860" height="410" fill="white"/>']
    for value in range(0, most + 1, 50):
        out.append(f'<path d="M{left} {up(value):.1f}h{width}" stroke="#ddd"/>'
                   f'<text x="{left - 8}" y="{up(value) + 4:.1f}" text-anchor="end">{value}</text>')
    for ms in range(0, 251, 50):
        out.append(f'<text x="{across(ms / 1000):.1f}" y="{top + height + 20}" text-anchor="middle">{ms}</text>')
    for i, (shade, speed) in enumerate(zip(shades, SPEEDS)):
        run = runs[next(iter(WAYS)), speed]
        points = " ".join(f"{across(j / RATE_HZ):.1f},{up(a):.1f}"
                          for j, a in enumerate(run.deceleration[:round(span_s * RATE_HZ)]) if j % 5 == 0)
        least = speed**2 / (2 * run.stroke_m)
        out.append(f'<polyline points="{points}" fill="none" stroke="{shade}" stroke-width="1.5"/>')
        out.append(f'<path d="M{left} {up(least):.1f}h{width}" stroke="{shade}" stroke-dasharray="5 5"/>')
        y = top + 10 + 20 * i
        out.append(f'<path d="M{left + width + 15} {y}h24" stroke="{shade}" stroke-width="2"/>'
                   f'<text x="{left + width + 45}" y="{y + 4}">{speed} m/s</text>')
    out.append(f'<text x="{left + width + 15}" y="{top + 82}">dashed: v^2 / 2s</text>')
    out.append(f'<text x="{left + width / 2}" y="{top + height + 44}" text-anchor="middle">time after first contact [ms]</text>')
    out.append(f'<text x="20" y="{top + height / 2}" text-anchor="middle" '
               f'transform="rotate(-90 20 {top + height / 2})">deceleration of the payload [m/s^2]</text>')
    return "\n".join(out + ["</svg>", ""])


def page(taut):
    started = time.monotonic()
    coarse = {(way, speed): variant(way, speed) for way in WAYS for speed in SPEEDS}
    fine = {key: variant(*key, step_s=FINE_S) for key in coarse}
    face = next(iter(WAYS))
    soft = {k: variant(face, SPEEDS[-1], stiffness=k) for k in SUSPENSIONS}
    results = taut.run([*coarse.values(), *fine.values(), *soft.values()])
    left_out = [name for name, result in results.items() if result.summary["contacts_left_out"]]
    if left_out:
        raise Problem(f"more contacts than the trace has slots: {', '.join(left_out)}")

    def read(variants, speed_of):
        return {key: Landing(taut.folder / v.name, speed_of(key)) for key, v in variants.items()}

    runs, finer = read(coarse, lambda key: key[1]), read(fine, lambda key: key[1])
    softer = read(soft, lambda key: SPEEDS[-1])
    keep_picture(taut, "docs/validation/landing.svg", picture(runs))

    def worst(form, unit=1.0):
        return f"{unit * max(abs(form(finer[key]) - form(run)) for key, run in runs.items()):.1f}"

    def worst_percent(form):
        return f"{100 * max(abs(form(finer[key]) / form(run) - 1) for key, run in runs.items()):.1f}"

    dead = SPEEDS[-1] * math.sqrt(2 * SUSPENSIONS[4] / PAYLOAD_KG)   # six of twelve cables taut: 2 k in every direction
    values = {
        "landings": landings_table(runs),
        "gives": gives_table(runs),
        "dead": g(dead),
        "suspensions": table(["stiffness [N/m]", "damping [N s/m]", "largest deceleration [m/s^2]",
                              "smallest height of the payload [cm]", "contacts besides strut ends and ground"],
                             [[str(k), f"{DAMPING_S * k:.4g}",
                               "payload hits the ground" if "payload" in run.touches() else g(run.most), f"{100 * run.gap_m:.0f}",
                               run.touches()] for k, run in softer.items()]),
        "stretch": f"{100 * max(run.outer_n for run in runs.values()) / STIFFNESS_N_PER_M:.0f}",
        "euler": f"{euler_n() / 1000:.1f}",
        "step_deceleration": worst_percent(lambda r: r.most),
        "step_outer": worst_percent(lambda r: r.outer_n),
        "step_inner": worst_percent(lambda r: r.inner_n),
        "step_gap": worst(lambda r: r.gap_m, 1000),
        "version": taut("--version").split()[-1],
        "runs": str(len(coarse) + len(fine) + len(soft)),
        "seconds": f"{time.monotonic() - started:.0f}",
        "machine": machine(),
    }
    return fill(TEMPLATE.read_text(), values)
