#!/usr/bin/env python3
"""script/bench on contact-rich scenes, regardless of speed

Usage: contact_bench_test.py PROGRAM TEST. TEST is the name of a function of this file; PROGRAM is taut_contact_bench.
"""

import json
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path[:0] = [str(ROOT / "script"), str(ROOT / "benchmarks")]

from measuring import contacts, page, wasm  # noqa: E402
from validation.runs import Problem  # noqa: E402

PROGRAM = sys.argv[1]
CONTEXT = {"mujoco": "1", "bullet": "2", "ode": "3", "step_s": "0.001", "max_linear_solves": "10", "tolerance_m_per_s": "0.1"}


def bench(*words):
    return subprocess.run([sys.executable, ROOT / "script/bench", "--contacts", "--contact-program", PROGRAM,
                           *map(str, words)], capture_output=True, text=True)


def start(scene, mean, engine="taut", setting="default", lanes=1, steps=100, **more):
    """Returns the program's result line of one start."""
    run = {"scene": scene, "seed": 1, "engine": engine, "setting": setting, "lanes": lanes, "held_out": False,
           "bodies": 1, "cables": 0, "steps": steps, "planned_steps": steps,
           "time_us": {"mean": mean, "median": mean / 2, "p99": 3 * mean, "p999": 4 * mean, "worst": 5 * mean}}
    if engine == "taut":
        run |= {"solved": steps, "worst_residual_m_per_s": 1e-11, "other_status_bits": 0, "contacts": 4,
                "iterations": {"mean": 2, "median": 2, "p99": 3, "p999": 4, "worst": 5}}
    return {**run, **more}


def items_of(*runs):
    return contacts.results({"context": CONTEXT, "runs": list(runs)}, [0.5])


def EveryStepOfAFewScenesIsMeasured():
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder, "results.json")
        run = bench("--filter", "^(wedge|feet_8|prisms_4|painleve)$", "--seeds", 2, "--steps", 20, "--json", path)
        assert run.returncode == 0, run.stderr
        items = json.loads(path.read_text())
    assert {item["robot"] for item in items} == {"wedge", "feet_8", "prisms_4", "painleve"}
    for item in items:
        starts = 1 if item["robot"] == "painleve" else 2
        steps = 468 if item["robot"] == "painleve" else 40 * item["lanes"]
        assert (item["kind"], item["repetitions"], item["steps"]) == (contacts.KIND, starts, steps), item
        assert not item["cut"], item
        times = [item["time_us"][key] for key in ("median", "p99", "p999", "worst")]
        assert times == sorted(times) and 0 < item["time_us"]["mean"] <= times[-1], item
        assert item["held_out"] == (item["robot"] == "prisms_4"), item
        if item["engine"] == "taut":
            assert 0 <= item["solved"] <= steps and not item["went_wrong"], item
            assert item["contacts"] == {"feet_8": 8, "painleve": 1}.get(item["robot"], item["contacts"]), item
    if items[0]["machine"]["mujoco_wasm"] != wasm.ABSENT:
        elsewhere = {item["robot"]: item for item in items if item["engine"] == wasm.ENGINE}
        assert set(elsewhere) == {"wedge", "feet_8", "prisms_4"}, elsewhere
    easy = [item for item in items if item["engine"] == "taut" and item["robot"] == "wedge"]
    assert easy and all(item["share_solved"] == 1 for item in easy), easy
    assert "a disc on 64 feet" in run.stdout and "wedge" in run.stdout, run.stdout


def SaysWhatIsWrong():
    run = bench("--filter", "nothing_like_this")
    assert run.returncode == 2 and "no benchmark matches nothing_like_this" in run.stderr, run
    run = bench("--seeds", 0)
    assert run.returncode == 2 and "usage: taut_contact_bench" in run.stderr, run
    run = bench("--filter", "wedge", "--contact-program", "no_such_program")
    assert run.returncode == 2 and "there is no no_such_program" in run.stderr, run


def StartsOfASceneBecomeOneItem():
    (item,) = items_of(start("pile_20", 10, steps=100, solved=99, share_within_16_of_ode=1.0),
                       start("pile_20", 40, steps=300, worst_residual_m_per_s=1e-3, share_within_16_of_ode=0.8))
    assert (item["steps"], item["solved"], item["share_solved"], item["repetitions"]) == (400, 399, 399 / 400, 2), item
    assert item["time_us"]["mean"] == 32.5 and item["steps_per_s"] == 1e6 / 32.5, item  # (100 10 + 300 40) / 400
    assert item["time_us"]["median"] == 12.5, item  # mean of 5 and 20
    assert (item["time_us"]["p99"], item["time_us"]["worst"]) == (120, 200), item  # of the worse start
    assert item["worst_residual_m_per_s"] == 1e-3 and abs(item["share_within_16_of_ode"] - 0.85) < 1e-12, item


def AnEngineThatFailsOnAStartIsLeftOutOfItsScene():
    items = items_of(start("pile_20", 1, "ode", "full_step"),
                     {**start("pile_20", 1, "ode", "full_step"), "error": "it broke"}, start("pile_20", 2))
    assert [item["engine"] for item in items] == ["taut"], items
    try:
        items_of({**start("pile_20", 1), "error": "it broke"})
    except Problem as problem:
        assert str(problem) == "pile_20: it broke"
    else:
        raise AssertionError("an error of ours went unseen")


def RatiosAreOfMeansOfTheSameRun():
    items = items_of(start("tetraspine3", 2), start("feet_64", 9), start("pile_20", 30, share_within_16_of_ode=0.9975),
                     start("pile_20", 20, "ode", "full_step"), start("boxes_10", 5),
                     start("boxes_10", 2, "ode", "full_step", planned_steps=101), start("painleve", 1, solved=60))
    text = contacts.ratios(items)
    for row in ("| step of a disc on 64 feet, relative to a step of Tetraspine3 | 4.5 |",
                "| step of a heap of 20 rods, relative to ODE's full step | 1.5 |",
                "| step of a stack of 10 boxes, relative to ODE's full step | 2.5* |",
                "| a heap of 20 rods: share of steps shorter than 16 times ODE's mean step | 99.75 % |",
                "| a stack of 10 boxes: share of steps shorter than 16 times ODE's mean step | - |",
                "| Painleve's rod: steps solved | 60 of 100 |"):
        assert row in text, (row, text)


def TheSectionHasAllScenesAndNamesThoseThatWentWrong():
    items = items_of(start("pile_20", 30, solved=97), start("pile_20", 12, lanes=8, steps=12345, solved=12000, planned_steps=24000),
                     start("pile_20", 20, "ode", "full_step"), start("bricks", 7, held_out=True, other_status_bits=4))
    text = contacts.section(items)
    assert "| pile_20 | 4 | 100 | 3 | 1.0e-11 | 2 | 3 | 5 | 30 | 15 | 90 | 120 | 150 | 12* | 345 |" in text, text
    assert "| bricks (held out) | 4 | 100 | 0 |" in text and text.count("| bricks") == 1, text
    assert "with more contacts than the capacity: bricks (held out)." in " ".join(text.split()), text
    assert "| pile_20 | 30 (15) | 20 (10) |" in text, text


def ARunWithoutThemSaysSoOnThePage():
    assert contacts.section([{"kind": "one"}]) == contacts.NOT_MEASURED
    try:
        page.text(items_of(start("pile_20", 30)))
    except Problem as problem:
        assert "contact-rich scenes alone" in str(problem)
    else:
        raise AssertionError("a page of these alone")


if __name__ == "__main__":
    globals()[sys.argv[2]]()
