"""The quasi-static push of Mirletz et al. (2015), in comparison with NTRT and the robot."""

import csv
import gzip
import math
import os
import pathlib
import platform
import time

from validation.runs import Problem, Variant, fill, replaced, table, yaml_block

EXPERIMENT = "share/experiments/push_20n.yaml"
TRACE = "tests/data/ntrt/push_1000hz.csv.gz"
TEMPLATE = pathlib.Path(__file__).with_suffix(".md.in")
PHASES = {"before": (25, 30), "during": (35, 40), "after": (50, 60)}
START_S = 5.0  # end of the start-up transient; same limit as in summary.json
ROD_FRICTION = 0.15
LEFT, LEFT_T0_N, LEFT_K_N_PER_M = "outer_left_1", 11, 100  # as in EXPERIMENT

NTRT_LAWS = {"inertia": "bounding_box", "damping_law": "clamped", "friction_law": "along_slip",
             "friction_combine": "product", "restitution_combine": "product"}
OWN_LAWS = {"inertia": "exact", "damping_law": "exact", "friction_law": "cone",
            "friction_combine": "product", "restitution_combine": "product"}


def laws(base, **changes):
    """Returns control laws; a key replaces the base's key as a whole, so all options are given."""
    options = ", ".join(f"{key}: {value}" for key, value in {**base, **changes}.items())
    return f"model_options: {{{options}}}\n"


def ground(static, kinetic):
    """Returns ground friction for effective coefficients: the rods' 0.15 times the ground's."""
    return ("terrain: [{name: ground, plane: {height_m: 0, "
            f"static_friction: {static / ROD_FRICTION:.9g}, kinetic_friction: {kinetic / ROD_FRICTION:.9g}}}}}]\n")


def controller(text):
    return replaced(yaml_block(EXPERIMENT, "controllers"), "conversion: stiffness", text)


def pid(proportional, integral):
    return controller(f"conversion: pid\n      pid: {{proportional_m_per_s_n: {proportional}, "
                      f"integral_m_per_s2_n: {integral}}}")


def turned(yaw_deg, pitch_deg, holds):
    """Returns the push turned to the left and up, and optionally the forces that hold the robot."""
    yaw, pitch = math.radians(yaw_deg), math.radians(pitch_deg)
    way = [math.cos(pitch) * math.cos(yaw), math.cos(pitch) * math.sin(yaw), math.sin(pitch)]
    text = replaced(yaml_block(EXPERIMENT, "timeline"), "[1, 0, 0]", f"[{way[0]}, {way[1]}, {way[2]}]")
    return replaced(text, "[-1, 0, 0]", f"[{-way[0]}, {-way[1]}, {-way[2]}]") if holds else text


def staircase():
    """Returns the push as in NTRT's timeline: a new force every 0.05 s."""
    points, last = [], "0"
    for tick in range(20 * 30, 20 * 45 + 1):
        time_s = tick * 0.05
        force = f"{max(0.0, min(1.0, (time_s - 30) / 5, (45 - time_s) / 5)):.9g} * push_n"
        if points and force != last:
            points.append(f"[{time_s - 1e-6:.6f}, {last}]")
        points.append(f"[{time_s:.2f}, {force}]")
        last = force
    text = yaml_block(EXPERIMENT, "timeline")
    for share in ("", "0.45 * ", "0.55 * "):
        ramp = f"[[30, 0], [35, {share}push_n], [40, {share}push_n], [45, 0]]"
        scale = f", scale: {share[:4]}" if share else ""
        text = replaced(text, "force_n: " + ramp, f"force_n: [{', '.join(points)}]{scale}")
    return text


# Label of a row, and its run. The first of each list is the reference for the others.
LAWS_OFF = [
    ("all of NTRT's laws", Variant("ntrt", "push_20n_ntrt", full_trace=True)),
    ("friction: exact cone", Variant("ntrt_cone", "push_20n_ntrt", laws(NTRT_LAWS, friction_law="cone"))),
    ("friction: geometric mean, 0.27, instead of the product, 0.075",
     Variant("ntrt_geometric_mean", "push_20n_ntrt", laws(NTRT_LAWS, friction_combine="geometric_mean"))),
    ("restitution: larger of the two, 0.2, instead of the product, 0",
     Variant("ntrt_restitution", "push_20n_ntrt", laws(NTRT_LAWS, restitution_combine="maximum"))),
    ("inertia: true", Variant("ntrt_true_inertia", "push_20n_ntrt", laws(NTRT_LAWS, inertia="exact"))),
    ("damping: not clamped", Variant("ntrt_not_clamped", "push_20n_ntrt", laws(NTRT_LAWS, damping_law="exact"))),
    ("controller: exact rate", Variant("ntrt_exact_rate", "push_20n", laws(NTRT_LAWS))),
    ("B = 100 N s/m on the top cables",
     Variant("ntrt_b100", "push_20n_ntrt", parameters={"top_damping_n_s_per_m": 100})),
    ("push of 20 N", Variant("ntrt_20n", "push_20n_ntrt", parameters={"push_n": 20})),
]
LAWS_ON = [
    ("taut's own laws", Variant("own", "push_20n", full_trace=True)),
    ("friction: along the sliding velocity only",
     Variant("own_along_slip", "push_20n", laws(OWN_LAWS, friction_law="along_slip"))),
    ("inertia: of the bounding box",
     Variant("own_box_inertia", "push_20n", laws(OWN_LAWS, inertia="bounding_box"))),
    ("damping: clamped", Variant("own_clamped", "push_20n", laws(OWN_LAWS, damping_law="clamped"))),
    ("controller: difference of lengths, from the rest length",
     Variant("own_differenced", "push_20n_ntrt", laws(OWN_LAWS))),
    ("push: a staircase of 0.05 s", Variant("own_staircase", "push_20n", staircase())),
]
AS_IT_IS = LAWS_ON[0]
SLIDING = [(f"friction {mu:g}", Variant(f"friction_{mu:g}", "push_20n",
                                        parameters={"ground_friction": f"{mu} / {ROD_FRICTION}"}))
           for mu in (0, 0.025, 0.05, 0.1, 0.15, 0.2, 0.3, 0.5)]
STICKING = [(f"static friction {mu:g}", Variant(f"static_{mu:g}", "push_20n", ground(mu, 0.075)))
            for mu in (0.15, 0.3, 0.5, 1, 2)]
STICKING += [("static friction 2, start from equilibrium",
              Variant("static_2_settled", "push_20n", ground(2, 0.075) + "start: settled\n"))]
PUSHES = [(f"push of {force:g} N", Variant(f"push_{force:g}n", "push_20n", parameters={"push_n": force}))
          for force in (15, 17.5, 20, 25)]
WAYS = [("left", 5, 0), ("right", -5, 0), ("up", 0, 5), ("down", 0, -5)]
PUSHES += [(f"{'all three forces' if holds else 'push'} turned 5 degrees {way}",
            Variant(f"{'all' if holds else 'push'}_5deg_{way}", "push_20n", turned(yaw, pitch, holds)))
           for holds in (False, True) for way, yaw, pitch in WAYS]
OTHERS = [
    ("inertia of the bounding box", dict(LAWS_ON)["inertia: of the bounding box"]),
    ("start from equilibrium", Variant("settled", "push_20n", "start: settled\n")),
    ("B = 100 N s/m (Table I)", Variant("table1", "push_20n_table1")),
    ("controller: difference of lengths",
     Variant("differenced", "push_20n", controller("conversion: stiffness\n      rate: differenced"))),
    ("PID, P = 0.1 m/(s N)", Variant("pid", "push_20n", pid(0.1, 0))),
    ("PID, P = 0.01 m/(s N)", Variant("pid_slow", "push_20n", pid(0.01, 0))),
    ("PID, P = 0.1 m/(s N), I = 0.1 m/(s^2 N)", Variant("pid_integral", "push_20n", pid(0.1, 0.1))),
]
CHOICES = [AS_IT_IS, *SLIDING, *STICKING, *PUSHES, *OTHERS]


def read_csv(path, value):
    with open(path, newline="") as file:
        return {row["cable"]: float(row[value]) for row in csv.DictReader(file)}


class Ntrt:
    """NTRT's run."""

    def __init__(self):
        with gzip.open(TRACE, "rt", newline="") as file:
            self.rows = [{key: float(x) for key, x in row.items()} for row in csv.DictReader(file)]
        self.max_n = read_csv("tests/data/ntrt/push_maxima.csv", "elastic_n")
        self.system_max_n = max(self.max_n.values())

    def within(self, cable, from_s, to_s):
        return [row[cable + "_tension_N"] for row in self.rows
                if from_s - 1e-9 <= row["time_s"] <= to_s + 1e-9]

    def mean(self, cable, phase):
        values = self.within(cable, *PHASES[phase])
        return sum(values) / len(values)

    def max_after_start(self, cable):
        return max(self.within(cable, START_S, math.inf))

    def time_of_max_s(self, cable):
        return max(self.rows, key=lambda row: row[cable + "_tension_N"])["time_s"]


def plain(cable):
    return cable.replace("_", " ")


def percent(value, digits=1):
    return f"{value:+.{digits}f} %"


def worst_mean(result, reference, full_n):
    """Returns the largest difference of a mean elastic tension, in % of the largest tension, and its cable."""
    return max((100 * abs(result.mean(cable, phase) - reference.mean(cable, phase)) / full_n, cable, phase)
               for cable in result.cables for phase in PHASES)


def means_table(ntrt, results):
    head = ["cable"] + [f"{phase}: {who}" for phase in PHASES
                        for who in ("NTRT", "NTRT's laws", "cone", "taut's own laws")]
    rows = []
    for cable in results["ntrt"].cables:
        row = [plain(cable)]
        for phase in PHASES:
            row += [f"{x.mean(cable, phase):.3f}" for x in
                    (ntrt, results["ntrt"], results["ntrt_cone"], results["own"])]
        rows.append(row)
    return table(head, rows)


def system_table(ntrt, results):
    rows = [["NTRT", f"{ntrt.system_max_n:.3f}", "", ""]]
    for text, name in (("NTRT's laws", "ntrt"), ("NTRT's laws, exact cone", "ntrt_cone"), ("taut's own laws", "own")):
        largest = results[name].summary["system_max_elastic_n"]
        rows.append([text, f"{largest:.3f}", percent(100 * (largest / ntrt.system_max_n - 1), 2),
                     f"{worst_mean(results[name], ntrt, ntrt.system_max_n)[0]:.2f} %"])
    return table(["run", "largest `elastic` [N]", "difference from NTRT", "largest difference of a mean from NTRT"], rows)


def laws_table(ntrt, results, variants):
    base, rows = results[variants[0][1].name], []
    for text, variant in variants:
        result = results[variant.name]
        worst, cable, phase = worst_mean(result, ntrt, ntrt.system_max_n)
        change = worst_mean(result, base, ntrt.system_max_n)[0]
        largest = result.summary["system_max_elastic_n"]
        rows.append([text, "" if result is base else f"{change:.2f} %", f"{worst:.2f} %",
                     f"{plain(cable)}, {phase}", f"{largest:.3f}",
                     percent(100 * (largest / ntrt.system_max_n - 1), 2)])
    return table(["run", "largest change of a mean", "largest difference of a mean from NTRT", "where",
                  "largest `elastic` [N]", "difference from NTRT"], rows)


def moved_table(ntrt, folder):
    """Formats the displacements of the segments from the first to the last row."""
    def ends(name):
        with open(folder / name / "trace.csv", newline="") as file:
            reader = csv.DictReader(file)
            first = last = next(reader)
            for last in reader:
                pass
        return {key: float(last[key]) - float(first[key]) for key in first}

    first, last = ntrt.rows[0], ntrt.rows[-1]
    its, own, rows = ends("ntrt"), ends("own"), []
    for segment in ("segment_0", "segment_1", "segment_2"):
        cells = [100 * (last[f"{segment}_{axis}_m"] - first[f"{segment}_{axis}_m"]) for axis in "zx"]
        cells += [100 * moved[f"body/{segment}/position_{axis}_m"] for moved in (its, own) for axis in "xy"]
        rows.append([plain(segment), *(f"{cell:+.1f}" for cell in cells)])
    return table(["segment", "NTRT: forward", "NTRT: left", "taut, NTRT's laws: forward", "taut, NTRT's laws: left",
                  "taut, own laws: forward", "taut, own laws: left"], rows)


def maxima_table(robot, ntrt, result, after_start):
    rows = []
    for cable, measured in robot.items():
        cells = [ntrt.max_after_start(cable) if after_start else ntrt.max_n[cable],
                 result.max(cable, "tension", after_start), result.max(cable, "elastic", after_start)]
        rows.append([plain(cable), f"{measured:.3f}", *(
            text for cell in cells for text in (f"{cell:.3f}", percent(100 * (cell / measured - 1))))])
    return table(["cable", "robot [N]", "NTRT `elastic` [N]", "error", "taut `tension` [N]", "error",
                  "taut `elastic` [N]", "error"], rows)


def errors(robot, result, after_start):
    return {cable: 100 * (result.max(cable, "tension", after_start) / measured - 1)
            for cable, measured in robot.items()}


def choices_table(robot, results, after_start):
    rows = []
    for text, variant in CHOICES:
        off = errors(robot, results[variant.name], after_start)
        rows.append([text, *(f"{value:+.1f}" for value in off.values()),
                     f"{sum(map(abs, off.values())) / len(off):.1f}"])
    return table(["error [%]", *map(plain, robot), "mean magnitude"], rows)


def stretch_mm(tension_n):
    """Returns l - L0 of the cable outer left 1 at rest with this tension [mm]."""
    return 1000 * (tension_n - LEFT_T0_N) / LEFT_K_N_PER_M


def outer_left_text(robot, results):
    """Describes the effect of the choices on the worst cable."""
    off = {text: errors(robot, results[variant.name], True)[LEFT] for text, variant in CHOICES}
    near = {text: value for text, value in off.items() if round(abs(value), 1) < 30}
    far = [abs(value) for text, value in off.items() if text not in near]
    text = (f"From 5 s on, the magnitude of the error of outer left 1 is {min(far):.1f} to {max(far):.1f} % in "
            f"{len(far)} of the {len(off)} runs. ")
    listed = "; ".join(f"{name} ({value:+.1f} %)" for name, value in near.items())
    return text + (f"It is below 30 % in: {listed}." if near else "")


def largest_shift(robot, results, choices):
    """Returns the largest change of a cable's error by one of these choices, in percentage points."""
    own = errors(robot, results[AS_IT_IS[1].name], True)
    return max(abs(value - own[cable]) for _, variant in choices
               for cable, value in errors(robot, results[variant.name], True).items())


def comparison(taut):
    arguments = ["runs/validation/push/ntrt/trace.h5", TRACE, "--map", "mappings/ntrt.json",
                 "--channels", "cable/*/elastic_n", "--tables"]
    shown = "taut compare " + " ".join(f"'{x}'" if "*" in x else x for x in arguments)
    text = taut("compare", *arguments)
    tables = text[text.index("\na: ") + 1:text.rindex("\nnext: ")].rstrip()
    return f"$ {shown}\n{tables}"


def machine():
    name = platform.machine()
    info = pathlib.Path("/proc/cpuinfo")
    for line in info.read_text().splitlines() if info.exists() else []:
        if line.startswith("model name"):
            name = line.split(":", 1)[1].strip()
            break
    return f"{name}, {os.cpu_count()} cores"


def page(taut):
    started = time.monotonic()
    ntrt = Ntrt()
    robot = read_csv("tests/data/hardware/tetraspine3_push_maxima.csv", "tension_n")
    variants = {variant.name: variant for _, variant in LAWS_OFF + LAWS_ON + CHOICES}
    results = taut.run(variants.values())
    for result in results.values():
        if set(PHASES.items()) != {(p["name"], (p["from_s"], p["to_s"])) for p in result.summary["phases"]}:
            raise Problem(f"{result.variant.name}: the phases are not those of NTRT's figures")
    its_laws = results["ntrt"]
    worst, cable, phase = worst_mean(its_laws, ntrt, ntrt.system_max_n)
    values = {
        "means": means_table(ntrt, results),
        "system": system_table(ntrt, results),
        "worst_its": f"{worst:.2f}",
        "worst_where": f"{plain(cable)}, {phase}",
        "ntrt_max": f"{ntrt.system_max_n:.3f}",
        "laws_off": laws_table(ntrt, results, LAWS_OFF),
        "laws_on": laws_table(ntrt, results, LAWS_ON),
        "moved": moved_table(ntrt, taut.folder),
        "comparison": comparison(taut),
        "maxima": maxima_table(robot, ntrt, results["own"], False),
        "maxima_after": maxima_table(robot, ntrt, results["own"], True),
        "peak_times": ", ".join(f"{plain(c)} {ntrt.time_of_max_s(c):.2f} s" for c in robot),
        "outer_left": outer_left_text(robot, results),
        "left_t0": f"{LEFT_T0_N:g}",
        "left_k": f"{LEFT_K_N_PER_M:g}",
        "left_robot": f"{robot[LEFT]:.1f}",
        "left_robot_mm": f"{stretch_mm(robot[LEFT]):+.0f}",
        "left_taut_mm": f"{stretch_mm(results['own'].mean(LEFT, 'during')):+.0f}",
        **{f"{name}_shift": f"{largest_shift(robot, results, choices):.1f}" for name, choices in
           (("sliding", SLIDING), ("sticking", STICKING), ("push", PUSHES), ("other", OTHERS))},
        "choices_after": choices_table(robot, results, True),
        "choices": choices_table(robot, results, False),
        "version": its_laws.summary["taut_version"],
        "runs": str(len(variants)),
        "seconds": f"{time.monotonic() - started:.0f}",
        "machine": machine(),
    }
    return fill(TEMPLATE.read_text(), values)
