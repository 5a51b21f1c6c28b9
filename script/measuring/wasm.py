"""Current MuJoCo for comparison with Debian's: npm's @mujoco/mujoco, in WebAssembly, run by node."""

import fcntl
import functools
import json
import shutil
import subprocess
import sys

from measuring.commands import command
from validation.runs import ROOT, Problem

ENGINE = "mujoco_wasm"
ABSENT = "not measured"
FOLDER = ROOT / "benchmarks/wasm"
PACKAGE = "node_modules/@mujoco/mujoco"


def locked():
    return json.loads((FOLDER / "package-lock.json").read_text())["packages"][PACKAGE]["version"]


def installed():
    try:
        return json.loads((FOLDER / PACKAGE / "package.json").read_text())["version"]
    except (OSError, ValueError):
        return None


def what_is_missing():
    """Installs the package if necessary. Returns a text about missing parts; None if all are available."""
    if not shutil.which("node"):
        return "there is no node (script/setup)"
    if installed() == locked():
        return None
    if not shutil.which("npm"):
        return "there is no npm (script/setup)"
    run = subprocess.run(["npm", "ci", "--no-audit", "--no-fund", "--fetch-retries=1"], cwd=FOLDER,
                         capture_output=True, text=True)
    if run.returncode != 0 or installed() != locked():
        return f"npm ci failed: {next(iter(run.stderr.strip().splitlines()), 'it says nothing')}"
    return None


@functools.cache
def version():
    """Returns the versions of MuJoCo and node; ABSENT, after a message with the reason, if one is missing."""
    with (FOLDER / "node_modules.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)  # tests run this in parallel
        missing = what_is_missing()
    if missing:
        print(f"script/bench: MuJoCo in WebAssembly is {ABSENT}: {missing}", file=sys.stderr)
        return ABSENT
    return f"{installed()} (node {command('node', '--version').strip()})"


def measured(what, cases, *numbers):
    """Returns the results of measure.mjs for the cases printed by a benchmark program; None without node or package."""
    if version() == ABSENT:
        return None
    run = subprocess.run(["node", FOLDER / "measure.mjs", what, *map(str, numbers)], input=cases,
                         capture_output=True, text=True)
    if run.returncode != 0:
        raise Problem(f"MuJoCo in WebAssembly: {run.stderr.rstrip()}")
    answer = json.loads(run.stdout)
    if answer["version"] != installed():
        raise Problem(f"the package of MuJoCo {installed()} holds MuJoCo {answer['version']}")
    return answer["found"]
