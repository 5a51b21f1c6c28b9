"""Files of `taut export structure`, checked with numpy against the equations of tensegrity statics

Usage: structure_test.py TEST TAUT. TEST is the name of a function of this file; status 77: numpy is missing.
"""

import csv
import json

import command as run

try:
    import numpy as np
except ImportError:
    run.skip("there is no numpy (apt-get install python3-numpy)")

ROOT = run.ROOT
# In equilibrium without weight: rods; elastic bars, and supports; bodies of several rods; cables that end off the axes
# of rods; a load in the middle; cables through eyelets
MODELS = {
    "prism3": [],
    "six_strut": [],
    "t3_prism": [],
    "superball": [],
    "superball_payload": [],
    "tetraspine3": [],
    "tetraspine3_eyelets": ["--set", "eyelet_friction=0"],
}


class Structure:
    """The files of an exported folder"""

    def __init__(self, folder):
        for name in ("N", "C_b", "C_s", "S", "q", "W", "R", "pinned"):
            setattr(self, name, np.loadtxt(folder / f"{name}.csv", delimiter=",", ndmin=2))
        self.nodes, self.members, self.clusters = (
            list(csv.DictReader(open(folder / f"{name}.csv"))) for name in ("nodes", "members", "clusters")
        )
        self.json = json.loads((folder / "structure.json").read_text())
        nodes = self.N.shape[1]
        self.C_b, self.C_s = self.C_b.reshape(-1, nodes), self.C_s.reshape(-1, nodes)
        self.C = np.vstack([self.C_b, self.C_s])
        self.q = self.q.ravel()

    def column(self, name):
        return np.array([float(member[name]) for member in self.members])

    def lengths(self):
        return np.linalg.norm(self.N @ self.C.T, axis=0)

    def unbalanced(self):
        """Returns N C' diag(q) C - W: the additional forces that equilibrium needs at the nodes."""
        return self.N @ self.C.T @ np.diag(self.q) @ self.C - self.W

    def free(self):
        """Returns a mask of the nodes on which only members and weight act."""
        ground = np.array([node["on_ground"] == "1" for node in self.nodes])
        return ~ground & (self.pinned.sum(axis=0) == 0)


def export(taut, folder, model, *words):
    run.taut(taut, folder, "export", "structure", model, "--out", "out", *words)
    return Structure(folder / "out")


def model(name):
    return ROOT / "share/models" / f"{name}.yaml"


def MatricesSayTheSameAsTheTable(taut, folder):
    for name in (*MODELS, "puppy"):
        s = export(taut, folder, model(name))
        members, nodes = len(s.members), len(s.nodes)
        assert s.N.shape == (3, nodes) and s.C.shape == (members, nodes), name
        assert (np.sum(s.C == -1, axis=1) == 1).all() and (np.sum(s.C == 1, axis=1) == 1).all()
        assert (np.abs(s.C).sum(axis=1) == 2).all()
        for m, member in enumerate(s.members):
            assert s.C[m, int(member["from"]) - 1] == -1 and s.C[m, int(member["to"]) - 1] == 1
            assert s.S[int(member["cluster"]) - 1, m] == 1
            assert (member["kind"] == "string") == (m >= len(s.C_b))
        assert (s.S.sum(axis=0) == 1).all() and s.S.shape == (len(s.clusters), members)
        assert np.allclose(s.lengths(), s.column("length_m"), rtol=0, atol=1e-14)
        assert np.allclose(s.q * s.lengths(), s.column("force_n"), rtol=1e-13, atol=1e-13)
        # For tools with clustered members: l_c = S l, and one force along the whole cable, t = S' t_c
        assert np.allclose(s.S @ s.lengths(), [float(c["length_m"]) for c in s.clusters], rtol=1e-13)
        assert np.allclose(s.S.T @ [float(c["force_n"]) for c in s.clusters], s.column("force_n"), rtol=1e-12, atol=1e-12)
        assert len({node["name"] for node in s.nodes}) == nodes
        assert all(np.array_equal(getattr(s, key).reshape(-1), np.array(s.json[key]).reshape(-1)) for key in ("N", "C_s", "S", "q", "W"))
        assert [m["from"] + 1 for m in s.json["members"]] == [int(m["from"]) for m in s.members]


def ForcesOfModelsAtRestBalance(taut, folder):
    for name, words in MODELS.items():
        s = export(taut, folder, model(name), "--equilibrium", "--no_weight", *words)
        largest = np.abs(s.column("force_n")).max()
        assert largest > 1, name
        free = s.pinned == 0
        assert free.sum() >= 12, name
        assert np.abs(s.unbalanced()[free]).max() < 1e-7 * largest, (name, np.abs(s.unbalanced()).max())
        assert np.allclose(s.unbalanced(), s.R, rtol=0, atol=1e-9 * largest)
        assert (s.q[len(s.C_b) :] >= 0).all() and (s.W == 0).all()
        assert s.json["notes"] == [], s.json["notes"]


def WhatIsLeftIsWhatTautSaysIsLeft(taut, folder):
    """Bodies that are points, in the described pose: far from equilibrium, on their supports, with weight"""
    s = export(taut, folder, model("t3_prism"))
    said = json.loads(run.taut(taut, folder, "check", model("t3_prism"), "--json"))
    assert len(s.nodes) == 6 and len(s.members) == 12
    joints = {joint["name"]: np.array(joint["force_n"]) for joint in said["joints"]}
    for n, (node, body) in enumerate(zip(s.nodes, said["bodies"])):
        assert node["name"] == body["name"]
        # Reaction of the support, and the force that remains unbalanced: -R has no counterpart here.
        support = joints.get(node["name"], np.zeros(3))
        left = np.array(body["left_force_n"]) - support
        assert np.allclose(-s.R[:, n], left, atol=1e-6), (node, s.R[:, n], left)
    assert s.pinned.T.tolist() == [[1, 0, 1], [1, 1, 1], [0, 0, 1], [0] * 3, [0] * 3, [0] * 3]


def TensionsLengthsAndRodsAreAsTautSays(taut, folder):
    for name in ("prism3", "six_strut", "tetraspine3", "superball"):
        s = export(taut, folder, model(name))
        said = json.loads(run.taut(taut, folder, "check", model(name), "--json"))
        strings = {c["name"]: c for c in s.clusters[len(s.C_b) :]}
        assert set(strings) == {cable["name"] for cable in said["cables"]}
        for cable in said["cables"]:
            own = strings[cable["name"]]
            assert abs(float(own["length_m"]) - cable["length_m"]) < 1e-12 * cable["length_m"]
            assert abs(float(own["force_n"]) - cable["tension_n"]) < 1e-9 * max(1, cable["tension_n"])
        rods = {m["name"]: float(m["force_n"]) for m in s.members if m["kind"] == "rod"}
        if name != "prism3":
            continue
        # For a single rod taut has a separate law (docs/theory/loads.md, eq. 4).
        for strut in said["struts"]:
            [force] = [f for rod, f in rods.items() if rod.startswith(strut["body"] + ".")]
            assert abs(force - strut["axial_n"]) < 1e-9 * abs(force), (strut, force)


def ARunThatHasComeToRestBalancesOnItsFeet(taut, folder):
    experiment = ROOT / "share/experiments" / "drop_six_strut.yaml"
    run.taut(taut, folder, "run", experiment, "--duration_s", "6", "--quiet", "--out", "run")
    s = export(taut, folder, experiment, "--pose", "run/trace.h5")
    weight = -s.W[2].sum()
    mass = sum(float(node["mass_kg"]) for node in s.nodes)
    assert abs(weight - 9.81 * mass) < 1e-9 * weight
    feet = ~s.free()
    assert 3 <= feet.sum() <= 6, feet
    left = s.unbalanced()
    # The ground carries exactly the weight; all other nodes balance, up to the residual motion.
    assert abs(left[2, feet].sum() - weight) < 1e-3 * weight, (left[2, feet].sum(), weight)
    assert np.abs(left[:, ~feet]).max() < 1e-3 * weight, np.abs(left[:, ~feet]).max()


def RoutedCablesAreClusters(taut, folder):
    s = export(taut, folder, model("tetraspine3_eyelets"), "--set", "eyelet_friction=0")
    cables = s.clusters[len(s.C_b) :]
    assert len(cables) == 12 and len(s.C_s) == 24
    assert (s.S[len(s.C_b) :].sum(axis=1) == 2).all()
    said = json.loads(run.taut(taut, folder, "check", model("tetraspine3_eyelets"), "--set", "eyelet_friction=0", "--json"))
    for cable, own in zip(said["cables"], cables):
        assert own["name"] == cable["name"]
        assert abs(float(own["length_m"]) - cable["length_m"]) < 1e-12
        k, rest = float(own["stiffness_n_per_m"]), float(own["rest_length_m"])
        assert abs(k * (cable["length_m"] - rest) - cable["tension_n"]) < 1e-9
    # With friction in the eyelets each side may have a different force.
    parted = export(taut, folder, model("tetraspine3_eyelets"))
    assert len(parted.clusters) - len(parted.C_b) == 24
    assert (parted.S.sum(axis=1) == 1).all()
    # The truss is in equilibrium, so that the total unbalanced force and torque of a body are the total force and
    # torque of its cables.
    for body in said["bodies"]:
        own = [n for n, node in enumerate(s.nodes) if node["name"].startswith(body["name"])]
        forces, arms = -s.R[:, own].T, s.N[:, own].T - body["com_m"]
        assert np.allclose(forces.sum(axis=0), body["cable_force_n"], rtol=0, atol=1e-9)
        assert np.allclose(np.cross(arms, forces).sum(axis=0), body["cable_torque_n_m"], rtol=0, atol=1e-9)


def APrismHasTheForceDensitiesOfTheLiterature(taut, folder):
    s = export(taut, folder, model("prism3"))
    # Prism of three rods: side cables have sqrt(3) times the force density of the base cables; rods the same, in
    # compression.
    kinds = {"lower": [], "upper": [], "side": [], "strut": []}
    for member, q in zip(s.members, s.q):
        kinds[member["name"].split("_")[0]].append(q)
    base = kinds["lower"][0]
    for name, ratio in (("lower", 1), ("upper", 1), ("side", 3**0.5), ("strut", -(3**0.5))):
        assert np.allclose(np.array(kinds[name]) / base, ratio, rtol=1e-6), (name, kinds[name], base)


def WhatIsWrongIsSaid(taut, folder):
    prism = model("prism3")
    (folder / "bad.yaml").write_text("taut: 1\nkind: model\nname: bad\nnoodles: {}\nnodes: {a: [0, 0]}\n")
    complaints = run.taut(taut, folder, "export", "structure", "bad.yaml", "--out", "out", status=3)
    assert "bad.yaml:4" in complaints and "bad.yaml:5" in complaints, complaints
    assert not (folder / "out").exists()
    assert "no flag" in run.taut(taut, folder, "export", "structure", prism, "--folder", "x", status=2)
    assert "at_s" in run.taut(taut, folder, "export", "structure", prism, "--at_s", "1", status=2)
    assert "gait" in run.taut(taut, folder, "export", "structure", ROOT / "share/gaits" / "hand_tuned_sine.yaml", status=3)
    assert "cannot open" in run.taut(taut, folder, "export", "structure", prism, "--pose", "no.h5", status=3)
    (folder / "file").write_text("")
    run.taut(taut, folder, "export", "structure", prism, "--out", "file", status=1)
    run.taut(taut, folder, "export", "structure", prism, "--out", "file/x", status=1)


if __name__ == "__main__":
    run.main(globals())
