"""Commands end if an argument is a pipe without a program at its other end, an endless device or a folder

Usage: pipes_test.py TEST TAUT. TEST is the name of a function of this file.
"""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
MODEL, EXPERIMENT = "models/six_strut.yaml", "experiments/push_20n.yaml"

# Arguments of commands that read. X.: the file of the attack, followed by its ending. TRACE and LOG: good files.
READING = [
    ["analyze", "X.yaml"],
    ["analyze", MODEL, "--pose", "X.h5"],
    ["analyze", MODEL, "--pose", "X.csv"],
    ["check", "X.yaml"],
    ["compare", "X.h5", "TRACE"],
    ["compare", "TRACE", "X.csv"],
    ["compare", "TRACE", "X.csv.gz"],
    ["compare", "TRACE", "X.mcap"],
    ["compare", "TRACE", "LOG", "--map", "X.json"],
    ["compare", "TRACE", "X.csv", "--map", "LOG.map.json"],
    ["export", "mjcf", "X.yaml"],
    ["export", "shape", "X.yaml", "--out", "shape.stl"],
    ["export", "structure", "X.yaml", "--out", "structure"],
    ["export", "structure", MODEL, "--out", "structure", "--pose", "X.h5"],
    ["fit", "X.yaml"],
    ["gait", "create", "X.yaml"],
    ["gait", "export", "X.yaml", MODEL],
    ["gait", "import", "X.json"],
    ["gait", "values", "X.yaml"],
    ["import", "mjcf", "X.xml"],
    ["import", "ntrt", "X.yaml", "--length_unit_m", "0.1"],
    ["learn", "X.yaml"],
    ["new", "mapping", "X.csv"],
    ["new", "mapping", "X.h5"],
    ["new", "mapping", "X.mat"],
    ["new", "mapping", "X.csv.gz"],
    ["new", "mapping", "LOG", "--model", "X.yaml", "--out", "new.json"],
    ["report", "X.h5"],
    ["report", "TRACE", "--compare", "X.h5"],
    ["robot", "calibrate", "encoder", "outer_top_1", "--way_m", "0.1", "--port", "none", "--model", "X.yaml"],
    ["robot", "hold", "--port", "none", "--model", "X.yaml"],
    ["robot", "hold", "--port", "none", "--calibration", "X.yaml"],
    ["robot", "log", "--port", "none", "--model", "X.yaml"],
    ["robot", "run", "X.yaml", "--port", "none"],
    ["run", "X.yaml"],
    ["run", EXPERIMENT, "--replay", "X.h5", "--out", "replayed"],
    ["size", "X.h5"],
    ["size", "run", "--catalogue", "X.yaml"],
    ["trace", "convert", "X.h5", "--out", "trace.csv"],
    ["trace", "convert", "X.csv", "--out", "trace.mcap"],
    ["view", "X.h5", "--port", "0"],
    ["view", "TRACE", "--compare", "X.h5", "--port", "0"],
]
# Commands that write to a file of this name, after short work.
WRITING = [
    ["check", MODEL, "--settled", "--out", "X.yaml"],
    ["export", "mjcf", MODEL, "--out", "X.xml"],
    ["export", "shape", MODEL, "--out", "X.stl"],
    ["gait", "create", "models/tetraspine3.yaml", "--out", "X.yaml"],
    ["new", "mapping", "LOG", "--out", "X.json"],
    ["report", "TRACE", "--out", "X.html"],
    ["trace", "convert", "TRACE", "--out", "X.csv"],
]
MOST_S = 240  # for all commands together, on a busy machine


def start(taut, words, folder, number):
    """Starts a command with its output in files."""
    with open(folder / f"{number}.out", "w", encoding="utf-8") as output:
        return subprocess.Popen([taut, *words], cwd=folder, stdin=subprocess.DEVNULL, stdout=output, stderr=output,
                                env={**os.environ, "TAUT_WEB": str(folder / "pages")})


def ends(taut, commands, make):
    """Runs all commands at once, each in a folder of its own, where make(path) creates the file of the attack. Returns
    descriptions of the commands that do not end, crash, or end without an error about this file."""
    with tempfile.TemporaryDirectory() as parent:
        given = pathlib.Path(parent, "given")
        (given / "pages").mkdir(parents=True)
        for page in ("index.html", "report.html"):
            (given / "pages" / page).write_text("<script type=\"application/json\" id=\"taut-report\"></script>")
        (given / "log.csv").write_text("time [s],force [N]\n" + "".join(f"{i / 10},{i % 7}\n" for i in range(50)))
        (given / "log.map.json").write_text('{"version": 1, "table": {"time": {"column": "time [s]"}}}')
        subprocess.run([taut, "run", ROOT / "share/experiments/hang.yaml", "--duration_s", "0.01", "--quiet", "--out",
                        "run"], cwd=given, check=True)
        running = []
        for number, words in enumerate(commands):
            folder = pathlib.Path(parent, str(number))
            shutil.copytree(given, folder)
            named = {"TRACE": "run/trace.h5", "LOG": "log.csv", "LOG.map.json": "log.map.json"}
            words = [named.get(word, word) for word in words]
            words = [word if not word.startswith("X.") else make(folder, "x" + word[1:]) for word in words]
            running.append((words, start(taut, words, folder, "all"), folder / "all.out"))
        wrong, until = [], time.monotonic() + MOST_S
        for words, process, output in running:
            try:
                status = process.wait(max(until - time.monotonic(), 0.1))
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
                status = "no end"
            text = output.read_text(errors="replace")
            if status not in (1, 3) or "x." not in text:
                wrong.append(f"{status}: taut {' '.join(map(str, words))}\n{text[-300:]}")
        return wrong


def pipe(folder, name):
    os.mkfifo(folder / name)
    return name


def folder_of(folder, name):
    (folder / name).mkdir()
    return name


def device(folder, name):
    (folder / name).symlink_to("/dev/zero")
    return name


def PipesWithoutAWriterAreRefused(taut):
    return ends(taut, READING, pipe)


def EndlessDevicesAreRefused(taut):
    return ends(taut, READING, device)


def FoldersAreRefused(taut):
    return ends(taut, READING, folder_of)


def PipesWithoutAReaderAreRefused(taut):
    return ends(taut, WRITING, pipe)


def APipeWithAWriterIsRead(taut):
    with tempfile.TemporaryDirectory() as parent:
        folder = pathlib.Path(parent)
        model = subprocess.run([taut, "export", "mjcf", MODEL], cwd=folder, capture_output=True, check=True).stdout
        pipe(folder, "x.xml")
        process = start(taut, ["import", "mjcf", "x.xml", "--out", "x.yaml"], folder, "import")
        time.sleep(0.3)  # the command waits meanwhile
        with open(folder / "x.xml", "wb") as writer:
            time.sleep(0.3)
            writer.write(model)
        status = process.wait(60)
        return [] if status == 0 else [(folder / "import.out").read_text()]


if __name__ == "__main__":
    found = globals()[sys.argv[1]](sys.argv[2])
    print("\n".join(found))
    sys.exit(1 if found else 0)
