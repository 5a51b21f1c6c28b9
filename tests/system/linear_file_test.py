"""HDF5 files of `taut analyze --linear`, read in Python: against runs and closed forms

Usage: linear_file_test.py TEST TAUT. TEST is the name of a function of this file; status 77: h5py is missing.
"""

import pathlib
import subprocess
import sys
import tempfile

try:
    import h5py
    import numpy as np
except ImportError:
    print("skipped: there is no h5py (apt-get install python3-h5py)")
    sys.exit(77)

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent

# A ball on three soft damped ropes, pushed for 0.1 s and released
MODEL = """\
taut: 1
kind: model
name: held
nodes:
  a: [0.5, 0, 1]
  b: [-0.3, 0.4, 1.1]
  c: [-0.2, -0.5, 0.9]
  ball: [0, 0, 0.5]
pairs:
  - {each: [[a, ball], [b, ball], [c, ball]], tags: [rope]}
builders:
  - {match: a, anchor: {}}
  - {match: b, anchor: {}}
  - {match: c, anchor: {}}
  - {match: ball, point_mass: {mass_kg: 0.4, radius_m: 0.05}}
  - {match: rope, cable: {stiffness_n_per_m: 150, damping_n_s_per_m: 0.8, rest_length_m: 0.6}}
"""
EXPERIMENT = """\
taut: 1
kind: experiment
name: pushed
model: held.yaml
step_s: 0.002
duration_s: 1.5
start: settled
timeline:
  events:
    - push: {name: tap, node: ball, direction: [0.6, 0, 0.8], force_n: [[0, PUSH], [0.098, PUSH], [0.1, 0]]}
record:
  rate_hz: 0
  channels: ["node/ball/position_*", "cable/*/tension_n", "body/*"]
"""


def taut(command, folder, *words):
    done = subprocess.run([command, *words], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, f"{words}: {done.stderr}"
    return done.stdout


def texts(data):
    return [text.decode() for text in data[:]]


class System:
    def __init__(self, path):
        with h5py.File(path, "r") as file:
            self.A, self.B, self.C, self.D = (file[name][:] for name in "ABCD")
            self.period_s, self.step_s = file.attrs["period_s"], file.attrs["step_s"]
            self.attributes = dict(file.attrs)
            self.names = {kind: texts(file[kind + "/name"]) for kind in ("states", "inputs", "outputs")}
            self.units = {kind: texts(file[kind + "/unit"]) for kind in ("states", "inputs", "outputs")}
            self.at = {kind: file[kind + "/at"][:] for kind in ("states", "inputs", "outputs")}
            self.bodies, self.place_m = texts(file["rest/bodies"]), file["rest/position_m"][:]
            self.turn = file["rest/orientation"][:]
            self.cables, self.rest_m = texts(file["rest/cables"]), file["rest/rest_length_m"][:]

    def number(self, kind, name):
        return self.names[kind].index(name)


def in_folder(act):
    with tempfile.TemporaryDirectory() as folder:
        act(pathlib.Path(folder))


def AFreeResponseIsThatOfTheRun(command):
    """x' = A x + B u from rest under the push, then x' = A x, compared with the simulation"""

    def act(folder):
        push_n = 3e-3
        (folder / "held.yaml").write_text(MODEL)
        (folder / "pushed.yaml").write_text(EXPERIMENT.replace("PUSH", str(push_n)))
        said = taut(command, folder, "analyze", "pushed.yaml", "--linear", "held.h5")
        assert "pushes and drags are left out" in said and "Linear system: held.h5" in said, said
        taut(command, folder, "run", "pushed.yaml", "--out", "run", "--quiet")
        system = System(folder / "held.h5")
        n, m, p = (len(system.names[kind]) for kind in ("states", "inputs", "outputs"))
        assert system.A.shape == (n, n) and system.B.shape == (n, m), "columns and rows are as documented"
        assert system.C.shape == (p, n) and system.D.shape == (p, m)
        with h5py.File(folder / "run/trace.h5") as run:
            seen = {f"node/ball/position_{axis}": run[f"node/ball/position_{axis}_m"][:] for axis in "xyz"}
            for cable in system.cables:
                seen[f"cable/{cable}/tension"] = run[f"cable/{cable}/tension_n"][:]
            time_s = run["time_s"][:]
            start = [run[f"body/{system.bodies[0]}/position_{axis}_m"][0] for axis in "xyz"]
        assert system.period_s == system.step_s == 0.002
        assert np.allclose(system.place_m[0], start, atol=1e-9) and np.allclose(system.turn[0], [1, 0, 0, 0], atol=1e-6)
        u = np.zeros(m)
        u[system.number("inputs", "node/ball/force_x")] = 0.6 * push_n
        u[system.number("inputs", "node/ball/force_z")] = 0.8 * push_n
        x, said = np.zeros(n), []
        for at_s in time_s:
            pushed = u * np.interp(at_s + system.step_s / 2, [0.098, 0.1], [1, 0])  # force in the middle of the step
            said.append(system.C @ x + system.D @ pushed)
            x = system.A @ x + system.B @ pushed
        said = np.array(said)
        largest = {kind: max(np.abs(v - v[0]).max() for name, v in seen.items() if kind in name)
                   for kind in ("position", "tension")}
        for name, values in seen.items():
            j = system.number("outputs", name)
            off = np.abs(said[:, j] - (values - values[0])).max()
            size = largest["tension" if "tension" in name else "position"]
            assert size > 1e-5 and off < 2e-4 * size, f"{name}: {off / size} of {size}"
            assert abs(system.at["outputs"][j] - values[0]) < 1e-7 * max(1, abs(values[0])), name

    in_folder(act)


def EigenvaluesAreTheRingDownOfAMassOnASpring(command):
    """Closed form of the integrator: leapfrog oscillates with 2 sin(w h / 2) = h sqrt(k / m), undamped."""

    def act(folder):
        taut(command, folder, "analyze", ROOT / "share/models/hanging_mass.yaml", "--linear", "mass.h5")
        system = System(folder / "mass.h5")
        h, own = system.step_s, np.sqrt(400 / 0.5)
        angles = np.angle(np.linalg.eigvals(system.A))
        wanted = 2 * np.arcsin(own * h / 2)
        assert np.abs(angles - wanted).min() < 1e-9, (angles, wanted)
        sideways = 2 * np.arcsin(np.sqrt(9.81 / (1 + 0.5 * 9.81 / 400)) * h / 2)
        assert np.sort(np.abs(angles - sideways))[1] < 1e-9, (angles, sideways)

    in_folder(act)


def NamesUnitsAndTheRestAreThere(command):
    def act(folder):
        taut(command, folder, "analyze", ROOT / "share/models/prism3.yaml", "--linear", "prism.h5")
        system = System(folder / "prism.h5")
        assert system.attributes["format"].decode() == "taut linear", system.attributes
        assert system.attributes["derivatives"].decode() in ("exact", "differences")
        assert system.attributes["disagreement"] < 1e-5
        assert system.bodies == ["strut_1", "strut_2", "strut_3"] or len(system.bodies) == 3, system.bodies
        assert len(system.cables) == 9 and system.rest_m.min() > 0
        unit = dict(zip(system.names["states"], system.units["states"]))
        assert unit[f"body/{system.bodies[0]}/velocity_x"] == "m/s"
        assert unit[f"body/{system.bodies[0]}/turn_z"] == "rad"
        for body, place_m in zip(system.bodies, system.place_m):
            for axis, value_m in zip("xyz", place_m):
                at = system.at["states"][system.number("states", f"body/{body}/position_{axis}")]
                assert abs(at - value_m) < 1e-7, (body, axis)
        assert np.allclose(np.linalg.norm(system.turn, axis=1), 1)
        length_m = system.at["outputs"][system.number("outputs", f"cable/{system.cables[0]}/length")]
        tension_n = system.at["outputs"][system.number("outputs", f"cable/{system.cables[0]}/tension")]
        assert length_m > system.rest_m[0] and tension_n > 0
        # C contains the cable's stiffness: dT = k dl + ...
        assert np.isfinite(system.A).all() and np.isfinite(system.C).all()

    in_folder(act)


def TheRestIsHowBodiesAreTurned(command):
    """A floating box keeps its recorded orientation."""

    def act(folder):
        (folder / "box.yaml").write_text("taut: 1\nkind: model\nname: box\nnodes:\n  box: [0, 0, 0]\nbuilders:\n"
                                         "  - {match: box, box: {size_m: [0.1, 0.2, 0.3], mass_kg: 1}}\n")
        turn = np.array([0.2, 0.4, 0.4, 0.8])
        names = [f"body/box/position_{axis}_m" for axis in "xyz"] + [f"body/box/orientation_{axis}" for axis in "wxyz"]
        (folder / "seen.csv").write_text("time_s," + ",".join(names) + "\n0,1,2,3," + ",".join(map(str, turn)) + "\n")
        taut(command, folder, "analyze", "box.yaml", "--pose", "seen.csv", "--linear", "box.h5")
        system = System(folder / "box.h5")
        assert np.allclose(system.place_m[0], [1, 2, 3], atol=1e-7), system.place_m
        assert np.allclose(system.turn[0], turn, atol=1e-9), system.turn

    in_folder(act)


if __name__ == "__main__":
    globals()[sys.argv[1]](pathlib.Path(sys.argv[2]).resolve())
