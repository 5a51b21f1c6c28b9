"""Commands of `taut robot` with failing calls. The motor boards run natively (tests/faults/fault_adapter.cpp)."""

import contextlib
import os
import re
import subprocess

from robustness.scenarios import EXPERIMENT, Scenario, digest
from validation.runs import ROOT, Problem

OLD = """\
taut: 1
kind: calibration
name: calibration
cables:
  - {cable: outer_top_2, measured: "2026-01-01", encoder_m_per_count: 1e-5}
"""
DRIVE = EXPERIMENT.format(root=ROOT, base="push_20n_motors", name="drive", duration_s=0.2) + "timeline: {phases: {before: [0, 0.1], during: [0.1, 0.15], after: [0.15, 0.2]}}\n"

ATTEMPTS = 5  # of preparing commands: boards answer late on a busy machine


class Boards:
    """An adapter with boards, as a separate program."""

    def __init__(self, path, winds_m_per_s):
        self.process = subprocess.Popen([path, str(winds_m_per_s)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        self.device = self.process.stdout.readline().strip()

    def has_power(self):
        print(file=self.process.stdin, flush=True)
        return self.process.stdout.readline().strip() == "1"

    def close(self):
        self.process.stdin.close()
        self.process.wait()


class Robot(Scenario):
    """A command in real time. `prepares`: commands before it, without faults. `makes`: traces that it writes."""
    winds_m_per_s, lines, prepares, makes = 0, "", (), ()

    def __init__(self, program, folder):
        super().__init__(program, folder)
        if not os.access(program.adapter or "", os.X_OK):
            raise Problem(f"there is no {program.adapter}; script/build makes it")
        self.prepare()
        self.inputs = digest(self.before)

    def prepare(self):
        pass

    def run(self, folder, fault=None):
        runtime = folder / "runtime"  # sockets of other commands at the same time are elsewhere
        runtime.mkdir()
        with contextlib.closing(Boards(self.program.adapter, self.winds_m_per_s)) as boards:
            port = ("--port", boards.device)
            program = self.program.instead(self.program.command, {"XDG_RUNTIME_DIR": str(runtime)})
            for words in self.prepares:
                for _ in range(ATTEMPTS):
                    before = program.plain((*words, *port), folder)
                    if before.returncode == 0:
                        break
                else:
                    raise Problem(f"taut {' '.join(words)}\n{before.stderr}")
            outcome = program.run((*self.words(), *port), folder, fault, lines=self.lines)
            outcome.power = boards.has_power()
            return outcome

    def check(self, outcome, folder):
        if any(content != digest(folder).get(name) for name, content in self.inputs.items() if name not in self.makes):
            return "an input is not as it was"
        if "Motors are off." in outcome.output and outcome.power:
            return "it reports motors as off, but they have power"
        if outcome.status == 0 and outcome.power:
            return "status 0, and motors have power"
        return self.check_files(outcome, folder)

    def check_files(self, outcome, folder):
        for name in self.makes:
            if not (folder / name).exists():
                if outcome.status == 0:
                    return f"status 0, and no {name}"
                continue
            read = self.program.plain(("compare", name, name, "--json"), folder)
            if outcome.status == 0 and read.returncode != 0:
                return f"status 0, and {name} cannot be read: {read.stderr}"
        return None


class Log(Robot):
    makes = ("log/trace.h5",)

    def words(self):
        return ("robot", "log", "--duration_s", "0.2", "--quiet", "--out", "log")


class Hold(Robot):
    prepares = (("robot", "reference", "--as_model"),)

    def words(self):
        return ("robot", "hold", "--duration_s", "0.2")


class Run(Robot):
    prepares = Hold.prepares
    makes = ("drive/trace.h5", "drive/host.h5")

    def prepare(self):
        (self.before / "drive.yaml").write_text(DRIVE)

    def words(self):
        return ("robot", "run", "drive.yaml", "--quiet", "--out", "drive")


class Calibrate(Robot):
    """Extends an older calibration file."""
    winds_m_per_s, lines, makes = 0.5, "\n\n", ("calibration.yaml",)

    def prepare(self):
        (self.before / "calibration.yaml").write_text(OLD)

    def words(self):
        return ("robot", "calibrate", "encoder", "outer_right_1", "--way_m", "0.1")

    def check_files(self, outcome, folder):
        text = (folder / "calibration.yaml").read_text()
        new = re.search(r"cable: outer_right_1\b", text) and re.search(r"Encoder: \d+ counts over 0.1 m", text)
        if text != OLD and not (new and "outer_top_2" in text and text.endswith("\n")):
            return "calibration.yaml is neither the old nor the new file"
        return "status 0, and calibration.yaml is the old file" if outcome.status == 0 and not new else None
