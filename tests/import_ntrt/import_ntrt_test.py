"""Compares every structure of NTRT with a second reader (ntrt_reader.py) and, where available, with reference numbers
that do not depend on taut's import (expected.json).

Usage: import_ntrt_test.py TAUT TEST     TEST may be `table`, which prints the result of ten seconds for each file
"""

import json
import pathlib
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
import numpy  # noqa: E402
from ntrt_reader import read  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[1] / "data/ntrt/yaml"
FILES = sorted(ROOT.rglob("*.yaml"))
UNIT = 0.1
NO_FILE = "src/dev/ultra-spine/SpineKinematicsTest/TwoSegSpine.yaml"
NO_SOLIDS = "src/dev/ultra-spine/SpineKinematicsTest/TetrahedronSymmetricFixed.yaml"
NO_REST = "resources/YamlStructures/Spines/5PrismSpine.yaml"
CROSSING = "Double3Prism.yaml"  # its rods intersect each other
FINER = "3PrismSpine.yaml"      # rods are pulled onto each other: at 1 ms one solve does not converge
TIES = ["BigPuppy.yaml", "Centipede.yaml", "MountainGoat.yaml"]


def taut(*arguments):
    return subprocess.run([sys.argv[1], *map(str, arguments)], capture_output=True, text=True, check=False)


def imported(file, *flags, change=lambda text: text):
    """Imports a file. Returns the output of `taut check` for the model, or None if NTRT's rules leave no model."""
    with tempfile.TemporaryDirectory() as folder:
        model = pathlib.Path(folder) / "model.yaml"
        done = taut("import", "ntrt", file, "--length_unit_m", UNIT, "--out", model, *flags)
        if done.returncode != 0:
            return None, done
        model.write_text(change(model.read_text()))
        checked = taut("check", model, "--json")
        if "overlap by" in checked.stderr and file.name == CROSSING:
            model.write_text(model.read_text().replace("friction: ", "collides: false, friction: "))
            checked = taut("check", model, "--json")
        if checked.returncode != 0:
            return None, checked
        return json.loads(checked.stdout), done


def z_up(v):
    return UNIT * numpy.array([v[2], v[0], v[1]])


def same(found, expected, what, within=1e-9):
    found, expected = numpy.array(found, float), numpy.array(expected, float)
    scale = 1 + numpy.abs(expected).max(initial=0)
    if found.shape != expected.shape or (found.size and numpy.abs(found - expected).max() > within * scale):
        raise SystemExit(f"{what}: found {found.tolist()}, expected {expected.tolist()}")


def in_order(rows):
    """Sorts rows by values rounded to 1e-6, so that rows that differ by rounding have the same order."""
    return numpy.array(sorted(rows, key=lambda row: [round(x, 6) for x in row]), float)


def name_of(file):
    return str(file.relative_to(ROOT))


def lower_pretension(text):
    """Lowers the pretension of 5PrismSpine, which exceeds the force at zero rest length."""
    return text.replace("prestress_n: 300\n", "prestress_n: 30\n")


def all_but_one_import():
    for file in FILES:
        model, done = imported(file)
        if name_of(file) == NO_FILE:
            assert done.returncode == 3 and "there is no file" in done.stderr, done.stderr
            assert f"{file}:6:11: error:" in done.stderr, done.stderr
        elif name_of(file) == NO_REST:
            assert model is None and "would stretch the cable" in done.stderr, done.stderr
            said = taut("import", "ntrt", file, "--length_unit_m", UNIT).stderr
            assert "50 cables would start with a rest length of zero or less" in said and said.count("NTRT ends with an error") == 5, said
            assert imported(file, change=lower_pretension)[0]
        else:
            assert model, f"{file}: {done.stderr}"


def models_are_what_a_second_reader_finds():
    for file in FILES:
        if name_of(file) == NO_FILE:
            continue
        for flags in ([], ["--like_ntrt"]):
            change = lower_pretension if name_of(file) == NO_REST else str
            model, done = imported(file, *flags, change=change)
            if flags and name_of(file) == NO_SOLIDS:
                assert done.returncode == 3 and "build no solid" in done.stderr, done.stderr
                continue
            assert model, f"{file}: {done.stderr}"
            bodies, cables = read(file, bool(flags))
            what = f"{name_of(file)} {flags}: "
            mass = [sum(solid["mass"] for solid in body) for body in bodies]
            com = [sum(solid["mass"] * numpy.mean(solid["ends"], axis=0) for solid in body) / (m or 1)
                   for body, m in zip(bodies, mass)]
            assert [m == 0 for m in sorted(mass)] == [not b["fixed"] for b in
                                                      sorted(model["bodies"], key=lambda b: not b["fixed"])][::-1] or \
                sum(m == 0 for m in mass) == sum(b["fixed"] for b in model["bodies"]), what + "what stands still"
            same(in_order([[b["mass_kg"], *b["com_m"]] for b in model["bodies"] if not b["fixed"]]),
                 in_order([[m, *z_up(c)] for m, c in zip(mass, com) if m > 0]), what + "masses and centres")
            tied = file.name in TIES
            same(sorted(c["rest_length_m"] for c in model["cables"]),
                 sorted(UNIT * (c["rest"] if name_of(file) != NO_REST else c["length"] - 0.1 * (c["length"] - c["rest"]))
                        for c in cables), what + "rest lengths", 1e-2 if tied else 1e-9)
            same(sorted(c["stiffness_n_per_m"] for c in model["cables"]), sorted(c["stiffness"] for c in cables),
                 what + "stiffness")
            if tied:
                continue
            ends = in_order([[c for at in sorted([a["position_m"] for a in cable["attachments"]],
                                                 key=lambda p: [round(x, 6) for x in p]) for c in at]
                             for cable in model["cables"]])
            theirs = in_order([[c for at in sorted([list(z_up(cable["from"])), list(z_up(cable["to"]))],
                                                   key=lambda p: [round(x, 6) for x in p]) for c in at]
                               for cable in cables])
            same(ends, theirs, what + "ends of cables")


def models_have_the_numbers_expected_of_them():
    for name, of in json.loads((ROOT / "expected.json").read_text())["files"].items():
        what = name + ": "
        change = lower_pretension if name == NO_REST else str
        model, done = imported(ROOT / name, "--like_ntrt", change=change)
        if name == NO_SOLIDS:
            assert of["bodies"] == 0 and done.returncode == 3, done.stderr
            continue
        assert model, what + done.stderr
        moving = sorted(b["mass_kg"] for b in model["bodies"] if not b["fixed"])
        assert len(model["bodies"]) == of["bodies"] and len(model["cables"]) == of["cables"], what + "counts"
        same(sum(moving), of["total_mass"], what + "mass")
        masses = [m for m in of["body_masses"] if m]
        if "..." not in masses:
            same(moving, masses, what + "masses", 1e-11)
        com = sum(b["mass_kg"] * numpy.array(b["com_m"]) for b in model["bodies"] if not b["fixed"]) / sum(moving)
        same(com, z_up(of["com"]), what + "centre of mass")
        within = 1e-2 if of["ends_with_tied_choice"] else 1e-9
        same(sum(c["length_m"] for c in model["cables"]), UNIT * of["sum_length"], what + "lengths", within)
        if name != NO_REST:
            rest = sorted(UNIT * r for r in [c["rest_length_m"] / UNIT for c in model["cables"]])
            same(sum(rest), UNIT * of["sum_rest_length"], what + "rest lengths", within)
            if rest:
                same([rest[0], rest[-1]], [UNIT * of["min_rest_length"], UNIT * of["max_rest_length"]],
                     what + "least and most", within)
            if "rest_lengths_sorted" in of:
                same(rest, [UNIT * r for r in of["rest_lengths_sorted"]], what + "sorted")
        pretension = sum(c["tension_n"] for c in model["cables"])
        same(pretension * (10 if name == NO_REST else 1), UNIT * of["sum_pretension"], what + "pretension", 1e-9)


def ten_seconds(file):
    """Runs the model on level ground, 1 mm above it at the start. Returns its parts and the summary of `taut run`."""
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        done = taut("import", "ntrt", file, "--length_unit_m", UNIT, "--out", folder / "model.yaml")
        if done.returncode != 0:
            return None, "a file that it includes is missing"
        bodies, cables = read(file)
        low = min(end[1] - solid.get("radius", 0) for body in bodies for solid in body for end in solid["ends"])
        (folder / "run.yaml").write_text(
            "taut: 1\nkind: experiment\nname: run\nmodel: model.yaml\nduration_s: 10\n"
            f"step_s: {0.0005 if file.name == FINER else 0.001}\n"
            f"place: {{at_m: [0, 0, {0.001 - UNIT * low}]}}\n"
            "terrain: [{name: ground, plane: {height_m: 0, friction: 0.5}}]\nrecord: {rate_hz: 10}\n")
        done = taut("run", folder / "run.yaml", "--out", folder / "run")
        what = (len(bodies), len(cables), sum(s["mass"] for b in bodies for s in b),
                UNIT * max((c["pretension"] for c in cables), default=0))
        summary = folder / "run/summary.json"
        if done.returncode == 3:
            return what, done.stderr.splitlines()[0].split("error: ")[1]
        return what, json.loads(summary.read_text())["status"] if summary.exists() else done.stderr


def runs(files):
    for file in files:
        what, said = ten_seconds(file)
        if name_of(file) in (NO_FILE, NO_REST) or file.name == CROSSING:
            assert said != "ok", file
        else:
            assert said == "ok", f"{file}: {said}"


def some_run():
    runs(ROOT / "resources/YamlStructures" / name for name in
         ("BaseStructures/3Prism.yaml", "Spines/SuperBallSpine.yaml", "Spines/TetrahedralSpine.yaml", "Double3Prism.yaml"))


def all_run():
    runs(FILES)


def table():
    print("| file | bodies | cables | kg | largest pretension [N] | 10 s |\n|---|---|---|---|---|---|")
    for file in FILES:
        what, said = ten_seconds(file)
        name = name_of(file).replace("resources/YamlStructures/", "").replace("src/dev/", "")
        numbers = f"{what[0]} | {what[1]} | {what[2]:.4g} | {what[3]:.4g}" if what else "| | |"
        print(f"| `{name}` | {numbers} | {said} |", flush=True)


if __name__ == "__main__":
    globals()[sys.argv[2]]()
