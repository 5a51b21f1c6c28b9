"""The paper's experiments on emulated boards, in comparison with the pure simulation and NTRT; causes of
differences."""

import concurrent.futures
import json
import os
import pathlib
import subprocess

from validation.runs import ROOT, Problem, fill, keep_picture, table
from validation.tension_curves import Curve, picture
from validation.tension_waves import Off, h5py, read_ntrt, read_trace
from validation.virtual_robot_causes import (ADDED, LIMITED, LOSS_ALONE, MOTORS_CHANGED, ON_BOARDS, SENSITIVITY, STIFF,
                                             STIFF_PID, STRONG_P, TOGETHER, Cause, build_firmware)

TEMPLATE = pathlib.Path(__file__).with_suffix(".md.in")
PUSH, SINE, CPG = "push_20n", "sine_hand_tuned", "cpg_learned"
EXPERIMENTS = (PUSH, SINE, CPG)
NTRT = {name: ROOT / f"tests/data/ntrt/{trace}_1000hz.csv.gz"
        for name, trace in ((PUSH, "push"), (SINE, SINE), (CPG, CPG))}
CAUSE_S = 20.0  # duration of the gaits' runs for causes; the push is over after 45 s
# For the pictures: time span, interval of points, width of the set point (the push's tensions cover it).
SPANS = {PUSH: ((20, 60), 0.2, 4.5), SINE: ((30, 40), 0.04, 1.2), CPG: ((30, 35), 0.02, 0.8)}
FULL_DUTY = 0.999
FAULTS = ("over tension", "sensor", "slack", "stall", "polarity", "runaway", "hot")  # MotorFault of taut/board/faults.h


class Runs:
    """Runs of causes, simulated and on boards, by experiment and cause."""

    def __init__(self, taut):
        self.taut, self.command = taut, pathlib.Path(taut.command).parent / "taut_virtual_robot"
        if not os.access(self.command, os.X_OK):
            raise Problem(f"there is no {self.command}: it wants gcc-avr, avr-libc and libsimavr-dev")
        self.firmware = {}  # by the changes in it

    def folder(self, kind, name, cause):
        title = "".join(letter if letter.isalnum() else "_" for letter in cause.title)
        return self.taut.folder / f"{kind}_{name}_{title}"

    def simulate(self, name, cause):
        folder = self.folder(cause.model, name, cause)
        self.taut("run", cause.write(folder, name), "--quiet", "--out", folder / "run")
        return folder / "run"

    def on_boards(self, job):
        name, cause, duration_s = job
        folder = self.folder("boards", name, cause)
        flags = list(cause.flags)
        if cause.firmware:
            flags += ["--firmware", self.firmware[cause.title]]
        if duration_s:
            flags += ["--duration_s", str(duration_s)]
        done = subprocess.run([self.command, "--experiment", cause.write(folder, name), "--run", "--quiet",
                               "--out", folder / "run", *flags], capture_output=True, text=True)
        if done.returncode != 0:
            raise Problem(f"{cause.title}: {done.stdout}{done.stderr}")
        return job, folder / "run"

    def all_on_boards(self, jobs):
        for cause in dict.fromkeys(cause for _, cause, _ in jobs if cause.firmware):
            self.firmware[cause.title] = build_firmware(self.folder("firmware", "motor_loop", cause), cause.firmware)
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            return {(name, cause): path for (name, cause, _), path in pool.map(self.on_boards, jobs)}


class Beside:
    """The pure simulation of an experiment, and comparisons with it."""

    def __init__(self, name, path):
        self.name, self.path, self.whole = name, path, read_trace(path / "trace.h5")
        self.until_s = None if name == PUSH else CAUSE_S
        self.cut = read_trace(path / "trace.h5", self.until_s)
        self.frequency_hz = None if name == PUSH else self.whole.strongest()

    def off(self, path):
        """Returns the difference from the start to the end of a cause's run."""
        return Off(read_trace(path / "trace.h5", self.until_s), self.cut, self.frequency_hz)


def percent(value, reference):
    return f"{100 * (value / reference - 1):+.1f} %"


def late_ms(off):
    return f"{round(1000 * off.lag_s) + 0:d}"


def compared_tables(beside, motors, boards):
    """Formats differences over the whole minute: size and composition."""
    sizes, shapes = [], []
    for name in EXPERIMENTS:
        ntrt, pure = read_ntrt(NTRT[name]), beside[name]
        sizes.append([name, "NTRT", f"{ntrt.largest():.2f}", "", f"{ntrt.mean():.2f}", f"{ntrt.swing():.2f}", "", ""])
        for who, path in (("simulated", pure.path), ("simulated, with motors", motors[name]),
                          ("emulated boards", boards[name])):
            waves = read_trace(path / "trace.h5")
            off = Off(waves, pure.whole, pure.frequency_hz)
            itself = path == pure.path
            sizes.append(["", who, f"{waves.largest():.2f}", percent(waves.largest(), ntrt.largest()),
                          f"{waves.mean():.2f}", f"{waves.swing():.2f}",
                          *(("", "") if itself else (f"{off.rms_n:.3f}", f"{off.most_n:.2f}"))])
            if name != PUSH:
                shapes.append(["" if not itself else name, who, f"{1 / waves.strongest():.3f}", *(
                    [""] * 5 if itself else (f"{off.rms_n:.2f}", f"{off.means_n:.2f}", f"{100 * off.swing:.0f}",
                                             late_ms(off), f"{off.aligned_n:.2f}"))])
    return (table(["experiment", "variant", "largest tension [N]", "relative to NTRT", "mean tension [N]", "swing [N]",
                   "rms difference from the simulation [N]", "largest difference [N]"], sizes),
            table(["experiment", "variant", "period [s]", "rms difference [N]", "difference of means [N]", "swing [%]", "delay [ms]",
                   "rms without means and delay [N]"], shapes))


def causes_table(causes, names, beside, path_of):
    """Formats one row per cause: the difference, for gaits also its composition."""
    head, rows = ["change"], []
    for name in names:
        gait = "sine" if name == SINE else "learned gait"
        head += ["push: rms [N]", "push: largest [N]"] if name == PUSH else [
            f"{gait}: rms [N]", f"{gait}: difference of means [N]", f"{gait}: swing [%]", f"{gait}: delay [ms]"]
    for cause in causes:
        row = [cause.title]
        for name in names:
            off = beside[name].off(path_of(name, cause))
            row += [f"{off.rms_n:.3f}", f"{off.most_n:.2f}"] if name == PUSH else [
                f"{off.rms_n:.3f}", f"{off.means_n:.2f}", f"{100 * off.swing:.0f}", late_ms(off)]
        rows.append(row)
    return table(head, rows)


def winding_table(motors, boards, strong):
    """Formats the winding speeds at full voltage, in and out, and how often they occur."""
    rows = []
    for name in (SINE, CPG):
        rows.append([f"{name}, with motors", *winding_cells(motors[name])])
        rows.append([f"{name}, emulated boards", *winding_cells(boards[name])])
        rows.append([f"{name}, emulated boards, P ten times as strong", *winding_cells(strong[name])])
    return table(["run", "winding in at full voltage [% of the time]", "speed [cm/s]", "mean tension [N]",
                  "paying out [% of the time]", "speed [cm/s]", "mean tension [N]"], rows)


def winding_cells(path):
    import numpy
    parts = {1: [], -1: []}
    count = 0
    with h5py().File(path / "trace.h5", "r") as file:
        late = file["time_s"][:] >= 5
        for cable in file["cable"].values():
            duty, tension_n = cable["duty"][:][late], cable["tension_n"][:][late]
            speed_rad_per_s = cable["rotor_speed_rad_per_s"][:][late]
            m_per_rad = -numpy.polyfit(cable["rotor_angle_rad"][:], cable["rest_length_m"][:], 1)[0]
            count += len(duty)
            for sign, part in parts.items():
                full = sign * duty > FULL_DUTY
                part.append((100 * m_per_rad * sign * speed_rad_per_s[full], tension_n[full]))
    cells = []
    for part in parts.values():
        speeds, tensions = (numpy.concatenate(column) for column in zip(*part))
        cells.append(f"{100 * len(speeds) / count:.0f}")
        cells += [f"{speeds.mean():.1f}", f"{tensions.mean():.1f}"] if len(speeds) else ["", ""]
    return cells


def faults(done):
    """Describes the faults that stopped a motor in runs on boards, which limit their validity."""
    found = []
    for (name, cause), path in done.items():
        with h5py().File(path / "host.h5", "r") as file:
            for cable, channels in sorted(file["cable"].items()):
                bits = set(channels["faults"][:].astype(int)) - {0}
                what = [word for bit, word in enumerate(FAULTS) if any(value >> bit & 1 for value in bits)]
                if what:
                    found.append(f"{cause.title}, {name}, {cable}: {', '.join(what)}")
    return "; ".join(found) if found else "none"


def times_table(boards):
    rows = []
    for name in EXPERIMENTS:
        figures = json.loads((boards[name] / "boards.json").read_text())
        rows.append([name, f"{figures['tick_mean_us']:.0f}", f"{figures['tick_longest_us']:.0f}",
                     str(figures["late_ticks"]), f"{figures['cycle_mean_ms']:.2f}",
                     f"{figures['cycle_longest_ms']:.2f}", str(figures["bad_frames"])])
    return table(["experiment", "board tick, mean [us]", "longest tick [us]", "late ticks", "bus cycle, mean [ms]", "longest cycle [ms]",
                  "bad frames"], rows)


def draw(taut, name, pure, boards):
    def heard(quantity):
        with h5py().File(boards / "host.h5", "r") as file:
            return file["time_s"][:], {cable: group[quantity][:] for cable, group in file["cable"].items()}

    span_s, row_s, wide = SPANS[name]
    ntrt = read_ntrt(NTRT[name], 0)
    tensions = [Curve("simulation", "black", pure.whole.time_s, pure.whole.of, 2),
                Curve("NTRT, elastic part", "#e0a020", ntrt.time_s, ntrt.of, 1.4, "4 3"),
                Curve("boards: load cells", "#e03020", *heard("tension_n"), 0.9)]
    set_point = Curve("boards: set point", "#9cc6f0", *heard("setpoint_n"), wide)
    keep_picture(taut, f"docs/validation/virtual_robot_{name}.svg", picture(set_point, tensions, span_s, row_s))


def called(causes, title):
    return next(cause for cause in causes if cause.title == title)


def headlines(beside, motors, boards, done, simulate):
    """Returns the numbers at the top of the page: rms difference from the pure simulation [N], as in the tables."""

    def rms(name, path):
        return f"{beside[name].off(path).rms_n:.1f}"

    alone = called(MOTORS_CHANGED, LOSS_ALONE)
    stiff, stiff_pid = called(ON_BOARDS, STIFF), called(TOGETHER, STIFF_PID)
    return {
        "push_most": f"{beside[PUSH].off(boards[PUSH]).most_n:.2f}",
        "cpg_boards": rms(CPG, boards[CPG]), "cpg_motors": rms(CPG, motors[CPG]),
        "cpg_alone": rms(CPG, simulate(CPG, alone)),
        "cpg_stiff": rms(CPG, done[CPG, stiff]), "cpg_stiff_pid": rms(CPG, done[CPG, stiff_pid]),
        "sine_boards": rms(SINE, boards[SINE]), "sine_rest": rms(SINE, done[SINE, TOGETHER[-1]]),
        "cause_s": f"{CAUSE_S:.0f}",
    }


def page(taut):
    runs = Runs(taut)
    as_it_is, motors_cause, pure_cause = ON_BOARDS[0], MOTORS_CHANGED[0], Cause("nothing", LIMITED)
    jobs = [(name, as_it_is, None) for name in EXPERIMENTS]
    jobs += [(name, cause, CAUSE_S) for cause in (*ON_BOARDS[1:], *TOGETHER) for name in (SINE, CPG)]
    done = runs.all_on_boards(jobs)
    beside = {name: Beside(name, runs.simulate(name, pure_cause)) for name in EXPERIMENTS}
    boards = {name: done[name, as_it_is] for name in EXPERIMENTS}
    motors = {name: runs.simulate(name, motors_cause) for name in EXPERIMENTS}
    for name in EXPERIMENTS:
        draw(taut, name, beside[name], boards[name])
    compared, shapes = compared_tables(beside, motors, boards)
    strong_p = called(ON_BOARDS, STRONG_P)
    figures = json.loads((boards[PUSH] / "boards.json").read_text())
    return fill(TEMPLATE.read_text(), {
        "compared": compared,
        "shapes": shapes,
        "winding": winding_table(motors, boards, {name: done[name, strong_p] for name in (SINE, CPG)}),
        "sensitivity": causes_table(SENSITIVITY, EXPERIMENTS, beside, runs.simulate),
        "added": causes_table(ADDED, EXPERIMENTS, beside, runs.simulate),
        "motors": causes_table(MOTORS_CHANGED, EXPERIMENTS, beside, runs.simulate),
        "on_boards": causes_table(ON_BOARDS, (SINE, CPG), beside, lambda name, cause: done[name, cause]),
        "together": causes_table(TOGETHER, (SINE, CPG), beside, lambda name, cause: done[name, cause]),
        "faults": faults(done),
        **headlines(beside, motors, boards, done, runs.simulate),
        "times": times_table(boards),
        "memory": f"{figures['static_memory_bytes']} bytes of variables and {figures['deepest_stack_bytes']} of stack",
    })
