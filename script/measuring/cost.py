"""Instructions of a step in ten scenes, compared with the recorded counts."""

import concurrent.futures
import json
import os
import shutil

from measuring.compare import by_valgrind
from measuring.measure import command
from validation.runs import ROOT, Problem, table

RECORD = ROOT / "benchmarks/step_cost.json"
LIMIT = 0.01  # a larger relative increase is a regression
NOT_HERE = 4  # status of step_cost: the processor lacks the instruction set

# (experiment, worlds, instruction set, steps): each kind of robot, ground and controller; four worlds fill the lanes.
SCENES = (
    ("push_20n", 1, "scalar", 200),            # spine on the ground, impedance control
    ("push_20n", 4, "avx2", 200),
    ("sine_hand_tuned_motors", 1, "scalar", 200),
    ("hills", 4, "avx2", 60),                  # long spine above a height field
    ("drop_six_strut", 1, "scalar", 400),      # six struts in free fall
    ("stairs", 1, "scalar", 200),
    ("puppy_stand", 1, "scalar", 60),          # ball joints
    ("wall_touching", 1, "scalar", 40),        # cables that touch obstacles
    ("t3_press", 1, "scalar", 200),            # elastic struts and supports
    ("goal_blocks", 1, "scalar", 100),         # tetrahedra among blocks
)


def compiler():
    """Returns the compiler whose code is counted; other compilers have other counts."""
    return command("g++", "--version").splitlines()[0]


def name_of(scene):
    experiment, worlds, simd, _ = scene
    return f"{experiment}, {worlds} world{'s' * (worlds > 1)}, {simd}"


def instructions(program, scene):
    """Returns the instructions of a step of all worlds; None if this processor lacks the instruction set."""
    experiment, worlds, simd, steps = scene
    count = by_valgrind([program, ROOT / f"share/experiments/{experiment}.yaml", worlds, simd, steps],
                        "--toggle-collect=CountedSteps", absent=NOT_HERE)
    if count == 0:
        raise Problem(f"{name_of(scene)}: the function CountedSteps was not found")
    return count and count / steps


def counts(program, threads=None):
    """Returns {name: instructions of a step}."""
    if not shutil.which("valgrind"):
        raise Problem("counting instructions needs valgrind (script/setup)")
    with concurrent.futures.ThreadPoolExecutor(threads or os.cpu_count()) as pool:
        found = pool.map(lambda scene: instructions(program, scene), SCENES)
        return {name_of(scene): round(count) for scene, count in zip(SCENES, found) if count is not None}


def recorded():
    return json.loads(RECORD.read_text())


def compare(before, now):
    """Returns the names of scenes that need more than LIMIT more instructions, and rows of a table."""
    worse = [name for name, count in now.items() if count > (1 + LIMIT) * before.get(name, count)]
    rows = [[name, str(before.get(name, "")), str(count),
             f"{100 * (count / before[name] - 1):+.2f} %" if name in before else "new"] for name, count in now.items()]
    return worse, rows


def main(program, record):
    now = counts(program)
    before = recorded()["instructions"] if RECORD.exists() else {}
    worse, rows = compare(before, now)
    print(table(["scene", "instructions recorded", "now", "change"], rows))
    if record:
        RECORD.write_text(json.dumps({"compiler": compiler(), "instructions": before | now}, indent=1) + "\n")
        print(f"recorded in {RECORD.relative_to(ROOT)}")
    elif worse:
        print(f"more than {100 * LIMIT:g} % more instructions: {'; '.join(worse)}")
        return 1
    return 0
