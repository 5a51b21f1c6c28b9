"""Comparison of taut's optimizers: quality, speed, and robustness of the solutions."""

import csv
import json
import os
import pathlib
import sqlite3
import statistics
import subprocess

from validation.runs import ROOT, Problem, fill, table

TEMPLATE = pathlib.Path(__file__).with_suffix(".md.in")
SEEDS = (1, 2, 3, 4, 5)
FIRST = "{method: monte_carlo, evaluations: 128, batch: 64}"
METHODS = {
    "Monte Carlo": ["{method: monte_carlo, evaluations: 512, batch: 64}"],
    "hill climbing": [FIRST, "{method: hill_climbing, evaluations: 384, batch: 16, deviation: 0.1}"],
    "hill climbing, NTRT's step": [
        FIRST, "{method: hill_climbing, evaluations: 384, batch: 16, deviation: 0.005, adapt: false}"],
    "Nelder-Mead": [FIRST, "{method: nlopt, evaluations: 384, starts: 8}"],
    "BOBYQA": [FIRST, "{method: nlopt, algorithm: bobyqa, evaluations: 384, starts: 8}"],
    "CMA-ES": ["{method: cma_es, evaluations: 512, batch: 16}"],
}
COLOURS = ("#888888", "#c0392b", "#e59866", "#2471a3", "#7d3c98", "#1e8449")
AT = (64, 128, 256, 512)
GAITS = {"sidewinder3": "learned with taut, 3 segments", "sidewinder12": "learned with taut, 12 segments",
         "cpg_learned": "NTRT's oscillators (paper IV.C)", "sine_hand_tuned": "NTRT's sines (paper IV.B)"}
CHANGES = [("as described", "", 0.001)]
CHANGES += [(f"{key} {sign}20 %", f"scale: [{{{key}: {1.2 if sign == '+' else 0.8}}}]\n", 0.001)
            for key in ("friction", "mass", "stiffness") for sign in "-+"]
CHANGES += [("250 Hz", "", 0.004), ("4000 Hz", "", 0.00025)]


def learn(taut, method, seed):
    """Returns [(best score so far, wall-clock seconds so far)] by evaluation."""
    name = f"{method}_{seed}".lower().replace(" ", "_").replace(",", "").replace("'", "")
    folder = taut.folder / name
    folder.mkdir(parents=True, exist_ok=True)
    base = os.path.relpath(ROOT / "share/studies/sidewinder3.yaml", folder)
    (folder / "study.yaml").write_text(
        f"taut: 1\nkind: study\nbase: {base}\nname: {name}\nseed: {seed}\n"
        "worlds: {count: 2, friction: 0.2, mass: 0.1, stiffness: 0.1, start: {position_m: 0.001}}\n"
        f"search: [{', '.join(METHODS[method])}]\n")
    taut("learn", folder / "study.yaml", "--out", folder, "--quiet")
    best, curve = float("-inf"), []
    with sqlite3.connect(folder / "study.sqlite") as log:
        rows = log.execute("SELECT score, elapsed_s FROM evaluation ORDER BY id").fetchall()
    wall = 0.0
    for score, elapsed in rows:
        best = max(best, score if score is not None else best)
        wall = max(wall, elapsed)
        curve.append((best, wall))
    return curve


def curves_table(curves):
    def cell(runs, at):
        scores = sorted(run[at - 1][0] for run in runs)
        return f"{statistics.median(scores):.3f} ({scores[0]:.3f}..{scores[-1]:.3f})"

    rows = [[name, *(cell(runs, at) for at in AT), f"{statistics.median(r[-1][1] for r in runs):.0f} s"]
            for name, runs in curves.items()]
    return table(["method", *(f"score after {at} evaluations [m]" for at in AT), "wall-clock time"], rows)


def panel(curves, left, width, last, x_of, label):
    """Draws one plot: median over the seeds, and the range from minimum to maximum."""
    height, top = 300, 20
    most = max(run[-1][0] for runs in curves.values() for run in runs) * 1.05

    def point(x, score):
        return f"{left + width * x / last:.1f},{top + height * (1 - max(score, 0) / most):.1f}"

    out = [f'<rect x="{left}" y="{top}" width="{width}" height="{height}" fill="none" stroke="#999"/>']
    step = 0.1 if most < 1 else 0.2
    for i in range(int(most / step) + 1):
        y = top + height * (1 - i * step / most)
        out.append(f'<text x="{left - 6}" y="{y + 4:.1f}" text-anchor="end">{i * step:.1f}</text>')
    for i in range(5):
        x = left + width * i / 4
        out.append(f'<text x="{x:.1f}" y="{top + height + 16}" text-anchor="middle">{last * i / 4:.0f}</text>')
    out.append(f'<text x="{left + width / 2}" y="{top + height + 34}" text-anchor="middle">{label}</text>')
    for (name, runs), colour in zip(curves.items(), COLOURS):
        lines = [[], [], []]
        for i in range(0, len(runs[0]), 8):
            scores = sorted(run[i][0] for run in runs)
            x = x_of(runs, i)
            for line, score in zip(lines, (scores[0], statistics.median(scores), scores[-1])):
                line.append(point(min(x, last), score))
        band = " ".join(lines[0] + lines[2][::-1])
        out.append(f'<polygon points="{band}" fill="{colour}" fill-opacity="0.12"/>')
        out.append(f'<polyline points="{" ".join(lines[1])}" fill="none" stroke="{colour}" stroke-width="1.6"/>')
    return out


def picture(curves):
    walls = [statistics.median(r[-1][1] for r in runs) for runs in curves.values()]
    out = ['<svg xmlns="http://www.w3.org/2000/svg" width="960" height="420" viewBox="0 0 960 420" '
           'font-family="sans-serif" font-size="11">', '<rect width="960" height="420" fill="white"/>']
    out += panel(curves, 50, 400, max(AT), lambda runs, i: i + 1, "evaluations")
    out += panel(curves, 520, 400, max(walls),
                 lambda runs, i: statistics.median(run[i][1] for run in runs), "wall clock [s]")
    for i, (name, colour) in enumerate(zip(curves, COLOURS)):
        x, y = 50 + 300 * (i % 3), 380 + 20 * (i // 3)
        out.append(f'<rect x="{x}" y="{y - 9}" width="18" height="8" fill="{colour}"/>')
        out.append(f'<text x="{x + 24}" y="{y}">{name}</text>')
    return "\n".join(out + ["</svg>", ""])


def distance(taut, gait, change, keys, step_s):
    """Returns the horizontal displacement of the center of mass in 60 s [m]."""
    name = f"{gait}_{change}".replace(" ", "_").replace("%", "").replace("+", "more").replace("-", "less")
    folder = taut.folder / name
    folder.mkdir(parents=True, exist_ok=True)
    base = os.path.relpath(ROOT / "share/experiments" / f"{gait}.yaml", folder)
    (folder / "experiment.yaml").write_text(
        f"taut: 1\nkind: experiment\nbase: {base}\nname: {name}\nduration_s: 60\nstep_s: {step_s}\n"
        f"record: {{rate_hz: 1, channels: [system/com_*]}}\n{keys}")
    taut("run", folder / "experiment.yaml", "--csv", "--quiet", "--out", folder)
    with open(folder / "trace.csv", encoding="utf-8") as file:
        rows = [row for row in csv.reader(file) if row and row[0].replace(".", "").isdigit()]
    first, last = ([float(x) for x in rows[i][1:3]] for i in (0, -1))
    return ((last[0] - first[0]) ** 2 + (last[1] - first[1]) ** 2) ** 0.5


def robust_table(taut):
    rows = []
    for change, keys, step_s in CHANGES:
        rows.append([change, *(f"{distance(taut, gait, change, keys, step_s):.3f}" for gait in GAITS)])
    return table(["distance in 60 s [m]", *GAITS.values()], rows)


def speeds(taut):
    program = taut.command.parent / "benchmarks/rollout_speed"
    rows = []
    for experiment in ("sidewinder3_start", "sidewinder3", "cpg_learned", "sidewinder12"):
        run = subprocess.run([program, f"share/experiments/{experiment}.yaml", "4"], capture_output=True,
                             text=True, check=False)
        if run.returncode != 0:
            raise Problem(f"{program}: {run.stderr}; script/build makes it")
        found = json.loads(run.stdout)
        held, bare, rollout = (found[f"{key}_steps_per_s"] for key in ("held", "bare", "rollout"))
        rows.append([experiment, f"{held / 1e6:.2f}", f"{bare / 1e6:.2f}", f"{rollout / 1e6:.2f}",
                     f"{100 * rollout / bare:.0f} %", f"{rollout / 60000:.1f}"])
    return table(["experiment", "held [10^6 steps/s]", "bare [10^6 steps/s]", "rollouts [10^6 steps/s]", "rollouts / bare",
                  "rollouts of 60 s per second"], rows)


def page(taut):
    curves = {name: [learn(taut, name, seed) for seed in SEEDS] for name in METHODS}
    (ROOT / "docs/validation/learning.svg").write_text(picture(curves))
    return fill(TEMPLATE.read_text(), {"curves": curves_table(curves), "robust": robust_table(taut),
                           "speeds": speeds(taut), "seeds": str(len(SEEDS)),
                           "processor": processor()})


def processor():
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return f"{line.split(': ')[1]}, {os.cpu_count()} cores"
    return "unknown"
