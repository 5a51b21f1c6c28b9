#!/usr/bin/env python3
"""script/bench, regardless of speed

Usage: bench_test.py PROGRAM TEST. TEST is the name of a function of this file; PROGRAM is taut_bench, or empty if it
could not be built.
"""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path[:0] = [str(ROOT / "script"), str(ROOT / "benchmarks")]

from measuring import compare, hills, joints, measure, page, wasm  # noqa: E402
from validation.runs import Problem  # noqa: E402

PROGRAM = sys.argv[1]
FEW = "(one|batch|stages)/.*/tetraspine3/|/(spine|footed)_4/|^hills/.*/six_strut@(plane|hills)/"


def bench(*words, **more):
    return subprocess.run([sys.executable, ROOT / "script/bench", *map(str, words)], capture_output=True, text=True,
                          **more)


def measured(folder, only=FEW):
    """Returns the path and the results of one short repetition of some benchmarks."""
    path = pathlib.Path(folder, "results.json")
    run = bench("--program", PROGRAM, "--repetitions", 1, "--seconds", 0.001, "--filter", only, "--json", path)
    assert run.returncode == 0, run.stderr
    return path, json.loads(path.read_text())


def elsewhere(only):
    """Returns the JSON output of the program for another MuJoCo."""
    return json.loads(subprocess.run([PROGRAM, "--mjcf", only], capture_output=True, check=True).stdout)


def WritesAListOfWhatItMeasured():
    with tempfile.TemporaryDirectory() as folder:
        _, results = measured(folder)
    assert results
    for item in results:
        for key, kind in {"engine": str, "robot": str, "worlds": int, "lanes": int, "threads": int,
                          "steps_per_s": float, "machine": dict}.items():
            assert isinstance(item[key], kind), (key, item)
        assert item["steps_per_s"] > 0, item
        assert item["machine"]["processor"], item
    engines = {"taut"} | {name for name in ("mujoco", "mujoco_wasm", "bullet", "ode")
                          if results[0]["machine"][name] not in ("not built in", wasm.ABSENT)}
    for robot in ("tetraspine3", "spine_4", "footed_4"):
        assert {item["engine"] for item in results if item["robot"] == robot} == engines, robot
    ours = [item for item in results if item["engine"] == "taut" and item["robot"] == "tetraspine3"]
    assert {1} < {item["lanes"] for item in ours}
    for item in ours:
        if item["kind"] == "stages":
            assert set(item["stages_ns"]) == set(page.STAGES), item
        else:
            assert item["bytes_per_world"] > 0 and item["contacts"] == 6 and item["converged"], item


def MakesThePageFromItsList():
    with tempfile.TemporaryDirectory() as folder:
        _, results = measured(folder)
    text = page.text(results)
    assert "{{" not in text
    for item in results:
        assert page.SETTINGS[item["engine"], item["setting"]] in text, item
    rate = page.Results(results).rate(kind="one", engine="taut", robot="tetraspine3")
    assert f"| taut | {page.number(rate)} | - | - |" in text
    assert page.one_world(results) in text
    assert hills.section(results) in text
    us = [1e6 / page.Results(results).rate(kind="hills", engine="taut", robot=f"six_strut@{ground}", lanes=1) for ground in ("plane", "hills")]
    assert f"| six_strut | {page.number(us[0])} | {page.number(us[1])} ({page.number(us[1] / us[0], 2)}x) | -" in text
    elsewhere = {**results[0], "machine": {**results[0]["machine"], "processor": "another"}}
    try:
        page.text([*results, elsewhere])
    except Problem as problem:
        assert str(problem) == "these results are of several machines or versions"
    else:
        raise AssertionError("results of two machines on one page")


def MakesTheSectionOnJointsAlone():
    with tempfile.TemporaryDirectory() as folder:
        _, results = measured(folder, "^joints/.*/(chain_16|puppy)/")
    text = joints.replaced("a\n\n### With joints\n\nold\n\n### Next\n\nb\n", results)
    assert text == f"a\n\n### With joints\n\n{joints.section(results)}\n\n### Next\n\nb\n"
    assert "{{" not in text
    assert {(item["robot"], item["joints"]) for item in results} == {("chain_16", 16), ("puppy", 8)}
    for item in results:
        solve = item["stages_ns"]["solve"] / item["joints"]
        assert item["linear_solves"] >= 1, item
        assert f"| {joints.number(solve)} | {joints.number(solve / item['linear_solves'])} |" in text, item


def MakesTheSectionOnHillsAlone():
    with tempfile.TemporaryDirectory() as folder:
        _, results = measured(folder, "^hills/.*/(six_strut@(plane|hills)|ball@level)/")
    text = hills.replaced("a\n\n### On hills, by the clock\n\nold\n\nold\n\n### Next\n\nb\n", results)
    assert text == f"a\n\n### On hills, by the clock\n\n{hills.section(results)}\n\n### Next\n\nb\n"
    assert "{{" not in text
    (row,) = (line for line in hills.Beside(results).worth().splitlines() if line.startswith("| taut |"))
    assert row == "| taut | 1 | < 0.001 |", row
    for item in results:
        if item["robot"] == "ball@level":
            assert 0.9 < item["speed_kept"] < 1.0001, item
        elif item["robot"] == "six_strut@hills" and item["engine"] != wasm.ENGINE:
            assert 0 <= item["deepest_m"] < 0.031, item
        assert hills.SETTINGS[item["engine"], item["setting"]] in text, item
    try:
        hills.replaced("### Other\n\n", results)
    except Problem as problem:
        assert str(problem) == "the page has no section ### On hills"
    else:
        raise AssertionError("a page without that section")


def AMujocoElsewhereGetsTheRobotAsText():
    (one,) = elsewhere("^one/.*pyramidal/tetraspine3/")
    assert one["name"] == "one/mujoco_wasm/euler_pyramidal/tetraspine3/1/1/1", one["name"]
    file = one["file"]
    tree = xml.etree.ElementTree.fromstring(file["mjcf"])
    # share/models/tetraspine3.yaml: three segments, four cables between neighbors and four from edge to edge per pair
    assert file["bodies"] == len(tree.findall("worldbody/body")) == 3
    assert len(tree.findall("tendon/spatial")) == 12 and len(tree.findall("worldbody/geom[@type='plane']")) == 1
    assert len(tree.find("keyframe/key").get("qvel").split()) == 18
    start = [float(word) for word in tree.find("keyframe/key").get("ctrl").split()]
    commands = file["rest_lengths_m"]
    assert len(commands) * file["control_steps"] * file["step_s"] == 1 and {len(row) for row in commands} == {12}
    for cable, length in enumerate(start):  # a sine of 2 %
        own = [row[cable] / length - 1 for row in commands]
        assert abs(max(own) - 0.02) < 1e-5 and abs(min(own) + 0.02) < 1e-5 and abs(sum(own)) < 1e-9, own
    free = xml.etree.ElementTree.fromstring(file["free"]["mjcf"])
    assert not free.findall("worldbody//geom") and len(free.findall("worldbody/body")) == 3


def AMujocoElsewhereIsTheSame():
    needs_webassembly()
    for item in wasm.measured("rates", json.dumps(elsewhere("^one/.*pyramidal|spine_4/|footed_4/")), 1, 0.001):
        assert item["steps_per_s"] > 0 and item["apart_m"] < 1e-12, item  # rounding of 100 steps
        assert item["contacts"] >= 3, item  # the robot stands


def AMujocoThatDiffersIsNotMeasured():
    needs_webassembly()
    good = elsewhere("^one/.*pyramidal/tetraspine3/")
    for change, said in ((lambda file: file.update(bodies=4), "18 speeds where 4 and the world are free"),
                         (lambda file: file["free"]["masses_kg"].__setitem__(0, 1), "body 0 has"),
                         (lambda file: file["free"]["positions_m"][2].__setitem__(1, 1), "after 100 steps without contacts"),
                         (lambda file: file["free"].update(mjcf=file["free"]["mjcf"].replace("-9.81", "-9.82")),
                          "after 100 steps without contacts"),
                         (lambda file: file.update(mjcf="<mujoco"), "XML")):
        bad = json.loads(json.dumps(good))
        change(bad[0]["file"])
        assert bad != good, said
        try:
            wasm.measured("rates", json.dumps(bad), 1, 0.001)
        except Problem as problem:
            assert said in str(problem), problem
        else:
            raise AssertionError(said)


def needs_webassembly():
    if wasm.version() == wasm.ABSENT:
        print("skipped: MuJoCo in WebAssembly is not there")
        sys.exit(0)


def WithoutNodeAllElseIsMeasured():
    with tempfile.TemporaryDirectory() as folder:
        pathlib.Path(folder, "git").symlink_to(shutil.which("git"))
        path = pathlib.Path(folder, "results.json")
        run = bench("--program", PROGRAM, "--repetitions", 1, "--seconds", 0.001, "--filter", "one/.*/tetraspine3/",
                    "--json", path, env={**os.environ, "PATH": folder})
        assert run.returncode == 0, run.stderr
        assert run.stderr.count("MuJoCo in WebAssembly is not measured: there is no node") == 1, run.stderr
        results = json.loads(path.read_text())
    assert results[0]["machine"]["mujoco_wasm"] == wasm.ABSENT
    assert "taut" in {item["engine"] for item in results} and wasm.ENGINE not in {item["engine"] for item in results}
    assert "MuJoCo 3 was not measured in this run" in page.text(results)


def BothMujocosStandBesideEachOther():
    def item(engine, rate, robot="six_strut", **more):
        return {"kind": "one", "engine": engine, "setting": "euler_pyramidal", "robot": robot, "steps_per_s": rate,
                "machine": {"mujoco_wasm": "3.1.4 (node v9)"}, **more}
    items = [item("mujoco", 200.0), item(wasm.ENGINE, 50.0, apart_m=2e-16), item("mujoco", 9.0, "tetraspine3")]
    assert "| pyramidal cones | - | - | 0.25x |" in page.mujocos(items), page.mujocos(items)
    text = " ".join(page.which_mujoco(items).split())
    assert "`@mujoco/mujoco` 3.1.4 (node v9): WebAssembly, one thread" in text and "distance was 2.0e-16 m" in text, text
    del items[1]["apart_m"]
    assert "no other one in this run to compare with" in " ".join(page.which_mujoco(items).split())


def ThePageSaysThatOthersWorkedThere():
    assert page.company({"load": [1.0], "cores": 2}) == ""
    assert "Other programs ran on the machine" in page.company({"load": [1.1], "cores": 2})


def SaysWhatIsWrong():
    run = bench("--program", PROGRAM, "--filter", "nothing_like_this")
    assert run.returncode == 2 and "script/bench:" in run.stderr and "nothing_like_this" in run.stderr, run
    run = bench("--from", "no_such_file.json", "--page")
    assert run.returncode == 2 and run.stderr.startswith("script/bench: no_such_file.json: "), run
    run = bench("--program", "no_such_program")
    assert run.returncode == 2 and "there is no no_such_program" in run.stderr, run
    run = bench("--compare", "a", "b", "c")
    assert run.returncode == 2 and "--compare takes one or two commits" in run.stderr, run
    run = bench("--compare", "no_such_commit")
    assert run.returncode == 2 and "no_such_commit" in run.stderr, run


def NumbersAreRoundedAndGrouped():
    for value, text in {1234567: "1 230 000", 999.6: "1 000", 123.4: "123", 12.34: "12.3", 0.001234: "0.00123",
                        0: "0"}.items():
        assert page.number(value) == text, (value, page.number(value))


def AMedianIsTakenOfTheRepetitions():
    context = {"load_avg": [0.5], "mujoco": "1", "bullet": "2", "ode": "3", "step_s": "0.001", "max_linear_solves": "10",
               "tolerance_m_per_s": "0.1"}
    runs = [{"name": "x", "run_name": "batch/taut/default/robot/128/8/2/real_time", "run_type": "iteration",
             "steps_per_s": rate} for rate in (1.0, 4.0, 2.0)]
    runs.append({**runs[0], "run_type": "aggregate"})
    (item,) = measure.results({"context": context, "benchmarks": runs})
    assert (item["steps_per_s"], item["repetitions"], item["spread"]) == (2.0, 3, 1.5), item
    assert (item["kind"], item["worlds"], item["lanes"], item["threads"]) == ("batch", 128, 8, 2), item
    runs[1] = {**runs[1], "error_occurred": True, "error_message": "it broke"}
    try:
        measure.results({"context": context, "benchmarks": runs})
    except Problem as problem:
        assert str(problem) == "x: it broke"
    else:
        raise AssertionError("an error went unseen")


def MoreInstructionsAreARegression():
    assert compare.verdict([("a", 1000, 1030), ("b", 1000, 900)])[0] == 0
    status, words = compare.verdict([("a", 1000, 1031), ("b", 1000, 900)])
    assert status == 1 and words == "more than 3 % more instructions: a", words


def main():
    if not PROGRAM:
        print("skipped: taut_bench was not built (libbenchmark-dev)")
        return
    globals()[sys.argv[2]]()


if __name__ == "__main__":
    main()
