"""Contact-rich scenes: runs the program that measures each of their steps, and formats its tables."""

import json
import os
import pathlib
import statistics

from measuring.table_text import NOTHING, SETTINGS, count, number
from measuring import wasm
from measuring.commands import command
from measuring.measure import machine
from validation.runs import Problem, fill, table

KIND = "contact_scenes"
TEMPLATE = pathlib.Path(__file__).with_name("contact_scenes.md.in")
NOT_MEASURED = "Not measured in this run; `script/bench --contacts` does."
PAINLEVE = "painleve"
REFERENCE = "tetraspine3"  # a robot on flat ground, with few contacts
ODE = ("ode", "full_step")
CUT = "*"


def run(program, only, seeds, steps, seconds, load):
    """Returns the list for scenes whose names match; empty if there are none."""
    if not os.access(program, os.X_OK):
        raise Problem(f"there is no {program}")
    limit = ["--steps", steps] if steps else []
    wanted = ["--scene", only, "--seeds", seeds, "--seconds", seconds, *limit]
    raw = json.loads(command(program, *wanted))
    raw["context"]["mujoco_wasm"] = wasm.version()
    elsewhere = wasm.measured("steps", command(program, *wanted, "--mjcf"), seconds)
    raw["runs"] += elsewhere["runs"] if elsewhere else []
    return results(raw, load)


def together(runs):
    """Merges the runs from all starts of a scene: means over all steps, and the worst of all runs."""
    first = runs[0]
    steps = sum(one["steps"] for one in runs)

    def over_steps(of):
        return sum(of(one) * one["steps"] for one in runs) / steps

    means = [one["time_us"]["mean"] for one in runs]
    item = {"kind": KIND, "engine": first["engine"], "setting": first["setting"], "robot": first["scene"],
            "worlds": first["lanes"], "lanes": first["lanes"], "threads": 1,
            "held_out": first["held_out"], "bodies": first["bodies"], "cables": first["cables"],
            "steps": steps, "cut": any(one["steps"] < one["planned_steps"] for one in runs), "repetitions": len(runs),
            "spread": (max(means) - min(means)) / statistics.median(means),
            "time_us": {"mean": over_steps(lambda one: one["time_us"]["mean"]),
                        "median": statistics.median(one["time_us"]["median"] for one in runs),
                        **{key: max(one["time_us"][key] for one in runs) for key in ("p99", "p999", "worst")}}}
    item["steps_per_s"] = 1e6 / item["time_us"]["mean"]
    if first["engine"] == "taut":
        item["solved"] = sum(one["solved"] for one in runs)
        item["share_solved"] = item["solved"] / steps
        item["worst_residual_m_per_s"] = max(one["worst_residual_m_per_s"] for one in runs)
        item["went_wrong"] = any(one["other_status_bits"] for one in runs)
        item["contacts"] = over_steps(lambda one: one["contacts"])
        item["iterations"] = {"mean": over_steps(lambda one: one["iterations"]["mean"]),
                              "p99": max(one["iterations"]["p99"] for one in runs),
                              "worst": max(one["iterations"]["worst"] for one in runs)}
        if all("share_within_16_of_ode" in one for one in runs):
            item["share_within_16_of_ode"] = over_steps(lambda one: one["share_within_16_of_ode"])
    return item


def results(raw, load):
    """Converts the program's JSON to the list. A peer that fails at any start of a scene is omitted there."""
    where = machine({**raw["context"], "load_avg": load})
    starts, failed = {}, set()
    for one in raw["runs"]:
        key = one["scene"], one["engine"], one["setting"], one["lanes"]
        if "error" in one:
            if one["engine"] == "taut":
                raise Problem(f"{one['scene']}: {one['error']}")
            failed.add(key)
        else:
            starts.setdefault(key, []).append(one)
    return [{**together(runs), "machine": where} for key, runs in starts.items() if key not in failed]


class Scenes:
    def __init__(self, items):
        self.items = [item for item in items if item["kind"] == KIND]
        self.names = list(dict.fromkeys(item["robot"] for item in self.items))

    def of(self, scene, engine="taut", setting="default", lanes=1):
        for item in self.items:
            if (item["robot"], item["engine"], item["setting"], item["lanes"]) == (scene, engine, setting, lanes):
                return item
        return None

    @property
    def widest(self):
        return max(item["lanes"] for item in self.items)


def mean(item):
    """Formats the mean time of a step; an asterisk marks an aborted run, whose mean is over fewer steps."""
    return number(item["time_us"]["mean"]) + (CUT if item["cut"] else "")


def not_solved(item):
    return count(item["steps"] - item["solved"])


def name(item):
    return item["robot"] + (" (held out)" if item["held_out"] else "")


def steps(items):
    """Formats the solver's results and times of each scene."""
    scenes = Scenes(items)
    rows = []
    for scene in scenes.names:
        one, lanes = scenes.of(scene), scenes.of(scene, lanes=scenes.widest)
        if one is None:
            continue
        time, iterations = one["time_us"], one["iterations"]
        wide = [mean(lanes), not_solved(lanes)] if lanes and scenes.widest > 1 else [NOTHING, NOTHING]
        rows.append([name(one), number(one["contacts"]), count(one["steps"]),
                     not_solved(one), f"{one['worst_residual_m_per_s']:.1e}",
                     *(number(iterations[key]) for key in ("mean", "p99", "worst")),
                     mean(one), *(number(time[key]) for key in ("median", "p99", "p999", "worst")), *wide])
    return table(["scene", "contacts, mean", "steps", "not solved", "worst residual [m/s]", "iterations, mean", "iterations, 99 %", "iterations, maximum",
                  "step, mean [us]", "step, median [us]", "step, 99 % [us]", "step, 99.9 % [us]", "step, worst [us]", f"{scenes.widest} lanes: step, mean [us]", f"{scenes.widest} lanes: not solved"], rows)


def beside(items):
    """Formats mean and median times of the same steps with other engines."""
    scenes = Scenes(items)
    engines = [key for key in SETTINGS if any((item["engine"], item["setting"]) == key for item in scenes.items)]
    rows = []
    for scene in scenes.names:
        found = [scenes.of(scene, *key) for key in engines]
        if sum(item is not None for item in found) < 2:
            continue
        first = next(item for item in found if item)
        rows.append([name(first), *(f"{mean(item)} ({number(item['time_us']['median'])})"
                                    if item else NOTHING for item in found)])
    return table(["scene", *(SETTINGS[key] for key in engines)], rows)


def ratios(items):
    """Formats the ratios by which a solver is evaluated, each from the same run."""
    scenes = Scenes(items)

    def over(scene, other):
        ours = scenes.of(scene)
        if not (ours and other):
            return NOTHING
        cut = CUT if ours["cut"] or other["cut"] else ""
        return number(ours["time_us"]["mean"] / other["time_us"]["mean"]) + cut

    def share(scene):
        item = scenes.of(scene)
        return f"{100 * item['share_within_16_of_ode']:.2f} %" if item and "share_within_16_of_ode" in item else NOTHING

    rod = scenes.of(PAINLEVE)
    rows = [["step of a disc on 64 feet, relative to a step of Tetraspine3", over("feet_64", scenes.of(REFERENCE))],
            *([f"step of {what}, relative to ODE's full step", over(scene, scenes.of(scene, *ODE))]
              for scene, what in {"pile_20": "a heap of 20 rods", "boxes_10": "a stack of 10 boxes"}.items()),
            *([f"{what}: share of steps shorter than 16 times ODE's mean step", share(scene)]
              for scene, what in {"pile_20": "a heap of 20 rods", "boxes_10": "a stack of 10 boxes"}.items()),
            ["Painleve's rod: steps solved", f"{rod['solved']} of {rod['steps']}" if rod else NOTHING]]
    return table(["quantity", "value"], rows)


def section(items):
    scenes = Scenes(items)
    if not scenes.items:
        return NOT_MEASURED
    wrong = [name(item) for item in scenes.items if item.get("went_wrong")]
    return fill(TEMPLATE.read_text(), {
        "steps": steps(items), "engines": beside(items), "ratios": ratios(items),
        "starts": str(max(item["repetitions"] for item in scenes.items)), "lanes": str(scenes.widest),
        "wrong": f"Scenes with a state that is not finite, or with more contacts than the capacity: {', '.join(wrong)}." if wrong
                 else "The states of all worlds stayed finite, and no world exceeded its capacity of contacts."}).rstrip()
