#!/usr/bin/env python3
"""Runs the portable archive and the wheels in bare systems without a compiler (systems.txt).

  bare_systems.py OUT [SUITE...]    OUT: folder of script/portable; suites: as in systems.txt; by default, all of them

Each system is a chroot in build/portable/systems, which debootstrap creates once (one minute each). Archive and wheel
must give the same results as the command TAUT_COMMAND (build/release/taut) and the module in its folder: the final state
hash of push_20n, and the output of `taut analyze` for all models. Needs root. Prints one line per check; returns status
1 if a check fails.
"""

import contextlib
import json
import os
import pathlib
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import zipfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
PACKAGES = "python3,python3-numpy,python3-pip,python3-venv"
ARCHIVES = {"debian": ("http://deb.debian.org/debian", "main", "/usr/share/keyrings/debian-archive-keyring.gpg"),
            "ubuntu": ("http://archive.ubuntu.com/ubuntu", "main,universe",
                       ROOT / "build/portable/ubuntu-keyring/usr/share/keyrings/ubuntu-archive-keyring.gpg")}
SYSTEM_CPU_S = 60  # all checks of a system, so that a user's first minute suffices
IMPORT_CPU_S = 0.06  # besides numpy
ARCHIVE_MB, WHEEL_MB = 15, 13
PROGRAM = """
import time
start = time.process_time()
import numpy
between = time.process_time()
import taut
print("import", round(time.process_time() - between, 3))
experiment = taut.load("experiments/push_20n.yaml")
experiment.duration_s = 3
print("hash", taut.run(experiment).state_hash)
sim = taut.Simulation("experiments/push_20n.yaml", worlds=3, threads=2)
sim.run_until(1)
print("tension", round(float(sim.tension_n("outer_right_1")[0]), 6))
"""


class Failed(Exception):
    pass


def systems():
    """Returns {suite: (name, version of Python)} of systems.txt."""
    lines = (ROOT / "script/publishing/systems.txt").read_text().splitlines()
    rows = [re.split(r"  +", line) for line in lines if line and not line.startswith("#")]
    return {suite: (name, python) for suite, name, python in rows}


def run(words, **more):
    done = subprocess.run(words, capture_output=True, text=True, **more)
    if done.returncode != 0:
        raise Failed(f"{' '.join(map(str, words))}: status {done.returncode}\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return done.stdout


def cpu_s():
    """Returns the processor time of all ended child processes [s]: other programs do not change it."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def bare_system(suite):
    """Returns the folder of a bare system; makes it once."""
    place = ROOT / "build/portable/systems" / suite.replace("/", "_")
    if (place / "made").exists():
        return place
    shutil.rmtree(place, ignore_errors=True)
    place.mkdir(parents=True)
    print(f"making a bare {suite} (a minute)", flush=True)
    distribution, _, codename = suite.rpartition("/")
    archive, components, keyring = ARCHIVES[distribution or "debian"]
    # Debian 12 has no script for later suites of Ubuntu; all of them are links to this one.
    script = ["/usr/share/debootstrap/scripts/gutsy"] if distribution == "ubuntu" else []
    run(["debootstrap", "--variant=minbase", f"--include={PACKAGES}", f"--components={components}", f"--keyring={keyring}",
         codename, place, archive, *script])
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
        print(len(urllib.request.urlopen(found[0].replace("localhost", "127.0.0.1"), timeout=60).read()))
        break
view.terminate()
"""
    (place / "tmp/view.py").write_text(script)
    return int(within(place, "python3 view.py").strip() or 0) > 100_000


def readme_example():
    """Returns the program of the README's "Ten lines of Python" and its output."""
    text = (ROOT / "README.md").read_text()
    program = re.search(r"^```python [^\n]*\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
    output = re.search(r"^```console\n\$ python3[^\n]*\n(.*?)^```$", text[program.end():], re.MULTILINE | re.DOTALL)
    return program[1], output[1]


def same_analyses(taut, native, place):
    """Returns (whether all analyses equal the native ones, models with differences)."""
    found = analyses(taut, native["models"], lambda command: within(place, command))
    wrong = [model for model in found if found[model] != native["analyses"][model]]
    return not wrong, ", ".join(wrong)


def small(path, most_mb):
    """Returns (whether the file has at most this size, its size)."""
    size_mb = path.stat().st_size / 1e6
    return size_mb <= most_mb, f"{size_mb:.1f} MB"


def features(place, taut):
    """Returns (whether the build is complete, its lines that are wrong)."""
    found = within(place, f"{taut} --version --features").splitlines()
    wrong = [line for line in ("viewer's pages: yes", "static libraries: yes") if line not in found]
    wrong += [line for line in found if line == "assertions: yes"]
    return not wrong, ", ".join(wrong) or found[0]


def check_archive(place, name, native):
    taut = f"{name}/bin/taut"
    yield "archive: taut --version --features", *features(place, taut)
    within(place, f"{taut} run experiments/push_20n.yaml --report --out run")
    found = hash_of(place / "tmp/run/summary.json")
    yield "archive: taut run --report", found == native["hash"], found
    yield f"archive: taut analyze of {len(native['models'])} models", *same_analyses(taut, native, place)
    yield "archive: taut view answers", views(place, taut), ""


def check_wheel(place, wheel, python, native):
    start = cpu_s()
    within(place, f"python3 -m venv --system-site-packages env && env/bin/pip install --no-index --quiet {wheel.name}")
    yield "wheel: pip install", True, f"{cpu_s() - start:.1f} s processor time"
    (place / "tmp/program.py").write_text(PROGRAM)
    within(place, "env/bin/python program.py")  # compiles the Python files
    lines = dict(line.split() for line in within(place, "env/bin/python program.py").splitlines())
    yield "wheel: taut.run", lines["hash"] == str(native["python_hash"]), lines["hash"]
    yield (f"wheel: import within {IMPORT_CPU_S} s besides numpy", float(lines["import"]) <= IMPORT_CPU_S,
           f"{lines['import']} s processor time")
    yield "wheel: Simulation", lines["tension"] == native["tension"], lines["tension"]
    program, output = readme_example()
    (place / "tmp/readme.py").write_text(program)
    found = within(place, "env/bin/python readme.py")
    yield "wheel: README's ten lines", found == output, "" if found == output else found
    within(place, "env/bin/taut run experiments/push_20n.yaml --report --out run2")
    found = hash_of(place / "tmp/run2/summary.json")
    yield "wheel: command taut run --report", found == native["hash"], found
    yield f"wheel: taut analyze of {len(native['models'])} models", *same_analyses("env/bin/taut", native, place)
    yield "wheel: taut view answers", views(place, "env/bin/taut"), ""
    yield "wheel: taut --version --features", *features(place, "env/bin/taut")


def check_other_python(place, wheel, python):
    """Checks that the module for another Python names both versions."""
    with zipfile.ZipFile(wheel) as file:
        file.extractall(place / "tmp/other")
    said = within(place, "PYTHONPATH=other python3 -c 'import taut' 2>&1 || true")
    built = re.search(r"-cp(\d+)-", wheel.name)[1]
    good = f"_core.cpython-{built}-" in said and f"this is Python {python} " in said
    yield "wheel of another Python: the error names both versions", good, said.strip().rpartition("\n")[2]


def check(suite, archive, wheels, native):
    name, python = systems()[suite]
    place = bare_system(suite)
    with mounted(place):
        tag = f"-cp{python.replace('.', '')}-"
        compiler = subprocess.run(["chroot", place, "sh", "-c", "command -v cc gcc g++ c++ clang"], capture_output=True, check=False)
        yield f"{name}: no compiler", compiler.returncode != 0, ""
        start = cpu_s()
        top = archive.name[: -len(".tar.xz")]
        subprocess.run(["tar", "-C", place / "tmp", "-xf", archive], check=True)  # a minimal system has no xz
        yield from check_archive(place, top, native)
        wheel = next((one for one in wheels if tag in one.name), None)
        if wheel is None:
            raise Failed(f"there is no wheel for Python {python} (script/portable builds it)")
        shutil.copy(wheel, place / "tmp")
        yield from check_wheel(place, wheel, python, native)
        used = cpu_s() - start
        yield f"all within {SYSTEM_CPU_S} s", used <= SYSTEM_CPU_S, f"{used:.0f} s processor time"
        other = next((one for one in wheels if tag not in one.name), None)
        if other is not None:
            yield from check_other_python(place, other, python)


def check_library(archive):
    """Compiles a C++ program with the unpacked archive on this machine, by pkg-config and by CMake."""
    name, source = archive.name[: -len(".tar.xz")], ROOT / "tests/package/consumer"
    with tempfile.TemporaryDirectory() as folder:
        run(["tar", "-C", folder, "-xf", archive])
        prefix = pathlib.Path(folder) / name
        flags = run(["pkgconf", "--cflags", "--libs", "taut"], env={**os.environ, "PKG_CONFIG_LIBDIR": str(prefix / "lib/pkgconfig")})
        run(["c++", "-std=c++20", source / "main.cpp", "-o", f"{folder}/by_pkgconf", *flags.split()])
        run(["cmake", "-S", source, "-B", f"{folder}/by_cmake", "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={prefix}"])
        run(["cmake", "--build", f"{folder}/by_cmake"])
        for way, program in (("pkg-config", f"{folder}/by_pkgconf"), ("find_package", f"{folder}/by_cmake/consumer")):
            said = run([program, prefix / "share/taut/models/tetraspine3.yaml", f"{folder}/trace.h5"]).strip()
            needed = re.findall(r"NEEDED\s+(\S+)", run(["objdump", "-p", program]))
            others = [library for library in needed if not library.startswith(("libstdc++.", "libgcc_s.", "libc.", "libm."))]
            yield f"archive: C++ program by {way}", "12 cables" in said and not others, " ".join([said, *others])


def native_results(taut):
    """Returns the results of the native build, the reference for all systems."""
    folder = ROOT / "build/portable/native"
    shutil.rmtree(folder, ignore_errors=True)
    models = sorted(path.name for path in (ROOT / "share/models").glob("*.yaml"))
    run([taut, "run", "experiments/push_20n.yaml", "--out", folder], cwd=ROOT)
    program = ("import json, taut\n"
               "e = taut.load('experiments/push_20n.yaml'); e.duration_s = 3\n"
               "s = taut.Simulation('experiments/push_20n.yaml'); s.run_until(1)\n"
               "print(json.dumps([taut.run(e).state_hash, round(float(s.tension_n('outer_right_1')[0]), 6)]))")
    python = json.loads(run(["/usr/bin/python3", "-c", program], cwd=ROOT,
                            env={**os.environ, "PYTHONPATH": str(taut.parent / "python")}))
    found = {"hash": hash_of(folder / "summary.json"), "python_hash": python[0], "tension": str(python[1]), "models": models,
             "analyses": analyses(taut, models, lambda command: run(["sh", "-c", command], cwd=ROOT / "share"))}
    shutil.rmtree(folder)
    return found


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    out = pathlib.Path(sys.argv[1]).resolve()
    suites = sys.argv[2:] or list(systems())
    if os.getuid() != 0 or not shutil.which("debootstrap"):
        sys.exit("bare_systems.py: this test needs root and debootstrap (fix: sudo, script/setup portable)")
    archive = next(iter(out.glob("taut-*-linux-x86_64.tar.xz")), None)
    wheels = sorted(out.glob("*.whl"))
    if archive is None:
        sys.exit(f"bare_systems.py: {out} contains no archive (script/portable builds it)")
    failed = 0
    for what, good, note in check_library(archive):
        print(f"{'ok    ' if good else 'WRONG '} {what} ({note})", flush=True)
        failed += not good
    for path, most_mb in ((archive, ARCHIVE_MB), *((wheel, WHEEL_MB) for wheel in wheels)):
        good, note = small(path, most_mb)
        print(f"{'ok    ' if good else 'WRONG '} {path.name}: at most {most_mb} MB ({note})", flush=True)
        failed += not good
    native = native_results(pathlib.Path(os.environ.get("TAUT_COMMAND", ROOT / "build/release/taut")).resolve())
    for suite in suites:
        try:
            for what, good, note in check(suite, archive, wheels, native):
                print(f"{'ok    ' if good else 'WRONG '} {suite}: {what}{f' ({note})' if note else ''}", flush=True)
                failed += not good
        except Failed as error:
            print(f"WRONG  {suite}: {error}", flush=True)
            failed += 1
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
