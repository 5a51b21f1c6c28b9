"""compare_with_mujoco.py TAUT [COUNT [SEED]]: compares `taut import mjcf` with MuJoCo's compiler on random MJCF files.

Each file has tendons, nested default classes and actuators of all kinds, with random attributes. For every file that
taut accepts, stiffness, damping, tension and limits of each cable must equal MuJoCo's, and each limit, lag and push
that a cable lacks must cause a warning. Every rejection must contain a line number. Skipped (77) without the Python
package `mujoco`.
"""

import collections
import math
import pathlib
import random
import re
import subprocess
import sys
import tempfile

try:
    import mujoco
except ImportError:
    print("skipped: this machine has no Python package mujoco")
    sys.exit(77)

KINDS = ["general", "motor", "position", "velocity", "intvelocity", "cylinder", "damper", "muscle"]
NEWER_KINDS = ["pid", "dcmotor"]  # since MuJoCo 4.0
NO_BIAS, AFFINE = int(mujoco.mjtBias.mjBIAS_NONE), int(mujoco.mjtBias.mjBIAS_AFFINE)
DYNAMICS = [int(d) for d in (mujoco.mjtDyn.mjDYN_NONE, mujoco.mjtDyn.mjDYN_FILTER, mujoco.mjtDyn.mjDYN_FILTEREXACT)]
NEWER = int(mujoco.__version__.split(".")[0]) >= 4


class Writer:
    """Writer of random files. Rare values are rare so that most files are accepted."""

    def __init__(self, rng):
        self.rng = rng

    def seldom(self, share=0.1):
        return self.rng.random() < share

    def number(self, low, high):
        return f"{self.rng.uniform(low, high):.3g}"

    def attributes(self, **choices):
        """Returns a random selection of the attributes. In a pair, the second element is the probability."""
        text = ""
        for name, made in choices.items():
            make, share = made if isinstance(made, tuple) else (made, 0.4)
            if self.seldom(share):
                text += f' {name}="{make()}"'
        return text

    def kind(self):
        if self.seldom(0.02):
            return self.rng.choice(["damper", "muscle"] + (NEWER_KINDS if NEWER else []))
        return self.rng.choices(KINDS[:6], [5, 2, 6, 2, 0.3, 1])[0]

    def common(self):
        n = self.number
        return self.attributes(
            gear=(lambda: n(0.5, 2) if self.seldom(0.7) else n(-2, -0.5), 0.15),
            ctrlrange=(lambda: self.rng.choice(["0 0", f"{n(0, 0.2)} {n(0.3, 0.8)}", "0.5 0.1"])
                       if self.seldom(0.07) else f"{n(0, 0.2)} {n(0.3, 0.8)}", 0.2),
            ctrllimited=(lambda: self.rng.choice(["auto", "true", "false"]), 0.1),
            forcerange=(lambda: self.rng.choice(["0 0", "5 -5"]) if self.seldom(0.1) else f"{n(-300, -20)} {n(0, 50)}", 0.1),
            forcelimited=(lambda: self.rng.choice(["auto", "true", "false"]), 0.1),
            group=(lambda: self.rng.randint(0, 3), 0.1),
            **({"damping": (lambda: self.rng.choice(["0", "2"]), 0.01),
                "armature": (lambda: self.rng.choice(["0", "0.1"]), 0.01)} if NEWER else {}),
        )

    def actuator(self, kind):
        n = self.number
        text = self.common()
        if kind == "general":
            text += self.attributes(
                gainprm=lambda: n(20, 200), biastype=(lambda: self.rng.choice(["affine", "affine", "none"]), 0.6),
                biasprm=lambda: " ".join([n(-10, 10), n(-200, 0), n(-9, 0)][:self.rng.randint(1, 3)]),
                dyntype=(lambda: self.rng.choice(["none", "filter", "filter", "filterexact", "integrator"]), 0.1),
                dynprm=(lambda: n(0.01, 0.2), 0.1), gaintype=(lambda: "fixed", 0.2),
                actlimited=(lambda: "false", 0.05), actrange=(lambda: "0 1", 0.03))
        elif kind in ("position", "intvelocity"):
            text += self.attributes(kp=lambda: n(20, 200), kv=(lambda: n(0, 9), 0.5),
                                    dampratio=(lambda: n(0, 1), 0.02),
                                    inheritrange=(lambda: n(0, 1), 0.03))
            if kind == "position":
                text += self.attributes(timeconst=(lambda: self.rng.choice(["0", n(0.01, 0.2)]), 0.15))
        elif kind in ("velocity", "damper"):
            text += self.attributes(kv=lambda: n(0, 9))
        elif kind == "cylinder":
            text += self.attributes(
                timeconst=lambda: n(0.01, 0.1), area=lambda: n(1, 100), diameter=(lambda: n(1, 9), 0.1),
                bias=lambda: " ".join([n(-10, 10), n(-200, 0), n(-9, 0)][:3]))
        return text

    def tendon(self):
        n = self.number
        return self.attributes(
            stiffness=(lambda: n(10, 300), 0.5), damping=(lambda: n(0, 9), 0.4),
            springlength=lambda: self.rng.choice([n(0.3, 1.5), f"0 {n(0.3, 1.5)}", f"{n(0.1, 0.3)} {n(0.4, 1)}", "-1"]),
            frictionloss=(lambda: self.rng.choice(["0", n(0, 1)]), 0.03),
            range=(lambda: f"{n(0, 0.3)} {n(0.6, 2)}", 0.1), limited=(lambda: self.rng.choice(["auto", "false"]), 0.1),
            armature=(lambda: self.rng.choice(["0", "0.1"]), 0.01))

    def default(self, classes, depth):
        text = ""
        for _ in range(self.rng.choice([0, 1, 1, 2])):
            kind = self.kind()
            if f"<{kind} " not in text:
                text += f"<{kind} {self.actuator(kind)}/>\n"
        if self.seldom(0.5):
            text += f"<tendon{self.tendon()}/>\n"
        if depth < 3:
            for _ in range(self.rng.choice([0, 0, 1, 2])):
                classes.append(f"c{len(classes)}")
                text += f'<default class="{classes[-1]}">\n{self.default(classes, depth + 1)}</default>\n'
        return text

    def file(self):
        classes, n = [], self.number
        compiler = f'<compiler{self.attributes(autolimits=(lambda: self.rng.choice(["true", "false"]), 0.1))}/>'
        defaults = f"<default>\n{self.default(classes, 0)}</default>\n"
        if self.seldom():
            defaults += f"<default>\n{self.default(classes, 2)}</default>\n"
        flags = self.attributes(clampctrl=(lambda: "disable", 0.1), frictionloss=(lambda: "disable", 0.05),
                                limit=(lambda: "disable", 0.05))
        option = f'<option{self.attributes(actuatorgroupdisable=(lambda: "2", 0.05))}><flag{flags}/></option>'
        of_class = lambda: f' class="{self.rng.choice(classes)}"' if classes and self.seldom(0.7) else ""
        count = self.rng.randint(1, 3)
        tops = "".join(f'<site name="top{i}" pos="{i} 0 2"/>' for i in range(count))
        sites = "".join(f'<site name="s{i}" pos="{n(-0.1, 0.1)} 0 {n(0.2, 0.6)}"/>' for i in range(count))
        tendons = "".join(
            f'<spatial name="t{i}"{of_class()}{self.tendon()}><site site="top{i}"/><site site="s{i}"/></spatial>\n'
            for i in range(count))
        actuators, controls = "", 0
        for i in range(count):
            for _ in range(self.rng.choice([0, 1, 1, 1, 2])):
                kind = self.kind()
                actuators += f'<{kind} name="a{controls}" tendon="t{i}"{of_class()}{self.actuator(kind)}/>\n'
                controls += 1
        return (f"<mujoco>\n{compiler}\n{option}\n{defaults}<worldbody>{tops}\n"
                f'<body name="b" pos="0 0 1"><freejoint/><geom size="0.1"/>{sites}</body></worldbody>\n'
                f"<tendon>\n{tendons}</tendon>\n<actuator>\n{actuators}</actuator>\n"), controls

    def with_key(self, xml, controls):
        """Adds a keyframe. Only the compiler knows the number of activations."""
        try:
            model = mujoco.MjModel.from_xml_string(xml + "</mujoco>")
        except ValueError as error:
            return xml + "</mujoco>\n", str(error)
        numbers = lambda count: " ".join(self.number(0.1, 0.9) for _ in range(count))
        act = f' act="{numbers(model.na)}"' if model.na and self.seldom(0.5) else ""
        return xml + f'<keyframe><key name="k" ctrl="{numbers(controls)}"{act}/></keyframe></mujoco>\n', None


def taut_cables(text):
    """Returns the cables of the model written by taut, by name: stiffness, damping, rest length."""
    cables, anchors = {}, {}
    for match, anchor, keys in re.findall(r"^  - \{match: ([^,]+|\[[^\]]*\]), cable: (?:&(\w+) )?\{(.*)\}\}$", text, re.M):
        if base := re.match(r"<<: \*(\w+), ", keys):
            keys = keys[base.end():] + ", " + anchors[base[1]]  # the first one of a key counts
        anchors[anchor] = keys
        number = lambda key, if_absent=0.0: float((re.findall(rf"\b{key}: ([-+.\de]+)", keys) or [if_absent])[0])
        for name in re.findall(r"t\d+", match):
            cables[name] = number("stiffness_n_per_m"), number("damping_n_s_per_m"), number("rest_length_m")
    return cables


class Comparison:
    def __init__(self, model, xml, text, said):
        self.m, self.cables, self.said = model, taut_cables(text), said
        self.d = mujoco.MjData(model)
        if model.nkey:
            mujoco.mj_resetDataKeyframe(model, self.d, 0)
            if ' act="' not in xml:
                self.settle()
        mujoco.mj_forward(model, self.d)
        self.wrong = []

    def settle(self):
        """Sets activations to their steady values: taut's cables follow at once."""
        for a in range(self.m.nu):
            if self.m.actuator_actadr[a] >= 0:
                u, clamped = self.d.ctrl[a], not self.m.opt.disableflags & int(mujoco.mjtDisableBit.mjDSBL_CLAMPCTRL)
                if self.m.actuator_ctrllimited[a] and clamped:
                    u = min(max(u, self.m.actuator_ctrlrange[a][0]), self.m.actuator_ctrlrange[a][1])
                self.d.act[self.m.actuator_actadr[a]] = u

    def same(self, what, ours, theirs, size=0.0):
        if not math.isclose(ours, theirs, rel_tol=1e-9, abs_tol=1e-9 * size + 1e-12):
            self.wrong.append(f"{what}: {ours} for {theirs}")

    def warned(self, what, text):
        if text not in self.said:
            self.wrong.append(f"{what} without a warning")

    def run(self):
        for t in range(self.m.ntendon):
            self.tendon(t)
        return self.wrong

    def tendon(self, t):
        m, d, name = self.m, self.d, f"t{t}"
        k, b, pull, length = m.tendon_stiffness[t], m.tendon_damping[t], 0.0, d.ten_length[t]
        lower, upper = m.tendon_lengthspring[2 * t:2 * t + 2] if m.tendon_lengthspring.ndim == 1 else m.tendon_lengthspring[t]
        pull += k * (length - upper if length > upper else length - lower if length < lower else 0)
        dry = m.tendon_frictionloss[t] > 0 and not m.opt.disableflags & int(mujoco.mjtDisableBit.mjDSBL_FRICTIONLOSS)
        actuators = [a for a in range(m.nu) if m.actuator_trnid[a][0] == t]
        for a in actuators:
            gear, bias = m.actuator_gear[a][0], m.actuator_biasprm[a]
            known = (int(m.actuator_gaintype[a]) == int(mujoco.mjtGain.mjGAIN_FIXED)
                     and int(m.actuator_biastype[a]) in (NO_BIAS, AFFINE)
                     and int(m.actuator_dyntype[a]) in DYNAMICS)
            if not known:
                self.wrong.append(f"a{a} has no law of a cable and is read")
            if int(m.actuator_biastype[a]) == AFFINE:
                k, b = k - gear * gear * bias[1], b - gear * gear * bias[2]
            pull -= gear * d.actuator_force[a]
            if NEWER and (m.actuator_damping[a] != 0 or m.actuator_armature[a] != 0):
                self.wrong.append(f"a{a} has damping or armature and is read")
            if int(m.actuator_dyntype[a]) != DYNAMICS[0]:
                if m.actuator_dynprm[a][0] > 0:
                    self.warned(f"lag of a{a}", "with a lag behind their controls (dyntype)")
                if m.actuator_actlimited[a]:
                    self.wrong.append(f"a{a} has a range of its activation and is read")
            if m.actuator_forcelimited[a]:
                self.warned(f"forcerange of a{a}", "(forcerange)")
        limited = m.tendon_limited[t] and not m.opt.disableflags & int(mujoco.mjtDisableBit.mjDSBL_LIMIT)
        if m.tendon_armature[t] != 0 or dry:
            self.wrong.append(f"{name} has armature or dry friction and is read")
        if name not in self.cables:
            if k != 0 or b != 0 or actuators or limited:
                self.wrong.append(f"{name} is missing")
            return
        if limited:
            self.warned(f"range of {name}", "a length limit (range)")
        stiffness, damping, rest = self.cables[name]
        self.same(f"stiffness of {name}", stiffness, k)
        self.same(f"damping of {name}", damping, b)
        self.same(f"tension of {name}", max(0.0, stiffness * (length - rest)), max(0.0, pull), k * (length + rest))
        if pull < -1e-9 * k * length:
            self.warned(f"a push by {name}", "would push in MuJoCo")


def main():
    taut, count = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 60
    seed = int(sys.argv[3]) if len(sys.argv) > 3 else 1
    tally, reasons, wrong = collections.Counter(), collections.Counter(), 0
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "model.xml"
        for i in range(count):
            writer = Writer(random.Random(f"{seed} {i}"))
            xml, theirs = writer.with_key(*writer.file())
            path.write_text(xml)
            key = ["--keyframe", "k"] if theirs is None else []
            done = subprocess.run([taut, "import", "mjcf", path, *key], capture_output=True, text=True)
            said, problems = done.stderr, []
            if done.returncode == 3:
                errors = [line for line in said.splitlines() if "error:" in line]
                if not errors or not all(re.search(r"model\.xml:\d+: error: ", line) for line in errors):
                    problems = ["a refusal without a line"]
                for line in set(re.sub(r'"[^"]*"|-?\d[\d.e+-]*', "_", e.split("error: ")[1]) for e in errors):
                    reasons[line] += 1
                tally["refused by both" if theirs else "refused by taut"] += 1
            elif done.returncode != 0:
                problems = [f"status {done.returncode}"]
            elif theirs is not None:
                tally["refused by MuJoCo only"] += 1
                reasons["MuJoCo: " + re.sub(r"\s+", " ", theirs)[:90]] += 1
            else:
                tally["compared"] += 1
                problems = Comparison(mujoco.MjModel.from_xml_string(xml), xml, done.stdout, said).run()
            if problems:
                wrong += 1
                print(f"file {i} of seed {seed}: " + "; ".join(problems))
                if wrong <= 3:
                    print(xml + said)
    print(f"MuJoCo {mujoco.__version__}: {count} files, " + ", ".join(f"{n} {what}" for what, n in tally.items()) + f", {wrong} wrong")
    if "--reasons" in sys.argv:
        for reason, n in reasons.most_common():
            print(f"{n:5} {reason}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
