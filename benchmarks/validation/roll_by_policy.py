"""A six-strut robot that rolls by a learned policy: training, and comparison with the best sine gait."""

import csv
import json
import os
import pathlib
import subprocess

from validation.push import machine
from validation.rolling import MOVING, STARTS, Run, moving_row, variant
from validation.runs import Problem, fill, keep_picture, table

TEMPLATE = pathlib.Path(__file__).with_suffix(".md.in")
PYTHON = "/usr/bin/python3"   # the python3 for which the module is built
UPDATES, SECONDS = 391, 60   # six minutes of processor time
LEFT, TOP, WIDTH, HEIGHT = 60, 20, 560, 300


def python(taut, *arguments):
    """Runs a program that needs taut's module; returns its output."""
    where = {**os.environ, "PYTHONPATH": str(taut.command.parent / "python")}
    run = subprocess.run([PYTHON, *map(str, arguments)], env=where, capture_output=True, text=True)
    if run.returncode != 0:
        raise Problem(f"{' '.join(map(str, arguments))}\n{run.stdout}{run.stderr}".rstrip())
    return run.stdout


def curve(taut):
    with open(taut.folder / "ppo/curve.csv", newline="") as file:
        return [{name: float(value) for name, value in row.items()} for row in csv.DictReader(file)]


def picture(rows, sine_m_per_s):
    """Draws the speed during training against processor time."""
    last_s = 60 * (int(rows[-1]["processor_s"] / 60) + 1)
    most = 0.5 * (int(max(row["per_s"] for row in rows) / 0.5) + 1)

    def place(x_s, y):
        return f"{LEFT + WIDTH * x_s / last_s:.1f},{TOP + HEIGHT * (1 - y / most):.1f}"

    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="660" height="385" viewBox="0 0 660 385" '
           'font-family="sans-serif" font-size="13">', '<rect width="660" height="385" fill="white"/>']
    for i in range(int(most / 0.5) + 1):
        y = place(0, 0.5 * i).split(",")[1]
        out.append(f'<path d="M{LEFT} {y}h{WIDTH}" stroke="#e4e4e4"/>'
                   f'<text x="{LEFT - 8}" y="{float(y) + 4:.1f}" text-anchor="end">{0.5 * i:.1f}</text>')
    for minute in range(last_s // 60 + 1):
        x = place(60 * minute, 0).split(",")[0]
        out.append(f'<path d="M{x} {TOP}v{HEIGHT}" stroke="#e4e4e4"/>'
                   f'<text x="{x}" y="{TOP + HEIGHT + 18}" text-anchor="middle">{minute}</text>')
    line = " ".join(place(row["processor_s"], max(row["per_s"], 0)) for row in rows)
    out.append(f'<path d="M{place(0, sine_m_per_s)}H{LEFT + WIDTH}" stroke="#4aa3c7" stroke-width="2"/>'
               f'<polyline points="{line}" fill="none" stroke="#b2182b" stroke-width="2"/>')
    for i, (text, shade) in enumerate((("policy, with exploration noise", "#b2182b"),
                                       ("the sine, median", "#4aa3c7"))):
        x, y = LEFT + 15, TOP + 20 + 20 * i
        out.append(f'<path d="M{x} {y}h24" stroke="{shade}" stroke-width="2"/><text x="{x + 30}" y="{y + 4}">{text}</text>')
    out.append(f'<text x="{LEFT + WIDTH / 2}" y="{TOP + HEIGHT + 42}" text-anchor="middle">processor time, minutes</text>'
               f'<text x="16" y="{TOP + HEIGHT / 2}" text-anchor="middle" '
               f'transform="rotate(-90 16 {TOP + HEIGHT / 2})">speed along x [m/s]</text>')
    return "\n".join(out + ["</svg>", ""])


def page(taut):
    learned = taut.folder / "ppo"   # an existing policy is not trained again
    python(taut, "examples/ppo.py", "--out", learned, "--updates", UPDATES, "--minutes", 600)
    python(taut, "examples/ppo.py", "--out", learned, "--play", "--starts", STARTS, "--seconds", SECONDS)
    elsewhere = json.loads(python(taut, "benchmarks/validation/roll_elsewhere.py", learned))
    bases = {"policy": os.path.relpath(taut.folder / "ppo/play/policy_{}", "share/experiments"), "sine": "roll_six_strut"}
    groups = {name: [variant(name, base.format(number), number) for number in range(STARTS)]
              for name, base in bases.items()}
    taut.run([v for group in groups.values() for v in group])
    runs = {name: [Run(taut.folder / v.name) for v in group] for name, group in groups.items()}
    ways = {name: sorted(run.way_m for run in group) for name, group in runs.items()}
    median_m = {name: (way[len(way) // 2] + way[(len(way) - 1) // 2]) / 2 for name, way in ways.items()}
    rows = curve(taut)
    keep_picture(taut, "docs/validation/roll_by_policy.svg", picture(rows, median_m["sine"] / SECONDS))
    better = next((row for row in rows if row["per_s"] * SECONDS > ways["sine"][-1]), None)
    if better is None:
        raise Problem(f"after {UPDATES} updates the policy is not as fast as the sine")

    def way(run):
        return run.way_m

    first = runs["policy"][0]
    values = {
        "table": table(MOVING, [moving_row("policy", runs["policy"], way), moving_row("sine", runs["sine"], way)]),
        "each": table(["start", *map(str, range(STARTS))],
                      [[name, *(f"{run.way_m:.1f}" for run in runs[name])] for name in runs]),
        "elsewhere": table(["change (first start)", "policy: distance in 60 s [m]", "sine: distance in 60 s [m]"],
                           [[name, f"{policy_m:.1f}", f"{sine_m:.1f}"] for name, policy_m, sine_m in elsewhere]),
        "times": f"{median_m['policy'] / median_m['sine']:.1f}",
        "updates": str(UPDATES),
        "periods": f"{rows[-1]['periods'] / 1e6:.1f}",
        "minutes": f"{rows[-1]['processor_s'] / 60:.1f}",
        "better_updates": f"{better['update']:.0f}",
        "better_periods": f"{better['periods'] / 1e6:.1f}",
        "better_minutes": f"{better['processor_s'] / 60:.1f}",
        "per_turn": f"{first.length_m / first.turns:.2f}",
        "height": f"{first.height_m:.2f}",
        "wheel": f"{6.283185 * first.height_m:.2f}",
        "version": taut("--version").split()[-1],
        "machine": machine(),
    }
    return fill(TEMPLATE.read_text(), values)
