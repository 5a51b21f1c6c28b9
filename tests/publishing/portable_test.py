"""Wheels of script/portable are reproducible and limited to an old C library; the table of bare systems is consistent.

Usage: portable_test.py Portable.TEST. TEST is the name of a function of this file.
"""

import ctypes
import os
import pathlib
import shutil
import sys
import tarfile
import tempfile
import time
import zipfile

sys.dont_write_bytecode = True
from harness import ROOT, Skipped, main, run  # noqa: E402
from publishing import bare_systems, release  # noqa: E402

OLD = "extern int abs(int); int f(int x) { return abs(x); }"  # since glibc 2.2.5
NEW = "extern double hypot(double, double); double f(double x) { return hypot(x, 1); }"  # a later version in glibc 2.35

LOCKS = """
#include <chrono>
#include <mutex>
#include <thread>
extern "C" int Locks(bool held, int wait_ms) {
  std::timed_mutex mutex;
  if (held) std::thread([&] { mutex.lock(); }).join();
  return mutex.try_lock_for(std::chrono::milliseconds(wait_ms));
}
"""


def module(place, code, *libraries):
    """Compiles a shared library with the name of a module for Python 3.9."""
    compiler = shutil.which("cc")
    if compiler is None:
        raise Skipped("there is no C compiler")
    source, out = place / "module.c", place / "_core.cpython-39-x86_64-linux-gnu.so"
    source.write_text(code)
    run(compiler, "-shared", "-fPIC", "-fno-builtin", source, "-o", out, "-Wl,--no-as-needed", "-lc", *libraries)
    return out


def pack(place, code_module, out, status=0):
    (place / "web").mkdir(exist_ok=True)
    (place / "web/index.html").write_text("<p>")
    env = dict(os.environ, PYTHONPATH=str(ROOT / "script"), PYTHONDONTWRITEBYTECODE="1", SOURCE_DATE_EPOCH="1767225600")
    return run(sys.executable, "-m", "publishing.wheel", code_module, place / "web", out, env=env, status=status)


def PackingAWheelTwiceGivesTheSameBytes():
    with tempfile.TemporaryDirectory() as name:
        place = pathlib.Path(name)
        built = module(place, OLD)
        pack(place, built, place / "first")
        for path in (built, place / "web/index.html"):
            os.utime(path, (1, 1))
        pack(place, built, place / "second")
        first, second = (next((place / folder).glob("*.whl")) for folder in ("first", "second"))
        assert first.name == second.name and first.read_bytes() == second.read_bytes()
        assert first.name.endswith("-cp39-cp39-manylinux_2_28_x86_64.whl"), first.name
        with zipfile.ZipFile(first) as wheel:
            assert {entry.date_time for entry in wheel.infolist()} == {(2026, 1, 1, 0, 0, 0)}
            assert {"taut/__init__.py", f"taut/{built.name}", "taut/share/taut/web/index.html"} <= set(wheel.namelist())


def AModuleThatNeedsALaterCLibraryIsRefused():
    with tempfile.TemporaryDirectory() as name:
        place = pathlib.Path(name)
        said = pack(place, module(place, NEW, "-lm"), place / "out", status=1)
        assert "needs glibc 2.35: hypot" in said, said
        assert not (place / "out").exists()


def PackingAFolderTwiceGivesTheSameBytes():
    with tempfile.TemporaryDirectory() as name:
        place = pathlib.Path(name)
        for folder, files in (("a", ("x", "y")), ("b", ("y", "x"))):  # created in another order, at another time
            (place / folder / "assets").mkdir(parents=True)
            for file in files:
                (place / folder / "assets" / file).write_text(file)
        os.utime(place / "b/assets/x", (1, 1))
        packed = [release.pack(place / folder, "taut-browser", 1767225600, place / folder) for folder in "ab"]
        assert packed[0].read_bytes() == packed[1].read_bytes()
        with tarfile.open(packed[0]) as file:
            names = {one.name: one.mtime for one in file}
        assert names.keys() == {"taut-browser", "taut-browser/assets", "taut-browser/assets/x", "taut-browser/assets/y"}, names
        assert set(names.values()) == {1767225600}


def TimedLocksNeedNoLaterCLibrary():
    """The module's timed mutexes wait by functions of glibc 2.28 (older_libc.c), for the right time."""
    compiler, c_compiler = shutil.which("c++"), shutil.which("cc")
    if compiler is None or c_compiler is None:
        raise Skipped("there is no compiler")
    with tempfile.TemporaryDirectory() as name:
        place = pathlib.Path(name)
        (place / "locks.cpp").write_text(LOCKS)
        run(c_compiler, "-fPIC", "-c", ROOT / "python/core/older_libc.c", "-o", place / "older.o")
        run(compiler, "-std=c++20", "-shared", "-fPIC", place / "locks.cpp", place / "older.o", "-o", place / "locks.so", "-pthread")
        listed = run("objdump", "-T", place / "locks.so")
        wanted = [line.split()[-1] for line in listed.splitlines() if "*UND*" in line]
        assert "pthread_mutex_timedlock" in wanted and "pthread_mutex_clocklock" not in wanted, wanted
        locks = ctypes.CDLL(str(place / "locks.so"))
        start = time.monotonic()
        assert locks.Locks(False, 10000) == 1
        assert time.monotonic() - start < 9
        start = time.monotonic()
        assert locks.Locks(True, 50) == 0
        assert 0.05 <= time.monotonic() - start < 10


def TheErrorOfAnotherPythonNamesBothVersions():
    with tempfile.TemporaryDirectory() as name:
        shutil.copytree(ROOT / "python/taut", pathlib.Path(name) / "taut")
        (pathlib.Path(name) / "taut/_core.cpython-399-x86_64-linux-gnu.so").touch()
        env = dict(os.environ, PYTHONPATH=name, PYTHONDONTWRITEBYTECODE="1")
        said = run(sys.executable, "-c", "import taut", env=env, status=1)
        python = f"this is Python {sys.version_info.major}.{sys.version_info.minor} ({sys.implementation.cache_tag})"
        assert f"taut is built for another Python: _core.cpython-399-x86_64-linux-gnu.so; {python}" in said, said


def EveryPythonHasASystemThatTheDocumentsName():
    text = (ROOT / "docs/install.md").read_text()
    systems = bare_systems.systems()
    pythons = [python for _, python in systems.values()]
    assert pythons == [f"3.{minor}" for minor in range(9, 9 + len(pythons))], pythons
    for name, python in systems.values():
        row = next(line for line in text.splitlines() if line.startswith(f"| wheel for CPython {python} "))
        assert name in row, row


def TheExampleOfTheReadmeIsFound():
    program, output = bare_systems.readme_example()
    assert program == (ROOT / "examples/run_from_python.py").read_text()
    assert len(output.splitlines()) == 2 and "friction" in output, output


if __name__ == "__main__":
    main(globals())
