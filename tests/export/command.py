"""Helpers that run `taut` and other programs for the tests of this folder"""

import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
NODE_TESTS = ROOT / "web" / "test"


def taut(command, folder, *words, status=0):
    """Runs taut. Returns its standard output or, if `status` is not 0, its error messages."""
    done = subprocess.run([command, *map(str, words)], cwd=folder, capture_output=True, text=True)
    assert done.returncode == status, f"{words}: {done.returncode}\n{done.stdout}{done.stderr}"
    return done.stdout if status == 0 else done.stderr


def node(script, *words, needs):
    """Returns the JSON output of a program of web/test. Skips the test if node or a needed package is missing."""
    if shutil.which("node") is None:
        skip("there is no node (apt-get install nodejs npm)")
    for package in needs:
        if not (ROOT / "web" / "node_modules" / package).is_dir():
            skip(f"{package} is not installed in web/node_modules (npm ci)")
    done = subprocess.run(["node", NODE_TESTS / script, *map(str, words)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def skip(why):
    print(f"skipped: {why}")
    sys.exit(77)


def main(tests):
    """Runs the test given on the command line: NAME TAUT."""
    name, command = sys.argv[1:3]
    with tempfile.TemporaryDirectory() as folder:
        tests[name](str(pathlib.Path(command).resolve()), pathlib.Path(folder))
    print("good")
