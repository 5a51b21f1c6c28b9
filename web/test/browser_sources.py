#!/usr/bin/env python3
"""Checks that the files in the list of the browser's build (TAUT_BROWSER) are enough to link. Continuous
integration does not compile them for WebAssembly, so a moved function would go unnoticed.

  browser_sources.py BUILD     BUILD: a build of all of taut, for its objects and its compiler

Sources that only the browser's build has are compiled for this machine, those with the same command together;
all other objects exist."""
import functools
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
ABSENT = {"std::bit_cast": "__builtin_bit_cast"}
LIBRARY = re.compile(r"^#include <(fmt|nlohmann)/", re.MULTILINE)
OURS = re.compile(r"_ZT?[A-Z]*(NK?|K)?4taut")


def output_of(*command):
    """Returns the command's output; exits with its error output if it fails."""
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(f"{shlex.join(command)}: {done.stdout}{done.stderr}")
    return done.stdout


def commands_of(build):
    """Returns a dict from source paths to entries of compile_commands.json."""
    with open(os.path.join(build, "compile_commands.json"), encoding="utf-8") as file:
        return {os.path.realpath(entry["file"]): entry for entry in json.load(file)}


def browser_commands(of_all, folder):
    """Returns the commands of the browser's build, configured for this machine."""
    yaml = os.path.join(folder, "yaml-cpp")
    os.makedirs(os.path.join(yaml, "src"))
    os.makedirs(os.path.join(yaml, "include"))
    with open(os.path.join(yaml, "src", "none.cpp"), "w", encoding="utf-8"):
        pass
    build = os.path.join(folder, "build")
    with open(os.path.join(of_all, "CMakeCache.txt"), encoding="utf-8") as file:
        kernels = re.search(r"^TAUT_INSTRUCTION_SETS:\w+=(.*)$", file.read(), re.M).group(1)
    output_of("cmake", "-S", ROOT, "-B", build, "-DTAUT_BROWSER=ON", f"-DTAUT_YAML_SOURCE={yaml}",
              f"-DTAUT_INSTRUCTION_SETS={kernels}",  # same instruction sets as in the objects
              "-DTAUT_UNITY_BUILD=OFF", "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON")
    commands = commands_of(build)
    return {path: entry for path, entry in commands.items() if path.startswith(ROOT + os.sep)
            and not path.startswith(os.path.join(ROOT, "benchmarks"))}


def check_text(wanted, folder):
    """Exits with an error if emscripten cannot compile a source that the compiler of this machine accepts: a library's
    header in a layer that does not link the library (emscripten does not search /usr/include), or a function that the
    libc++ of emscripten 3.1.6 lacks."""
    wrong = []
    for path, entry in wanted.items():
        text = pathlib.Path(path).read_text(encoding="utf-8")
        linked = os.path.join(folder, "build", "headers") in entry["command"]
        if not linked and (found := LIBRARY.search(text)):
            wrong.append(f"{os.path.relpath(path, ROOT)}: includes {found[1]}, which the layer's CMakeLists.txt does not link")
        wrong += [f"{os.path.relpath(path, ROOT)}: {name} (use {instead})" for name, instead in ABSENT.items() if name in text]
    if wrong:
        sys.exit("\n".join(wrong))


def object_in(entry):
    """Returns the object file of an entry of compile_commands.json."""
    words = shlex.split(entry["command"])
    return os.path.join(entry["directory"], words[words.index("-o") + 1])


def objects_made(here, wanted):
    """Returns the object in the build for each source path. A file of a unity build with other sources
    than the wanted ones is omitted, because their symbols would count as well."""
    objects = {}
    for path, entry in here.items():
        sources = [path]
        if os.path.basename(os.path.dirname(path)) == "Unity":
            with open(path, encoding="utf-8") as file:
                sources = [os.path.realpath(name) for name in re.findall(r'#include "(.*)"', file.read())]
        if wanted.issuperset(sources):
            objects.update(dict.fromkeys(sources, object_in(entry)))
    return objects


def objects_of(build, folder):
    """Returns an object for each source path relative to the top folder."""
    wanted = browser_commands(build, folder)
    check_text(wanted, folder)
    made = objects_made(commands_of(build), set(wanted))
    launcher = [word for word in os.environ.get("CMAKE_CXX_COMPILER_LAUNCHER", "").split(";") if word]  # compiler cache
    for number, (command, paths) in enumerate(missing_units(wanted, made)):
        unit = os.path.join(folder, f"{number}.cpp")
        with open(unit, "w", encoding="utf-8") as file:
            file.writelines(f'#include "{path}"\n' for path in paths)
        compiled = os.path.join(folder, f"{number}.o")
        output_of(*launcher, *command, "-O0", "-I/usr/include", "-o", compiled, "-c", unit)
        made.update(dict.fromkeys(paths, compiled))
    return {os.path.relpath(path, ROOT): made[path] for path in sorted(wanted)}


def missing_units(wanted, made):
    """Returns pairs of a compiler command without files, and the sources that it compiles together. These have no object
    in `made`. Sources of a layer are together, as in unity builds; in apps/browser, each is alone, because names clash."""
    units = {}
    for path, entry in sorted(wanted.items()):
        if path not in made:
            words = shlex.split(entry["command"])
            for option in ("-o", "-c"):
                at = words.index(option)
                del words[at:at + 2]
            plain = tuple(word for word in words if not re.fullmatch(r"-O.*|-flto|-s[A-Z_]+=.*", word))
            parts = os.path.relpath(path, ROOT).split(os.sep)
            together = parts[1] if parts[0] == "src" else path
            units.setdefault((plain, together), []).append(path)
    return [(command, paths) for (command, _), paths in units.items()]


@functools.cache  # a unity build has one object for many sources
def symbols_of(made):
    """Returns the taut symbols that an object defines, and the symbols that it needs."""
    has, wants = set(), set()
    for line in output_of("nm", "--no-demangle", made).splitlines():
        kind, name = line.split()[-2:]
        if OURS.match(name):
            (wants if kind == "U" else has).add(name)
    return has, wants


def main():
    build = os.path.abspath(sys.argv[1])
    folder = os.path.join(build, "browser_sources")  # always the same, for the compiler cache
    shutil.rmtree(folder, ignore_errors=True)
    try:
        symbols = {name: symbols_of(made) for name, made in objects_of(build, folder).items()}
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    who_has = {}
    for name, (has, _) in symbols.items():
        for symbol in has:
            who_has.setdefault(symbol, name)
    # Same as a linker with archives: from the entry points to the symbols that they need.
    reached = [name for name in symbols if name.startswith("apps/browser/")]
    if len(reached) < 2:
        sys.exit("the browser's build has no apps/browser")
    missing = {}
    for name in reached:
        for symbol in sorted(symbols[name][1]):
            owner = who_has.get(symbol)
            if owner is None:
                missing.setdefault(symbol, []).append(name)
            elif owner not in reached:
                reached.append(owner)
    for symbol, names in missing.items():
        print(f"{output_of('c++filt', symbol).strip()}\n  is wanted by {', '.join(names)}; no file of "
              "the browser's build has it (src/*/CMakeLists.txt, TAUT_BROWSER)")
    print(f"{len(reached)} of {len(symbols)} files are reached, {len(missing)} names are missing")
    sys.exit(1 if missing else 0)


if __name__ == "__main__":
    main()
