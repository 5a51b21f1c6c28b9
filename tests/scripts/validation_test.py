"""script/validate reports invalid requests, and its pages contain computed figures only.

Usage: validation_test.py TEST. TEST is the name of a function of this file.
"""

import os
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path[:0] = [str(ROOT / "script"), str(ROOT / "benchmarks")]
sys.dont_write_bytecode = True
from validation import push, runs  # noqa: E402


def validate(*arguments, cwd=ROOT):
    environment = {key: value for key, value in os.environ.items() if key != "TAUT"}
    return subprocess.run([sys.executable, ROOT / "script" / "validate", *arguments], cwd=cwd,
                          env=environment, capture_output=True, text=True)


def problem(function, *arguments):
    """Returns the message of the Problem that the call raises; fails if it raises none."""
    try:
        function(*arguments)
    except runs.Problem as found:
        return str(found)
    raise AssertionError("no Problem")


def AnUnknownPageIsAnError():
    run = validate("pull")
    assert run.returncode == 2 and "no page pull; the pages are: push, gaits, goal, wall, peers" in run.stderr, run


def AMissingTautIsAnError():
    with tempfile.TemporaryDirectory() as folder:  # --taut is relative to the user's folder
        run = validate("--taut", "no_taut", "push", cwd=folder)
        assert run.returncode == 1 and "no_taut; build it with script/build" in run.stderr, run
        assert str(pathlib.Path(folder).resolve() / "no_taut") in run.stderr, run


def AFailingRunIsShown():
    said = problem(runs.Taut("/bin/ls", pathlib.Path(".")), "--no-such-option")
    assert said.startswith("taut --no-such-option\n") and "no-such-option" in said.split("\n", 1)[1], said


def TemplateAndValuesMustFit():
    assert runs.fill("a {{x}} b {{x}}", {"x": "1"}) == "a 1 b 1"
    assert problem(runs.fill, "{{x}}", {}) == "template and values do not fit: x"
    assert problem(runs.fill, "{{x}}", {"x": "1", "unused": "2"}).endswith(": unused")


def AVariantChangesWhatIsThere():
    assert runs.replaced("a b", "b", "c") == "a c"
    assert problem(runs.replaced, "a b", "x", "c") == "there is no 'x' in\na b"
    assert "has no key nothing" in problem(runs.yaml_block, push.EXPERIMENT, "nothing")
    block = runs.yaml_block(push.EXPERIMENT, "timeline")
    assert block.startswith("timeline:\n") and "hold_2" in block and "record" not in block, block


def TheStaircaseHasTheSteps():
    """NTRT's force of 22.563 N (t - 30) / 5 in steps of 0.05 s: 100 up, 100 down, three forces"""
    text = push.staircase()
    assert text.count("[30.05, 0.01 * push_n]") == 3, text
    assert text.count("[35.00, 1 * push_n]") == 3 and text.count("[45.00, 0 * push_n]") == 3, text
    assert text.count("scale: 0.45") == 1 and text.count("scale: 0.55") == 1, text


def VariantsAreDistinct():
    variants = {variant for _, variant in push.LAWS_OFF + push.LAWS_ON + push.CHOICES}
    assert len({variant.name for variant in variants}) == len(variants)
    texts = {(v.base, v.keys, *v.parameters.items()) for v in variants}
    assert len(texts) == len(variants), "two variants are the same run"


if __name__ == "__main__":
    globals()[sys.argv[1]]()
