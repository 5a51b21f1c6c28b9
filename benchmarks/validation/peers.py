"""Comparison of taut with MuJoCo, Bullet and ODE on the ground."""

import json
import math
import pathlib
import subprocess

from validation.runs import Problem, fill, table

TEMPLATE = pathlib.Path(__file__).with_suffix(".md.in")
NAMES = {
    "taut/default": "taut",
    "mujoco/euler_pyramidal": "MuJoCo, pyramidal cones",
    "mujoco/euler_elliptic": "MuJoCo, elliptic cones",
    "bullet/iterations_10": "Bullet, 10 iterations",
    "bullet/iterations_50": "Bullet, 50 iterations",
    "bullet/two_directions": "Bullet, 10 iterations, two friction directions",
    "ode/quick_10": "ODE, quick step, 10 iterations",
    "ode/full_step": "ODE, full step",
}


def report(taut):
    program = taut.command.parent / "tests/peers_report"
    try:
        run = subprocess.run([program], capture_output=True, text=True)
    except OSError as error:
        raise Problem(f"{program}: {error.strerror}; script/build makes it") from error
    if run.returncode != 0:
        raise Problem(f"{program}: {run.stderr}".rstrip())
    found = json.loads(run.stdout)
    missing = [engine for engine, version in found["versions"].items() if version == "not built in"]
    if missing:
        raise Problem(f"{', '.join(missing)} not built in: script/setup, then script/build")
    return found


def rows_of(by_engine, cells):
    return [[name, *cells(by_engine[key])] for key, name in NAMES.items()]


def speed(metres_per_second):
    """Formats a creeping speed; values below a nanometer per second are the engines' round-off."""
    return "< 1e-9" if metres_per_second < 1e-9 else f"{metres_per_second:.1e}"


def tensions(found):
    ours = found["stand"]["tetraspine3"]["taut/default"]["tensions_n"]
    cables = found["cables"]["tetraspine3"]
    rows = [[cable, *(f"{found['stand']['tetraspine3'][key]['tensions_n'][i]:.2f}" for key in NAMES)]
            for i, cable in enumerate(cables)]
    worst = [max(abs(a - b) for a, b in zip(found["stand"]["tetraspine3"][key]["tensions_n"], ours)) for key in NAMES]
    rows.append(["largest difference", *("" if key == "taut/default" else f"{d:.2f}" for key, d in zip(NAMES, worst))])
    return table(["cable", *NAMES.values()], rows)


def stand(found, robot):
    def cells(run):
        force = run["tensions_n"]
        return [f"{run['height_m']:.4f}", str(run["contacts"]), f"{sum(force):.1f}", f"{min(force):.2f}",
                f"{max(force):.2f}", speed(run["creep_m_per_s"])]
    return table(["engine", "height of the center [m]", "contacts", "sum of tensions [N]", "smallest tension [N]", "largest tension [N]",
                  "speed of the center [m/s]"], rows_of(found["stand"][robot], cells))


def by_heading(series, cell):
    headings = sorted(series, key=int)
    rows = [[name, *(cell(series[heading][key]) for heading in headings)] for key, name in NAMES.items()]
    return table(["engine", *(f"{heading} degrees" for heading in headings)], rows)


def page(taut):
    found = report(taut)
    distance = 1 / (2 * 0.5 * 9.81)
    values = {
        **found["versions"],
        "tensions": tensions(found), "stand3": stand(found, "tetraspine3"), "stand6": stand(found, "six_strut"),
        "slope": by_heading(found["slope"], speed),
        "slide": by_heading(found["slide"], lambda way: f"{way:.4f} ({100 * (way / distance - 1):+.1f} %)"),
        "distance": f"{distance:.4f}", "diagonal": f"{math.sqrt(2):.3f}",
    }
    return fill(TEMPLATE.read_text(), values)
