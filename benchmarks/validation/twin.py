"""Fits to simulated measurements of a robot with known parameters: accuracy, and detection of unidentifiable ones."""

import pathlib
import time

from validation import blind, fits
from validation.push import machine
from validation.runs import fill, table

TEMPLATE = pathlib.Path(__file__).with_suffix(".md.in")
SEEDS = 20
RATE_HZ, LASTS_S = 50, 4.0
WEIGHT_N = 8                           # placed on the robot while it is dragged
# True parameters of the robot of a seed, in contrast to the model: nominal, deviation (sd).
ROBOT = {"stiffness_n_per_m": (229.16, 12), "mass": (1, 0.05), "ground_friction": (0.5, 0.1)}
CELLS, CAMERA, DELAY = "gain cable/*/tension_n", "offset body/*/position_x_m", "delay"
SENSORS = {CELLS: (1, 0.03), CAMERA: (0, 0.004), DELAY: (0.05, 0.02)}
WHAT = {"stiffness_n_per_m": "stiffness of the springs [N/m]", "mass": "factor on all masses",
        "ground_friction": "friction of the ground", CELLS: "gain of the load cells",
        CAMERA: "camera position, x [m]", DELAY: "delay of the logger's clock [s]"}
ESTIMATE = ["{parameter: stiffness_n_per_m, low: 100, high: 500, scale: 12}",
            "{parameter: mass, low: 0.5, high: 2, scale: 0.05}",
            "{parameter: ground_friction, low: 0.05, high: 2, scale: 0.1}",
            '{channel: "cable/*/tension_n", gain: {scale: 0.03}}',
            '{channel: "body/*/position_x_m", offset: {scale: 0.004}}',
            "{clock: data, delay_s: {low: 0, high: 0.2, start: 0.05, scale: 0.02}}"]
DAMPING = "{parameter: damping_n_s_per_m, low: 1, high: 100, scale: 4}"
ALIAS = "{parameter: friction, low: 0.01, high: 1, scale: 0.03}"  # coefficient of the rods; only its product with the ground's has an effect
NOISE = {"tension_n": 0.2, "position_m": 0.001, "scale_n": 0.05}  # standard deviation of the noise of a row


def experiment(folder):
    """Writes the experiment: a hand drags the robot's tip by a spring scale while two cables are wound in and let out.
    From 2.2 s on a known weight lies on it: the increase of the force separates friction from mass."""
    (folder / "twin.yaml").write_text(f"""taut: 1
kind: experiment
name: twin
model: {fits.beside(folder, "share/models/tetraspine3.yaml")}
parameters: {{ground_friction: 0.5, mass: 1, weight_n: {WEIGHT_N}}}
terrain: [{{name: ground, plane: {{height_m: 0, friction: ground_friction}}}}]
scale: [{{mass: mass}}]
duration_s: {LASTS_S}
start: settled
controllers:
  - name: winding
    position:
      programs:
        - {{cables: inner_top_1, change_m: [[0.2, 0], [0.5, -0.03], [2.5, -0.03], [2.8, 0]]}}
        - {{cables: outer_left_2, change_m: [[0.4, 0], [0.8, -0.04], [3, -0.04], [3.4, 0]]}}
timeline:
  events:
    - drag: {{name: scale, node: segment_0.tip, velocity_m_per_s: [0.05, 0, 0], stiffness_n_per_m: 100,
             damping_n_s_per_m: 5, from_s: 0.5, to_s: {LASTS_S}}}
    - push: {{name: known_weight, node: segment_1.top, direction: [0, 0, -1], scale: weight_n,
             force_n: [[2.2, 0], [2.4, 1], [{LASTS_S}, 1]]}}
record: {{rate_hz: 200}}
""")


def measure(taut, folder, seed, name, weight_n):
    """Simulates the robot of a seed with half the step of the fits, and writes the readings of its sensors by a late
    logger. Returns the truth."""
    truth = blind.drawn(f"twin {seed}", {**ROBOT, **SENSORS})
    run = folder / f"truth_{name}"
    changes = [x for key in ROBOT for x in ("--set", f"{key}={truth[key]!r}")]
    changes += ["--set", f"weight_n={weight_n}"]
    taut("run", folder.parent / "twin.yaml", *changes, "--step_s", "0.0005", "--csv", "--quiet", "--out", run)
    trace = blind.Trace(run / "trace.csv")
    sensors = {}
    for channel in trace.of:
        if channel.startswith("cable/") and channel.endswith("/tension_n"):
            sensors[channel] = (truth[CELLS], 0, NOISE["tension_n"])
        elif channel.startswith("body/") and "/position_" in channel:
            sensors[channel] = (1, truth[CAMERA] if channel.endswith("_x_m") else 0, NOISE["position_m"])
    sensors["drag/scale/force_n"] = (1, 0, NOISE["scale_n"])
    fits.write_rows(folder / f"{name}.csv",
                    *blind.measured(trace, sensors, f"noise of twin {seed}", RATE_HZ, LASTS_S, truth[DELAY]))
    return truth


def text(estimate, name, weight_n):
    return (f"experiments: [{{name: twin, experiment: ../../twin.yaml, data: ../{name}.csv, "
            f"set: {{weight_n: {weight_n}}}}}]\nestimate:\n" +
            "".join(f"  - {e}\n" for e in estimate) + f"""residuals:
  - {{channel: "cable/*/tension_n", sd: {NOISE["tension_n"]}, statistic: rows, window: {{from_s: 0, to_s: 3.8}}}}
  - {{channel: "body/*/position_*_m", sd: {NOISE["position_m"]}, statistic: rows, window: {{from_s: 0, to_s: 3.8}}}}
  - {{channel: drag/scale/force_n, sd: {NOISE["scale_n"]}, statistic: rows, window: {{from_s: 0, to_s: 3.8}}}}
""")


class Twin:
    """True parameters of one seed, and fits to its data."""

    def __init__(self, taut, seed):
        top = taut.folder.resolve()
        self.taut, self.name = taut, f"seed_{seed}"
        folder = top / self.name
        folder.mkdir(parents=True, exist_ok=True)
        experiment(top)
        self.truth = measure(taut, folder, seed, "measured", WEIGHT_N)
        self._measure = lambda: measure(taut, folder, seed, "unweighted", 0)

    def fit(self, name="fit", more=()):
        return fits.run(self.taut, f"{self.name}/{name}", text([*ESTIMATE, *more], "measured", WEIGHT_N))

    def without_weight(self):
        """Fits the same robot without the known weight, with free dampers."""
        self._measure()
        return fits.run(self.taut, f"{self.name}/without_weight", text([*ESTIMATE, DAMPING], "unweighted", 0))

    def off(self, fit):
        """Returns errors in standard errors, by the names of the estimates."""
        return {name: blind.off(fit.parameters[name], truth) for name, truth in self.truth.items()}


def alias_is_named(fit):
    """Returns whether the fit reports that only the product of these two parameters is identifiable, with the ratio at
    which they compensate, and names no other parameter."""
    rods, ground = fit.parameters["friction"], fit.parameters["ground_friction"]
    others = [p for name, p in fit.parameters.items() if name not in ("friction", "ground_friction")]
    return (all(p["verdict"] == "confounded" and set(p["confounded_with"]) == {"friction", "ground_friction"} for p in (rods, ground))
            and all(p["verdict"] == "estimated" for p in others) and fit.summary["unidentifiable"])


def row(name, twins, found):
    offs = [twin.off(fit)[name] for twin, fit in zip(twins, found)]
    errors = [blind.error_of(fit.parameters[name]) for fit in found]
    return [WHAT[name], f"{ROBOT.get(name, SENSORS.get(name))[1]:g}", f"{sum(errors) / len(errors):.2g}",
            f"{sum(abs(x) <= 1 for x in offs)}", f"{sum(abs(x) <= 2 for x in offs)}", f"{sum(offs) / len(offs):+.2f}",
            f"{max(map(abs, offs)):.1f}"]


def page(taut):
    started = time.monotonic()
    twins = [Twin(taut, seed) for seed in range(SEEDS)]
    found = [twin.fit() for twin in twins]
    aliased = [twin.fit("alias", [ALIAS]) for twin in twins]
    light = [twin.without_weight() for twin in twins]
    offs = [x for twin, fit in zip(twins, found) for x in twin.off(fit).values()]
    lost = [fit for fit in light if fit.summary["unidentifiable"] or fit.summary["unreliable"]]
    shown, truth = found[0], twins[0].truth
    of_one = []
    for name in truth:
        p = shown.parameters[name]
        of_one.append([WHAT[name], f"{p['start']:g}", *blind.digits(p["value"], blind.error_of(p)), p["verdict"],
                       blind.digits(truth[name], blind.error_of(p))[0]])
    return fill(TEMPLATE.read_text(), {
        "version": taut("--version").split()[-1], "seconds": f"{time.monotonic() - started:.0f}", "machine": machine(),
        "seeds": str(SEEDS), "numbers": str(len(offs)), "rate": str(RATE_HZ), "lasts": f"{LASTS_S:g}",
        "tension_n": f"{NOISE['tension_n']:g}", "position_mm": f"{1e3 * NOISE['position_m']:g}",
        "scale_n": f"{NOISE['scale_n']:g}",
        "table": table(["parameter", "standard deviation over the robots", "mean standard error", f"within one standard error, of {SEEDS}",
                        f"within two standard errors, of {SEEDS}", "mean error [standard errors]",
                        "largest error [standard errors]"], [row(name, twins, found) for name in WHAT]),
        "within": f"{sum(abs(x) <= 2 for x in offs)}", "share": f"{100 * sum(abs(x) <= 2 for x in offs) / len(offs):.0f}",
        "good": f"{sum(not fit.judgements() for fit in found)}",
        "one": table(["parameter", "nominal", "estimate", "standard error", "verdict", "true value"], of_one),
        "named": f"{sum(map(alias_is_named, aliased))}",
        "sentence": aliased[0].parameters["ground_friction"]["sentence"],
        "lost": str(len(lost)), "weight_n": f"{WEIGHT_N:g}",
    })
