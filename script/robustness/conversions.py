"""Commands that convert files (import, export, analyze and size) with failing calls.

The outputs of these commands replace older files, so each output has an old and a new content."""

import re
import shutil

from robustness.scenarios import Reader, Scenario, digest
from validation.runs import ROOT

OLD = b"old content\n"
LOST_OUTPUT = "warning: cannot write to standard output"
# An unfinished file, or a file of an unfinished folder, left by a command that is killed or cannot delete it.
PART = re.compile(r".*\.\d+\.part(/.*)?")
WINCHES = """\
taut: 1
kind: catalogue
name: winches
motors:
  large: {gear_ratio: 19, gear_efficiency: 0.8, spool_radius_m: 0.012, rated_torque_n_m: 0.04, peak_torque_n_m: 0.15,
    max_speed_rad_per_s: 800, rated_power_w: 20, mass_kg: 0.21}
"""


class Converter(Reader):
    """A command that writes files. Afterwards, each file must be the old or the new one."""
    kinds = ("memory", "hdf5", "write", "sync", "name", "open", "truncate", "close", "read")
    kills = True

    def prepare(self):
        for name in self.makes:
            (self.before / name).parent.mkdir(exist_ok=True)
            (self.before / name).write_bytes(OLD)
        self.beside = ()

    def check(self, outcome, folder):
        inputs = {name: content for name, content in digest(folder).items()
                  if name not in self.makes and not PART.fullmatch(name)}
        if inputs != {name: content for name, content in self.whole.items() if name not in self.makes}:
            return f"other files than before: {sorted(inputs)}"
        if outcome.status == 0 and outcome.output != self.right.output and LOST_OUTPUT not in outcome.errors:
            return "status 0, and it printed something else"
        for name, right in self.made_right.items():
            content = (folder / name).read_bytes() if (folder / name).exists() else None
            if content not in (OLD, right):
                return f"{name} is neither the old nor the new file"
            if outcome.status == 0 and content != right:
                return f"status 0, and {name} is the old file"
        return None


class ImportMjcf(Converter):
    makes = ("prism.yaml", "on_ground.yaml")

    def words(self):
        return ("import", "mjcf", ROOT / "docs/from_mujoco/prism.xml", "--out", "prism.yaml", "--experiment",
                "on_ground.yaml")


class ImportNtrt(Converter):
    makes = ("superball.yaml",)

    def words(self):
        return ("import", "ntrt", ROOT / "docs/from_ntrt/SuperBall.yaml", "--length_unit_m", "0.1", "--out",
                "superball.yaml")


class ExportMjcf(Converter):
    makes = ("prism.xml",)

    def words(self):
        return ("export", "mjcf", ROOT / "share/models/prism3.yaml", "--keyframe", "--out", "prism.xml")


class ExportShape(Converter):
    makes = ("prism.glb",)

    def words(self):
        return ("export", "shape", ROOT / "share/models/prism3.yaml", "--out", "prism.glb")


class ExportStructure(Converter):
    makes = tuple(f"prism/{name}" for name in (
        "N.csv", "C_b.csv", "C_s.csv", "S.csv", "q.csv", "W.csv", "R.csv", "pinned.csv", "nodes.csv", "members.csv",
        "clusters.csv", "structure.json"))

    def words(self):
        return ("export", "structure", ROOT / "share/models/prism3.yaml", "--out", "prism")


class New(Scenario):
    """A command that writes new files. Afterwards, either all of them are there or none, and the command can be
    repeated."""
    kinds = ("memory", "write", "sync", "name", "open", "close", "read")
    kills = True

    def __init__(self, program, folder):
        super().__init__(program, folder)
        self.prepare()
        shutil.copytree(self.before, folder / "right")
        self.made(*self.words(), folder=folder / "right")
        self.old, self.right = digest(self.before), digest(folder / "right")

    def prepare(self):
        pass

    def check(self, outcome, folder):
        left = {name: content for name, content in digest(folder).items() if not PART.fullmatch(name)}
        if left not in (self.old, self.right):
            return f"some files only: {sorted(left)}"
        if outcome.status == 0 and left != self.right:
            return "status 0, and nothing was written"
        again = self.program.plain(self.words(), folder)
        if again.returncode != (3 if left == self.right else 0):
            return f"again, with status {again.returncode}: {again.stderr}"
        return None if digest(folder).items() >= self.right.items() else "again, it is something else"


class NewRobot(New):
    def words(self):
        return ("new", "robot", "sam", "--like", "prism")


class NewMapping(New):
    def prepare(self):
        rows = "".join(f"{row / 10:.1f};{row % 7}\n" for row in range(300))
        (self.before / "log.csv").write_text("time [s];force [N]\n" + rows)

    def words(self):
        return ("new", "mapping", "log.csv")


class Analyze(Reader):
    def prepare(self):
        pass

    def words(self):
        return ("analyze", ROOT / "share/models/prism3.yaml", "--json")


class Size(Reader):
    command = ("size", "run", "--catalogue", "winches.yaml", "--json")

    def prepare(self):
        (self.before / "winches.yaml").write_text(WINCHES)
        self.made("run", ROOT / "share/experiments/rest_length_sine.yaml", "--duration_s", "0.3", "--quiet", "--out", "run")
