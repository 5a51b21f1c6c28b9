"""mujoco3_test.py CASES: runs mujoco3.mjs on the output of CASES; skipped (77) without node or the package."""

import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "script"), str(ROOT / "benchmarks")]
from measuring import wasm  # noqa: E402


def main():
    if wasm.version() == wasm.ABSENT:
        return 1 if os.environ.get("CI") else 77
    cases = subprocess.run([sys.argv[1]], capture_output=True, text=True, check=True).stdout
    script = pathlib.Path(__file__).with_name("mujoco3.mjs")
    package = wasm.FOLDER / wasm.PACKAGE / "mujoco.js"
    return subprocess.run(["node", script, package], input=cases, text=True).returncode


sys.exit(main())
