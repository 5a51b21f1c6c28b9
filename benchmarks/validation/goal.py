"""A spine of tetrahedra moves to a goal, from a hundred random starts on each of three terrains; NTRT's controller."""

import csv
import math
import pathlib
import shutil
import sqlite3
import statistics
import time

from validation import shares
from validation.push import machine
from validation.runs import Problem, Variant, fill, keep_picture, table
from validation.shares import HEIGHT, LEFT, TOP, WIDTH

TEMPLATE = pathlib.Path(__file__).with_suffix(".md.in")
TERRAINS = {"flat ground": "goal_trials", "hills": "goal_trials_hills", "blocks": "goal_trials_blocks"}
COLOURS = ("#2471a3", "#1e8449", "#c0392b")
WANTED_M, ASKED_M = 2.0, 1.5
HEADINGS = 9
# NTRT's impedance control of these cables (TC_goal, contactCables at commit f0c52e93), with the described lengths.
NTRT = """controllers:
  - name: motion
    period_s: 0.001
    velocity_input: {{gait: ../../../../share/gaits/ntrt_feedback.yaml, period_s: 0.01}}
    impedance:
      gains: [{{cables: cable, position_gain_n_per_m: 1000, velocity_gain_n_s_per_m: 200}}]
      set_points:
        - {{cables: outer, tension_n: 0, length_m: 0.115}}
        - {{cables: inner, tension_n: 0, length_m: 0.217313}}
place: {{at_m: [0.2875, 0, drop_m], rotate: {{axis: z, angle_rad: {heading}}}}}
record: {{rate_hz: 1, channels: ['body/segment_5/position_x_m', 'body/segment_5/position_y_m']}}
"""


def trials(taut, study):
    """Returns each world's decrease of the distance to the goal [m], ascending, without the first, unrandomized one."""
    folder = taut.folder / study
    shutil.rmtree(folder, ignore_errors=True)   # a study with a changed gait is a different study
    taut("learn", f"studies/{study}.yaml", "--out", folder, "--quiet")
    with sqlite3.connect(folder / "study.sqlite") as log:
        rows = log.execute("SELECT score, energy_j, max_tension_n FROM world WHERE world > 0").fetchall()
    if any(score is None for score, *_ in rows):
        raise Problem(f"{study}: a world failed")
    return sorted(row[0] for row in rows), statistics.median(row[1] for row in rows), max(row[2] for row in rows)


def ntrts_own(taut):
    """Returns the results of NTRT's controller on each terrain, from some headings: one row each."""
    bases = {"flat ground": "goal_flat", "hills": "goal_hills", "blocks": "goal_blocks"}
    variants = {(name, i): Variant(f"ntrt_{base}_{i}", base, NTRT.format(heading=2 * math.pi * i / HEADINGS),
                                   full_trace=True, any_status=True)
                for name, base in bases.items() for i in range(HEADINGS)}
    taut.run(variants.values())
    rows = []
    for name in bases:
        way = []
        for i in range(HEADINGS):
            with open(taut.folder / variants[name, i].name / "trace.csv", newline="") as file:
                places = [[float(row[f"body/segment_5/position_{axis}_m"]) for axis in "xy"] for row in csv.DictReader(file)]
            way.append(math.dist(places[0], places[-1]))
        rows.append([name, *(f"{value:.2f}" for value in (min(way), statistics.median(way), max(way)))])
    return rows


def share(scores, least):
    return f"{100 * sum(score >= least for score in scores) / len(scores):.0f} %"


def row(name, outcome):
    scores, energy_j, tension_n = outcome
    at = [f"{scores[int(part * len(scores))]:.2f}" for part in (0.05, 0.1, 0.25)]
    return [name, f"{scores[0]:.2f}", *at, f"{statistics.median(scores):.2f}", f"{scores[-1]:.2f}",
            share(scores, ASKED_M), share(scores, WANTED_M), f"{energy_j:.0f}", f"{tension_n:.0f}"]


def picture(outcomes):
    """Draws the share of starts against the least decrease of the distance."""
    least, most = -1.0, 3.5

    def x_of(score):
        return LEFT + WIDTH * (max(score, least) - least) / (most - least)

    guides = [f'<line x1="{x_of(at):.1f}" y1="{TOP}" x2="{x_of(at):.1f}" y2="{TOP + HEIGHT}" stroke="#ddd"/>'
              for at in (ASKED_M, WANTED_M)]
    curves = {name: [f"{LEFT},{TOP}"] + [f"{x_of(score):.1f},{TOP + HEIGHT * part / len(scores):.1f}"
                                         for k, score in enumerate(scores) for part in (k, k + 1)]
              for name, (scores, *_) in outcomes.items()}
    return shares.picture("progress towards the goal of at least [m]", [f"{least + 0.5 * i:.1f}" for i in range(10)],
                          guides, curves, COLOURS, 200)


def page(taut):
    started = time.monotonic()
    outcomes = {name: trials(taut, study) for name, study in TERRAINS.items()}
    keep_picture(taut, "docs/validation/goal.svg", picture(outcomes))
    version = taut("--version").split()[-1]
    return fill(TEMPLATE.read_text(), {
        "made_by": f"This page was made by `script/validate goal` with taut {version}: {303 + 3 * HEADINGS} runs of 60 s took "
                   f"{time.monotonic() - started:.0f} s on {machine()}.",
        "starts": table(["terrain", "minimum [m]", "5 % [m]", "10 % [m]", "25 % [m]", "median [m]", "maximum [m]",
                         "starts with at least 1.5 m", "starts with at least 2 m", "winding work [J]",
                         "largest tension [N]"],
                        [row(name, outcome) for name, outcome in outcomes.items()]),
        "ntrts_own": table(["terrain", "minimum [m]", "median [m]", "maximum [m]"], ntrts_own(taut)),
    })
