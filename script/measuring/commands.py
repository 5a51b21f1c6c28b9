"""Execution of external commands."""

import subprocess

from validation.runs import Problem


def command(*words, **more):
    """Runs a command; prints its output only if it fails."""
    run = subprocess.run([str(word) for word in words], capture_output=True, text=True, **more)
    if run.returncode != 0:
        raise Problem(f"{' '.join(map(str, words))}\n{run.stdout}{run.stderr}".rstrip())
    return run.stdout
