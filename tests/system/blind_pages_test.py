"""Sample of the fits of script/validate against hidden true values (docs/validation)

Usage: blind_pages_test.py TEST TAUT. TEST is the name of a function of this file.
"""

import os
import pathlib
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path[:0] = [str(ROOT / "script"), str(ROOT / "benchmarks")]
sys.dont_write_bytecode = True
from validation import blind, drag_friction, runs, twin, virtual_robot_fit  # noqa: E402

FAR = 4  # standard errors: once in 16 000 by chance


def near(fit, truth, wanted):
    """Checks that the fit reports these parameters as estimated, close to their true values."""
    for name in wanted:
        p = fit.parameters[name]
        assert p["verdict"] == "estimated" and abs(blind.off(p, truth[name])) < FAR, (p, truth[name])


def ATwinIsFoundAndItsAliasNamed(taut):
    one = twin.Twin(taut, 0)
    fit = one.fit()
    assert not fit.judgements() and fit.status == 0, fit.judgements()
    near(fit, one.truth, one.truth)
    # The test is meaningful only if the model's start values were wrong.
    for name in ("stiffness_n_per_m", "ground_friction"):
        p = fit.parameters[name]
        assert abs(p["start"] - one.truth[name]) > 5 * blind.error_of(p), p
    alias = one.fit("alias", [twin.ALIAS])
    assert twin.alias_is_named(alias) and alias.status == 1, alias.summary["sentences"]


def AGroundIsFoundFromADrag(taut):
    ground = drag_friction.Ground(taut, "rough", ("second",))
    fit = ground.fit()
    assert not fit.summary["rejected"], fit.summary["chi2"]
    near(fit, ground.truth, ["ground_sliding", "velocity_m_per_s second"])
    rest, error = drag_friction.at_rest(fit)
    truth = ground.truth["ground_sliding"] * (1 + ground.truth["extra"])
    assert abs(rest - truth) < FAR * error < 0.5 * truth, (rest, error, truth)


def AMotorsLogTellsItsSpringCellAndFriction(taut):
    stand = virtual_robot_fit.Stand(taut, range(2), duties=("most",))
    fit, truth = stand.fit(0), stand.truth(0)
    assert not fit.summary["rejected"], fit.summary["chi2"]
    near(fit, truth, [name for name in truth if not name.startswith("slack")])
    for name, share in (("stiffness_n_per_m_0", 0.005), ("friction_n_m_0", 0.1), ("efficiency_0", 0.02),
                        ("gain cable/cable_0/tension_n", 0.002)):
        assert abs(fit.parameters[name]["value"] / truth[name] - 1) < share, (fit.parameters[name], truth[name])
    zero_n = "offset cable/cable_0/tension_n"  # an eighth of a count is 0.02 N
    assert abs(fit.parameters[zero_n]["value"] - truth[zero_n]) < 0.012, (fit.parameters[zero_n], truth[zero_n])


if __name__ == "__main__":
    command = pathlib.Path(sys.argv[2]).resolve()
    os.chdir(ROOT)
    with tempfile.TemporaryDirectory(dir=ROOT / "build") as folder:
        globals()[sys.argv[1]](runs.Taut(command, pathlib.Path(folder)))
