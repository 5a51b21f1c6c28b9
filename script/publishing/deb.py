"""Debian packages of a source tree: builds them, checks them with lintian, installs them into an empty root and runs
their programs."""

import email.utils
import os
import pathlib
import re
import shutil
import subprocess

from .release import current
from .stage import Problem

TOOLS = {"dpkg-buildpackage": "dpkg-dev", "dh": "debhelper", "lintian": "lintian", "fakeroot": "fakeroot"}
PACKAGES = ("taut", "libtaut-dev")


def missing():
    """Returns the missing Debian packages."""
    return [package for tool, package in TOOLS.items() if shutil.which(tool) is None]


def run(command, **more):
    """Returns the command's output; raises a Problem with all of it if the command fails."""
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **more)
    if done.returncode != 0:
        raise Problem(f"{' '.join(map(str, command))} ended with status {done.returncode}:\n{done.stdout}")
    return done.stdout


def write_changelog(source, seconds):
    """Writes debian/changelog, in which Debian requires the version; the changes are in CHANGELOG.md only."""
    maintainer = re.search(r"^Maintainer: (.*)$", (source / "debian/control").read_text(), re.MULTILINE)[1]
    (source / "debian/changelog").write_text(
        f"taut ({current(source)}) unstable; urgency=medium\n\n"
        "  * What changes is in /usr/share/doc/taut/CHANGELOG.md.\n\n"
        f" -- {maintainer}  {email.utils.formatdate(seconds)}\n")


def build(source, seconds, built=None):
    """Builds the packages next to `source`. With `built`, packages that build folder without compiling."""
    write_changelog(source, seconds)
    environment = dict(os.environ, DEB_BUILD_OPTIONS="noautodbgsym", SOURCE_DATE_EPOCH=str(seconds))
    if built:
        environment["TAUT_BUILT"] = str(built)
    # -d: node may come from another source than Debian, as script/setup allows; debian/rules checks for its outputs.
    run(["dpkg-buildpackage", "-b", "-us", "-uc", "-d"], cwd=source, env=environment)
    debs = [next(source.parent.glob(f"{name}_*.deb"), None) for name in PACKAGES]
    if None in debs:
        raise Problem(f"dpkg-buildpackage made only {[deb.name for deb in debs if deb]}")
    return debs


def look_at(source):
    """Returns lintian's output; raises a Problem for errors and warnings."""
    changes = next(source.parent.glob("taut_*.changes"))
    command = ["lintian", "--fail-on", "error,warning"]
    return run(command + (["--allow-root"] if os.geteuid() == 0 else []) + [changes])


def install(debs, root):
    """Installs into an empty root, without the dependencies; apt checks whether they could be installed."""
    for folder in ("info", "updates", "triggers"):
        (root / "var/lib/dpkg" / folder).mkdir(parents=True)
    (root / "var/lib/dpkg/status").touch()
    as_root = [] if os.geteuid() == 0 else ["fakeroot"]
    run([*as_root, "dpkg", f"--root={root}", "--force-not-root", "--force-depends", "--force-bad-path",
         f"--log={root}/dpkg.log", "-i", *debs])
    run(["apt-get", "install", "--simulate", "--no-install-recommends", *debs])


def try_out(root, work, version):
    """Checks that the installed command works with the installed files and reports this version."""
    taut = root / "usr/bin/taut"
    if (said := run([taut, "--version"]).strip()) != f"taut {version}":
        raise Problem(f"the installed command says that it is \"{said}\", not taut {version}")
    shared = root / "usr/share/taut"
    if f"models, in {shared}/models" not in run([taut, "list", "models"]):
        raise Problem("the installed command does not list the installed models")
    run([taut, "run", shared / "experiments/hang.yaml", "--report", "--quiet", "--out", work / "run"])
    for name in ("trace.h5", "summary.json", "inputs.yaml", "report.html"):
        if not (work / "run" / name).is_file():
            raise Problem(f"the installed command made no {name}")
    run(["man", "--warnings", "-l", root / "usr/share/man/man1/taut.1.gz"] if shutil.which("man") else
        ["gzip", "-t", root / "usr/share/man/man1/taut.1.gz"])
    consumer = work / "consumer"
    run(["cmake", "-S", root / "usr/share/doc/taut/examples", "-B", consumer, "-G", "Ninja",
         f"-DCMAKE_PREFIX_PATH={root}/usr", "-DCMAKE_BUILD_TYPE=Release"])
    run(["cmake", "--build", consumer, "--target", "tip_over"])
    run([consumer / "tip_over", root / "usr/share/doc/taut/docs/tutorial_structures/table.yaml"], cwd=work)


def make(source, work, out, seconds, built=None):
    """Runs all steps: leaves the packages in `out` and returns lintian's output."""
    source, work = pathlib.Path(source), pathlib.Path(work)
    debs = build(source, seconds, built)
    said = look_at(source)
    install([deb.resolve() for deb in debs], work / "root")
    try_out(work / "root", work, current(source))
    out.mkdir(parents=True, exist_ok=True)
    return [shutil.copy(deb, out) for deb in debs], said
