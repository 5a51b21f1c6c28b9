"""Static and kinetic friction from a spring scale that drags the robot, on three kinds of ground."""

import math
import pathlib
import time

from validation import blind, fits
from validation.push import machine
from validation.runs import fill, table

TEMPLATE = pathlib.Path(__file__).with_suffix(".md.in")
GROUNDS = {"smooth": (0.32, 0.03), "medium": (0.5, 0.05), "rough": (0.8, 0.08)}   # ground, kinetic coefficient: mean, sd
EXTRA = (0.25, 0.08)                   # excess of the static coefficient, relative: mean, sd
MASS_SD, ZERO_SD_N, NOISE_N = 0.001, 0.03, 0.05    # relative error of the robot's mass; errors of the spring scale
DRAGS = {"first": 0.05, "second": 0.05, "slow": 0.01}   # intended speeds of the hand [m/s]
SPEED_SD = 0.06                        # relative deviation of each drag from its intended speed
BEGIN_S, END_S, RATE_HZ = 3.0, 13.0, 20
SCALE = "drag/scale/force_n"
ROD_FRICTION, MASS_KG, G = 0.15, 2.349, 9.81


def experiment(folder):
    """Writes share/experiments/drag.yaml with static friction, for a weighed robot."""
    (folder / "drag.yaml").write_text(f"""taut: 1
kind: experiment
base: {fits.beside(folder, "share/experiments/drag.yaml")}
name: drag
parameters: {{ground_sliding: 0.5, extra: 0.1, mass: 1}}
terrain:
  - {{name: ground, plane: {{height_m: 0, static_friction: ground_sliding * (1 + extra), kinetic_friction: ground_sliding}}}}
scale: [{{mass: mass}}]
duration_s: {END_S}
timeline:
  phases: {{sliding: [{END_S - 4}, {END_S}]}}
  events:
    - drag: {{name: scale, node: segment_0.tip, velocity_m_per_s: [velocity_m_per_s, 0, 0], stiffness_n_per_m: 100,
             damping_n_s_per_m: 5, from_s: {BEGIN_S}, to_s: {END_S}}}
record: {{rate_hz: 200}}
""")


class Ground:
    """A ground unknown to the fit, on which the robot is dragged three times."""

    def __init__(self, taut, name, drags=tuple(DRAGS)):
        top = taut.folder.resolve()
        self.taut, self.name, self.folder, self.drags = taut, name, top / name, drags
        self.folder.mkdir(parents=True, exist_ok=True)
        experiment(top)
        robot = blind.drawn(f"drag {name}", {"ground_sliding": GROUNDS[name], "extra": EXTRA, "mass": (1, MASS_SD)})
        self.truth = {key: robot[key] for key in ("ground_sliding", "extra")}
        for drag in drags:
            hand = blind.drawn(f"hand {name} {drag}", {"velocity_m_per_s": (DRAGS[drag], SPEED_SD * DRAGS[drag]),
                                                       "zero": (0, ZERO_SD_N)})
            run = self.folder / f"truth_{drag}"
            changes = {**robot, "velocity_m_per_s": hand["velocity_m_per_s"]}
            taut("run", top / "drag.yaml", *(x for k, v in changes.items() for x in ("--set", f"{k}={v!r}")), "--step_s",
                 "0.0005", "--csv", "--quiet", "--out", run)
            trace = blind.Trace(run / "trace.csv")
            fits.write_rows(self.folder / f"{drag}.csv", *blind.measured(
                trace, {SCALE: (1, hand["zero"], NOISE_N)}, f"scale {name} {drag}", RATE_HZ, END_S))
            self.truth[f"offset {SCALE} {drag}"] = hand["zero"]
            self.truth[f"velocity_m_per_s {drag}"] = hand["velocity_m_per_s"]

    def text(self):
        entries = "".join(f"  - {{name: {d}, experiment: ../../drag.yaml, data: ../{d}.csv, "
                          f"set: {{velocity_m_per_s: {DRAGS[d]}}}}}\n" for d in self.drags)
        speeds = "".join(f"  - {{parameter: velocity_m_per_s, experiments: [{d}], each: experiment, low: {0.5 * DRAGS[d]}, "
                         f"high: {2 * DRAGS[d]}, scale: {SPEED_SD * DRAGS[d]}}}\n" for d in self.drags)
        return f"""experiments:
{entries}estimate:
  - {{parameter: ground_sliding, low: 0.05, high: 2, scale: 0.05}}
  - {{parameter: extra, low: 0, high: 0.8}}
{speeds}  - {{channel: {SCALE}, offset: {{scale: {ZERO_SD_N}}}, each: experiment}}
residuals:
  - {{channel: {SCALE}, sd: {NOISE_N}, statistic: rows, window: {{from_s: 0, to_s: {END_S}}}}}
"""

    def fit(self):
        return fits.run(self.taut, f"{self.name}/fit", self.text())

    def naive(self):
        """Returns coefficients by a simple evaluation, scale force over weight and the rods' coefficient: mean while
        sliding, maximum before."""
        trace = blind.Trace(self.folder / f"{self.drags[0]}.csv")
        over = MASS_KG * G * ROD_FRICTION
        return trace.mean(SCALE, END_S - 4, END_S) / over, max(trace.of[SCALE]) / over


def at_rest(fit):
    """Returns the static coefficient, sliding * (1 + extra), and its standard error from the errors of both."""
    names = list(fit.parameters)
    sliding, extra = (fit.parameters[n] for n in ("ground_sliding", "extra"))
    together = fit.summary["correlation"][names.index("ground_sliding") * len(names) + names.index("extra")]
    a, b = (1 + extra["value"]) * sliding["se"], sliding["value"] * extra["se"]
    return sliding["value"] * (1 + extra["value"]), math.sqrt(a * a + b * b + 2 * a * b * together)


def page(taut):
    started = time.monotonic()
    grounds = [Ground(taut, name) for name in GROUNDS]
    rows, hands, offs = [], [], []
    for ground in grounds:
        fit = ground.fit()
        p, truth = fit.parameters, ground.truth
        offs += [blind.off(p[name], truth[name]) for name in p]
        sliding, (rest, rest_se) = p["ground_sliding"], at_rest(fit)
        naive_sliding, naive_rest = ground.naive()
        verdict = "; ".join(fit.judgements()) or "good"
        rows.append([ground.name, "kinetic", f"{naive_sliding:.3f}", *blind.digits(sliding["value"], blind.error_of(sliding)),
                     verdict, blind.digits(truth["ground_sliding"], blind.error_of(sliding))[0]])
        rows.append(["", "static", f"{naive_rest:.3f}", *blind.digits(rest, rest_se), "",
                     blind.digits(truth["ground_sliding"] * (1 + truth["extra"]), rest_se)[0]])
        for drag in ground.drags:
            speed, zero = p[f"velocity_m_per_s {drag}"], p[f"offset {SCALE} {drag}"]
            hands.append([ground.name, drag, *blind.digits(1e3 * speed["value"], 1e3 * blind.error_of(speed)),
                          f"{1e3 * truth[speed['name']]:.2f}", *blind.digits(zero["value"], blind.error_of(zero)),
                          f"{truth[zero['name']]:.4f}"])
    return fill(TEMPLATE.read_text(), {
        "version": taut("--version").split()[-1], "seconds": f"{time.monotonic() - started:.0f}", "machine": machine(),
        "noise": f"{NOISE_N:g}", "rate": str(RATE_HZ), "begin": f"{BEGIN_S:g}",
        "fast": f"{100 * DRAGS['first']:g}", "slow": f"{100 * DRAGS['slow']:g}",
        "grounds": table(["ground", "coefficient", "scale over weight", "estimate", "standard error", "verdict on the fit", "true value"],
                         rows),
        "hands": table(["ground", "drag", "speed of the hand [mm/s]", "standard error", "true value", "zero offset of the scale [N]",
                        "standard error", "true value"], hands),
        "within": str(sum(abs(x) <= 2 for x in offs)), "numbers": str(len(offs)),
    })
