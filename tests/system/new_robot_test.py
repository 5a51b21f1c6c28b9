"""Folders that `taut new robot` writes: every file is valid, runs, and does what its comments promise

Usage: new_robot_test.py TEST TAUT. TEST is the name of a function of this file. Exit status 77: a Python module is
missing.
"""

import csv
import importlib.util
import json
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
TEMPLATES = sorted(path.name for path in (ROOT / "share/robots").iterdir())
SKIPPED = 77


def call(taut, *words, status=0, cwd=None):
    done = subprocess.run([taut, *map(str, words)], capture_output=True, text=True, check=False, cwd=cwd)
    assert done.returncode == status, f"{words} ended with status {done.returncode}:\n{done.stdout}{done.stderr}"
    return done.stdout + done.stderr


def new_robot(taut, like, folder):
    call(taut, "new", "robot", "sam", "--like", like, cwd=folder)
    return folder / "sam"


def rows_of(taut, experiment, folder):
    """Runs an experiment. Returns the rows of its trace."""
    call(taut, "run", experiment, "--quiet", "--csv", "--out", folder / "run")
    with open(folder / "run/trace.csv", newline="") as file:
        return list(csv.DictReader(file))


def distance_m(taut, experiment, folder):
    """Runs an experiment. Returns the horizontal distance of the center of mass from start to end."""
    rows = rows_of(taut, experiment, folder)
    ends = [[float(row[f"system/com_{axis}_m"]) for axis in "xy"] for row in (rows[0], rows[-1])]
    return math.dist(*ends)


def EveryFileOfEveryTemplateIsValid(taut, folder):
    for like in TEMPLATES:
        (folder / like).mkdir()
        robot = new_robot(taut, like, folder / like)
        assert {"model.yaml", "README.md", "notebook.ipynb"} <= {path.name for path in robot.iterdir()}, like
        for file in sorted(robot.glob("*.yaml")):
            said = call(taut, "check", file, "--strict")
            assert ": good: " in said and "\nnext: taut " in said, said
        said = call(taut, "check", robot)  # the folder stands for its model
        assert "good: model sam," in said, said


def NothingOfTheTemplateIsLeft(taut, folder):
    for like in TEMPLATES:
        (folder / like).mkdir()
        for file in new_robot(taut, like, folder / like).iterdir():
            text = file.read_text()
            assert "my_robot" not in text and "../schema" not in text, file
            schema = re.match(r"# yaml-language-server: \$schema=(.*)\n", text)
            assert file.suffix != ".yaml" or pathlib.Path(schema[1]).is_file(), file


def EveryExperimentRuns(taut, folder):
    for like in TEMPLATES:
        for file in sorted((ROOT / "share/robots" / like).glob("*.yaml")):
            if "\nkind: experiment\n" not in file.read_text():
                continue
            summary = json.loads(call(taut, "run", file, "--json", "--out", folder / "run"))
            assert summary["status"] == "ok", f"{file}: {summary['status']}"


def EveryModelStands(taut, folder):
    for like in TEMPLATES:
        said = call(taut, "analyze", ROOT / "share/robots" / like / "model.yaml")
        verdict = said.splitlines()[0]
        assert verdict.startswith("my_robot stands"), said
        assert like == "quadruped" or not re.search("states of self-stress: 0", said), said


def LoadsOfTheTowerHaveSafetyFactors(taut, folder):
    said = call(taut, "analyze", ROOT / "share/robots/tower/loads.yaml")
    rows = re.findall(r"^  \w+ +[\d.]+ node \S+ +([\d.]+) (?:strength|yield|buckling) ", said, re.MULTILINE)
    factors = [float(factor) for factor in rows]
    assert len(factors) == 4 and all(2 < factor < 50 for factor in factors), said
    shown = call(taut, "analyze", ROOT / "share/robots/tower/loads.yaml", "--out", folder / "shapes")
    assert (folder / "shapes/settlement/mode_1/trace.h5").exists(), shown


def TheReadmesHaveTheDistancesOfTheFirstGaits(taut, folder):
    found = []
    for like in TEMPLATES:
        text = (ROOT / f"share/robots/{like}/README.md").read_text()
        for file, stated_m in re.findall(r"taut run (\w+\.yaml) +#.*: ([\d.]+) m in", text):
            moved_m = distance_m(taut, ROOT / "share/robots" / like / file, folder)
            assert f"{moved_m:.2f}" == stated_m, f"{like}: {moved_m} m, README: {stated_m} m"
            found.append(like)
    assert found == ["quadruped", "six_bar", "spine", "three_bar"], found


def TheQuadrupedWalksAheadAndUpright(taut, folder):
    """With its first gait, and with the best of the first 16 gaits of its study."""
    robot = new_robot(taut, "quadruped", folder)
    study = robot / "learn.yaml"
    study.write_text(study.read_text().replace("evaluations: 64", "evaluations: 16"))
    call(taut, "learn", study, "--quiet", "--out", folder / "learn")
    call(taut, "learn", "--best", folder / "learn", "--quiet")
    for experiment, least_m in ((robot / "trot.yaml", 0.5), (folder / "learn/best/inputs.yaml", 0.7)):
        rows = rows_of(taut, experiment, folder)
        ahead_m, aside_m, fall_m = (float(rows[-1][name]) - float(rows[0][name])
                                    for name in (f"system/com_{axis}_m" for axis in "xyz"))
        assert ahead_m > least_m and abs(aside_m) < 0.25 * ahead_m and abs(fall_m) < 0.02, (ahead_m, aside_m, fall_m)
        for row in rows:
            x, y = (float(row[f"body/vertebra_1/orientation_{axis}"]) for axis in "xy")
            tilt_rad = math.acos(1 - 2 * (x * x + y * y))
            assert tilt_rad < math.radians(6), f"{experiment}: {tilt_rad} rad at {row['time_s']} s"


def LearningMovesTheRobot(taut, folder):
    """A quarter of each study already moves its robot farther than the gait it starts from."""
    for like, move in (("six_bar", "roll"), ("three_bar", "crawl"), ("spine", "crawl")):
        robot = new_robot(taut, like, folder)
        before_m = distance_m(taut, robot / f"{move}.yaml", folder)
        study = robot / "learn.yaml"
        text, count = re.subn(r"evaluations: (\d+)", lambda found: f"evaluations: {int(found[1]) // 4}",
                              study.read_text())
        assert count == 1, like
        study.write_text(text)
        call(taut, "learn", study, "--quiet", "--out", folder / "learn")
        call(taut, "learn", "--best", folder / "learn", "--quiet")
        after_m = distance_m(taut, folder / "learn/best/inputs.yaml", folder)
        assert after_m > 1.5 * before_m, f"{like}: {before_m} m, then {after_m} m"
        for name in ("sam", "learn"):
            os.rename(folder / name, folder / f"{like}_{name}")


def AllConflictsAreReportedAndNothingIsOverwritten(taut, folder):
    robot = new_robot(taut, "prism", folder)
    (robot / "push.yaml").unlink()
    (robot / "model.yaml").write_text("mine")
    said = call(taut, "new", "robot", "sam", "--like", "prism", status=3, cwd=folder)
    lines = said.splitlines()
    assert lines[0] == "sam: error: the folder exists already, and nothing is overwritten", said
    assert lines[1:] == [f"sam/{name}: error: the file exists already"
                         for name in ("README.md", "drop.yaml", "model.yaml", "notebook.ipynb")], said
    assert (robot / "model.yaml").read_text() == "mine" and not (robot / "push.yaml").exists()
    (folder / "file").write_text("mine")
    said = call(taut, "new", "robot", "file", status=3, cwd=folder)
    assert said == "file: error: a file of this name exists already, and nothing is overwritten\n", said


def WrongArgumentsAreRefused(taut, folder):
    said = call(taut, "new", "robot", "sam", "--like", "prisms", status=2, cwd=folder)
    assert "\"prisms\" is unknown (did you mean \"prism\"?)" in said, said
    said = call(taut, "new", "model", "sam", "--like", "prism", status=2, cwd=folder)
    assert "--like needs a robot" in said, said
    assert not list(folder.iterdir())


def NotebooksRun(taut, folder):
    for module in ("taut", "numpy", "matplotlib"):
        if importlib.util.find_spec(module) is None:
            print(f"skipped: there is no Python module {module}")
            return SKIPPED
    features = subprocess.run([taut, "--version", "--features"], capture_output=True, text=True, check=True).stdout
    has_pages = "viewer's pages: yes" in features
    for like in TEMPLATES:
        (folder / like).mkdir()
        robot = new_robot(taut, like, folder / like)
        cells = json.loads((robot / "notebook.ipynb").read_text())["cells"]
        code = [cell["source"] for cell in cells if cell["cell_type"] == "code"]
        assert "taut.view(ran)" in code, like
        program = "\n".join(source for source in code if has_pages or "taut.view(" not in source)
        done = subprocess.run([sys.executable, "-c", program], cwd=robot, capture_output=True, text=True, check=False,
                              env=dict(os.environ, MPLBACKEND="Agg", MPLCONFIGDIR=str(folder)))
        assert done.returncode == 0 and "largest tension" in done.stdout, f"{like}:\n{done.stdout}{done.stderr}"
    return 0


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as work:
        sys.exit(globals()[sys.argv[1]](pathlib.Path(sys.argv[2]).resolve(), pathlib.Path(work)) or 0)
