#!/usr/bin/env python3
"""Runs the portable archive and the wheels in bare systems without a compiler: Debian 11, 12 and 13.

  bare_systems.py OUT [SUITE...]    OUT: folder of script/portable; suites: bullseye, bookworm, trixie (all by default)

Each system is a chroot in build/portable/systems, which debootstrap creates once (one minute each). Archive and wheel
must give the same results as build/release: the final state hash of push_20n, and the output of `taut analyze` for
all models. Needs root. Prints one line per check; returns status 1 if a check fails.
"""

import contextlib
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
SUITES = {"bullseye": "39", "bookworm": "311", "trixie": "313"}
PACKAGES = "python3,python3-numpy,python3-pip,python3-venv"
TEN_LINES = """
import time
start = time.time()
import numpy
between = time.time()
import taut
print("import", round(time.time() - between, 3))
experiment = taut.load("experiments/push_20n.yaml")
experiment.duration_s = 3
print("hash", taut.run(experiment).state_hash)
sim = taut.Simulation("experiments/push_20n.yaml", worlds=3, threads=2)
sim.run_until(1)
print("tension", round(float(sim.tension_n("outer_right_1")[0]), 6))
"""


class Failed(Exception):
    pass


def run(words, **more):
    done = subprocess.run(words, capture_output=True, text=True, **more)
    if done.returncode != 0:
        raise Failed(f"{' '.join(map(str, words))}: status {done.returncode}\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return done.stdout


def system(suite):
    """Returns the folder of a bare system; makes it once."""
    place = ROOT / "build/portable/systems" / suite
    if (place / "made").exists():
        return place
    shutil.rmtree(place, ignore_errors=True)
    place.mkdir(parents=True)
    print(f"making a bare {suite} (a minute)", flush=True)
    run(["debootstrap", "--variant=minbase", f"--include={PACKAGES}", suite, place, "http://deb.debian.org/debian"])
    (place / "made").touch()
    return place


@contextlib.contextmanager
def mounted(place):
    for kind, where in (("proc", "proc"), ("tmpfs", "tmp")):
        subprocess.run(["mount", "-t", kind, kind, place / where], check=True)
    subprocess.run(["mount", "--bind", "/dev", place / "dev"], check=True)
    try:
        yield
    finally:
        for where in ("dev", "tmp", "proc"):
            subprocess.run(["umount", "--lazy", place / where], check=False)


def within(place, command, **more):
    return run([shutil.which("chroot"), place, "/bin/sh", "-c", f"cd /tmp && {command}"],
               env={"PATH": "/usr/bin:/bin", "HOME": "/tmp", "LANG": "C.UTF-8"}, **more)


def hash_of(summary):
    return json.loads(summary.read_text())["state_hash"]


def analyses(taut, models, call):
    """Returns the analysis of each model, or its error, as text without paths."""
    out = {}
    for model in models:
        text = call(f"{taut} analyze models/{model} --json 2>&1 || true")
        out[model] = re.sub(r"/[\w./-]*share/taut/", "", text)
    return out


def views(place, taut):
    """Returns whether `taut view` serves its page."""
    script = f"""
import re, subprocess, urllib.request
view = subprocess.Popen(["{taut}", "view", "models/prism3.yaml", "--port", "0"], stdout=subprocess.PIPE, text=True)
for line in view.stdout:
    found = re.search(r"http://\\S+", line)
    if found:
        # A bare system has no /etc/hosts, so "localhost" is unknown.
        print(len(urllib.request.urlopen(found[0].replace("localhost", "127.0.0.1"), timeout=10).read()))
        break
view.terminate()
"""
    (place / "tmp/view.py").write_text(script)
    return int(within(place, "python3 view.py").strip() or 0) > 100_000


def check(suite, archive, wheel, native):
    place = system(suite)
    with mounted(place):
        shutil.copy(archive, place / "tmp")
        shutil.copy(wheel, place / "tmp")
        assert subprocess.run(["chroot", place, "sh", "-c", "command -v cc gcc g++ c++"], capture_output=True, check=False).returncode != 0
        name = archive.name[: -len(".tar.xz")]
        subprocess.run(["tar", "-C", place / "tmp", "-xf", archive], check=True)
        start = time.time()
        within(place, f"{name}/bin/taut run experiments/push_20n.yaml --report --out run")
        mine = hash_of(place / "tmp/run/summary.json")
        yield "archive: taut run --report", mine == native["hash"], f"{mine}, {time.time() - start:.1f} s"
        mine = analyses(f"{name}/bin/taut", native["models"], lambda command: within(place, command))
        wrong = [model for model in mine if mine[model] != native["analyses"][model]]
        yield f"archive: taut analyze of {len(mine)} models", not wrong, ", ".join(wrong)
        start = time.time()
        within(place, f"python3 -m venv --system-site-packages env && env/bin/pip install --no-index --quiet {wheel.name}")
        yield "wheel: pip install", True, f"{time.time() - start:.1f} s"
        (place / "tmp/ten.py").write_text(TEN_LINES)
        lines = dict(line.split() for line in within(place, "env/bin/python ten.py").splitlines())
        yield "wheel: taut.run", lines["hash"] == str(native["python_hash"]), f"import {lines['import']} s besides numpy"
        yield "wheel: Simulation", lines["tension"] == native["tension"], lines["tension"]
        within(place, "env/bin/taut run experiments/push_20n.yaml --report --out run2")
        mine = hash_of(place / "tmp/run2/summary.json")
        yield "wheel: command taut run --report", mine == native["hash"], mine
        mine = analyses("env/bin/taut", native["models"], lambda command: within(place, command))
        wrong = [model for model in mine if mine[model] != native["analyses"][model]]
        yield f"wheel: taut analyze of {len(mine)} models", not wrong, ", ".join(wrong)
        yield "archive: taut view answers", views(place, f"{name}/bin/taut"), ""
        yield "wheel: taut view answers", views(place, "env/bin/taut"), ""


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    out = pathlib.Path(sys.argv[1]).resolve()
    suites = sys.argv[2:] or list(SUITES)
    if os.getuid() != 0 or not shutil.which("debootstrap"):
        sys.exit("bare_systems.py: this test needs root and debootstrap (fix: sudo, script/setup portable)")
    archive = next(iter(out.glob("taut-*-linux-x86_64.tar.xz")), None)
    taut = ROOT / "build/release/taut"
    folder = out / "native"
    shutil.rmtree(folder, ignore_errors=True)
    models = sorted(path.name for path in (ROOT / "share/models").glob("*.yaml"))

    def here(command):
        return run(["sh", "-c", command], cwd=ROOT / "share")

    run([taut, "run", "experiments/push_20n.yaml", "--out", folder], cwd=ROOT)
    python = json.loads(run(["/usr/bin/python3", "-c", "import json, taut\n"
                             "e = taut.load('experiments/push_20n.yaml'); e.duration_s = 3\n"
                             "s = taut.Simulation('experiments/push_20n.yaml'); s.run_until(1)\n"
                             "print(json.dumps([taut.run(e).state_hash, round(float(s.tension_n('outer_right_1')[0]), 6)]))"],
                            cwd=ROOT, env={**os.environ, "PYTHONPATH": str(ROOT / "build/release/python")}))
    native = {"hash": hash_of(folder / "summary.json"), "python_hash": python[0], "tension": str(python[1]), "models": models,
              "analyses": analyses(taut, models, here)}
    shutil.rmtree(folder, ignore_errors=True)
    failed = 0
    for suite in suites:
        wheel = next(iter(out.glob(f"*-cp{SUITES[suite]}-*.whl")), None)
        if archive is None or wheel is None:
            sys.exit(f"{out} has no archive or no wheel for {suite}: script/portable builds them")
        try:
            for what, good, note in check(suite, archive, wheel, native):
                print(f"{'ok    ' if good else 'WRONG '} {suite}: {what}{f' ({note})' if note else ''}", flush=True)
                failed += not good
        except Failed as error:
            print(f"WRONG  {suite}: {error}", flush=True)
            failed += 1
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
