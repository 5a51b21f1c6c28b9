"""Pages of `taut analyze --page`: their data against the output of `taut analyze --json`

Usage: analyze_page_test.py TEST TAUT. TEST is the name of a function of this file; status 77: the pages are not built.
"""

import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
TAUT = sys.argv[2]

# A mass on two bars in line, which resist no motion across them
MECHANISM = """\
taut: 1
kind: model
name: toggle
nodes: {left: [-0.5, 0, 1], mid: [0, 0, 1], right: [0.5, 0, 1]}
pairs:
  - {each: [[left, mid], [mid, right]], tags: [bar]}
builders:
  - {match: left, anchor: {}}
  - {match: right, anchor: {}}
  - {match: mid, point_mass: {mass_kg: 1, radius_m: 0.02}}
  - {match: bar, bar: {stiffness_n_per_m: 1000}}
"""
EXPERIMENT = """\
taut: 1
kind: experiment
name: toggle
model: toggle.yaml
duration_s: 1
load_cases: [{name: nothing, weight: false}]
"""


def run(*words, folder, status=0):
    done = subprocess.run([TAUT, "analyze", *words], cwd=folder, capture_output=True, text=True)
    if "pages were not built" in done.stderr or "has no index.html" in done.stderr:
        sys.exit(77)
    assert done.returncode == status, (done.returncode, done.stdout, done.stderr)
    return done


def analyzed(model, *flags, status=0):
    """Returns the page's data, the JSON output and the page."""
    with tempfile.TemporaryDirectory() as folder:
        done = run(model, *flags, "--page", "page.html", folder=folder, status=status)
        assert "\nPage: page.html\nnext: xdg-open page.html\n" in done.stdout, done.stdout
        page = (pathlib.Path(folder) / "page.html").read_text(encoding="utf-8")
        result = json.loads(run(model, *flags, "--json", folder=folder, status=status).stdout)
    data = re.search(r'<script[^>]*id="taut-report"[^>]*>(.*?)</script>', page, re.S).group(1)
    return json.loads(data), result, page


def members_of(case, data, kind):
    """Returns forces and utilizations on the page by member name."""
    scene = data["scene"]
    if kind == "cable":
        names, forces = [c["name"] for c in scene["cables"]], case["cables"][::4]
        uses = case["cable_use"]
    elif kind == "rod":
        names, forces, uses = [b["name"] for b in scene["bodies"]], case["body_force_n"], case["body_use"]
    else:
        names, forces, uses = [j["name"] for j in scene["joints"]], case["joint_force_n"], case["joint_use"]
    return {n: (f, u) for n, f, u in zip(names, forces, uses)}


def compare(data, result):
    assert [c["name"] for c in data["cases"]] == [c["name"] for c in result["load_cases"]]
    for shown, case in zip(data["cases"], result["load_cases"]):
        if not case["found"]:
            assert case["why"] in shown["reason"] and "displacement" not in shown
            continue
        for member in case["members"]:
            force, use = members_of(shown, data, member["kind"])[member["name"]]
            low, high = member.get("least_force_n", member.get("tension_n")), member.get("greatest_force_n", member.get("tension_n"))
            assert force == (low if abs(low) > abs(high) else high)
            factors = [member[k] for k in ("buckling_factor", "yield_factor", "strength_factor") if member[k] is not None]
            assert (use is None) == (not factors), member
            assert not factors or use == 1 / min(factors), member
        assert shown["reactions"] == [x for r in case["reactions"] for x in r["point_m"] + r["force_n"]]
        for index, (body, at) in enumerate(zip(data["scene"]["bodies"], case["bodies"])):
            assert body["name"] == at["name"]
            moved = shown["displacement"]["translation_m"][index]
            assert all(math.isclose(d + p, q, abs_tol=1e-12) for d, p, q in zip(moved, body["position_m"], at["position_m"]))
        if "modes" in case:
            modes = [m for m in case["modes"]["modes"] if m["kind"] != "rigid"]
            assert [(m["kind"], m["frequency_hz"]) for m in modes] == [(m["kind"], m["frequency_hz"]) for m in shown["modes"]]


def ThePageOfABridgeHasTheLoadCasesOfTheJson():
    data, result, page = analyzed(str(ROOT / "share/experiments/bridge_crowd.yaml"), "--modes", "3")
    compare(data, result)
    assert len(data["cases"]) == 8 and data["tables"][0]["rows"][8][0] == "ultimate"
    assert any(use is not None for use in data["cases"][0]["cable_use"])
    assert not re.search(r'(src|href)="?https?:', page), "the page is self-contained"
    assert len(page) < 2_000_000, len(page)


def AModelWithoutLoadsHasItsSelfStressAndModes():
    data, result, _ = analyzed(str(ROOT / "share/models/prism3.yaml"))
    compare(data, result)
    described = {c["name"]: c for c in data["described"]}
    state = described["self-stress 1, all cables in tension"]
    told = result["as_described"]
    forces = {m["name"]: f for m, f in zip(told["members"], told["self_stress"][0]["force_n"]) if m["kind"] == "cable"}
    for name, force in forces.items():
        assert members_of(state, data, "cable")[name][0] == force
    assert len(described["mechanisms"]["modes"]) == len(told["mechanisms"]) > 0


def AMechanismHasNoFrequencyAndAPage():
    with tempfile.TemporaryDirectory() as folder:
        (pathlib.Path(folder) / "toggle.yaml").write_text(MECHANISM, encoding="utf-8")
        experiment = pathlib.Path(folder) / "loads.yaml"
        experiment.write_text(EXPERIMENT, encoding="utf-8")
        data, result, _ = analyzed(str(experiment))
        compare(data, result)
        kinds = [m["kind"] for m in data["cases"][0]["modes"]]
        assert kinds == ["mechanism", "mechanism", "elastic"], kinds
        mechanisms = data["described"][0]
        assert mechanisms["name"] == "mechanisms"
        assert [m["frequency_hz"] for m in mechanisms["modes"]] == [0, 0]


def ThePageExcludesOtherAnalyses():
    with tempfile.TemporaryDirectory() as folder:
        for flag in ("--inverse", "--form"):
            done = run(str(ROOT / "share/models/prism3.yaml"), flag, "--page", "page.html", folder=folder, status=2)
            assert "--page excludes" in done.stderr or "excludes --page" in done.stderr, done.stderr


globals()[sys.argv[1]]()
