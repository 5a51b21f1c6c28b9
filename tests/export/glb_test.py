"""glTF files of `taut export shape`, checked by the Khronos Group's validator and three.js

Usage: glb_test.py TEST TAUT. TEST is the name of a function of this file; status 77: a required program is missing.
"""

import json
import math

import command as run

ROOT = run.ROOT
NEEDS = ["gltf-validator", "three"]


def look(taut, folder, model, *words):
    run.taut(taut, folder, "export", "shape", model, "--out", "out.glb", *words)
    return run.node("read_glb.mjs", folder / "out.glb", needs=NEEDS)


def TheValidatorFindsNothing(taut, folder):
    for name in ("prism3", "tetraspine3", "puppy", "superball_payload", "superball_probe", "t3_prism"):
        path = ROOT / "share/models" / f"{name}.yaml"
        issues = look(taut, folder, path)["issues"]
        assert issues == [], (name, issues)


def ThreeLoadsWhatTheModelSays(taut, folder):
    model = ROOT / "share/models" / "prism3.yaml"
    seen = look(taut, folder, model, "--cable_radius_m", "0.001")
    said = json.loads(run.taut(taut, folder, "check", model, "--json"))
    names = [mesh["name"] for mesh in seen["meshes"]]
    for cable in said["cables"]:
        assert cable["name"] in names, names
    for body in said["bodies"]:
        assert body["name"] in seen["nodes"], seen["nodes"]
    by_name = {mesh["name"]: mesh for mesh in seen["meshes"]}
    # The volume of a cable's mesh equals the volume of a cylinder of its length.
    for cable in said["cables"]:
        volume = math.pi * 1e-6 * cable["length_m"]
        assert abs(by_name[cable["name"]]["volume"] - volume) < 1e-4 * volume
        assert by_name[cable["name"]]["material"] == "cable"
    rod = by_name["strut_0.bottom-top"]
    ends = {node["name"]: node["position_m"] for node in said["nodes"]}
    radius, length = said["parameters"]["rod_radius_m"], math.dist(ends["strut_0.bottom"], ends["strut_0.top"])
    volume = math.pi * radius**2 * (length + 4 / 3 * radius)
    assert abs(rod["volume"] - volume) < 1e-4 * volume, (rod["volume"], volume)
    assert rod["material"] == "rod" and rod["parent"] == "strut_0"
    # The color is #39414b (sRGB); glTF stores linear light.
    light = [((c / 255 + 0.055) / 1.055) ** 2.4 for c in (0x39, 0x41, 0x4B)]
    assert all(abs(a - b) < 1e-6 for a, b in zip(rod["colour"], light)), rod["colour"]


def APoseAndAScaleAreWhereTheyShouldBe(taut, folder):
    experiment = ROOT / "share/experiments" / "drop_six_strut.yaml"
    run.taut(taut, folder, "run", experiment, "--duration_s", "0.5", "--quiet", "--csv", "--out", "run")
    rows = (folder / "run" / "trace.csv").read_text().splitlines()
    head = rows[0].split(",")
    at = dict(zip(head, map(float, rows[20].split(","))))
    seen = look(taut, folder, experiment, "--pose", "run/trace.csv", "--at_s", str(at["time_s"]), "--scale", "10")
    for name, place in seen["places"].items():
        if f"body/{name}/position_x_m" not in at:
            continue
        x, y, z = (at[f"body/{name}/position_{axis}_m"] for axis in "xyz")
        # glTF's up axis is y.
        assert all(abs(a - b) < 1e-5 for a, b in zip(place, (10 * x, 10 * z, -10 * y))), (name, place, x, y, z)
    assert any(f"body/{name}/position_x_m" in at for name in seen["places"])
    # The center of a rod's mesh is the center of its body.
    for mesh in seen["meshes"]:
        if mesh["material"] == "rod":
            assert all(abs(a - b) < 1e-4 for a, b in zip(mesh["middle"], seen["places"][mesh["parent"]])), mesh


def WhatIsWrongIsSaid(taut, folder):
    prism = ROOT / "share/models" / "prism3.yaml"
    assert "unknown format" in run.taut(taut, folder, "export", "shape", prism, "--out", "x.obj", status=2)
    assert "--out" in run.taut(taut, folder, "export", "shape", prism, status=2)
    for wrong in ("0", "-1", "nan", "x"):
        run.taut(taut, folder, "export", "shape", prism, "--out", "x.stl", "--scale", wrong, status=2)
    run.taut(taut, folder, "export", "shape", prism, "--out", "x.stl", "--cable_radius_m=-1", status=2)
    run.taut(taut, folder, "export", "shape", "no.yaml", "--out", "x.stl", status=3)
    run.taut(taut, folder, "export", "shape", prism, "--out", "no/x.stl", status=1)
    (folder / "point.yaml").write_text(
        "taut: 1\nkind: model\nname: p\nnodes: {a: [0, 0, 1]}\nbuilders:\n  - {match: a, point_mass: {mass_kg: 1}}\n"
    )
    complaint = run.taut(taut, folder, "export", "shape", "point.yaml", "--out", "x.stl", status=3)
    assert "no shapes and no cables" in complaint, complaint
    assert not (folder / "x.stl").exists() and not (folder / "x.obj").exists()


if __name__ == "__main__":
    run.main(globals())
