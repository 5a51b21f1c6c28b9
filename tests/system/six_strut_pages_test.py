"""A landing and a roll of docs/validation reproduce their pages: a sample of script/validate --check

Usage: six_strut_pages_test.py TEST TAUT. TEST is the name of a function of this file.
"""

import os
import pathlib
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path[:0] = [str(ROOT / "script"), str(ROOT / "benchmarks")]
sys.dont_write_bytecode = True
from validation import landing, rolling, runs  # noqa: E402


def run_one(command, variant):
    """Runs the variant. Returns its folder, which is in build/ so that experiments/ is found from there."""
    folder = tempfile.TemporaryDirectory(dir=ROOT / "build")
    runs.Taut(pathlib.Path(command).resolve(), pathlib.Path(folder.name)).run([variant])
    return folder, pathlib.Path(folder.name) / variant.name


def shows(page, line):
    assert line in (ROOT / "docs/validation" / page).read_text().splitlines(), f"{page} has no line\n{line}"


def ALandingIsAsThePageShowsIt(command):
    way, speed = "a triangle of cables", 15
    keep, folder = run_one(command, landing.variant(way, speed))
    run = landing.Landing(folder, speed)
    keep.cleanup()
    shows("landing.md", landing.landings_table({(way, speed): run}).splitlines()[-1])
    shows("landing.md", landing.gives_table({(way, speed): run}).splitlines()[-1])
    assert run.most < 350 and run.gap_m > 0 and run.touches() == "none"


def ARollIsAsThePageShowsIt(command):
    keep, folder = run_one(command, rolling.variant("level", "roll_six_strut", 0))
    run = rolling.Run(folder)
    keep.cleanup()
    shown = next(line for line in (ROOT / "docs/validation/rolling.md").read_text().splitlines()
                 if line.startswith("| level ground |"))
    ours = rolling.moving_row("level ground", [run], lambda r: r.way_m)
    for place in (1, 3, 4, 6, 7, 9):  # the cells of this start only
        assert shown.split("|")[place + 1].strip() == ours[place], f"{shown}\n{ours}"
    assert run.way_m >= 5 and run.turns >= 1


if __name__ == "__main__":
    taut = pathlib.Path(sys.argv[2]).resolve()
    os.chdir(ROOT)  # variants name their base relative to this folder
    globals()[sys.argv[1]](taut)
