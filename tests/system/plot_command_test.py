"""The command `taut plot`: checks of its arguments, the request to the program that draws, figures of matplotlib

Usage: plot_command_test.py TEST TAUT. TEST is the name of a function of this file.
"""

import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

SKIPPED = 77
TAUT = os.path.abspath(sys.argv[2])
# Stands for Python: stores the request and returns a figure.
STORES = "#!/bin/sh\ncat >request.json\nprintf figure\n"


class Folder:
    """Temporary folder with two traces, a log and its mapping"""

    def __init__(self):
        self.at = pathlib.Path(tempfile.mkdtemp(prefix="taut_plot_command_"))
        head = "time_s,cable/a/tension_n,cable/b/tension_n,body/s/position_z_m\n"
        (self.at / "run").mkdir()
        (self.at / "run/trace.csv").write_text(head + "0,1,10,0.5\n1,2,nan,0.25\n2,3,30,0.125\n3,4,40,0\n")
        (self.at / "run/summary.json").write_text(json.dumps({"phases": [{"name": "push", "from_s": 1, "to_s": 2}]}))
        (self.at / "other.csv").write_text(head + "0,5,50,1\n3,6,60,2\n")
        (self.at / "lab.csv").write_text("ms,a lbf\n0,1\n1500,2\n3000,3\n")
        (self.at / "lab.map.json").write_text(json.dumps({
            "version": 1, "table": {"time": {"column": "ms", "unit": "ms"}},
            "channels": [{"from": "* lbf", "to": "cable/*/tension_n", "scale": 4}]}))

    def program(self, text):
        path = self.at / "python"
        path.write_text(text)
        path.chmod(0o755)
        return str(path)

    def taut(self, *words, python="/bin/false"):
        """Runs `taut plot`. Returns its status, output and errors."""
        done = subprocess.run([TAUT, "plot", *words], cwd=self.at, capture_output=True, text=True,
                              env={**os.environ, "TAUT_PYTHON": python})
        return done.returncode, done.stdout, done.stderr

    def read(self, name):
        return (self.at / name).read_bytes()


def AllMistakesAreReportedAtOnce():
    folder = Folder()
    status, output, errors = folder.taut(
        "run", "other.csv", "missing.csv", "--channels", "cable/*/tension", "body/*", "cable/*/tension_n", "--layout", "one",
        "--map", "lab.map.json", "--from_s", "2", "--to_s", "1", "--out", "figure.eps")
    assert status == 3 and output == "", (status, output)
    for part in ("figure.eps: error: unknown figure format \".eps\" (expected .pdf, .svg or .png)",
                 "--from_s 2 is not before --to_s 1", "--map needs a measurement (name the measurement with --with)", "missing.csv: error:",
                 "run/trace.csv: error: no channel matches \"cable/*/tension\"",
                 "one axis cannot show body/s/position_z_m [m] and cable/a/tension_n [N]"):
        assert part in errors, (part, errors)
    assert not (folder.at / "figure.eps").exists()
    (folder.at / "many.csv").write_text(",".join(["time_s", *(f"cable/c{i}/tension_n" for i in range(25))]) + "\n" +
                                        ",".join("0" * 26) + "\n")
    (folder.at / "nothing.csv").write_text("time_s,cable/z/tension_n\n0,1\n")
    for words, part in (
            (["many.csv"], "25 channels match; a figure shows at most 24"),
            (["run", "nothing.csv"], "nothing.csv: error: the run has none of the drawn channels, such as cable/a/tension_n"),
            (["run", "--with", "nothing.csv"], "nothing.csv: error: the measurement has none of the drawn channels"),
            (["run", "--with", "lab.csv"], "`taut new mapping`")):
        status, _, errors = folder.taut(*words, "--out", "figure.pdf")
        assert status == 3 and part in errors, (part, errors)


def TheProgramGetsTheDrawnRows():
    folder = Folder()
    status, output, errors = folder.taut(
        "run", "other.csv", "--with", "lab.csv", "--map", "lab.map.json", "--from_s", "0.5", "--to_s", "2", "--width_mm", "180",
        "--out", "figure.pdf", python=folder.program(STORES))
    assert status == 0, errors
    assert output == "Figure: figure.pdf (2 channels, 180 mm wide)\nnext: xdg-open figure.pdf\n", output
    assert folder.read("figure.pdf") == b"figure"
    asked = json.loads(folder.read("request.json"))
    assert asked["units"] == [["cable/a/tension_n", "N"], ["cable/b/tension_n", "N"]]
    assert asked["runs"][0] == {"time_s": [1, 2], "values": {"cable/a/tension_n": [2, 3], "cable/b/tension_n": [None, 30]}}
    assert asked["runs"][1]["time_s"] == []
    assert asked["measured"] == {"time_s": [1.5], "values": {"cable/a/tension_n": [8]}}
    assert asked["paths"] == ["run/trace.csv", "other.csv"] and asked["width_mm"] == 180
    assert asked["height_mm"] is None and asked["layout"] == ""
    # Patterns keep their order, and no channel is drawn twice.
    folder.taut("run", "--channels", "cable/b/*", "cable/*", "--out", "figure.svg", python=folder.program(STORES))
    assert [name for name, _ in json.loads(folder.read("request.json"))["units"]] == ["cable/b/tension_n", "cable/a/tension_n"]


def AFailureLeavesTheOldFigure():
    folder = Folder()
    (folder.at / "figure.pdf").write_text("old")
    for text, part in (("#!/bin/sh\nexit 4\n", "figures need matplotlib, which the program "),
                       ("#!/bin/sh\nprintf half\nexit 1\n", "failed with exit status 1"),
                       ("#!/bin/sh\nkill -9 $$\n", "was killed or did not start")):
        status, _, errors = folder.taut("run", "--out", "figure.pdf", python=folder.program(text))
        assert status == 1 and part in errors, (part, errors)
        assert folder.read("figure.pdf") == b"old"
    status, _, errors = folder.taut("run", "--out", "figure.pdf", python=str(folder.at / "none"))
    assert status == 1 and "apt install python3-matplotlib" in errors, errors


def MatplotlibDrawsThreeFormats():
    try:
        import matplotlib  # noqa: F401
    except ImportError:
        print("skipped: no matplotlib")
        return SKIPPED
    folder = Folder()
    (folder.at / "json.py").write_text("raise SystemExit(9)\n")   # a module of the user's folder is not imported
    for end, begin in (("pdf", b"%PDF"), ("svg", b"<?xml"), ("png", b"\x89PNG")):
        status, output, errors = folder.taut("run", "other.csv", "--with", "lab.csv", "--map", "lab.map.json", "--out",
                                             f"figure.{end}", "--width_mm", "120", python=sys.executable)
        assert status == 0, errors
        assert folder.read(f"figure.{end}").startswith(begin)
    pdf = folder.read("figure.pdf")
    box = re.search(rb"/MediaBox \[ *0 0 ([\d.]+) ([\d.]+) *\]", pdf)
    assert abs(float(box[1]) - 120 / 25.4 * 72) < 0.1, box[0]
    assert b"/FontFile2" in pdf and b"/Type3" not in pdf
    assert b"#e9edf1" in folder.read("figure.svg"), "the phase of the run's folder is not shaded"
    status, _, errors = folder.taut("run", "--channels", "*", "--layout", "many", "--out", "many.png", python=sys.executable)
    assert status == 0, errors
    return 0


sys.exit(globals()[sys.argv[1]]())
