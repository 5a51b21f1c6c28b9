"""Runs the benchmark program and converts its measurements to a list."""

import functools
import json
import os
import pathlib
import platform
import statistics
import subprocess
import tempfile

from measuring import wasm
from measuring.commands import command
from validation.runs import ROOT, Problem

STAGE = "ns_"  # prefix of the counters that are times of stages


def build(*targets):
    commit()
    command("bash", "-c", f"source script/common.sh; script/setup; build install {' '.join(targets)}", cwd=ROOT)


def processor():
    try:
        for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    except OSError:
        pass
    return platform.processor() or platform.machine()


@functools.cache  # computed once: the program was built at the start, even if sources are edited meanwhile
def commit():
    run = subprocess.run(["git", "describe", "--always", "--dirty", "--exclude", "*"], cwd=ROOT,
                         capture_output=True, text=True)
    return run.stdout.strip() or "unknown"


def machine(context):
    """Returns the conditions of the measurements: Google Benchmark's context and further properties of the machine."""
    return {"processor": processor(), "cores": os.cpu_count(), "load": context["load_avg"][:1],
            "commit": commit(), "mujoco_wasm": context.get("mujoco_wasm", wasm.ABSENT),
            **{key: context[key] for key in ("mujoco", "bullet", "ode", "step_s", "max_linear_solves",
                                             "tolerance_m_per_s")}}


def results(raw):
    """Converts Google Benchmark's JSON to the list: the median of the repetitions for each benchmark."""
    where = machine(raw["context"])
    repetitions = {}
    for run in raw["benchmarks"]:
        if run.get("error_occurred"):
            raise Problem(f"{run['name']}: {run['error_message']}")
        if run["run_type"] == "iteration":
            repetitions.setdefault(run["run_name"].removesuffix("/real_time"), []).append(run)
    found = []
    for name, runs in repetitions.items():
        kind, engine, setting, robot, worlds, lanes, threads = name.split("/")
        rates = [run["steps_per_s"] for run in runs]
        item = {"kind": kind, "engine": engine, "setting": setting, "robot": robot,
                "worlds": int(worlds), "lanes": int(lanes), "threads": int(threads),
                "steps_per_s": statistics.median(rates), "repetitions": len(rates),
                "spread": (max(rates) - min(rates)) / statistics.median(rates)}
        for key in ("contacts", "linear_solves", "bytes_per_world", "apart_m", "speed_kept", "joints"):
            if runs[0].get(key) is not None:
                item[key] = statistics.median(run[key] for run in runs)
        if "deepest_m" in runs[0]:
            item["deepest_m"] = max(run["deepest_m"] for run in runs)
        if "converged" in runs[0]:
            item["converged"] = all(run["converged"] == 1 for run in runs)
        stages = {key.removeprefix(STAGE): statistics.median(run[key] for run in runs)
                  for key in runs[0] if key.startswith(STAGE)}
        if stages:
            item["stages_ns"] = stages
        found.append({**item, "machine": where})
    return found


def run(program, only, repetitions, seconds):
    """Returns the list for benchmarks whose names match; empty if there are none."""
    if not os.access(program, os.X_OK):
        raise Problem(f"there is no {program}; it needs libbenchmark-dev (script/setup)")
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder, "raw.json")
        command(program, f"--benchmark_filter={only}", f"--benchmark_repetitions={repetitions}",
                f"--benchmark_min_time={seconds}", "--benchmark_enable_random_interleaving=true",
                f"--benchmark_out={out}", "--benchmark_out_format=json")
        text = out.read_text()  # empty if no benchmark matches
    if not text:
        return []
    raw = json.loads(text)
    raw["context"]["mujoco_wasm"] = wasm.version()
    raw["benchmarks"] += wasm.measured("rates", command(program, "--mjcf", only), repetitions, seconds) or []
    return results(raw)
