"""A measured aluminum prism: one parameter from one test, validated by another."""

import csv
import pathlib
import time

from validation import fits
from validation.push import machine
from validation.runs import Problem, fill, table

TEMPLATE = pathlib.Path(__file__).with_suffix(".md.in")
DATA = fits.REFERENCE / "feron_t3"
TESTS = {"6a": 0.00075, "6b": 0.0047}   # elongation of the struts [m]
STRUTS = ("S1", "S2", "S3")


def prepare(folder, test):
    """Writes the measured rows with taut's names, and the experiment with their load cases."""
    path = DATA / f"fig{test}_measured.csv"
    if not path.exists():
        raise Problem(f"{path} is missing: the data may not be redistributed (source: docs/validation/t3_prism.md)")
    rows = fits.rows_of(path, 1)
    members = path.read_text().splitlines()[0].split(",")[1:13]
    names = [m[:-len("_kN")] for m in members]
    head = [f"joint/{n}/axial_n" if n in STRUTS else f"cable/{n}/tension_n" for n in names]
    signs = [-1e3 if n in STRUTS else 1e3 for n in names]
    fits.write_rows(folder / f"{test}.csv", ["time_s", *head, *(f"node/n{n}/position_z_m" for n in (3, 4, 5))],
                    [[float(i), *(s * x for s, x in zip(signs, row[1:13])), *(h * 1e-3 for h in row[13:16])]
                     for i, row in enumerate(rows)])
    cases = "".join(
        f"  - name: load_{i}\n    forces:\n" +
        "".join(f"      - {{node: n{n}, force_n: [0, 0, {-1e3 * row[0]:g} * share]}}\n" for n in (3, 4, 5))
        for i, row in enumerate(rows))
    (folder / f"{test}.yaml").write_text(
        f"taut: 1\nkind: experiment\nname: t3_{test}\nmodel: {fits.beside(folder, 'share/models/t3_prism.yaml')}\n"
        f"set: {{lengthening_m: {TESTS[test]}}}\nparameters: {{share: 1}}\nduration_s: 1\nload_cases:\n{cases}")


def prepare_5a(folder):
    """Writes test 5a: cable CT3 is shortened in steps, without load. The figure has one curve per quantity and member."""
    curves = {}
    for row in csv.DictReader((DATA / "fig5a_measured_long.csv").open()):
        number = int(row["group_or_node_shade(1=dark=1/node5,2=mid=2/node4,3=light=3/node3)"])
        curves.setdefault((row["quantity"], number), []).append(
            (float(row["elongation_magnitude_mm"]), float(row["value"])))
    columns, steps = {}, [e for e, _ in curves[("S_kN", 1)]]
    for kind, channel, scale in (("S", "joint/{}/axial_n", -1e3), ("CB", "cable/{}/tension_n", 1e3),
                                 ("CT", "cable/{}/tension_n", 1e3), ("CV", "cable/{}/tension_n", 1e3)):
        for i in (1, 2, 3):
            columns[channel.format(f"{kind}{i}")] = [scale * x for _, x in curves[(f"{kind}_kN", i)]]
    for i, node in ((1, "n5"), (2, "n4"), (3, "n3")):
        columns[f"node/{node}/position_z_m"] = [1e-3 * x for _, x in curves[("height_mm", i)]]
    fits.write_rows(folder / "5a.csv", ["time_s", *columns],
                    [[float(i), *(c[i] for c in columns.values())] for i in range(len(steps))])
    cases = "".join(f"  - {{name: step_{i}, rest_lengths: [{{members: CT3, by_m: {-1e-3 * e:g}}}]}}\n"
                    for i, e in enumerate(steps))
    (folder / "5a.yaml").write_text(
        f"taut: 1\nkind: experiment\nname: t3_5a\nmodel: {fits.beside(folder, 'share/models/t3_prism.yaml')}\n"
        f"set: {{lengthening_m: {TESTS['6a']}}}\nparameters: {{share: 1}}\nduration_s: 1\nload_cases:\n{cases}")


def carried(check):
    """Returns the fraction of each applied load that the measured forces balance at the top nodes."""
    return [row["carried_n"] / row["applied_n"] for row in check["rows"][1:]]


def forces(points, key):
    """Returns the mean magnitude of the error, relative to the measurement [%]."""
    errors = [abs(p[key] / p["measured"] - 1) for p in points if p["channel"].endswith("_n")]
    return 100 * sum(errors) / len(errors)


def bias(points):
    """Returns the mean relative error of the forces, computed - measured, without a fit [%]."""
    errors = [p["untuned"] / p["measured"] - 1 for p in points if p["channel"].endswith("_n")]
    return 100 * sum(errors) / len(errors)


def heights(points, key):
    errors = [1e3 * (p[key] - p["measured"]) for p in points if p["channel"].endswith("position_z_m")]
    return (sum(e * e for e in errors) / len(errors)) ** 0.5


def error(p):
    """Returns the largest standard error of a parameter."""
    return max(p["se"], p["se_jackknife"] or 0, p["se_residuals"] or 0)


def estimate(fit, name):
    p = fit.parameters[name]
    return f"{p['value']:.3f} +- {error(p):.3f}, {p['verdict']}"


def text(train, test, estimate, groups="window"):
    uses = [(t, "train") for t in train.split()] + [(t, "test") for t in test.split()]
    return ("experiments:\n" +
            "".join(f"  - {{name: t{t}, experiment: ../{t}.yaml, data: ../{t}.csv, "
                    f"forward: load_cases, use: {use}}}\n" for t, use in uses) +
            "estimate:\n" + "".join(f"  - {e}\n" for e in estimate) +
            f"residuals:\n  - {{channel: \"*_n\", sd: 25, relative_sd: 0.01}}\n"
            f"  - {{channel: \"node/*/position_z_m\", sd: 0.001}}\ngroups: {groups}\nsearch: {{iterations: 30}}\n"
            "carried: [{name: top, bodies: [n3, n4, n5], experiments: [t6a, t6b]}]\n")


def page(taut):
    started = time.monotonic()
    folder = taut.folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    for test in TESTS:
        prepare(folder, test)
    prepare_5a(folder)
    share = "{parameter: share, low: 0.5, high: 1.2, scale: 0.05}"
    one = fits.run(taut, "share", text("6a", "6b", [share]), "--profile", "share")
    gain = "{channel: \"*_n\", gain: {scale: 0.05}}"
    both = fits.run(taut, "gain", text("6a", "6b", [share, gain]))
    unloaded = fits.run(taut, "unloaded", text("5a", "6a 6b", [gain]))
    assumed = fits.run(taut, "assumed", text("6a 5a", "6b", [share]))
    together = fits.run(taut, "together", text("6a 5a", "6b", [share, gain]))
    more = fits.run(taut, "lengths", text("6a", "6b", [
        share, "{parameter: strut_area_m2, scale: 2e-5}", "{parameter: cable_area_m2, scale: 2.5e-6}",
        "{parameter: lengthening_m, scale: 0.0001, experiments: [t6a]}"], "experiment"))
    strut = [p for p in one.points("train") if p["channel"] == "joint/S1/axial_n"][-1]
    rows = [["untuned", *(f"{forces(one.points(w), 'untuned'):.2f}" for w in ("train", "test")),
             *(f"{heights(one.points(w), 'untuned'):.2f}" for w in ("train", "test")), ""]]
    for name, fit in (("share of the load that arrives", one), ("share, gain of the load cells", both), ("share, areas, lengthening of the struts", more)):
        rows.append([name, *(f"{forces(fit.points(w), 'fitted'):.2f}" for w in ("train", "test")),
                     *(f"{heights(fit.points(w), 'fitted'):.2f}" for w in ("train", "test")),
                     "; ".join(fit.judgements()) or "good"])
    p = one.parameters["share"]
    return fill(TEMPLATE.read_text(), {
        "version": taut("--version").split()[-1], "seconds": f"{time.monotonic() - started:.0f}",
        "machine": machine(), "strut": f"{-strut['untuned'] / 1e3:.4f}",
        "table": table(["fitted to 6a", "forces 6a [%]", "forces 6b [%]", "heights 6a [mm]", "heights 6b [mm]",
                        "fit"], rows),
        "alias": next(a["sentence"] for a in assumed.summary["aliases"] if a["name"] == "gain *_n"),
        "gains": table(["fitted to", "share of the load", "gain of the load cells", "fit"], [
            ["6a", estimate(one, "share"), "1 (assumed)", "; ".join(one.judgements()) or "good"],
            ["6a", estimate(both, "share"), estimate(both, "gain *_n"), "; ".join(both.judgements()) or "good"],
            ["5a", "-", estimate(unloaded, "gain *_n"), "; ".join(unloaded.judgements()) or "good"],
            ["6a and 5a", estimate(assumed, "share"), "1 (assumed)", "; ".join(assumed.judgements()) or "good"],
            ["6a and 5a", estimate(together, "share"), estimate(together, "gain *_n"),
             "; ".join(together.judgements()) or "good"]]),
        "together": " ".join(s for s in together.summary["sentences"] if s.startswith("Contradiction")) or
                    "; ".join(t["sentence"] for t in together.summary["experiments_alone"]["tests"]),
        "unloaded": f"{forces(unloaded.points('train'), 'untuned'):.2f}",
        "bias": f"{bias(unloaded.points('train')):+.1f}",
        "share": f"{p['value']:.4f}", "error": f"{error(p):.4f}", "verdict": p["verdict"],
        "carried": table(["test", "minimum", "maximum", "mean"],
                         [[c["experiment"][1:], *(f"{x:.3f}" for x in (min(carried(c)), max(carried(c)),
                                                                       sum(carried(c)) / len(carried(c))))]
                          for c in one.summary["carried"]]),
        "says": "; ".join(c["sentence"] for c in one.summary["carried"]),
        "sentence": one.summary["sentences"][0],
    })
