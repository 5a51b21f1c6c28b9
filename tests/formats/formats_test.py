"""Reads files of every format as written by earlier releases.

Usage: formats_test.py TAUT TEST. TEST is the name of a function of this file; it runs for each folder next to this
file. Each folder is named after a release. Its files are never changed. A new release makes its folder in a copy of the
previous release's descriptions:

  taut run experiment.yaml --csv --quiet --out run; taut learn study.yaml --threads 1 --quiet --out study
  rm -f */.lock study/experiment.yaml; gzip -9n run/trace.h5 study/study.sqlite
"""

import gzip
import json
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import urllib.request

HERE = pathlib.Path(__file__).resolve().parent
TAUT = pathlib.Path(sys.argv[1]).resolve()
PAGES = (TAUT.parent / "web/report.html").exists()


class Skipped(Exception):
    """Reason for skipping a test"""


def taut(folder, *words, status=0):
    """Runs taut and checks its exit status. Returns its standard output."""
    done = subprocess.run([TAUT, *words], cwd=folder, capture_output=True, text=True, stdin=subprocess.DEVNULL)
    assert done.returncode == status, f"taut {' '.join(words)}: {done.returncode}\n{done.stdout}{done.stderr}"
    return done.stdout


def unpack(release, folder):
    shutil.copytree(release, folder)
    for path in list(folder.rglob("*.gz")):
        path.with_suffix("").write_bytes(gzip.decompress(path.read_bytes()))
        path.unlink()


def end_of(folder, experiment):
    return json.loads(taut(folder, "run", experiment, "--json", "--quiet", "--out", "again"))["state_hash"]


def DescriptionsAreGood(folder):
    for name in ("robot", "waves", "table", "experiment", "table_experiment"):
        taut(folder, "check", f"{name}.yaml", "--quiet")
    values = taut(folder, "gait", "values", "waves.yaml")
    assert "sine.first.amplitude_m" in values, values
    table = taut(folder, "gait", "export", "table.yaml", "robot.yaml", "--duration_s", "0.1", "--rate_hz", "10")
    assert table.splitlines()[-1].split(",")[0] == "0.1", table


def ResolvedInputsRunAsTheExperimentDoes(folder):
    # equal to the last bit in this version; CHANGELOG.md lists releases that changed bits
    assert end_of(folder, "run/inputs.yaml") == end_of(folder, "experiment.yaml")
    taut(folder, "run", "table_experiment.yaml", "--quiet")


def ControllersActOnTheTrace(folder):
    for trace in ("run/trace.h5", "run/trace.csv"):
        taut(folder, "run", "experiment.yaml", "--replay", trace, "--quiet", "--out", "replayed")
        rows = taut(folder, "compare", "replayed/trace.h5", trace, "--channels", "cable/*/tension_n",
                    "--max_rmse", "0", "--tables")
        assert "side_3" in rows, rows


def TraceIsComparedWithAForeignOne(folder):
    said = taut(folder, "compare", "run/trace.h5", "foreign.csv", "--map", "mapping.json")
    assert "cable/*/tension_n [N]" in said and "body/*/position_x_m" in said, said


def ReportIsMade(folder):
    if not PAGES:
        raise Skipped("the viewer's pages are not built")
    taut(folder, "report", "run/trace.h5", "--out", "report.html")
    html = (folder / "report.html").read_text()
    assert json.loads((folder / "run/summary.json").read_text())["run"] in html, "the report lacks the run's id"


def ViewShowsTheTrace(folder):
    if not PAGES:
        raise Skipped("the viewer's pages are not built")
    view = subprocess.Popen([TAUT, "view", "run/trace.h5", "--port", "0"], cwd=folder, text=True,
                            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL)
    said = ""
    while "Ctrl-C" not in said and (line := view.stdout.readline()):
        said += line
    with urllib.request.urlopen(re.search(r"http://\S+", said)[0]) as page:  # the server responds
        assert page.status == 200
    view.send_signal(signal.SIGINT)
    rest = view.communicate()[0]
    assert view.returncode == 0, f"{view.returncode}: {said}{rest}"


def StudyIsListedAndGoesOn(folder):
    listed = taut(folder, "learn", "--top", "9", "study", "--json")
    assert listed.count('"score"') >= 4, listed
    study = folder / "study.yaml"
    study.write_text(study.read_text().replace("evaluations: 4", "evaluations: 6"))
    done = subprocess.run([TAUT, "learn", "study.yaml", "--out", "study", "--threads", "1", "--quiet"], cwd=folder,
                          capture_output=True, text=True)
    if done.returncode == 3:  # results have changed since: a search must not mix them and reports an error
        assert "now ends in a different state" in done.stderr, done.stderr
        return
    assert done.returncode == 0, f"{done.returncode}: {done.stderr}"
    listed = taut(folder, "learn", "--top", "9", "study", "--json")
    assert listed.count('"score"') >= 6, listed


def BestIsReplayed(folder):
    taut(folder, "learn", "--best", "study", "--quiet")
    assert (folder / "study/best/trace.h5").is_file()


def main():
    releases = sorted(path for path in HERE.iterdir() if path.is_dir() and path.name[0].isdigit())
    assert releases, "there is no release's folder"
    for release in releases:
        with tempfile.TemporaryDirectory() as place:
            folder = pathlib.Path(place) / release.name
            unpack(release, folder)
            try:
                globals()[sys.argv[2]](folder)
            except Skipped as why:
                print(f"skipped: {why}")
                return 0
            except AssertionError as wrong:
                print(f"release {release.name}: {wrong}")
                return 1
    print(f"{len(releases)} releases: good")
    return 0


if __name__ == "__main__":
    sys.exit(main())
