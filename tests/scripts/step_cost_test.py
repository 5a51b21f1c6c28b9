#!/usr/bin/env python3
"""Guards the instructions of a step: ten scenes need at most 1 % more than benchmarks/step_cost.json.

Usage: step_cost_test.py STEP_COST TEST. STEP_COST is the program; TEST is the name of a function of this file.
"""

import pathlib
import shutil
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "script"), str(ROOT / "benchmarks")]

from measuring import cost  # noqa: E402

PROGRAM = sys.argv[1]
SKIPPED = 77


def NoSceneNeedsOnePercentMoreThanRecorded():
    if not shutil.which("valgrind"):
        print("skipped: there is no valgrind")
        return SKIPPED
    record = cost.recorded()
    if cost.compiler() != record["compiler"]:
        print(f"skipped: the counts are of {record['compiler']}")
        return SKIPPED
    now = cost.counts(PROGRAM, threads=1)
    worse, rows = cost.compare(record["instructions"], now)
    for row in rows:
        print("  ".join(row))
    assert not worse, ("more than 1 % more instructions. If the change needs them: script/bench --cost --record, and "
                       "give the reason in the commit message", worse)
    return 0


def EveryRecordedSceneIsCounted():
    assert len(cost.SCENES) == 10
    assert set(cost.recorded()["instructions"]) == {cost.name_of(scene) for scene in cost.SCENES}


def AnIncreaseOfMoreThanOnePercentIsNamed():
    before = {"a": 1000, "b": 1000, "c": 1000}
    worse, rows = cost.compare(before, {"a": 1010, "b": 1011, "c": 900, "d": 5})
    assert worse == ["b"], worse
    assert [row[3] for row in rows] == ["+1.00 %", "+1.10 %", "-10.00 %", "new"], rows


if __name__ == "__main__":
    sys.exit(globals()[sys.argv[2]]() or 0)
