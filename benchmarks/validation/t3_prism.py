"""A measured aluminum prism: one parameter from one test, validated by another."""

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
        raise Problem(f"there is no {path}: the data are not ours to pass on (docs/validation/t3_prism.md says where from)")
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


def carried(check):
    """Returns the fraction of each applied load that the measured forces balance at the top nodes."""
    return [row["carried_n"] / row["applied_n"] for row in check["rows"][1:]]


def forces(points, key):
    """Returns the mean magnitude of the error, relative to the measurement [%]."""
    errors = [abs(p[key] / p["measured"] - 1) for p in points if p["channel"].endswith("_n")]
    return 100 * sum(errors) / len(errors)


def heights(points, key):
    errors = [1e3 * (p[key] - p["measured"]) for p in points if p["channel"].endswith("position_z_m")]
    return (sum(e * e for e in errors) / len(errors)) ** 0.5


def text(train, test, estimate, groups="window"):
    return ("experiments:\n" +
            "".join(f"  - {{name: t{t}, experiment: ../{t}.yaml, data: ../{t}.csv, "
                    f"forward: load_cases, use: {use}}}\n" for t, use in ((train, "train"), (test, "test"))) +
            "estimate:\n" + "".join(f"  - {e}\n" for e in estimate) +
            f"residuals:\n  - {{channel: \"*_n\", sd: 25, relative_sd: 0.01}}\n"
            f"  - {{channel: \"node/*/position_z_m\", sd: 0.001}}\ngroups: {groups}\nsearch: {{iterations: 30}}\n"
            "carried: [{name: top, bodies: [n3, n4, n5]}]\n")


def page(taut):
    started = time.monotonic()
    folder = taut.folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    for test in TESTS:
        prepare(folder, test)
    share = "{parameter: share, low: 0.5, high: 1.2, scale: 0.05}"
    one = fits.run(taut, "share", text("6a", "6b", [share]), "--profile", "share")
    more = fits.run(taut, "lengths", text("6a", "6b", [
        share, "{parameter: strut_area_m2, scale: 2e-5}", "{parameter: cable_area_m2, scale: 2.5e-6}",
        "{parameter: lengthening_m, scale: 0.0001, experiments: [t6a]}"], "experiment"))
    strut = [p for p in one.points("train") if p["channel"] == "joint/S1/axial_n"][-1]
    rows = [["untuned", *(f"{forces(one.points(w), 'untuned'):.2f}" for w in ("train", "test")),
             *(f"{heights(one.points(w), 'untuned'):.2f}" for w in ("train", "test")), ""]]
    for name, fit in (("share of the load that arrives", one), ("share, areas, lengthening of the struts", more)):
        rows.append([name, *(f"{forces(fit.points(w), 'fitted'):.2f}" for w in ("train", "test")),
                     *(f"{heights(fit.points(w), 'fitted'):.2f}" for w in ("train", "test")),
                     "; ".join(fit.judgements()) or "good"])
    p = one.parameters["share"]
    return fill(TEMPLATE.read_text(), {
        "version": taut("--version").split()[-1], "seconds": f"{time.monotonic() - started:.0f}",
        "machine": machine(), "strut": f"{-strut['untuned'] / 1e3:.4f}",
        "table": table(["fitted to 6a", "forces 6a [%]", "forces 6b [%]", "heights 6a [mm]", "heights 6b [mm]",
                        "fit"], rows),
        "share": f"{p['value']:.4f}", "error": f"{max(p['se'], p['se_jackknife'] or 0):.4f}", "verdict": p["verdict"],
        "carried": table(["test", "least", "most", "mean"],
                         [[c["experiment"][1:], *(f"{x:.3f}" for x in (min(carried(c)), max(carried(c)),
                                                                       sum(carried(c)) / len(carried(c))))]
                          for c in one.summary["carried"]]),
        "says": "; ".join(c["sentence"] for c in one.summary["carried"]),
        "sentence": one.summary["sentences"][0],
    })
