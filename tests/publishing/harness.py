"""Common parts of the tests of publishing and of the project's files."""

import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "script"))  # for `publishing`


class Skipped(Exception):
    """Reason for skipping a test"""


def run(*command, cwd=None, env=None, status=0):
    done = subprocess.run(command, cwd=cwd, env=env, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    assert done.returncode == status, f"{command}: {done.returncode}\n{done.stdout}"
    return done.stdout


def build_packages():
    """Returns {package: reason} of the group build in script/packages.txt."""
    text = (ROOT / "script/packages.txt").read_text()
    return dict(re.findall(r"^build +(\S+) +# (.*)$", text, re.MULTILINE))


def main(tests):
    """Runs the function that the first argument names: AREA.TEST."""
    try:
        tests[sys.argv[1].split(".")[1]]()
    except Skipped as why:
        print(f"skipped: {why}")
