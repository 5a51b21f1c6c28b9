"""The paper's experiments on emulated boards, beside the pure simulation and NTRT; and where the difference comes from."""

import concurrent.futures
import csv
import gzip
import json
import os
import pathlib
import subprocess

from validation.runs import ROOT, Problem, fill, replaced, table

TEMPLATE = pathlib.Path(__file__).with_suffix(".md.in")
MODEL = "models/tetraspine3_motors.yaml"
EXPERIMENTS = {"push_20n": "push", "sine_hand_tuned": "sine_hand_tuned", "cpg_learned": "cpg_learned"}
NTRT = "tests/data/ntrt/{}_1000hz.csv.gz"
START_S = 5.0
CABLES = [f"{side}_{where}_{n}" for n in (1, 2) for side in ("outer", "inner") for where in ("right", "left", "top")]
CAUSES = (  # what differs: name, flags, replacements in the model
    ("as it is", [], {}),
    ("load cells without noise", ["--noise_counts", "0"], {}),
    ("load cells not filtered", ["--board", "tension_filter_share=1"], {}),
    ("rate of the encoder not filtered", ["--board", "rate_filter_share=1"], {}),
    ("PID three times as strong", ["--board", "force_p_per_n=0.18", "force_i_per_n_s=1.8"], {}),
    ("motors and gears without friction", [],
     {"static_friction_torque_n_m: 0.00012": "static_friction_torque_n_m: 0\n    friction_torque_n_m: 0",
      "gear_efficiency: 0.66": "gear_efficiency: 1"}),
    ("supply of 24 V", [], {"supply_voltage_v: 12": "supply_voltage_v: 24"}),
    ("USB without delay", ["--usb_latency_s", "0"], {}),
)


def h5py():
    try:
        import h5py as module
    except ImportError:
        raise Problem("this page reads traces with h5py (Debian: python3-h5py)") from None
    return module


class Waves:
    """Tensions of the cables after the start [N], 100 or 50 a second."""

    def __init__(self, path):
        with h5py().File(path, "r") as file:
            time_s = file["time_s"][:]
            rows = time_s >= START_S - 1e-9
            self.of = {cable: file[f"cable/{cable}/tension_n"][:][rows] for cable in CABLES}

    def largest(self):
        return max(wave.max() for wave in self.of.values())

    def mean(self):
        return sum(wave.mean() for wave in self.of.values()) / len(self.of)

    def off(self, other):
        """Root mean square and largest difference over all cables."""
        squares = [((self.of[c] - other.of[c]) ** 2).mean() for c in CABLES]
        return (sum(squares) / len(squares)) ** 0.5, max(abs(self.of[c] - other.of[c]).max() for c in CABLES)


def ntrt_figures(name):
    """Largest and mean tension of NTRT's elastic part after the start."""
    with gzip.open(ROOT / NTRT.format(EXPERIMENTS[name]), "rt") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    columns = [column for column in rows[0] if column.endswith("tension_n") or column.endswith("_tension_N")
               or "elastic" in column]
    late = [row for row in rows if float(row["time_s"]) >= START_S]
    values = [[float(row[column]) for row in late] for column in columns]
    return max(map(max, values)), sum(sum(v) / len(v) for v in values) / len(values)


class Boards:
    def __init__(self, taut):
        self.taut, self.command = taut, pathlib.Path(taut.command).parent / "taut_virtual_robot"
        if not os.access(self.command, os.X_OK):
            raise Problem(f"there is no {self.command}: it wants gcc-avr, avr-libc and libsimavr-dev")

    def run(self, job):
        name, cause = job
        title, flags, changes = CAUSES[cause]
        folder = self.taut.folder / f"boards_{name}_{cause}"
        folder.mkdir(parents=True, exist_ok=True)
        model = (ROOT / MODEL).read_text().replace("base: tetraspine3.yaml",
                                                   f"base: {os.path.relpath(ROOT / 'models', folder)}/tetraspine3.yaml")
        for old, new in changes.items():
            model = replaced(model, old, new)
        (folder / "model.yaml").write_text(model)
        base = os.path.relpath(ROOT / "experiments" / f"{name}.yaml", folder)
        (folder / "experiment.yaml").write_text(
            f"taut: 1\nkind: experiment\nbase: {base}\nname: {name}_boards\nmodel: model.yaml\n")
        done = subprocess.run([self.command, "--experiment", folder / "experiment.yaml", "--run", "--quiet", "--out",
                               folder, *flags], capture_output=True, text=True)
        if done.returncode != 0:
            raise Problem(f"{title}: {done.stdout}{done.stderr}")
        return job, (Waves(folder / "trace.h5"),
                     json.loads((folder / "boards.json").read_text()))


def simulated(taut, name):
    out = taut.folder / f"simulated_{name}"
    taut("run", f"experiments/{name}.yaml", "--quiet", "--out", out)
    return Waves(out / "trace.h5")


def percent(value, reference):
    return f"{100 * (value / reference - 1):+.1f} %"


def page(taut):
    boards = Boards(taut)
    pure = {name: simulated(taut, name) for name in EXPERIMENTS}
    motors = {name: simulated(taut, name + "_motors") for name in EXPERIMENTS}
    jobs = [(name, 0) for name in EXPERIMENTS]
    jobs += [(name, cause) for name in ("push_20n", "cpg_learned") for cause in range(1, len(CAUSES))]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        done = dict(pool.map(boards.run, jobs))
    rows = []
    for name in EXPERIMENTS:
        largest, mean = ntrt_figures(name)
        rows.append([name, "NTRT", f"{largest:.2f}", "", f"{mean:.2f}", "", ""])
        for kind, waves in (("simulated", pure[name]), ("simulated, with motors", motors[name]),
                            ("emulated boards", done[(name, 0)][0])):
            rms, most = waves.off(pure[name])
            rows.append(["", kind, f"{waves.largest():.2f}", percent(waves.largest(), largest), f"{waves.mean():.2f}",
                         *((f"{rms:.3f}", f"{most:.2f}") if waves is not pure[name] else ("", ""))])
    causes = []
    for cause, (title, _, _) in enumerate(CAUSES):
        cells = []
        for name in ("push_20n", "cpg_learned"):
            rms, most = done[(name, cause)][0].off(pure[name])
            cells += [f"{rms:.3f}", f"{most:.2f}", f"{done[(name, cause)][0].largest():.2f}"]
        causes.append([title, *cells])
    for title, source in (("no boards: motors that follow exact sensors", motors),):
        cells = []
        for name in ("push_20n", "cpg_learned"):
            rms, most = source[name].off(pure[name])
            cells += [f"{rms:.3f}", f"{most:.2f}", f"{source[name].largest():.2f}"]
        causes.append([title, *cells])
    times = []
    for name in EXPERIMENTS:
        figures = done[(name, 0)][1]
        times.append([name, f"{figures['tick_mean_us']:.0f}", f"{figures['tick_longest_us']:.0f}",
                      str(figures["late_ticks"]), f"{figures['cycle_mean_ms']:.2f}",
                      f"{figures['cycle_longest_ms']:.2f}", str(figures["bad_frames"])])
    figures = done[("push_20n", 0)][1]
    return fill(TEMPLATE.read_text(), {
        "compared": table(["experiment", "who", "largest tension [N]", "off NTRT's", "mean tension [N]",
                           "rms off the simulation [N]", "most [N]"], rows),
        "causes": table(["what is different", "push: rms [N]", "most [N]", "largest [N]", "learned gait: rms [N]",
                         "most [N]", "largest [N]"], causes),
        "times": table(["experiment", "tick, mean [us]", "longest [us]", "late ticks", "cycle, mean [ms]",
                        "longest [ms]", "bad frames"], times),
        "memory": f"{figures['static_memory_bytes']} bytes of variables and {figures['deepest_stack_bytes']} of stack",
    })
