"""A six-strut robot that has learned to roll: on level ground, down a slope, out of craters."""

import csv
import math
import pathlib
import random
import statistics
import time

from validation.push import machine
from validation.runs import Variant, fill, keep_picture, table

TEMPLATE = pathlib.Path(__file__).with_suffix(".md.in")
STARTS = 12          # the first is the unchanged experiment
STEPS_S = (0.001, 0.0005, 0.00025)
RIMS_M = (0.1, 0.2, 0.3, 0.4, 0.6, 2)
RADIUS_M, UP_M, TOUCH_M = 0.04, 0.05, 0.002
INNER_M, OUTER_M = 1.5, 4.5   # from the middle of the crater to the faces of its walls
CHANNELS = ["system/com_*", "system/contact_count", "body/*/angular_velocity_*", "node/*.l/position_*",
            "node/*.r/position_*", "cable/*/tension_n", "cable/*/rest_length_m"]


def start(number):
    """Returns the changes of a start: keys and parameters."""
    if number == 0:
        return "", {}
    friction = random.Random(number).uniform(0.4, 0.6)
    return (f"seed: {number}\nstart_noise: {{position_m: 0.01, heading_rad: 0.1}}\n",
            {"ground_friction": f"{friction:.4f}"})


def variant(name, experiment, number, keys="", parameters=None, channels=CHANNELS):
    noise, friction = start(number)
    if "crater" in experiment:
        friction = {}
    record = "record: {rate_hz: 50, channels: ['" + "', '".join(channels) + "']}\n"
    return Variant(f"{name}_{number}", experiment, noise + keys + record, {**friction, **(parameters or {})},
                   full_trace=True, any_status=True)


class Run:
    """Displacement, revolutions and footfalls from a trace; along the slope, if there is one: `downhill` is its
    angle."""

    def __init__(self, folder, downhill=0.0):
        with open(folder / "trace.csv", newline="") as file:
            reader = csv.reader(file)
            head = next(reader)
            rows = [[float(x) for x in row] for row in reader]
        at = {name: i for i, name in enumerate(head)}
        com = [at[f"system/com_{k}_m"] for k in "xyz"]
        self.path = [(row[com[0]], row[com[1]], row[com[2]]) for row in rows]
        (x0, y0, _), (x1, y1, _) = self.path[0], self.path[-1]
        self.way_m, self.forward_m = math.hypot(x1 - x0, y1 - y0), x1 - x0
        self.length_m = sum(math.dist(a, b) for a, b in zip(self.path, self.path[1:]))
        self.height_m = statistics.mean(z for _, _, z in self.path)
        turning = [name for name in at if "/angular_velocity_" in name]
        if not turning:
            return
        self._turns(rows, at)
        self._feet(rows, at, downhill)
        pulls = [(i, at[name.replace("tension_n", "rest_length_m")])
                 for name, i in at.items() if name.endswith("/tension_n")]
        self.most_n = max(row[i] for row in rows for i, _ in pulls)
        self.power_w = sum(max(0.0, a[k] - b[k]) * a[i] for a, b in zip(rows, rows[1:]) for i, k in pulls) \
            / (rows[-1][0] - rows[0][0])

    def _turns(self, rows, at):
        """Integrates the robot's mean angular velocity (over its struts) about the horizontal axis across its momentary
        path, in turns: the rotation of a wheel that rolls along the path."""
        spin = [[at[f"body/{body}/angular_velocity_{k}_rad_per_s"] for body in "abcdef"] for k in "xy"]
        angle = 0.0
        for i in range(len(rows) - 1):
            a, b = self.path[max(0, i - 25)], self.path[min(len(rows) - 1, i + 25)]
            way = (b[0] - a[0], b[1] - a[1])
            length = math.hypot(*way)
            if length > 1e-6:
                wx, wy = (sum(rows[i][k] for k in column) / 6 for column in spin)
                angle += (-way[1] * wx + way[0] * wy) / length * (rows[i + 1][0] - rows[i][0])
        self.turns = angle / (2 * math.pi)

    def _feet(self, rows, at, downhill):
        """Returns how often a strut's end is set down after a lift, and the sliding distance of ends on the ground."""
        self.feet, self.slide_m = 0, 0.0
        ends = [[at[f"node/{body}.{end}/position_{k}_m"] for k in "xyz"] for body in "abcdef" for end in "lr"]
        slope, level = math.sin(downhill), math.cos(downhill)
        up = [False] * len(ends)
        before = {}
        for row in rows:
            now = {}
            for i, (x, y, z) in enumerate(ends):
                gap = row[x] * slope + row[z] * level - RADIUS_M
                if gap > UP_M:
                    up[i] = True
                elif gap < TOUCH_M:
                    self.feet += up[i]
                    up[i] = False
                    now[i] = (row[x], row[y], row[z])
            stayed = [math.dist(now[i], before[i]) for i in now if i in before]
            if stayed:
                self.slide_m += statistics.mean(stayed)
            before = now

    def first_s(self, beyond_m):
        """Returns the time at which the center of mass is first that far from the middle, along x or y."""
        for i, (x, y, _) in enumerate(self.path):
            if max(abs(x), abs(y)) > beyond_m:
                return i / 50
        return None


def span(values, digits=1):
    return f"{min(values):.{digits}f}, {statistics.median(values):.{digits}f}, {max(values):.{digits}f}"


def moving_row(text, runs, way):
    first = runs[0]
    return [text, f"{way(first):.1f}", span([way(r) for r in runs]), f"{first.length_m:.0f}", f"{first.turns:.1f}",
            span([r.turns for r in runs]), str(first.feet), f"{100 * first.slide_m / max(first.length_m, 1e-9):.0f}",
            f"{max(r.most_n for r in runs):.0f}", f"{first.power_w:.0f}"]


MOVING = ["", "distance, first start [m]", "distance: minimum, median, maximum [m]", "path [m]", "turns, first start",
          "turns: minimum, median, maximum", "touchdowns of strut ends", "sliding of strut ends [% of path]", "largest tension [N]",
          "winding power [W]"]


def out_row(rim_m, motors, runs):
    out = [at_s for at_s in (r.first_s(INNER_M) for r in runs) if at_s is not None]
    off = [at_s for at_s in (r.first_s(OUTER_M) for r in runs) if at_s is not None]
    return [f"{rim_m:g}", motors, f"{len(out)} of {len(runs)}",
            f"{min(out):.0f} to {max(out):.0f}" if out else "", f"{len(off)} of {len(runs)}",
            f"{max(max(z for _, _, z in r.path) for r in runs):.1f}"]


def picture(runs):
    """Draws the paths of the center of mass, seen from above."""
    points = [(x, y) for run in runs for x, y, _ in run.path]
    low, high = (min(min(p) for p in points), max(max(p) for p in points))
    low, high = 5 * math.floor(low / 5), 5 * math.ceil(high / 5)
    left, top, size = 60, 15, 520

    def place(x, y):
        return f"{left + size * (x - low) / (high - low):.1f},{top + size * (high - y) / (high - low):.1f}"

    out = ['<svg xmlns="http://www.w3.org/2000/svg" width="720" height="590" viewBox="0 0 720 590" '
           'font-family="sans-serif" font-size="13">', '<rect width="720" height="590" fill="white"/>']
    for m in range(low, high + 1, 5):
        x, y = place(m, low).split(",")[0], place(low, m).split(",")[1]
        out.append(f'<path d="M{x} {top}v{size}M{left} {y}h{size}" stroke="#e4e4e4"/>'
                   f'<text x="{x}" y="{top + size + 18}" text-anchor="middle">{m}</text>'
                   f'<text x="{left - 8}" y="{float(y) + 4:.1f}" text-anchor="end">{m}</text>')
    for i, run in reversed(list(enumerate(runs))):
        line = " ".join(place(x, y) for x, y, _ in run.path[::10])
        out.append(f'<polyline points="{line}" fill="none" stroke="{"#b2182b" if i == 0 else "#4aa3c7"}" '
                   f'stroke-width="{2 if i == 0 else 1}"/>')
    for i, (text, shade) in enumerate((("as it is", "#b2182b"), ("other starts", "#4aa3c7"))):
        out.append(f'<path d="M{left + size + 15} {top + 15 + 20 * i}h24" stroke="{shade}" stroke-width="2"/>'
                   f'<text x="{left + size + 45}" y="{top + 19 + 20 * i}">{text}</text>')
    out.append(f'<text x="{left + size / 2}" y="{top + size + 42}" text-anchor="middle">x, m</text>'
               f'<text x="12" y="{top + size / 2}" text-anchor="middle" '
               f'transform="rotate(-90 12 {top + size / 2})">y, m</text>')
    return "\n".join(out + ["</svg>", ""])


def page(taut):
    started = time.monotonic()
    groups, downhill = {}, {}

    def add(name, experiment, count=STARTS, **more):
        groups[name] = [variant(name, experiment, number, **more) for number in range(count)]

    add("level", "roll_six_strut")
    for i, step_s in enumerate(STEPS_S):
        add(f"step_{i}", "roll_six_strut", count=1, keys=f"step_s: {step_s}\n")
    add("slope", "roll_six_strut_slope")
    add("slope_level_gait", "roll_six_strut", parameters={"slope_rad": "pi / 15"})
    add("slope_still", "roll_six_strut_slope", count=1, keys="controllers: []\n")
    for name in ("slope", "slope_level_gait", "slope_still"):
        downhill[name] = math.pi / 15
    com = ["system/com_*"]
    for rim_m in RIMS_M:
        add(f"rim_{1000 * rim_m:.0f}", "roll_six_strut_crater", parameters={"rim_m": rim_m}, channels=com)
    add("rim_ntrt", "roll_six_strut_crater_deep")
    taut.run([v for group in groups.values() for v in group])
    runs = {name: [Run(taut.folder / v.name, downhill.get(name, 0.0)) for v in group]
            for name, group in groups.items()}
    keep_picture(taut, "docs/validation/rolling.svg", picture(runs["level"]))

    def way(run):
        return run.way_m

    def forward(run):
        return run.forward_m

    level = runs["level"][0]
    values = {
        "level": table(MOVING, [moving_row("level ground", runs["level"], way)]),
        "slope": table(MOVING, [moving_row("gait learned on the slope", runs["slope"], forward),
                                moving_row("the gait for level ground", runs["slope_level_gait"], forward)]),
        "still": f"{1000 * runs['slope_still'][0].length_m:.1f}",
        "craters": table(["rim height [m]", "motors", "starts that leave the crater", "time [s]", "starts that come off the far side", "largest height of the center of mass [m]"],
                         [out_row(rim_m, "0.3 m/s, 500 N", runs[f"rim_{1000 * rim_m:.0f}"]) for rim_m in RIMS_M]
                         + [out_row(2, "NTRT's: 1000 m/s, 10 kN", runs["rim_ntrt"])]),
        "steps": ", ".join(f"{runs[f'step_{i}'][0].way_m:.1f} m at {1000 * step_s:g} ms"
                           for i, step_s in enumerate(STEPS_S)),
        "per_turn": f"{level.length_m / level.turns:.2f}",
        "height": f"{level.height_m:.2f}",
        "wheel": f"{2 * math.pi * level.height_m:.2f}",
        "hop_w": f"{runs['rim_ntrt'][0].power_w / 1000:.0f}",
        "starts": str(STARTS - 1),
        "version": taut("--version").split()[-1],
        "runs": str(sum(len(group) for group in groups.values())),
        "seconds": f"{time.monotonic() - started:.0f}",
        "machine": machine(),
    }
    return fill(TEMPLATE.read_text(), values)
