"""Parameters of springs, load cells and motors from logs of the virtual robot: twelve motors that lift weights."""

import math
import os
import pathlib
import subprocess
import time

from validation import blind, fits
from validation.push import machine
from validation.runs import Problem, fill, table

TEMPLATE = pathlib.Path(__file__).with_suffix(".md.in")
MOTORS = 12
LENGTH_M, LIFT_M = 0.9, 0.05           # cable length from weight to motor; height of the lift
DUTIES = {"half": 0.5, "most": 0.8, "held_out": 0.65}   # limits of the duty, one log each
BEGIN_S, CYCLE_S = 0.3, 0.01
FILTER_S = 0.004                       # delay of a tension: a low pass at 1 kHz with factor 0.2
G, VOLT, OHM, TORQUE_CONSTANT, M_PER_RAD = 9.81, 12, 20.25, 0.0115, 0.00517 / 76   # values from data sheets; gear 76:1
NOMINAL = {"stiffness_n_per_m": 229.16, "friction_n_m": 8e-5, "efficiency": 0.66, "slack_m": 0.02}
# True parameters of a motor's station, in contrast to these: nominal, deviation (sd).
STATION = {"stiffness_n_per_m": (229.16, 15), "friction_n_m": (8e-5, 2e-5), "efficiency": (0.66, 0.05),
           "slack_m": (0.02, 0.002)}
CELL = {"gain": (1, 0.04), "counts_at_zero": (31.5, 1.5)}
N_PER_COUNT, COUNTS_AT_ZERO = 0.1567, 4.9363 / 0.1567
TENSION_SD_N, DUTY_SD = 0.06, 0.002


def weight_kg(motor):
    return 1.0 + 0.1 * motor           # weighed mass [kg], the reference of all forces


def model(motors, numbers):
    """Writes a stand: each motor hangs above a weight on the floor. `numbers`: motor -> values of STATION."""
    parameters, nodes, pairs, builders = [], [], [], []
    for m in motors:
        parameters += [f"  {name}_{m}: {value!r}\n" for name, value in numbers[m].items()]
        nodes += [f"  motor_{m}: [{0.3 * m:g}, 0, {LENGTH_M + 0.05:g}]\n", f"  weight_{m}: [{0.3 * m:g}, 0, 0.05]\n"]
        pairs.append(f"  - {{name: cable_{m}, nodes: [motor_{m}, weight_{m}]}}\n")
        builders.append(f"""  - {{match: motor_{m}, anchor: {{}}}}
  - {{match: weight_{m}, box: {{size_m: [0.1, 0.1, 0.1], mass_kg: mass_factor * {weight_kg(m):g}}}}}
  - match: cable_{m}
    cable:
      stiffness_n_per_m: stiffness_n_per_m_{m}
      damping_n_s_per_m: 20
      rest_length_m: {LENGTH_M} + slack_m_{m}
      actuator:
        dc_motor:
          gear_efficiency: efficiency_{m}
          friction_torque_n_m: friction_n_m_{m}
          static_friction_torque_n_m: static_ratio * friction_n_m_{m}
          viscous_friction_n_m_s_per_rad: viscous_n_m_s_per_rad
          torque_constant_n_m_per_a: 0.0115 * torque_factor
          supply_voltage_v: 12
          servo_gain_per_m: servo_gain_per_m
          servo_damping_s_per_m: 60
""")
    return ("taut: 1\nkind: model\nname: motor_stand\ndescription: Motors that lift weights.\n"
            "allow_disconnected: true\nparameters:\n  mass_factor: 1\n  static_ratio: 1.5\n  torque_factor: 1\n"
            "  viscous_n_m_s_per_rad: 0\n  servo_gain_per_m: 20000\n" +
            "".join(parameters) + "nodes:\n" + "".join(nodes) + "pairs:\n" + "".join(pairs) + "builders:\n" +
            "".join(builders))


class Course:
    """A motor's winding in and back out at a limited duty, computed from the known parameters. The boards receive the
    far
    end as the target at once, so that they hold the duty at its limit all the way: then the duty that they report every
    10 ms is accurate. With a slow program the duty drops between broadcasts, and the reported value is always the first
    of each interval."""

    def __init__(self, motor, duty):
        load_n = weight_kg(motor) * G
        self.duty = duty
        self.tight_m = NOMINAL["slack_m"]
        self.lifted_m = self.tight_m + load_n / NOMINAL["stiffness_n_per_m"]
        self.way_m = self.lifted_m + LIFT_M
        load_a = load_n * M_PER_RAD / NOMINAL["efficiency"] / TORQUE_CONSTANT
        slowest_m_per_s = (VOLT * duty - OHM * load_a) / TORQUE_CONSTANT * M_PER_RAD
        self.down_s = BEGIN_S + 0.5 + self.way_m / (0.6 * slowest_m_per_s)
        self.end_s = self.down_s + 0.5 + self.way_m / (0.6 * VOLT * duty / TORQUE_CONSTANT * M_PER_RAD)

    def points(self):
        return [[BEGIN_S, 0], [BEGIN_S + 0.05, -self.way_m], [self.down_s, -self.way_m], [self.down_s + 0.05, 0]]

    def steady(self, way):
        """Returns the spans in which the motor turns at the limit: slack, half tightened and lifting, in both
        directions.
        `way`: times and wound lengths."""
        spans = [(0.25 * self.tight_m, 0.8 * self.tight_m),
                 *((self.tight_m + a * (self.lifted_m - self.tight_m), self.tight_m + b * (self.lifted_m - self.tight_m))
                   for a, b in ((0.2, 0.5), (0.5, 0.8))),
                 (self.lifted_m + 0.35 * LIFT_M, self.lifted_m + 0.85 * LIFT_M)]
        up = [(t, x) for t, x in way if BEGIN_S <= t < self.down_s]
        down = [(t, -x) for t, x in way if self.down_s <= t]

        def passes(leg, x):
            return next(t for t, here in leg if here >= x)
        return [(passes(up, a), passes(up, b)) for a, b in spans] + [(passes(down, -b), passes(down, -a)) for a, b in spans]


def experiment(path, motors, programs, duration_s):
    """Writes the experiment. `programs`: motor -> points of its rest length's change."""
    lines = "".join(f"        - {{cables: cable_{m}, change_m: {programs[m]}}}\n" for m in motors)
    path.write_text("taut: 1\nkind: experiment\nname: stand\nmodel: model.yaml\n"
                    "terrain: [{name: ground, plane: {height_m: 0}}]\n"
                    f"duration_s: {duration_s:.3f}\ncontrollers:\n  - name: winding\n    period_s: 0.001\n    position:\n"
                    f"      programs:\n{lines}record: {{rate_hz: 1000}}\n")


class Robot:
    """The virtual robot on its stand: its hidden parameters, and its boards' logs."""

    def __init__(self, taut, motors, seed):
        self.taut, self.motors = taut, motors
        self.command = pathlib.Path(taut.command).parent / "taut_virtual_robot"
        if not os.access(self.command, os.X_OK):
            raise Problem(f"there is no {self.command}: it wants gcc-avr, avr-libc and libsimavr-dev")
        self.truth = {m: blind.drawn(f"motor {m} of stand {seed}", STATION) for m in motors}
        self.cells = {m: blind.drawn(f"load cell {m} of stand {seed}", CELL) for m in motors}
        self.folder = taut.folder.resolve() / f"stand_{seed}"

    def log(self, name):
        """Runs the robot; returns the data received by the PC."""
        folder = self.folder / f"truth_{name}"
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "model.yaml").write_text(model(self.motors, self.truth))
        courses = {m: Course(m, DUTIES[name]) for m in self.motors}
        experiment(folder / "stand.yaml", self.motors, {m: c.points() for m, c in courses.items()},
                   max(c.end_s for c in courses.values()) + 0.3)
        # The true cells are the board's default assumption; the board's calibration is wrong here.
        cells = "".join(f"  - {{cable: cable_{m}, measured: 2026-01-01, load_cell_n_per_count: "
                        f"{N_PER_COUNT * cell['gain']!r}, load_cell_counts_at_zero: {cell['counts_at_zero']!r}}}\n"
                        for m, cell in self.cells.items())
        (folder / "believed.yaml").write_text(f"taut: 1\nkind: calibration\nname: believed\ncables:\n{cells}")
        done = subprocess.run([self.command, "--experiment", folder / "stand.yaml", "--calibration",
                               folder / "believed.yaml", "--board", f"duty_limit={DUTIES[name]}", "--run", "--csv",
                               "--quiet", "--out", folder / "run"], capture_output=True, text=True)
        if done.returncode != 0:
            raise Problem(f"taut_virtual_robot {folder}: {done.stdout}{done.stderr}")
        return blind.Trace(folder / "run/host.csv")

    def offset_n(self, motor):
        """Returns the boards' tension reading of a cable without tension."""
        cell = self.cells[motor]
        return N_PER_COUNT * cell["gain"] * (COUNTS_AT_ZERO - cell["counts_at_zero"])


def unrounded(heard, motor, name):
    """Returns columns of tension and duty before rounding: transmitted values are truncated
    (docs/hardware/protocol.md),
    tensions to a quarter of a count, duties to 1/127. Adds half a step to tensions; replaces duties at the limit by
    the exact pulse width, in steps of 1/400."""
    cable = f"cable/cable_{motor}"
    limit = int(400 * DUTIES[name])
    told = limit * 127 // 400 / 127
    tension = [x + N_PER_COUNT / 8 for x in heard.of[f"{cable}/tension_n"]]
    duty = [math.copysign(limit / 400, x) if abs(abs(x) - told) < 1e-9 else x for x in heard.of[f"{cable}/duty"]]
    return tension, duty


def heard_at(heard, motor):
    """Returns rows and the times of their measurements: a status from before the last broadcast (`stale_frames`) is one
    cycle old. For a board that ticks just as broadcasts arrive this alternates, and 10 ms in 300 would be 3 % of its
    speed."""
    stale = heard.of[f"board/{motor // 2}/stale_frames"]
    rows, times = [], []
    for i in range(1, len(stale)):
        time_s = heard.time_s[i] - (CYCLE_S if stale[i] > stale[i - 1] else 0)
        if time_s >= 0 and (not times or time_s > times[-1] + 0.5 * CYCLE_S):
            rows.append(i)
            times.append(time_s)
    return rows, times


def data(folder, motor, name, heard):
    """Writes the experiment, wound according to the encoder, and the measurement of one motor. Returns the spans in
    which
    the motor turned steadily."""
    cable = f"cable/cable_{motor}"
    rows, times = heard_at(heard, motor)
    first_m = heard.of[f"{cable}/rest_length_m"][rows[0]]
    wound = [first_m - heard.of[f"{cable}/rest_length_m"][i] for i in rows]
    experiment(folder / f"{name}.yaml", [motor], {motor: [[round(t, 6), round(-x, 7)] for t, x in zip(times, wound)]},
               times[-1])
    channels = [f"{cable}/tension_n", f"{cable}/duty"]
    tension, duty = unrounded(heard, motor, name)
    gap = math.nan  # a row has either tension or duty, because tensions are delayed
    fits.write_rows(folder / f"{name}.csv", ["time_s", *channels],
                    [row for t, i in zip(times, rows) for row in ([t - FILTER_S, tension[i], gap], [t, gap, duty[i]])
                     if row[0] >= 0])
    return Course(motor, DUTIES[name]).steady(list(zip(times, wound)))


BOUNDS = {"stiffness_n_per_m": "low: 50, high: 1000, scale: 15", "friction_n_m": "low: 0, high: 5e-4, scale: 2e-5",
          "efficiency": "low: 0.3, high: 1, scale: 0.05", "slack_m": "low: 0, high: 0.04, scale: 0.002"}


def text(motor, steady, more=()):
    """Returns the fit of one motor. `steady`: log -> spans; `more`: additional estimates."""
    cable = f"cable/cable_{motor}"
    estimate = [f"{{parameter: {name}_{motor}, {bounds}}}" for name, bounds in BOUNDS.items()]
    estimate += [f"{{channel: {cable}/tension_n, gain: {{scale: 0.04}}}}",
                 f"{{channel: {cable}/tension_n, offset: {{scale: 0.2}}}}", *more]
    uses = {name: "test" if name == "held_out" else "train" for name in steady}
    experiments = "".join(f"  - {{name: {name}, experiment: ../{name}.yaml, data: ../{name}.csv, use: {use}}}\n"
                          for name, use in uses.items())
    residuals = []
    for name, spans in steady.items():
        # When a weight lands or leaves the floor, its cable's damper makes the tension jump: no derivative there.
        still = [(0.05, BEGIN_S - 0.02), (Course(motor, DUTIES[name]).down_s - 0.4, Course(motor, DUTIES[name]).down_s - 0.05)]
        residuals += [f"  - {{channel: {cable}/tension_n, sd: {TENSION_SD_N}, statistic: rows, experiments: [{name}], "
                      f"window: {{from_s: {a:.3f}, to_s: {b:.3f}}}}}\n" for a, b in [*spans, *still]]
        residuals += [f"  - {{channel: {cable}/duty, sd: {DUTY_SD}, experiments: [{name}], "
                      f"window: {{from_s: {a:.3f}, to_s: {b:.3f}}}}}\n" for a, b in spans]
    return ("experiments:\n" + experiments + "estimate:\n" + "".join(f"  - {e}\n" for e in estimate) + "residuals:\n" +
            "".join(residuals) + "groups: window\nsearch: {step: 0.2}\n")


MORE = {"the weight, assumed unknown": "{parameter: mass_factor, low: 0.3, high: 3, scale: 0.05}",
        "ratio of static to kinetic friction": "{parameter: static_ratio, low: 1, high: 5, scale: 0.2}",
        "viscous friction": "{parameter: viscous_n_m_s_per_rad, low: 0, high: 1e-6, start: 1e-8, scale: 3e-8}",
        "the torque constant": "{parameter: torque_factor, low: 0.8, high: 1.2, scale: 0.01}"}


class Stand:
    """Fits of all motors, from their logs alone."""

    def __init__(self, taut, motors=range(MOTORS), seed=1, duties=tuple(DUTIES)):
        self.taut, self.motors = taut, list(motors)
        self.robot = Robot(taut, self.motors, seed)
        heard = {name: self.robot.log(name) for name in duties}
        self.steady = {}
        for m in self.motors:
            folder = self.robot.folder / f"motor_{m}"
            folder.mkdir(parents=True, exist_ok=True)
            (folder / "model.yaml").write_text(model([m], {m: NOMINAL}))
            self.steady[m] = {name: data(folder, m, name, log) for name, log in heard.items()}

    def fit(self, motor, name="fit", more=()):
        return fits.run(self.taut, f"{self.robot.folder.name}/motor_{motor}/{name}",
                        text(motor, self.steady[motor], more))

    def truth(self, motor):
        """Returns the true values by the names of the estimates."""
        cable = f"cable/cable_{motor}/tension_n"
        return {**{f"{name}_{motor}": value for name, value in self.robot.truth[motor].items()},
                # The assumed calibration is true for the cell; the board's is wrong.
                f"gain {cable}": self.robot.cells[motor]["gain"], f"offset {cable}": self.robot.offset_n(motor)}


WHAT = {"stiffness_n_per_m": ("stiffness of cable and spring [N/m]", 1), "friction_n_m": ("friction of the motor [mN m]", 1e3),
        "efficiency": ("efficiency of the gear", 1), "slack_m": ("initial slack of the cable [mm]", 1e3),
        "gain": ("gain of the load cell", 1), "offset": ("zero offset of the load cell [N]", 1)}


def kind(name):
    return next(short for short in WHAT if name.startswith(short))


def motor_row(stand, motor, found):
    """Formats a motor's line: estimate and truth of each parameter."""
    truth, cells = stand.truth(motor), [f"{motor}", f"{weight_kg(motor):g}"]
    for name, p in found.parameters.items():
        scale, error = WHAT[kind(name)][1], blind.error_of(p)
        value, se = blind.digits(scale * p["value"], scale * error)
        cells.append(f"{value} +- {se} ({blind.digits(scale * truth[name], scale * error)[0]})")
    return cells


def page(taut):
    started = time.monotonic()
    stand = Stand(taut)
    found = {m: stand.fit(m) for m in stand.motors}
    offs, errors = {}, {}
    for m, fit in found.items():
        truth = stand.truth(m)
        for name, p in fit.parameters.items():
            offs.setdefault(kind(name), []).append(blind.off(p, truth[name]))
            errors.setdefault(kind(name), []).append((p["value"], truth[name]))
    rows = []
    for short, (what, scale) in WHAT.items():
        off, pairs = offs[short], errors[short]
        mean = sum(truth for _, truth in pairs) / len(pairs)
        rms = math.sqrt(sum((a - b) ** 2 for a, b in pairs) / len(pairs))
        start = {**NOMINAL, "gain": 1, "offset": 0}[short]
        before = math.sqrt(sum((start - b) ** 2 for _, b in pairs) / len(pairs))
        rows.append([what, f"{scale * before:.2g}", f"{scale * rms:.2g}",
                     "" if short == "offset" else f"{100 * rms / mean:.2g} %",
                     str(sum(abs(x) <= 2 for x in off)), f"{max(map(abs, off)):.1f}"])
    held = [[f"{m}", *(f"{fits.rms([p for p in fit.points() if p['channel'].endswith(end)], channel, key):.2g}"
                       for end, channel in (("tension_n", f"cable/cable_{m}/tension_n"), ("duty", f"cable/cable_{m}/duty"))
                       for key in ("untuned", "fitted")), "; ".join(fit.judgements()) or "good"]
            for m, fit in found.items()]
    more = []
    for what, estimate in MORE.items():
        name = estimate.split(":")[1].split(",")[0].strip()
        fit = stand.fit(0, name, [estimate])
        p = fit.parameters[name]
        blamed = ", ".join(sorted(WHAT[kind(n)][0].split(" [")[0] for n in p["confounded_with"] if n != name))
        lost = ", ".join(WHAT[kind(n)][0].split(" [")[0] for n, q in fit.parameters.items()
                         if n != name and q["verdict"] != "estimated")
        more.append([what, *blind.digits(p["value"], blind.error_of(p)), p["verdict"], blamed, lost or "none"])
    everything = [x for off in offs.values() for x in off]
    return fill(TEMPLATE.read_text(), {
        "version": taut("--version").split()[-1], "seconds": f"{time.monotonic() - started:.0f}", "machine": machine(),
        "motors": str(len(stand.motors)), "duties": ", ".join(f"{d:g}" for d in DUTIES.values()),
        "lift_cm": f"{100 * LIFT_M:g}", "heaviest_kg": f"{weight_kg(MOTORS - 1):g}",
        "table": table(["parameter", "rms error before the fit", "rms error after", "rms error after, relative",
                        f"within two standard errors, of {len(stand.motors)}", "largest error [standard errors]"], rows),
        "within": str(sum(abs(x) <= 2 for x in everything)), "numbers": str(len(everything)),
        "held": table(["motor", "tension: untuned [N]", "tension: fitted [N]", "duty: untuned", "duty: fitted", "verdict on the fit"], held),
        "more": table(["parameter", "estimate", "standard error", "verdict", "confounded with", "no longer estimated"], more),
        "all": table(["motor", "weight [kg]", *(what for what, _ in WHAT.values())],
                     [motor_row(stand, m, fit) for m, fit in found.items()]),
    })
