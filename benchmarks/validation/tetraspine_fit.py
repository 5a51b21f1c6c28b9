"""Tetraspine3's six maxima: their information about a model, and experiments that would yield more."""

import pathlib
import re
import time

from validation import fits
from validation.push import machine
from validation.runs import ROOT, fill, replaced, table

TEMPLATE = pathlib.Path(__file__).with_suffix(".md.in")
CABLES = ("inner_top_1", "inner_left_1", "inner_right_1", "outer_top_1", "outer_left_1", "outer_right_1")
SET_POINTS = {"inner, top": "it", "inner, left": "il", "inner, right": "ir", "outer, top": "ot", "outer, left": "ol",
              "outer, right": "or"}
PRIORS = {"push_n": 3, "yaw_rad": 0.09, "pitch_rad": 0.09, "shared": 0.15, "hold_yaw_rad": 0.09, "ground_friction": 0.5,
          **{f"longer_{k}_m": 0.003 for k in SET_POINTS.values()}, "mass_0": 0.03, "mass_1": 0.03, "mass_2": 0.03,
          "inner": 0.05, "outer": 0.05, "spacing_m": 0.003, "edge_m": 0.003}
FIRST = ("push_n", "yaw_rad", "ground_friction")   # parameters to which the maxima are most sensitive


def experiment(folder):
    """Writes the push test with every uncertain quantity as a parameter."""
    text = (ROOT / "share/experiments" / "push_20n.yaml").read_text()
    text = replaced(text, "../models/", fits.beside(folder, "share/models") + "/")
    text = replaced(text, "  ground_friction: 0.5\n", "  ground_friction: 0.5\n" + "".join(
        f"  {name}: {default}\n" for name, default in
        [("yaw_rad", 0), ("pitch_rad", 0), ("shared", 0.45), ("hold_yaw_rad", 0), ("rise_s", 5),
         *((f"longer_{k}_m", 0) for k in SET_POINTS.values()), ("mass_0", 1), ("mass_1", 1), ("mass_2", 1),
         ("inner", 1), ("outer", 1)]))
    for tags, short in SET_POINTS.items():
        text, count = re.subn(rf"(\[{tags}, first\], tension_n: \d+, length_m: [\d.]+)", rf"\1 + longer_{short}_m", text)
        assert count == 1, tags
    ahead, back = "[cos(yaw_rad) * cos(pitch_rad), sin(yaw_rad) * cos(pitch_rad), sin(pitch_rad)]", \
        "[-cos(hold_yaw_rad), -sin(hold_yaw_rad), 0]"
    text = replaced(replaced(text, "direction: [1, 0, 0]", f"direction: {ahead}"), "direction: [-1, 0, 0]",
                    f"direction: {back}")
    text = replaced(replaced(text, "0.45 * push_n", "shared * push_n"), "0.55 * push_n", "(1 - shared) * push_n")
    text = replaced(text, "force_n: [[30, 0]", "force_n: [[35 - rise_s, 0]")
    text += ("scale:\n" + "".join(f"  - {{mass: mass_{i}, bodies: segment_{i}}}\n" for i in range(3)) +
             "  - {stiffness: inner, cables: inner}\n  - {stiffness: outer, cables: outer}\n")
    # Measurements by the robot's load cells only; results of another simulator are not measurements.
    text = re.sub(r"  - source: NTRT(?:.*\n)(?:    .*\n)*", "", text)
    (folder / "push.yaml").write_text(text)


def estimates(names):
    low = {"push_n": "low: 2, ", "ground_friction": "low: 0.02, ", "rise_s": "low: 0.02, "}
    return "".join(f"  - {{parameter: {n}, {low.get(n, '')}prior: {{sd: {PRIORS[n]}}}}}\n" for n in names)


def text(names, search, design="", set_=""):
    return (f"experiments: [{{name: push, experiment: ../push.yaml{set_}}}]\nestimate:\n{estimates(names)}"
            f"residuals: [{{reference: maxima, sd: 0.5}}]\ngroups: channel\nsearch: {search}\n{design}")


def phases(channels, sd):
    return "".join(f"      - {{channel: \"{c}\", sd: {sd}, window: {{phase: {p}}}}}\n"
                   for c in channels for p in ("before", "during", "after"))


DESIGN = ("design:\n  - name: cable_means\n    residuals:\n" + phases(["cable/*/tension_n"], 0.2) +
          "  - name: segments\n    residuals:\n" + phases([f"body/segment_*/position_{k}_m" for k in "xyz"], 0.001) +
          "  - name: means_and_segments\n    residuals:\n" + phases(["cable/*/tension_n"], 0.2) +
          phases([f"body/segment_*/position_{k}_m" for k in "xyz"], 0.001))


def off(fit, key):
    """Returns the mean error of the maxima [%]."""
    points = fit.points("train")
    return 100 * sum(abs(p[key] / p["measured"] - 1) for p in points) / len(points)


def page(taut):
    started = time.monotonic()
    folder = taut.folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    experiment(folder)
    push = fits.run(taut, "push", text(FIRST[:1], "{step: 0.25, iterations: 12}"))
    few = fits.run(taut, "few", text(FIRST, "{step: 0.25, iterations: 12}"))
    fast = fits.run(taut, "fast", text(FIRST[:1], "{step: 0.25, iterations: 1}", set_=", set: {rise_s: 0.1}"))
    everything = fits.run(taut, "all", text(PRIORS, "{step: 0.25, iterations: 6}", DESIGN), "--design")
    rows = [["untuned", "-", f"{off(push, 'untuned'):.1f}", "-", "-"]]
    for name, fit in (("push", push), ("push, yaw, friction", few), ("all parameters", everything)):
        p = fit.parameters["push_n"]
        chi2 = fit.summary["chi2"]["total"]
        rows.append([name, f"{p['value']:.1f} ({p['pull']:.1f} sd)", f"{off(fit, 'fitted'):.1f}",
                     f"{chi2['value']:.0f} for {chi2['freedom']:.0f}", "; ".join(fit.judgements()) or "good"])
    told = everything.summary["design"]
    left = {p["where"] + p["channel"]: p for p in fast.points("train")}
    slow = {p["where"] + p["channel"]: p for p in push.points("train")}
    outer = next(k for k in left if "outer_left_1" in k)
    return fill(TEMPLATE.read_text(), {
        "version": taut("--version").split()[-1], "seconds": f"{time.monotonic() - started:.0f}",
        "machine": machine(), "fits": table(["fitted", "push [N]", "mean error [%]", "chi-square", "fit"], rows),
        "numbers": str(len(PRIORS)),
        "measured": f"{left[outer]['measured']:.2f}", "slow": f"{slow[outer]['untuned']:.2f}",
        "fast": f"{left[outer]['untuned']:.2f}",
        "verdicts": table(["parameter", "prior mean", "prior standard deviation", "estimate", "verdict"],
                          [[f"`{n}`", f"{p['start']:.4g}", f"{p['prior_sd']:.3g}", f"{p['value']:.4g}", p["verdict"]]
                           for n, p in everything.parameters.items()]),
        "sentences": "\n".join(f"> {s}" for s in everything.summary["sentences"][:3]),
        "design": table(["measurements", "combinations determined"],
                        [["the six maxima", str(told["now"]["fixed"])],
                         *([f"and {w['name'].replace('_', ' ')}", str(w["fixed"])] for w in told["alone"])]),
    })
