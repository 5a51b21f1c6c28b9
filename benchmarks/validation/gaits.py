"""The two motion experiments of Mirletz et al. (2015): hand-tuned sine waves and a learned gait."""

import csv
import gzip
import math
import os
import pathlib
import time

from validation import gaits_eyelets
from validation.push import OWN_LAWS, laws, machine, percent, plain
from validation.runs import ROOT, Variant, fill, replaced, table, yaml_block
from validation.waves import dominant, harmonics, line_at, off_sine, off_triangle

TEMPLATE = pathlib.Path(__file__).with_suffix(".md.in")
FROM_S, TO_S = 30.0, 60.0  # span in which both gaits are periodic
ROW_S = 0.04  # row interval of NTRT's traces in tests/data
TIMES_S = (5, 10, 20, 30, 40, 50, 60)
CABLES = [f"{side}_{role}_{joint}" for joint in (1, 2) for side in ("outer", "inner")
          for role in ("top", "left", "right")]
# NTRT's masses of the segments [kg], for the center of mass, read from the running model.
MASSES_KG = (0.713080883, 0.913080871, 0.723080874)


class Gait:
    """An experiment, its NTRT variant, and NTRT's results."""

    def __init__(self, key, title, trace, column, system_max_n):
        self.key, self.title, self.trace, self.column = key, title, trace, column
        self.system_max_n = system_max_n  # NTRT's largest tension, 100 Hz samples of 60 s


SINE = Gait("sine_hand_tuned", "Hand-tuned sine waves", "tests/data/ntrt/sine_hand_tuned_1000hz.csv.gz",
            "_velocity_input_m_s", 26.9256)
CPG = Gait("cpg_learned", "The learned gait", "tests/data/ntrt/cpg_learned_1000hz.csv.gz", "_cpg_m_s", 30.2723)

STEPS_S = (0.00025, 0.0005, 0.001, 0.002, 0.004)
STARTS = 6
APART_M = 1e-6
DISTANCE_S = 20.0
PARTED_M = 1e-3


class Ntrt:
    def __init__(self, gait):
        with gzip.open(ROOT / gait.trace, "rt", newline="") as file:
            self.rows = [{key: float(x) for key, x in row.items()} for row in csv.DictReader(file)]

    def tension(self, cable):
        return [row[cable + "_tension_N"] for row in self.rows if FROM_S - 1e-9 <= row["time_s"] < TO_S - 1e-9]

    def velocity(self, cable, column):
        return [row[cable + column] for row in self.rows]

    def com(self, time_s):
        row = self.rows[round(time_s / ROW_S)]
        return [sum(m * row[f"segment_{i}_{axis}_m"] for i, m in enumerate(MASSES_KG)) / sum(MASSES_KG)
                for axis in "zx"]

    def heading(self, time_s):
        row = self.rows[round(time_s / ROW_S)]
        return math.degrees(math.atan2(row["segment_0_x_m"] - row["segment_2_x_m"],
                                       row["segment_0_z_m"] - row["segment_2_z_m"]))


class Run:
    """trace.csv of a run, at the times of NTRT's rows."""

    def __init__(self, folder, result):
        self.largest_n = result.summary["system_max_elastic_n"] if result else math.nan
        with open(folder / "trace.csv", newline="") as file:
            rows = [{key: float(x) for key, x in row.items()} for row in csv.DictReader(file)]
        self.rows = [row for row in rows if abs(row["time_s"] / ROW_S - round(row["time_s"] / ROW_S)) < 1e-6]

    def tension(self, cable):
        return [row[f"cable/{cable}/elastic_n"] for row in self.rows
                if FROM_S - 1e-9 <= row["time_s"] < TO_S - 1e-9]

    def com(self, time_s):
        row = self.rows[round(time_s / ROW_S)]
        return [row[f"system/com_{axis}_m"] for axis in "xy"]

    def heading(self, time_s):
        row = self.rows[round(time_s / ROW_S)]
        away = [row[f"body/segment_0/position_{axis}_m"] - row[f"body/segment_2/position_{axis}_m"]
                for axis in "xy"]
        return math.degrees(math.atan2(away[1], away[0]))


class Path:
    """Center of mass of a run that recorded no other channels."""

    def __init__(self, folder):
        with open(folder / "trace.csv", newline="") as file:
            self.rows = [(float(row["time_s"]), float(row["system/com_x_m"]), float(row["system/com_y_m"]))
                         for row in csv.DictReader(file)]

    def distance_m(self, time_s):
        start, end = self.rows[0], min(self.rows, key=lambda row: abs(row[0] - time_s))
        return math.hypot(end[1] - start[1], end[2] - start[2])

    def parts_from_s(self, other):
        """Returns the time at which the two centers of mass are first more than PARTED_M apart; None if never."""
        for a, b in zip(self.rows, other.rows):
            if math.hypot(a[1] - b[1], a[2] - b[2]) > PARTED_M:
                return a[0]
        return None


def mean(values):
    return sum(values) / len(values)


def swing(values):
    return max(values) - min(values)


def degrees_apart(a_rad, b_rad):
    return (math.degrees(a_rad - b_rad) + 180) % 360 - 180


def cable_rows(gait, ntrt, its, own):
    """Returns the rows of the tables for each cable: NTRT, taut with NTRT's laws, taut with default laws."""
    for cable in CABLES:
        waves = [source.tension(cable) for source in (ntrt, its, own)]
        lines = [dominant(wave, ROW_S) for wave in waves]
        phases = [line_at(wave, ROW_S, lines[0][0])[1] for wave in waves]
        yield cable, waves, lines, [degrees_apart(phase, phases[0]) for phase in phases[1:]]


def means_table(rows):
    head = ["cable", "mean: NTRT [N]", "mean: NTRT's laws [N]", "mean: taut's own laws [N]", "p-p: NTRT [N]",
            "p-p: NTRT's laws [N]", "p-p: taut's own laws [N]"]
    return table(head, [[plain(cable), *(f"{mean(wave):.3f}" for wave in waves),
                         *(f"{swing(wave):.3f}" for wave in waves)] for cable, waves, _, _ in rows])


def lines_table(rows):
    head = ["cable", "frequency [Hz]: NTRT", "frequency [Hz]: NTRT's laws", "frequency [Hz]: taut's own laws",
            "amplitude [N]: NTRT", "amplitude [N]: NTRT's laws", "amplitude [N]: taut's own laws",
            "phase relative to NTRT [degrees]: NTRT's laws", "phase relative to NTRT [degrees]: taut's own laws"]
    return table(head, [[plain(cable), *(f"{line[0]:.3f}" for line in lines),
                         *(f"{line[1]:.3f}" for line in lines), *(f"{phase:+.1f}" for phase in phases)]
                        for cable, _, lines, phases in rows])


def shapes_table(rows, fundamental_hz):
    """Formats harmonics of the tension in % of the first, and the remainder after subtraction of a sine or a
    triangle."""
    head = ["cable", *(f"harmonic {n} [%]: {who}" for n in (2, 3, 5) for who in ("NTRT", "taut's own laws")),
            "deviation from a sine [%]: NTRT", "deviation from a sine [%]: taut's own laws",
            "deviation from a triangle [%]: NTRT", "deviation from a triangle [%]: taut's own laws"]
    out = []
    for cable, waves, _, _ in rows:
        spectra = [harmonics(waves[pick], ROW_S, fundamental_hz, 7) for pick in (0, 2)]
        cells = [f"{100 * abs(s[n - 1] / s[0]):.1f}" for n in (2, 3, 5) for s in spectra]
        cells += [f"{100 * f(s):.1f}" for f in (off_sine, off_triangle) for s in spectra]
        out.append([plain(cable), *cells])
    return table(head, out)


def paths_table(sources):
    head = ["time [s]"] + [f"{what}: {who}" for what in ("forward [cm]", "left [cm]", "rotation [degrees]")
                      for who in ("NTRT", "NTRT's laws", "taut's own laws")]
    out = []
    for time_s in TIMES_S:
        moved = [[100 * (end - start) for start, end in zip(source.com(0), source.com(time_s))]
                 for source in sources]
        turned = [source.heading(time_s) - source.heading(0) for source in sources]
        out.append([f"{time_s}", *(f"{m[0]:+.2f}" for m in moved), *(f"{m[1]:+.2f}" for m in moved),
                    *(f"{angle:+.1f}" for angle in turned)])
    return table(head, out)


def worst_mean(rows, pick, full_n):
    return max((100 * abs(mean(waves[pick]) - mean(waves[0])) / full_n, plain(cable))
               for cable, waves, _, _ in rows)


def system_table(gait, rows, runs):
    out = [["NTRT", f"{gait.system_max_n:.3f}", "", "", ""]]
    for pick, (who, run) in enumerate(zip(("NTRT's laws", "taut's own laws"), runs), start=1):
        worst, cable = worst_mean(rows, pick, gait.system_max_n)
        out.append([who, f"{run.largest_n:.3f}", percent(100 * (run.largest_n / gait.system_max_n - 1), 2),
                    f"{worst:.2f} %", cable])
    return table(["run", "largest tension [N]", "difference from NTRT", "largest difference of a mean from NTRT", "cable"], out)


def frequency_text(rows):
    """Formats the largest difference of the dominant frequencies from NTRT's, for cables with the same line."""
    worst, others = 0.0, []
    for cable, _, lines, _ in rows:
        for who, line in zip(("NTRT's laws", "taut's laws"), lines[1:]):
            off = abs(line[0] / lines[0][0] - 1)
            if off < 0.1:
                worst = max(worst, off)
            else:
                others.append(f"{plain(cable)} with {who} ({line[0]:.2f} instead of {lines[0][0]:.2f} Hz)")
    text = f"If taut and NTRT have the same strongest line, the frequencies agree within {100 * worst:.2f} %."
    return text + (f" Another line is strongest in: {'; '.join(others)}." if others else "")


# --- each law separately --------------------------------------------------------------------------


def beside(text):
    """Returns the text of an experiment's controllers for a file in runs/validation/gaits/x/."""
    return replaced(text, "../gaits/", os.path.relpath(ROOT / "share/gaits", ROOT / "runs/validation/gaits/x") + "/")


def changed_controllers(gait, old, new):
    return beside(replaced(yaml_block(f"share/experiments/{gait.key}.yaml", "controllers"), old, new))


def law_variants(gait):
    """Returns the changes and their runs; the first is the reference for the others."""
    changes = [
        ("taut's own laws", ""),
        ("gait at 1 kHz instead of 100 Hz", changed_controllers(gait, "period_s: 0.01}", "period_s: 0.001}")),
        ("impedance control at 100 Hz instead of 1 kHz",
         changed_controllers(gait, "    period_s: 0.001\n", "    period_s: 0.01\n")),
        ("controller: difference of lengths",
         changed_controllers(gait, "conversion: stiffness", "conversion: stiffness\n      rate: differenced")),
        ("friction: along the sliding velocity only", laws(OWN_LAWS, friction_law="along_slip")),
        ("inertia: of the bounding box", laws(OWN_LAWS, inertia="bounding_box")),
        ("damping: at most the elastic force", laws(OWN_LAWS, damping_law="clamped")),
    ]
    return [(text, Variant(f"{gait.key}_law_{i}" if i else gait.key, gait.key, keys, full_trace=True))
            for i, (text, keys) in enumerate(changes)]


def laws_table(gait, ntrt, runs):
    out = []
    for text, run in runs:
        worst = max(abs(mean(run.tension(cable)) - mean(ntrt.tension(cable))) for cable in CABLES)
        far = [100 * math.dist(run.com(0), run.com(time_s)) for time_s in (DISTANCE_S, TO_S)]
        out.append([text, f"{run.largest_n:.3f}", percent(100 * (run.largest_n / gait.system_max_n - 1), 2),
                    f"{100 * worst / gait.system_max_n:.2f} %", *(f"{cm:.2f}" for cm in far),
                    f"{run.heading(TO_S) - run.heading(0):+.1f}"])
    return table(["run", "largest tension [N]", "difference from NTRT", "largest difference of a mean from NTRT",
                  "distance in 20 s [cm]", "distance in 60 s [cm]", "rotation [degrees]"], out)


def saturation_table(run_of):
    """Formats the fraction of 30 to 60 s in which a motor winds at its limit of 0.07 m/s, from row to row."""
    out = []
    for side in ("inner", "outer"):
        cells = []
        for run in run_of:
            rows = [row for row in run.rows if FROM_S - 1e-9 <= row["time_s"] <= TO_S + 1e-9]
            at_limit = [abs(b[key] - a[key]) > 0.99 * 0.07 * ROW_S
                        for key in (f"cable/{cable}/rest_length_m" for cable in CABLES if cable.startswith(side))
                        for a, b in zip(rows, rows[1:])]
            cells.append(f"{100 * mean(at_limit):.0f} %")
        out.append([side, *cells])
    return table(["cables", SINE.title.lower(), CPG.title.lower()], out)


# --- distance and step ----------------------------------------------------------------------------


def controllers(gait, exact):
    """Returns the experiment's controllers on one clock that every step divides: the law at 250 Hz, the gait at
    50 Hz."""
    text = yaml_block(f"share/experiments/{gait.key}.yaml", "controllers")
    text = replaced(text, "    period_s: 0.001\n", "    period_s: 0.004\n")
    text = replaced(text, "period_s: 0.01}", "period_s: 0.02}")
    text = beside(text)
    return text if exact else replaced(text, "conversion: stiffness", "conversion: stiffness\n      rate: differenced")


def step_variant(gait, exact, step_s, start):
    name = f"{gait.key}_{'exact' if exact else 'differenced'}_{1 / step_s:.0f}hz_{start}"
    keys = (f"step_s: {step_s}\nduration_s: {DISTANCE_S if start else TO_S:g}\ntimeline: {{}}\n"
            f"place: {{at_m: [0, 0, {start * APART_M:g}]}}\n"
            "record: {rate_hz: 10, channels: [system/com_x_m, system/com_y_m]}\n")
    return Variant(name, gait.key, keys + controllers(gait, exact), full_trace=True)


STEP_RUNS = {(gait.key, exact, step_s, start): step_variant(gait, exact, step_s, start)
             for gait in (SINE, CPG) for exact in (True, False) for step_s in STEPS_S for start in range(STARTS)}


def steps_table(gait, exact, paths):
    """Formats mean and spread of the distance in the first 20 s over the starts, and the time at which paths part."""
    means, out = {}, []
    finest = paths[gait.key, exact, STEPS_S[0], 0]
    for step_s in STEPS_S:
        far = [paths[gait.key, exact, step_s, start].distance_m(DISTANCE_S) for start in range(STARTS)]
        means[step_s] = mean(far)
        parted = paths[gait.key, exact, step_s, 0].parts_from_s(finest)
        out.append([f"{1 / step_s:.0f}", f"{100 * mean(far):.3f}",
                    f"{100 * min(far):.3f} to {100 * max(far):.3f}",
                    "" if step_s == STEPS_S[0] else percent(100 * (mean(far) / means[STEPS_S[0]] - 1), 2),
                    "" if step_s == STEPS_S[0] else "never" if parted is None else f"{parted:.1f}"])
    largest = max(abs(means[step_s] / means[STEPS_S[0]] - 1) for step_s in STEPS_S)
    return table(["step rate [Hz]", "mean distance [cm]", f"range of {STARTS} starts [cm]", "difference from 4 kHz",
                  "time to a difference of 1 mm from 4 kHz [s]"], out), largest


# --- commands -------------------------------------------------------------------------------------


def inverted():
    line = next(line for line in (ROOT / "share/gaits/cpg_learned.yaml").read_text().splitlines() if "inverted:" in line)
    return {name.strip(" []") for name in line.split(":", 1)[1].split(",")}


def export(taut, gait_path, rate_hz=1000):
    path = taut.folder / (pathlib.Path(gait_path).stem + ".csv")
    taut("gait", "export", gait_path, "models/tetraspine3.yaml", "--rate_hz", rate_hz, "--duration_s", 60,
         "--out", path)
    with open(path, newline="") as file:
        return [{key: float(x) for key, x in row.items()} for row in csv.DictReader(file)]


def worst_command(ntrt, gait, table_, signs, until_s, rate_hz=1000):
    return max(abs(signs.get(cable, 1) * table_[round(row["time_s"] * rate_hz)][cable + "_m_per_s"]
                   - row[cable + gait.column])
               for row in ntrt.rows if 0 < row["time_s"] <= until_s for cable in CABLES)


def command_values(taut, ntrts):
    signs = {cable: -1 for cable in inverted()}
    taut.folder.mkdir(parents=True, exist_ok=True)
    waves = export(taut, "gaits/hand_tuned_sine.yaml")
    fine = export(taut, "gaits/cpg_learned_ntrt.yaml")
    shipped = export(taut, "gaits/cpg_learned.yaml", 100)  # no faster than the gait's steps
    return {
        "sine_command": f"{worst_command(ntrts[SINE.key], SINE, waves, {}, 60):.1e}",
        "cpg_command_10": f"{worst_command(ntrts[CPG.key], CPG, fine, signs, 10):.1e}",
        "cpg_command_60": f"{worst_command(ntrts[CPG.key], CPG, fine, signs, 60):.1e}",
        "cpg_command_coarse": f"{worst_command(ntrts[CPG.key], CPG, shipped, signs, 60, 100):.1e}",
    }


def page(taut):
    started = time.monotonic()
    under_its_laws = [Variant(gait.key + "_ntrt", gait.key + "_ntrt", full_trace=True) for gait in (SINE, CPG)]
    one_law = {gait.key: law_variants(gait) for gait in (SINE, CPG)}
    results = taut.run([*under_its_laws, *(variant for runs in one_law.values() for _, variant in runs),
                        *STEP_RUNS.values(), *gaits_eyelets.variants()])
    values, ntrts, owns = {}, {}, []
    for gait, prefix in ((SINE, "sine"), (CPG, "cpg")):
        ntrt = ntrts[gait.key] = Ntrt(gait)
        its, own = (Run(taut.folder / name, results[name]) for name in (gait.key + "_ntrt", gait.key))
        rows = list(cable_rows(gait, ntrt, its, own))
        owns.append(own)
        # of NTRT's largest oscillation
        fundamental_hz = max((lines[0] for _, _, lines, _ in rows), key=lambda line: line[1])[0]
        values.update({
            f"{prefix}_system": system_table(gait, rows, (its, own)),
            f"{prefix}_means": means_table(rows),
            f"{prefix}_lines": lines_table(rows),
            f"{prefix}_frequencies": frequency_text(rows),
            f"{prefix}_paths": paths_table((ntrt, its, own)),
            f"{prefix}_shapes": shapes_table(rows, fundamental_hz),
            f"{prefix}_laws": laws_table(gait, ntrt, [(text, Run(taut.folder / variant.name, results[variant.name]))
                                                      for text, variant in one_law[gait.key]]),
            f"{prefix}_fundamental": f"{fundamental_hz:.3f}",
        })
    paths = {key: Path(taut.folder / variant.name) for key, variant in STEP_RUNS.items()}
    for gait, prefix in ((SINE, "sine"), (CPG, "cpg")):
        for exact, rate in ((True, "exact"), (False, "differenced")):
            text, largest = steps_table(gait, exact, paths)
            values[f"{prefix}_steps_{rate}"] = text
            values[f"{prefix}_steps_{rate}_worst"] = f"{100 * largest:.1f}"
    values["saturation"] = saturation_table(owns)
    values.update(command_values(taut, ntrts))
    values.update(gaits_eyelets.values(taut.folder, results))
    values.update({
        "version": results[SINE.key].summary["taut_version"],
        "runs": str(len(results)),
        "seconds": f"{time.monotonic() - started:.0f}",
        "machine": machine(),
    })
    return fill(TEMPLATE.read_text(), values)
