"""script/faults finds errors, and reports nothing else.

Usage: faults_test.py TAUT LIBRARY TEST [PYTHON]. TEST is the name of a function of this file, PYTHON the one of the
module.
"""

import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
TAUT, LIBRARY = sys.argv[1:3]


PYTHON = sys.argv[4] if len(sys.argv) > 4 else sys.executable


def faults(*words, taut=TAUT, python=PYTHON):
    return subprocess.run([sys.executable, ROOT / "script/faults", *words, "--quiet", "--taut", taut, "--library", LIBRARY,
                           "--python", python], capture_output=True, text=True)


def instead(folder, lines):
    """Returns a command that replaces taut or Python and handles the arguments "$@" with the shell code `lines`."""
    path = pathlib.Path(folder, "taut")
    path.write_text(f"#!/bin/sh\ntaut={TAUT} python={PYTHON}\n{lines}\n")
    path.chmod(0o755)
    return path


def AWriteThatFailsIsSaid():
    run = faults("run", "--at", "write 20 once")
    assert run.returncode == 0 and "failed: 1," in run.stdout and "status 1" in run.stdout, run
    assert "error: " in run.stdout and "No space left on device" in run.stdout, run


def ACommandThatHidesItsFailureIsFound():
    with tempfile.TemporaryDirectory() as folder:
        run = faults("run", "--at", "write 20 once", taut=instead(folder, '"$taut" "$@"\nexit 0'))
    assert run.returncode == 1 and "WRONG: " in run.stdout, run


def ACommandThatCrashesIsFound():
    with tempfile.TemporaryDirectory() as folder:
        run = faults("run", "--at", "write 20 once", taut=instead(folder, '"$taut" "$@" || kill -SEGV $$'))
    assert run.returncode == 1 and "WRONG: ended by SIGSEGV" in run.stdout, run


def AKilledRunIsNoFinishedRun():
    with tempfile.TemporaryDirectory() as folder:
        keep = 'cp run/summary.json kept 2>/dev/null; "$taut" "$@"; status=$?\n'
        keep += '[ $status -lt 128 ] || mv kept run/summary.json; rm -f kept; [ $status -lt 128 ] || kill -KILL $$; exit $status'
        run = faults("run", "--at", "write 150 kill", taut=instead(folder, keep))
    assert run.returncode == 1 and "WRONG: neither the old run nor the new one is left" in run.stdout, run


def AFitKilledAtItsFirstWritesGoesOn():
    # These include the writes of the facts to which the points belong.
    run = faults("fit", *(word for at in range(25, 45, 3) for word in ("--at", f"write {at} kill")))
    assert run.returncode == 0 and run.stdout.count("good: killed") == 7, run


def AFileThatCannotBeReadEndsAFitAndIsNoFailedTrial():
    calls = faults("fit", "--at", "read 1 once").stdout
    count = int(re.search(r"(\d+) read", calls)[1])
    # Reads of the search; the first and the last ones may belong to the stages around it.
    run = faults("fit", *(word for part in range(21, 28) for word in ("--at", f"read {count * part // 100} sticky")))
    assert run.returncode == 0 and run.stdout.count("run the same command again to resume") > 0, run


def AnImportThatCannotCheckItsModelSaysSo():
    run = faults("import_ntrt", "--at", "open 1 once", "--at", "read 3 once", "--at", "name 1 once")
    assert run.returncode == 0 and run.stdout.count("cannot check the model: temporary file: cannot") == 3, run
    assert "refuses the model" not in run.stdout, run


def ANewRobotIsWholeOrAbsent():
    run = faults("new_robot", "--at", "write 2 kill", "--at", "open 3 kill", "--at", "name 1 kill", "--at", "write 3 once")
    assert run.returncode == 0 and run.stdout.count("good: killed") == 3 and run.stdout.count("good: said") == 1, run


def MemoryThatIsMissingWhereNothingMayBeThrownIsSaid():
    # Some of these fail during the destruction of JSON texts, which also allocates memory.
    calls = faults("top", "--at", "memory 1 once").stdout
    count = int(re.search(r"calls: (\d+) memory", calls)[1])
    run = faults("top", *(word for back in range(100, 400, 23) for word in ("--at", f"memory {count - back} sticky")))
    assert run.returncode == 0 and run.stdout.count("good: said") == 14, run


def MemoryThatTheModuleLacksIsAMemoryError():
    calls = faults("python_run", "--at", "memory 1 once").stdout
    count = int(re.search(r"calls: (\d+) memory", calls)[1])
    run = faults("python_run", *(word for part in range(1, 9) for word in ("--at", f"memory {count * part // 9} sticky")))
    assert run.returncode == 0 and run.stdout.count("\nerror: MemoryError: ") == 8, run


def AModuleThatHidesItsFailureIsFound():
    with tempfile.TemporaryDirectory() as folder:
        hides = instead(folder, '"$python" "$@" 2>/dev/null || echo done')
        run = faults("python_run", "--at", "memory 100 sticky", python=hides)
    assert run.returncode == 1 and "WRONG: status 0, and it printed something else" in run.stdout, run


def SaysWhatItCannotDo():
    for words, said in ((("nothing",), "there is no nothing"), (("run", "--kinds", "x"), "there is no x"),
                        (("run", "--at", "write"), "a kind, a number and a mode"),
                        (("--at", "write 1 once"), "wants one command")):
        run = faults(*words)
        assert run.returncode == 2 and said in run.stderr, run
    run = faults("run", taut="nothing")
    assert run.returncode == 2 and "there is no nothing" in run.stderr, run


if __name__ == "__main__":
    globals()[sys.argv[3]]()
