"""Scenes of mechanics with known solutions: expected and measured values, as in tests/mechanics."""

import os
import pathlib
import subprocess

from validation.runs import Problem, fill

TEMPLATE = pathlib.Path(__file__).with_suffix(".md.in")


def page(taut):
    build = pathlib.Path(taut.command).parent
    if subprocess.run(["cmake", "--build", str(build), "--target", "mechanics_page"], stdout=subprocess.DEVNULL,
                      check=False).returncode != 0:
        raise Problem(f"cannot build mechanics_page in {build}; configure it with script/build")
    program = next((path for path in build.rglob("mechanics_page") if os.access(path, os.X_OK) and path.is_file()),
                   None)
    if program is None:
        raise Problem(f"there is no mechanics_page below {build}")
    run = subprocess.run([str(program)], stdout=subprocess.PIPE, text=True, check=False)
    if run.returncode not in (0, 1):
        raise Problem(f"{program} ended with status {run.returncode}")
    failed = run.stdout.count("(fails)")
    verdict = "All values are as expected." if failed == 0 else f"{failed} values are not as expected (bold)."
    return fill(TEMPLATE.read_text(), {"tables": run.stdout.strip(), "verdict": verdict})
