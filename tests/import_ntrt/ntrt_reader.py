"""A reader of NTRT's structures, independent of taut's: matrices instead of quaternions, points instead of nodes

`read(path)` returns solids and cables in the files' units, with y up, as NTRT's builder makes them.
"""

import itertools
import math
import pathlib

import numpy
import yaml

SAME = 1e-7
DEFAULTS = {
    "tgRodInfo": {"radius": 0.5, "density": 1, "friction": 1, "restitution": 0.2},
    "tgBoxInfo": {"width": 1, "height": 1, "density": 1, "friction": 1, "restitution": 0.2},
    "tgSphereInfo": {"radius": 0.5, "density": 1, "friction": 1, "restitution": 0.2},
    "cable": {"stiffness": 1000, "damping": 10, "pretension": 0, "max_tension": 1000, "target_velocity": 100,
              "min_actual_length": 0.1, "min_rest_length": 0.1, "rotation": 0,
              "moveCablePointAToEdge": True, "moveCablePointBToEdge": True},
}


class Points:
    """A structure: named points, pairs of points, and nested structures"""

    def __init__(self, name):
        self.name, self.nodes, self.pairs, self.children = name, [], [], []

    def levels(self):
        row = [self]
        while row:
            yield from row
            row = [child for structure in row for child in structure.children]

    def child(self, name):
        return next(s for s in self.levels() if s is not self and s.name == name)

    def node(self, path):
        *names, last = path.split(".")
        structure = self
        for name in names:
            structure = structure.child(name)
        return next(point for s in structure.levels() for name, point in s.nodes if name == last)

    def points(self):
        """Returns every array once: pairs share the arrays of the nodes."""
        return [point for s in self.levels() for _, point in s.nodes]

    def move(self, matrix, about, shift):
        for point in self.points():
            point[:] = about + matrix @ (point - about) + shift


def turn(axis, angle):
    """Returns the rotation matrix of an axis and an angle (Rodrigues' formula)."""
    x, y, z = numpy.array(axis, float) / numpy.linalg.norm(axis)
    k = numpy.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return numpy.eye(3) + math.sin(angle) * k + (1 - math.cos(angle)) * (k @ k)


def unit(v):
    return v / numpy.linalg.norm(v)


def between(a, b, fallback):
    a, b = unit(a), unit(b)
    if numpy.linalg.norm(a - b) < 1e-5:
        return numpy.eye(3)
    if numpy.linalg.norm(a + b) < 1e-5:
        return turn(fallback, math.pi)
    return turn(numpy.cross(a, b), math.atan2(numpy.linalg.norm(numpy.cross(a, b)), a @ b))


class Reader:
    def __init__(self):
        self.builders = [({"rod"}, "tgRodInfo", {}), ({"string"}, "tgBasicActuatorInfo", {}),
                         ({"box"}, "tgBoxInfo", {}), ({"sphere"}, "tgSphereInfo", {})]

    def structure(self, name, path, like_ntrt):
        lines = path.read_text().split("\n")
        for i, line in enumerate(lines):
            if line.startswith("%"):
                lines = lines[:i] if like_ntrt else lines[:i] + ["#"] + lines[i + 1:]
                if like_ntrt:
                    break
        root = yaml.safe_load("\n".join(lines).replace("\t", " ")) or {}
        here = Points(name)
        inside = (root.get("substructures") or {}).items()
        for names, is_ in inside:
            if "path" in is_:
                here.children += [self.structure(n, path.parent / is_["path"], like_ntrt) for n in names.split("/")]
        for names, is_ in inside:
            rotation = is_.get("rotation")
            for child in map(here.child, names.split("/") if rotation else []):
                about = rotation.get("reference", numpy.mean(child.points(), axis=0))
                child.move(turn(rotation["axis"], math.radians(rotation["angle"])), numpy.array(about), 0)
        for names, is_ in inside:
            for i, child in enumerate(map(here.child, names.split("/"))):
                if "scale" in is_:
                    child.move(is_["scale"] * numpy.eye(3), numpy.mean(child.points(), axis=0), 0)
                shift = i * numpy.array(is_.get("offset", [0, 0, 0])) + is_.get("translation", [0, 0, 0])
                child.move(numpy.eye(3), numpy.zeros(3), shift)
        for tags, is_ in (root.get("builders") or {}).items():
            self.builders.append((set(tags.split()), is_["class"], is_.get("parameters") or {}))
        here.nodes = [(n, numpy.array(p, float)) for n, p in (root.get("nodes") or {}).items()]
        for tags, pairs in (root.get("pair_groups") or {}).items():
            here.pairs += [(set(tags.split()), here.node(a), here.node(b)) for a, b in pairs]
        for outer, inner in (root.get("bond_groups") or {}).items():
            for key, lines in inner.items():
                bond, tags = (outer, key) if "/" in outer else (key, outer)
                *names, kind = bond.split("/")
                for one, two in itertools.pairwise(names):
                    getattr(self, kind)(here, here.child(one), here.child(two), set(tags.split()), lines)
        return here

    def node_node(self, here, one, two, tags, lines):
        here.pairs += [(tags | {one.name, two.name}, one.node(a), two.node(b)) for a, b in lines]

    def node_edge(self, here, one, two, tags, lines):
        found = [[[s.node(n) for n in half.split("/")] for s, half in zip((one, two), line)] for line in lines]
        on = [[numpy.mean(half, axis=0) for half in line] for line in found]
        p, q = (numpy.array([line[side] for line in on]) for side in (0, 1))
        p_normal = numpy.cross(p[1] - p[0], p[2] - p[0])
        q_normal = numpy.cross(q[1] - q[0], q[2] - q[0])
        p_mean, q_mean = p.mean(axis=0), q.mean(axis=0)
        level = between(q_normal, p_normal, q[1] - q[0])
        two.move(level, q_mean, p_mean - q_mean)
        two.move(between(level @ (q[0] - q_mean), p[0] - p_mean, p_normal), p_mean, 0)
        nodes = [next(half[0] for half in line if len(half) == 1) for line in found]
        edges = [next(half for half in line if len(half) == 2) for line in found]
        gone = edges + list(itertools.combinations(nodes, 2))
        for s in itertools.chain(one.levels(), two.levels()):
            s.pairs = [pair for pair in s.pairs
                       if self.kind(pair[0], "") in ("tgRodInfo", "tgBoxInfo") or not any(
                           {id(pair[1]), id(pair[2])} == {id(a), id(b)} for a, b in gone)]
        for node, (a, b) in zip(nodes, edges):
            here.pairs += [(tags, a, node), (tags, node, b)]

    def builder(self, tags, structure, kinds):
        for wanted, kind, is_ in reversed(self.builders):
            if kinds(kind) and wanted - {structure} <= tags:
                defaults = DEFAULTS.get(kind, DEFAULTS["cable"])
                return kind, {**defaults, **{k: v for k, v in is_.items() if k in defaults}}
        return None

    def kind(self, tags, structure):
        found = self.builder(tags, structure, lambda k: k in ("tgRodInfo", "tgBoxInfo")) or \
            self.builder(tags, structure, lambda k: k not in DEFAULTS)
        return found[0] if found else None


def touching(solids, at):
    ends = numpy.array([s["ends"] for s in solids])
    return [solids[i] for i in numpy.nonzero((numpy.linalg.norm(ends - at, axis=2) < SAME).any(axis=1))[0]]


def surface(solids, at, to, moves):
    near = touching(solids, at)
    best = min(near, key=lambda s: round(numpy.linalg.norm(numpy.mean(s["ends"], axis=0) - at), 7))
    if not moves:
        return at, best
    if best["kind"] == "tgSphereInfo":
        return at + best["radius"] * unit(to - at), best
    axis = unit(best["ends"][1] - best["ends"][0])
    aside = (to - at) - axis * (axis @ (to - at))
    return at + best.get("radius", best.get("width")) * unit(aside), best


def read(path, like_ntrt=False):
    reader = Reader()
    top = reader.structure("", pathlib.Path(path), like_ntrt)
    solids, strings = [], []

    def build(s):
        for name, point in s.nodes:
            found = reader.builder(set(name.split()), s.name, lambda k: k == "tgSphereInfo")
            if found:
                mass = found[1]["density"] * 4 / 3 * math.pi * found[1]["radius"] ** 3
                solids.append({"kind": found[0], "ends": [point, point], "mass": mass, **found[1]})
        for tags, a, b in s.pairs:
            found = reader.builder(tags, s.name, lambda k: k in ("tgRodInfo", "tgBoxInfo"))
            if found:
                is_ = found[1]
                area = math.pi * is_["radius"] ** 2 if "radius" in is_ else 4 * is_["width"] * is_["height"]
                mass = is_["density"] * area * numpy.linalg.norm(b - a)
                solids.append({"kind": found[0], "ends": [a, b], "mass": mass, **is_})
                continue
            found = reader.builder(tags, s.name, lambda k: k not in DEFAULTS)
            if found:
                strings.append((a, b, found[1]))
        for child in s.children:
            build(child)

    build(top)
    for number, solid in enumerate(solids):
        solid["body"] = number
    for solid in solids:  # solids that share a point are one body
        for end in solid["ends"]:
            numbers = {other["body"] for other in touching(solids, end)}
            for other in solids if len(numbers) > 1 else []:
                other["body"] = min(numbers) if other["body"] in numbers else other["body"]
    bodies = [[s for s in solids if s["body"] == number] for number in sorted({s["body"] for s in solids})]
    cables = []
    for a, b, is_ in strings:
        p, on_p = surface(solids, a, b, is_["moveCablePointAToEdge"])
        q, on_q = surface(solids, b, a, is_["moveCablePointBToEdge"])
        if on_p["body"] == on_q["body"]:
            continue
        length = numpy.linalg.norm(p - q)
        cables.append({"from": p, "to": q, "length": length, "rest": length - is_["pretension"] / is_["stiffness"],
                       **is_})
    return bodies, cables
