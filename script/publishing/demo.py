#!/usr/bin/python3
"""Assembles the browser demo (script/wasm): pages, core, shipped files, and the state hashes of `taut run` for them, so
that the page can compare its results."""

import argparse
import concurrent.futures
import hashlib
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
SHARE = ROOT / "share"
FOLDERS = {"models": (".yaml", ".obj"), "experiments": (".yaml",), "gaits": (".yaml",)}
SOON_S = 1.0  # time of the first comparison of hashes


def shipped():
    """Returns {path: text} of all files that an experiment may read."""
    return {f"{folder}/{path.name}": path.read_text()
            for folder, ends in FOLDERS.items() for path in sorted((SHARE / folder).iterdir()) if path.suffix in ends}


def run(taut, path, duration_s=None):
    """Returns the time at which a run ends, and the hash of its last state."""
    with tempfile.TemporaryDirectory() as out:
        command = [taut, "run", SHARE / path, "--json", "--quiet", "--out", pathlib.Path(out) / "run"]
        command += [] if duration_s is None else ["--duration_s", repr(duration_s)]
        done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"script/wasm: {path}: {done.stderr}")
    summary = json.loads(done.stdout)
    return {"time_s": summary["simulated_s"], "hash": summary["state_hash"]}


def hashes_of(taut, path):
    end = run(taut, path)
    return ([run(taut, path, SOON_S)] if end["time_s"] > SOON_S else []) + [end]


def hashes(taut, files, kept):
    """Returns {experiment: [{time_s, hash}, ...]}; cached while neither files nor command change."""
    what = hashlib.sha256(json.dumps(files).encode() + taut.read_bytes()).hexdigest()
    if kept.exists():
        known = json.loads(kept.read_text())
        if known["of"] == what:
            return known["hashes"]
    print("script/wasm: running all experiments for their hashes (a minute)", flush=True)
    paths = [path for path in files if path.startswith("experiments/")]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        found = dict(zip(paths, pool.map(lambda path: hashes_of(taut, path), paths)))
    kept.write_text(json.dumps({"of": what, "hashes": found}))
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    for name in ("pages", "core", "taut", "out"):
        parser.add_argument(f"--{name}", type=pathlib.Path, required=True)
    args = parser.parse_args()
    files, found = shipped(), {}
    if args.taut.exists():
        found = hashes(args.taut.resolve(), files, args.out.with_name("hashes.json"))
    else:
        print(f"script/wasm: there is no {args.taut} (script/build): the page has no hashes to set beside its own",
              file=sys.stderr)
    fresh = args.out.with_name(args.out.name + ".new")
    shutil.rmtree(fresh, ignore_errors=True)
    shutil.copytree(args.pages, fresh)
    (fresh / "demo.html").rename(fresh / "index.html")
    for name in ("taut_core.mjs", "taut_core.wasm"):
        shutil.copy(args.core / name, fresh)
    (fresh / "files.json").write_text(json.dumps({"files": files, "hashes": found}))
    for name in ("LICENSE", "NOTICE"):
        shutil.copy(ROOT / name, fresh)
    shutil.rmtree(args.out, ignore_errors=True)
    fresh.rename(args.out)
    print(f"{args.out}/index.html")


if __name__ == "__main__":
    main()
