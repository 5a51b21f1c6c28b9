"""Variants of an experiment, run in parallel, and templates of pages filled with their results."""

import concurrent.futures
import json
import os
import pathlib
import re
import subprocess


ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


class Problem(Exception):
    """An error that the user can fix, with instructions in its text."""


class Variant:
    """An experiment of share/experiments/ with some of its keys replaced.

    `keys` is the YAML of the top-level keys that replace the base's, `parameters` the values for
    --set. `full_trace` keeps all channels at the base's rate, in trace.h5 and trace.csv. A run whose status
    is not ok is a Problem, unless `any_status` is set: then the caller checks it."""

    def __init__(self, name, base, keys="", parameters=None, full_trace=False, any_status=False):
        self.name, self.base, self.keys = name.replace(".", "_"), base, keys
        self.parameters, self.full_trace, self.any_status = parameters or {}, full_trace, any_status


class Taut:
    """The taut command and its output folder. `writes`: pages are written, not checked."""

    def __init__(self, command, folder, writes=True):
        self.command, self.folder, self.writes = command, folder, writes
        if not os.access(command, os.X_OK):
            raise Problem(f"there is no {command}; build it with script/build, or name it with --taut")

    def __call__(self, *arguments):
        """Runs taut; returns its output."""
        run = subprocess.run([str(self.command), *map(str, arguments)], capture_output=True, text=True)
        if run.returncode != 0:
            raise Problem(f"taut {' '.join(map(str, arguments))}\n{run.stdout}{run.stderr}".rstrip())
        return run.stdout

    def _run(self, variant):
        folder = self.folder / variant.name
        folder.mkdir(parents=True, exist_ok=True)
        base = os.path.relpath(pathlib.Path("share/experiments", variant.base + ".yaml"), folder)
        record = "" if variant.full_trace else "record: {rate_hz: 1}\n"
        experiment = folder / "experiment.yaml"
        experiment.write_text(
            f"taut: 1\nkind: experiment\nbase: {base}\nname: {variant.name}\n{record}{variant.keys}")
        settings = [x for name, value in variant.parameters.items() for x in ("--set", f"{name}={value}")]
        csv = ["--csv"] if variant.full_trace else []
        self("run", experiment, *settings, *csv, "--quiet", "--out", folder)
        summary = json.loads((folder / "summary.json").read_text())
        if summary["status"] != "ok" and not variant.any_status:
            raise Problem(f"{experiment}: {summary['status']}")
        return Result(variant, summary)

    def run(self, variants):
        """Runs all variants in parallel, one per core; returns a Result for each name."""
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            return {result.variant.name: result for result in pool.map(self._run, variants)}


class Result:
    """summary.json of a run; forces in newtons."""

    def __init__(self, variant, summary):
        self.variant, self.summary = variant, summary
        self.cables = {cable["name"]: cable for cable in summary["cables"]}

    def mean(self, cable, phase, quantity="elastic"):
        return self.cables[cable][quantity]["phases"][phase]["mean_n"]

    def max(self, cable, quantity, after_start=False):
        return self.cables[cable][quantity]["max_after_start_n" if after_start else "max_n"]


def keep_picture(taut, path, text):
    """Writes a page's picture, or when checking reports a difference."""
    path = ROOT / path
    if taut.writes:
        path.write_text(text)
    elif not path.exists() or path.read_text() != text:
        raise Problem(f"{path.relative_to(ROOT)} is not up to date")


def yaml_block(path, key):
    """Returns the text of a top-level key of a YAML file, including its value."""
    match = re.search(rf"^{key}:.*\n(?:[ #].*\n|\n)*", (ROOT / path).read_text(), re.MULTILINE)
    if not match:
        raise Problem(f"{path} has no key {key}")
    return match[0]


def replaced(text, old, new):
    """Returns `text` with `old` replaced; `old` must occur."""
    if old not in text:
        raise Problem(f"there is no '{old}' in\n{text}")
    return text.replace(old, new)


def fill(template, values):
    """Replaces each {{name}} by its value; every name needs a value, and every value must be used."""
    wanted = set(re.findall(r"\{\{(\w+)\}\}", template))
    if wanted != set(values):
        raise Problem(f"template and values do not fit: {', '.join(sorted(wanted ^ set(values)))}")
    return re.sub(r"\{\{(\w+)\}\}", lambda match: values[match[1]], template)


def table(head, rows):
    """Returns a Markdown table without its last line break."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)
