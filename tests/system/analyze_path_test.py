"""Load-displacement paths of `taut analyze --path`: a shallow tripod against its closed form

Usage: analyze_path_test.py TEST TAUT. TEST is the name of a function of this file.
"""

import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile

TAUT = sys.argv[2]
STIFFNESS, RISE_M = 4e4, 0.25

# Three bars from supports on a circle of radius 1 m to a mass 0.25 m above it
MODEL = f"""\
taut: 1
kind: model
name: tripod
nodes:
  p0: [1, 0, 0]
  p1: [-0.5, sqrt(0.75), 0]
  p2: [-0.5, -sqrt(0.75), 0]
  top: [0, 0, {RISE_M}]
pairs:
  - {{tags: [bar], each: [[p0, top], [p1, top], [p2, top]]}}
builders:
  - {{match: [[p0], [p1], [p2]], anchor: {{}}}}
  - {{match: top, point_mass: {{mass_kg: 1, radius_m: 0.02}}}}
  - {{match: bar, bar: {{stiffness_n_per_m: {STIFFNESS}}}}}
"""
EXPERIMENT = """\
taut: 1
kind: experiment
name: tripod
model: tripod.yaml
duration_s: 1
load_cases:
  - {name: press, weight: false, forces: [{node: top, force_n: [0, 0, -100]}]}
"""


def analyze(*flags, status=0):
    with tempfile.TemporaryDirectory() as folder:
        (pathlib.Path(folder) / "tripod.yaml").write_text(MODEL, encoding="utf-8")
        (pathlib.Path(folder) / "loads.yaml").write_text(EXPERIMENT, encoding="utf-8")
        done = subprocess.run([TAUT, "analyze", "loads.yaml", *flags], cwd=folder, capture_output=True, text=True)
    assert done.returncode == status, (done.returncode, done.stdout, done.stderr)
    return done


def limit_factor():
    """Load factor of the first limit point: 3 k l0 (1 - cos^(2/3) a0)^(3/2) over 100 N."""
    l0 = math.hypot(1, RISE_M)
    return 3 * STIFFNESS * l0 * (1 - (1 / l0) ** (2 / 3)) ** 1.5 / 100


def APathSnapsThrough():
    path = json.loads(analyze("--path", "--to_factor", "10", "--json").stdout)["paths"][0]
    assert path["reached_end"] and path["load_case"] == "press"
    l0 = math.hypot(1, RISE_M)
    for point in path["points"]:
        z = RISE_M - point["displacement_m"]
        length = math.hypot(1, z)
        assert abs(point["load_factor"] - 3 * STIFFNESS * (l0 - length) * z / length / 100) < 1e-6
    limits = [point["load_factor"] for point in path["points"] if point["limit"]]
    assert len(limits) == 2 and all(abs(abs(f) - limit_factor()) < 1e-7 for f in limits), limits
    assert abs(path["points"][-1]["load_factor"] - 10) < 1e-9


def TheSummaryNamesTheLimitPoint():
    text = analyze("--path", "--to_factor", "10").stdout
    found = re.search(r"load case press: limit point at load factor ([\d.]+)", text)
    assert abs(float(found.group(1)) - limit_factor()) < 1e-4, text
    assert "unstable" in text and "stable" in text


def WrongFlagsAreRefused():
    assert "--to_factor requires --path" in analyze("--to_factor", "3", status=2).stderr
    for other in (["--page", "a.html"], ["--inverse"], ["--modes", "3"]):
        assert "excludes" in analyze("--path", *other, status=2).stderr


globals()[sys.argv[1]]()
