"""Checks that the schemas in share/schema/, the shipped files, the reader and the format reference agree.

Usage: schema_test.py SPEC_PROBE [TEST]. Prints the errors; exit status 1 if there are any.
"""

import importlib.machinery
import importlib.util
import itertools
import json
import pathlib
import re
import subprocess
import sys
import tempfile

try:
    import jsonschema
    import yaml
except ImportError as missing:
    print(f"skipped: {missing}; it is in Debian's python3-jsonschema or python3-yaml")
    sys.exit(0)

ROOT = pathlib.Path(__file__).resolve().parents[3]
loader = importlib.machinery.SourceFileLoader("docs", str(ROOT / "script" / "docs"))
docs = importlib.util.module_from_spec(importlib.util.spec_from_loader("docs", loader))
sys.dont_write_bytecode = True
loader.exec_module(docs)

KINDS = {"model": "models", "experiment": "experiments", "gait": "gaits", "study": "studies",
         "fit": "fits", "faults": "faults"}
PROBE = ""


def load(kind):
    return docs.load_schema(kind)


def shipped(kind):
    files = sorted((ROOT / "share" / KINDS[kind]).glob("*.yaml"))
    return files or [f"no files in {KINDS[kind]}/"]


def probe(path, *options):
    run = subprocess.run([PROBE, *options, str(path)], capture_output=True, text=True, check=False)
    return run.stdout + run.stderr


# --- requirements on every schema ------------------------------------------------------------


UNIT_OF_SUFFIX = {
    "force_i_per_n_s": "1/(N s)", "force_d_s_per_n": "s/N", "length_p_per_m": "1/m", "length_i_per_m_s": "1/(m s)",
    "length_d_s_per_m": "s/m", "_v_s_per_m": "V s/m",
    "_n_m_s_per_rad": "N m s/rad", "_n_m_per_rad": "N m/rad", "_n_m_per_a": "N m/A", "_n_m": "N m", "_n_per_s": "N/s",
    "alive_per_s": "1/s", "_per_j": "1/J", "gain_per_m": "1/m", "damping_s_per_m": "s/m", "friction_s_per_m": "s/m", "_rad_per_n_s": "rad/(N s)", "convergence_per_s": "1/s", "weight_per_m": "1/m",
    "weight_per_m_s": "1/(m s)", "_n_s_per_m": "N s/m", "_n_per_m": "N/m",
    "_kg_per_m3": "kg/m^3", "_kg_per_m": "kg/m",
    "_rad_per_s": "rad/s", "_m_per_s2_n": "m/(s^2 N)", "_m_per_s_n": "m/(s N)",
    "_m_per_s2": "m/s^2", "_m_per_s": "m/s", "_m_per_n": "m/N", "_per_n": "1/N", "_kg": "kg",
    "_hz_per_s": "Hz/s", "_rad": "rad", "_hz": "Hz", "_n": "N", "_s": "s", "_m": "m",
}


def test_SchemasAreWhatTautPrints():
    for kind in KINDS:
        run = subprocess.run([PROBE, "--schema", kind], capture_output=True, text=True, check=True)
        if run.stdout != docs.schema_path(kind).read_text():
            yield f"share/schema/{kind}.schema.json is not up to date: run script/docs"


def test_SchemasAreValid():
    for kind in KINDS:
        jsonschema.Draft202012Validator.check_schema(load(kind))


def test_EveryKeyHasADescriptionAndItsUnit():
    for kind in KINDS:
        schema = load(kind)
        for node in docs.all_maps(schema):
            for key, value in node["properties"].items():
                text = docs.resolve(schema, value).get("description", "")
                if not text.endswith("."):
                    yield f"{kind}: {node['title']}.{key} has no description with a full stop"
                suffix = next((s for s in UNIT_OF_SUFFIX if key.endswith(s)), None)
                full = docs.resolve(schema, value)
                full = full.get("additionalProperties") or full
                # the suffix of a map is the unit of its numbers
                if suffix and "properties" not in full and full.get("unit") != UNIT_OF_SUFFIX[suffix]:
                    yield f"{kind}: {node['title']}.{key} is not in {UNIT_OF_SUFFIX[suffix]}"


def test_ExamplesFitTheirSchemas():
    for kind in KINDS:
        schema = load(kind)
        for node in docs.all_maps(schema):
            entries = [(node["title"], node)] + list(node["properties"].items())
            for name, entry in entries:
                rules = {**entry, "$defs": schema["$defs"]}
                for example in entry.get("examples", []):
                    for error in jsonschema.Draft202012Validator(rules).iter_errors(example):
                        yield f"{kind}: example of {name}: {error.message}"


# --- shipped files ---------------------------------------------------------------------------


def test_ShippedFilesFitTheirSchemas():
    for kind in KINDS:
        validator = jsonschema.Draft202012Validator(load(kind))
        for path in shipped(kind):
            for error in validator.iter_errors(yaml.safe_load(path.read_text())):
                yield f"{path.name}: {list(error.path)}: {error.message[:200]}"


def test_ShippedFilesNameTheirSchema():
    for kind in KINDS:
        wanted = f"# yaml-language-server: $schema=../schema/{kind}.schema.json"
        for path in shipped(kind):
            if path.read_text().splitlines()[0] != wanted:
                yield f"{path.name}: the first line is not `{wanted}`"


def test_ShippedFilesLoad():
    for kind in KINDS:
        for path in shipped(kind):
            yield from probe(path).splitlines()


def test_SchemasRefuseWhatTheReaderRefuses():
    """Checks that schema and reader reject the same files: a misspelled, missing or superfluous key, a wrong type."""
    push = (ROOT / "share/experiments" / "push_20n.yaml").read_text()
    push = push.replace("../models/", str(ROOT / "share/models") + "/")
    spine = (ROOT / "share/models" / "tetraspine3.yaml").read_text()
    study = (ROOT / "share/studies" / "sidewinder3.yaml").read_text()
    study = study.replace("../experiments/", str(ROOT / "share/experiments") + "/")
    fit = (ROOT / "share/fits" / "tetraspine3_push.yaml").read_text()
    fit = fit.replace("../experiments/", str(ROOT / "share/experiments") + "/")
    learned = (ROOT / "share/gaits" / "cpg_learned.yaml").read_text()
    noise = (ROOT / "share/faults" / "noisy_bus.yaml").read_text()
    waves = (ROOT / "share/gaits" / "hand_tuned_sine.yaml").read_text()
    changes = [
        ("gait", learned, "symmetry: index", "symmetry: indices"),
        ("gait", learned, "weight_per_m:", "weight:"),
        ("gait", learned, "cpg:", "table: {file: a.csv}\ncpg:"),
        ("gait", waves, "cables: inner_top_1,", ""),
        ("experiment", push, "period_s: 0.001\n", "perod_s: 0.001\n"),
        ("experiment", push, "duration_s: 60", ""),
        ("experiment", push, "height_m: 0,", "height_m: 0, normal: [0, 0, 1],"),
        ("experiment", push, "height_m: 0,", "slope_rad: 0.1,"),
        ("experiment", push, "direction: [1, 0, 0]", "direction: [1, 0]"),
        ("experiment", push, "start: as_described", "start: somehow"),
        ("experiment", push, "rate_hz: 100", "rate_hz: [100]"),
        ("experiment", push, "conversion: stiffness", "conversion: pid"),
        ("experiment", push, "start: as_described", "scale: [{friction: 1, mass: 1}]"),
        ("experiment", push, "start: as_described", "sensors: {load_cell: {bits: 10}}"),
        ("experiment", push, "start: as_described", "sensors: {encoder: {lines: 16}}"),
        ("experiment", push, "start: as_described", "sensors: {encoder: {spool_radius_m: 0.01}}"),
        ("experiment", push, "start: as_described",
         "sensors: {encoder: {lines: 16, spool_radius_m: 0.01, decoding: 3}}"),
        ("experiment", push, "start: as_described", "sensors: {load_cell: {counts: {bits: 0}}}"),
        ("model", spine, "max_speed_m_per_s: 0.07,", "dc_motor: {gear: 76},"),
        ("study", study, "high: 2,", "height: 2,"),
        ("study", study, "measure: distance", "measure: happiness"),
        ("study", study, "measure: distance", "from_s: 2"),
        ("study", study, "each: motion.sine.frequency_hz,", ""),
        ("study", study, "method: monte_carlo", "method: magic"),
        ("study", study, "evaluations: 256, ", ""),
        ("study", study, "experiment: ", "# experiment: "),
        ("fit", fit, "high: 80", "hihg: 80"),
        ("fit", fit, "sd: 3", "mean: 20"),
        ("fit", fit, "reference: maxima", "reference: most"),
        ("fit", fit, "parameter: push_n", "channel: a, parameter: push_n"),
        ("fit", fit, "starts: 2", "starts: 0"),
        ("faults", noise, "at_s: 2.5", "at: 2.5"),
        ("faults", noise, "line: data", "line: sda"),
        ("faults", noise, "kind: bus_error, ", ""),
        ("model", spine, "radius_m: rod_radius_m", "radius: rod_radius_m"),
        ("model", spine, "prestress_n: 7", "prestress_n: 7\n      rest_length_m: 0.1"),
        ("model", spine, "ends: surface", "ends: anywhere"),
        ("model", spine, "copies: segments", "tags: [copy]"),
        ("model", spine, "mass_kg_per_m: rod_mass_kg_per_m", "mass_kg: 1, density_kg_per_m3: 1"),
    ]
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "changed.yaml"
        for kind, text, old, new in changes:
            assert old in text, old
            path.write_text(text.replace(old, new, 1))
            validator = jsonschema.Draft202012Validator(load(kind))
            if validator.is_valid(yaml.safe_load(path.read_text())):
                yield f"the {kind} schema accepts `{new}` for `{old}`"
            if probe(path) == "":
                yield f"the reader accepts `{new}` for `{old}`"


# --- the reader and the schema have the same keys ----------------------------------------------


def sample(schema, node, folder):
    """Returns a value that fits a node."""
    node = docs.resolve(schema, node)
    if "const" in node:
        return node["const"]
    if "enum" in node:
        return node["enum"][0]
    if docs.is_map(node):
        return least_map(schema, node, folder)
    if "oneOf" in node:
        return sample(schema, node["oneOf"][0], folder)
    kind = node["type"][0] if isinstance(node["type"], list) else node["type"]
    if kind == "array":
        return [sample(schema, node["items"], folder)] * node.get("minItems", 1)
    if kind == "object":
        return {"a": sample(schema, node["additionalProperties"], folder)}
    return {"number": 1, "string": "a", "boolean": True}[kind]


def sample_key(schema, node, key, folder):
    if key == "base":
        return str(folder / f"base_{schema['properties']['kind']['const']}.yaml")
    if key == "model":
        return str(ROOT / "share/models" / "rod.yaml")
    if key == "experiment":
        return str(ROOT / "share/experiments" / "stand_still.yaml")
    if key in ("each", "all"):
        return "model.friction"
    if key == "high":
        return 2
    return sample(schema, node["properties"][key], folder)


def least_map(schema, node, folder, with_key=None):
    """Returns a map with the required keys, and `with_key`."""
    needed = list(node.get("required", []))
    rules = [node, *node.get("allOf", [])]
    for whole in (a for a in node.get("anyOf", []) if "name" in a["required"]):
        needed += whole["required"]  # for a file without a base
        rules.append(whole)
    for rule in rules:
        for choice in ("oneOf", "anyOf"):
            alternatives = [b["required"] for a in rule.get(choice, []) for b in a.get("anyOf", [a])]
            if ["base"] in alternatives:
                continue
            fitting = [a for a in alternatives if with_key in a] or alternatives[:1]
            needed += itertools.chain(*fitting[:1])
        needed += rule.get("dependentRequired", {}).get(with_key, [])
    out = {key: sample_key(schema, node, key, folder) for key in needed if key != "base"}
    if with_key == "pid":
        out["conversion"] = "pid"
    if with_key == "algorithm":
        out["method"] = "nlopt"
    return out


def places(schema, node, folder, wrap=lambda inner: inner, seen=()):
    """Yields every map with known keys, with a function that puts such a map into a whole file."""
    yield node, wrap
    for key, value in node["properties"].items():
        for inner, lift in lifted(schema, value):
            if inner["title"] in seen:
                continue

            def wrap_inner(content, key=key, lift=lift):
                return wrap({**least_map(schema, node, folder, key), key: lift(content)})

            yield from places(schema, inner, folder, wrap_inner, (*seen, inner["title"]))


def lifted(schema, node, lift=lambda inner: inner):
    """Yields the maps that a value may hold, each with a function that makes the value from the map."""
    node = docs.resolve(schema, node)
    if docs.is_map(node):
        yield node, lift
    for part in node.get("oneOf", []):
        yield from lifted(schema, part, lift)
    if isinstance(node.get("items"), dict):
        yield from lifted(schema, node["items"], lambda inner: lift([inner]))
    if isinstance(node.get("additionalProperties"), dict):
        yield from lifted(schema, node["additionalProperties"], lambda inner: lift({"a": inner}))


def vocabulary():
    """Returns all words of string literals in the reader's source: every key is among them."""
    words = set()
    for path in (ROOT / "src" / "description").iterdir():
        if path.suffix in (".h", ".cpp"):
            words |= set(re.findall(r'"([a-z][a-z0-9_]*)"', path.read_text()))
    for kind in KINDS:
        for node in docs.all_maps(load(kind)):
            words |= set(node["properties"])
    return words


def test_ReaderAndSchemaKnowTheSameKeys():
    words = vocabulary()
    count = 0
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for kind in KINDS:
            (folder / f"base_{kind}.yaml").write_text(f"taut: 1\nkind: {kind}\n")
            schema = load(kind)
            for node, wrap in places(schema, schema, folder):
                count += 1
                known = set(node["properties"])
                unknown = words - known
                content = {key: sample_key(schema, node, key, folder) for key in known}
                content.update({word: 1 for word in unknown})
                path = folder / "probe.yaml"
                path.write_text(json.dumps(wrap(content), indent=1))
                complaints = set(re.findall(r'unknown key "(\w+)"', probe(path)))
                title = f"{kind}: {node['title']}"
                if not complaints:
                    yield f"{title} was not read at all"
                    continue
                for word in sorted(unknown - complaints):
                    yield f'{title}: the reader knows "{word}", the schema does not'
                for word in sorted(complaints - unknown):
                    yield f'{title}: the schema knows "{word}", the reader does not'
    if count < 40:
        yield f"only {count} maps were tried"


def test_ReaderAndSchemaKnowTheSameChoices():
    count = 0
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for kind in KINDS:
            schema = load(kind)
            for node, wrap in places(schema, schema, folder):
                for key, value in node["properties"].items():
                    choices = docs.resolve(schema, value).get("enum")
                    if not choices:
                        continue
                    count += 1
                    path = folder / "probe.yaml"
                    content = {**least_map(schema, node, folder, key), key: "qqqqqqqqqqqqqqqq"}
                    path.write_text(json.dumps(wrap(content), indent=1))
                    hint = re.search(r'cannot be "q+" \(one of: ([\w, ]+)\)', probe(path))
                    if not hint or set(hint[1].split(", ")) != set(choices):
                        known = hint and hint[1]
                        yield f"{kind}: {node['title']}.{key}: {choices}, the reader: {known}"
    if count < 12:
        yield f"only {count} keys with choices were tried"


# --- the format reference ------------------------------------------------------------------------


def test_FormatReferenceIsUpToDate():
    command = [sys.executable, ROOT / "script" / "docs", "--check"]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    yield from run.stdout.splitlines() + run.stderr.splitlines()


def main():
    global PROBE
    PROBE = sys.argv[1]
    tests = {name[5:]: function for name, function in globals().items() if name.startswith("test_")}
    chosen = sys.argv[2:] or list(tests)
    wrong = 0
    for name in chosen:
        for message in tests[name]() or ():
            print(f"{name}: {message}")
            wrong += 1
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
