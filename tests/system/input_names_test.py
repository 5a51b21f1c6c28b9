"""Commands accept input files by path, folder and name, all in the same way

Usage: input_names_test.py TEST TAUT. TEST is the name of a function of this file.
"""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]

# Shipped files of each kind
SHIPPED = {"model": "models/six_strut.yaml", "experiment": "experiments/push_20n.yaml",
           "gait": "gaits/hand_tuned_sine.yaml", "study": "studies/sidewinder3.yaml",
           "fit": "fits/tetraspine3_push.yaml"}

# Commands and the kinds of files that they read. A parameter that no file has ends them after reading, before they
# compute anything.
REFUSED = ["--set", "no_such_number=1"]
READING = [
    (["analyze", "FILE", *REFUSED], ("model", "experiment")),
    (["check", "FILE", *REFUSED], ("model", "experiment", "study", "fit")),
    (["export", "mjcf", "FILE", *REFUSED], ("model", "experiment")),
    (["export", "shape", "FILE", "--out", "shape.stl", *REFUSED], ("model", "experiment")),
    (["export", "structure", "FILE", "--out", "structure", *REFUSED], ("model", "experiment")),
    (["fit", "FILE", *REFUSED], ("fit",)),
    (["gait", "create", "FILE", *REFUSED], ("model", "experiment")),
    (["gait", "export", "GAIT", "FILE", *REFUSED], ("model", "experiment")),
    (["learn", "FILE", *REFUSED], ("study",)),
    (["learn", "--parameters", "FILE", *REFUSED], ("experiment",)),
    (["run", "FILE", *REFUSED], ("experiment",)),
    (["view", "FILE", *REFUSED], ("model", "experiment")),
]
READING_GAITS = [["check", "FILE"], ["gait", "values", "FILE"]]
READING_TRACES = [
    ["analyze", "sam/model.yaml", "--pose", "TRACE"],
    ["compare", "TRACE", "TRACE"],
    ["export", "structure", "sam/model.yaml", "--out", "structure", "--pose", "TRACE"],
    ["report", "TRACE"],
    ["report", "TRACE", "--compare", "TRACE"],
    ["run", "sam/drop.yaml", "--replay", "TRACE", "--out", "replayed"],
    ["size", "TRACE"],
    ["trace", "convert", "TRACE", "--out", "trace.csv"],
]


def call(taut, words, folder):
    pages = folder / "pages"
    pages.mkdir(exist_ok=True)
    for page in ("index.html", "report.html"):
        (pages / page).write_text("<script type=\"application/json\" id=\"taut-report\"></script>")
    done = subprocess.run([taut, *words], cwd=folder, capture_output=True, text=True, check=False, timeout=120,
                          env={**os.environ, "TAUT_WEB": str(pages)})
    return done.returncode, done.stdout + done.stderr


def forms(kind):
    """Returns the ways to refer to a shipped file: with and without folder and extension."""
    path = pathlib.Path(SHIPPED[kind])
    return [str(path), str(path.with_suffix("")), path.name, path.stem]


def EveryCommandAcceptsNamesAndFolders(taut, folder):
    shutil.copytree(ROOT / "share/robots/six_bar", folder / "sam")
    for words, kinds in READING:
        for kind in kinds:
            given = forms(kind)
            if kind in ("model", "study"):
                given.append("sam")  # the folder's only file of this kind
            for form in given:
                filled = [{"FILE": form, "GAIT": "hand_tuned_sine"}.get(word, word) for word in words]
                status, said = call(taut, filled, folder)
                assert status == 3 and '"no_such_number"' in said, f"{filled}: status {status}\n{said}"
    for words in READING_GAITS:
        for form in [*forms("gait"), "sam/gait.yaml", "sam/gait"]:
            filled = [form if word == "FILE" else word for word in words]
            status, said = call(taut, filled, folder)
            assert status == 0, f"{filled}: status {status}\n{said}"
    status, said = call(taut, ["run", "sam/drop", "--duration_s", "0.1", "--out", "runs/fall"], folder)
    assert status == 0, said
    for words in READING_TRACES:
        for form in ("runs/fall", "runs/fall/", "runs/fall/trace.h5"):
            filled = [form if word == "TRACE" else word for word in words]
            status, said = call(taut, filled, folder)
            assert status == 0, f"{filled}: status {status}\n{said}"
    status, said = call(taut, ["run", "runs/fall", "--quiet"], folder)  # its inputs, again
    assert status == 0, said


def AFolderWithSeveralFilesIsAnError(taut, folder):
    shutil.copytree(ROOT / "share/robots/six_bar", folder / "sam")
    status, said = call(taut, ["run", "sam"], folder)
    assert status == 2, said
    assert ("sam: the folder contains several files of the kind experiment: drop.yaml, push.yaml, roll.yaml "
            "(name one of them, such as sam/drop.yaml)") in said, said
    status, said = call(taut, ["learn", "--parameters", "sam"], folder)
    assert status == 2 and "several files of the kind experiment" in said, said
    (folder / "empty").mkdir()
    status, said = call(taut, ["check", "empty"], folder)
    assert status == 3 and "empty" in said, said
    (folder / "sam/model.yaml").write_text("kind: [")  # a file with errors is still the model
    status, said = call(taut, ["check", "sam"], folder)
    assert status == 3 and said.startswith("sam/model.yaml:1:"), said


def LocalFilesComeFirst(taut, folder):
    model = (ROOT / "share/models/hanging_mass.yaml").read_text()
    (folder / "six_strut.yaml").write_text(model)
    status, said = call(taut, ["check", "six_strut"], folder)
    assert status == 0 and said.startswith("six_strut.yaml: good: model hanging_mass"), said
    status, said = call(taut, ["check", "models/six_strut"], folder)
    assert status == 0 and "good: model six_strut" in said, said


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as work:
        globals()[sys.argv[1]](pathlib.Path(sys.argv[2]).resolve(), pathlib.Path(work))
