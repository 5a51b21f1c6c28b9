"""Which values of unpublished numbers agree with the published facts about the paper's robot."""

import json
import math
import os
import pathlib
import statistics
import subprocess
import sys

from validation.board_facts import DRIVES, LIMITS, NTRT, RANGES, misfit
from validation.push import machine
from validation.runs import Problem, fill, table

TEMPLATE = pathlib.Path(__file__).with_suffix(".md.in")
PROGRAM = pathlib.Path(__file__).with_name("board_members.py")
COUNT = 960
LEAST_WAY_M = 0.1


def within(run):
    low, high = LIMITS[run]
    return lambda member, pure: low <= member[run]["max_n"] <= high


def direction(member, pure):
    (x, y), (u, v) = member["gait"]["way_m"], pure["gait"]["way_m"]
    return x * u + y * v > math.cos(math.pi / 4) * math.hypot(x, y) * math.hypot(u, v)


def way(member):
    return math.hypot(*member["gait"]["way_m"])


FACTS = {
    "push: largest tension within 6.1 % of NTRT's": within("push"),
    "sine, amplitude x 10: largest tension within 7.9 %": within("sine"),
    "sine, amplitude x 10: mean tension at least half of the simulation's":
        lambda member, pure: member["sine"]["mean_n"] >= 0.5 * pure["sine"]["mean_n"],
    "learned gait: largest tension within 1.6 %": within("gait"),
    "learned gait: locomotion (0.1 m or more) within 45 degrees of the simulation's direction":
        lambda member, pure: way(member) >= LEAST_WAY_M and direction(member, pure),
    "learned gait: slower than the simulation":
        lambda member, pure: way(member) < math.hypot(*pure["gait"]["way_m"]),
}
OUTSIDE = "learned gait: mean tension of the outer cables below the simulation's"


def outside(member, pure):
    return member["gait"]["outer_n"] < pure["gait"]["outer_n"]


def span(values, form="{:.1f}"):
    """Returns the 5 %, 50 % and 95 % quantiles as text."""
    if len(values) < 2:
        return "-" if not values else form.format(values[0])
    cuts = statistics.quantiles(values, n=20, method="inclusive")
    return " / ".join(form.format(x) for x in (cuts[0], statistics.median(values), cuts[-1]))


def largest(members, run="gait"):
    return [member[run]["max_n"] for member in members]


def thirds(members, name):
    """Returns the members with the lowest, middle and highest third of a number."""
    low, high = (math.log(x) for x in RANGES[name])
    parts = [[], [], []]
    for member in members:
        share = (math.log(member["values"][name]) - low) / (high - low)
        parts[min(2, int(3 * share))].append(member)
    return parts


def cuts_of(name):
    low, high = RANGES[name]
    edges = [low * (high / low) ** (i / 3) for i in range(4)]
    return [f"{a:.3g} to {b:.3g}" for a, b in zip(edges, edges[1:])]


def simulate(taut):
    found = taut.folder / "members.json"
    where = {**os.environ, "PYTHONPATH": str(taut.command.parent / "python")}
    done = subprocess.run([sys.executable, PROGRAM, str(COUNT), taut.folder], env=where)
    if done.returncode != 0:
        raise Problem("board_members.py failed; it needs the Python module beside the command, and numpy")
    return json.loads(found.read_text())


def page(taut):
    data = simulate(taut)
    pure, members, refined = data["pure"], data["members"], data["refined"]
    described = [member for member in members if not member["capture"]]
    captured = [member for member in members if member["capture"]]

    def agreeing(among, facts):
        return [member for member in among if all(fact(member, pure) for fact in facts)]

    facts = [[title, *(f"{100 * len(agreeing(group, [fact])) / len(group):.0f}" for group in (described, captured))]
             for title, fact in [*FACTS.items(), (OUTSIDE, outside)]]
    good = agreeing([*members, *refined], FACTS.values())
    best = agreeing(good, [outside])
    scales = [member["values"]["boards.velocity_input_scale"] for member in good]
    misfits = {drive: min(misfit(member) for member in [*described, *refined] if member["drive"] == drive)
               for drive in DRIVES}
    facts.append(["all facts but the last", *(str(len(agreeing(group, FACTS.values()))) + f" of {len(group)}"
                                        for group in (described, captured))])
    facts.append(["all facts", *(str(len(agreeing(group, [*FACTS.values(), outside]))) + f" of {len(group)}"
                           for group in (described, captured))])
    influences = []
    for name in RANGES:
        influences += [[name, text, span(largest(part)), span([way(member) for member in part], "{:.2f}")]
                       for text, part in zip(cuts_of(name), thirds(described, name))]
    for drive in DRIVES:
        part = [member for member in described if member["drive"] == drive]
        influences.append(["drive", drive, span(largest(part)), span([way(member) for member in part], "{:.2f}")])
    left = [[name, f"{low:g} to {high:g}", span([member["values"][name] for member in good], "{:.3g}")]
            for name, (low, high) in RANGES.items()]
    left.append(["drive", "; ".join(DRIVES),
                 "; ".join(f"{drive}: {sum(member['drive'] == drive for member in good)} robots" for drive in DRIVES)])
    shown = [[str(i), member["drive"], f"{member['values']['boards.force_p_per_n']:.4f}",
              f"{member['values']['integral_s']:.2f}", f"{member['values']['boards.velocity_input_scale']:.2f}",
              *(f"{member[run]['max_n']:.1f}" for run in NTRT), f"{way(member):.2f}",
              f"{member['gait']['outer_n']:.1f}"] for i, member in enumerate((best or good)[:8], 1)]
    values = {
        "count": str(len(members)), "refined": str(len(refined)), "seconds": "60",
        "misfits": table(["drive", "deviation [%]"],
                         [[drive, f"{100 * least:.1f}"] for drive, least in misfits.items()]),
        "worst_misfit": f"{math.ceil(1000 * max(misfits.values())) / 10:g}",
        "scales": "{:.2f} to {:.2f}".format(*(extreme(scales) for extreme in (min, max))) if scales else "none",
        "limits": table(["run", "NTRT [N]", "published error [%]", "possible largest tension of the robot [N]"],
                        [[run, f"{simulated:.2f}", f"{100 * error:.1f}", "{:.2f} to {:.2f}".format(*LIMITS[run])]
                         for run, (simulated, error) in NTRT.items()]),
        "ranges": table(["number", "range"], [[name, f"{low:g} to {high:g}"] for name, (low, high) in RANGES.items()]),
        "facts": table(["fact", "set points of the paper: agreeing [%]", "captured: agreeing [%]"], facts),
        "influences": table(["number", "values", "largest tension of the learned gait [N]", "distance in 60 s [m]"], influences),
        "left": table(["number", "range before", "with the facts"], left),
        "shown": table(["example", "drive", "P [1/N]", "P / I [s]", "factor on V0", "push [N]", "sine [N]",
                        "learned gait [N]", "distance [m]", "outer cables [N]"], shown),
        "band": span(largest(described)), "least": f"{min(largest(described)):.1f}",
        "most": f"{max(largest(described)):.1f}", "good": str(len(good)), "best": str(len(best)),
        "pure_way": f"{math.hypot(*pure['gait']['way_m']):.2f}", "pure_outer": f"{pure['gait']['outer_n']:.2f}",
        "captured_push": span(largest(captured, "push")),
        "version": taut("--version").split()[-1], "machine": machine(),
    }
    return fill(TEMPLATE.read_text(), values)
