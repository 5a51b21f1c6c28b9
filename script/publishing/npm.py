#!/usr/bin/python3
"""Assembles the npm package (script/wasm --npm): the entry with its types, the core, and the shipped files."""

import argparse
import json
import pathlib
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "script"))
from publishing import demo, release  # noqa: E402


def assemble(entry, core, package):
    """Writes the files of the package into a new folder `package`. `entry`: folder of the compiled web/src/demo/simulate.ts."""
    shutil.rmtree(package, ignore_errors=True)
    dist = package / "dist"
    dist.mkdir(parents=True)
    for path in sorted(entry.iterdir()):
        shutil.copyfile(path, dist / path.name)
    for name in ("taut_simulate.mjs", "taut_simulate.wasm"):
        shutil.copyfile(core / name, dist / name)  # not executable
    (dist / "files.json").write_text(json.dumps(demo.shipped()))
    for name in ("LICENSE", "NOTICE", "packaging/npm/README.md"):
        shutil.copy(ROOT / name, package)
    about = json.loads((ROOT / "packaging/npm/package.json").read_text())
    about["version"] = release.current(ROOT)
    (package / "package.json").write_text(json.dumps(about, indent=2) + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    for name in ("entry", "core", "out"):
        parser.add_argument(f"--{name}", type=pathlib.Path, required=True)
    args = parser.parse_args()
    assemble(args.entry, args.core, args.out / "package")
    for old in args.out.glob("*.tgz"):
        old.unlink()
    packed = subprocess.run(["npm", "pack", "--json", "--pack-destination", args.out.resolve()], cwd=args.out / "package",
                            stdout=subprocess.PIPE, text=True, check=True)
    print(args.out / json.loads(packed.stdout)[0]["filename"])


if __name__ == "__main__":
    main()
