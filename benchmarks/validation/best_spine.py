"""Two-dimensional spine of the BEST laboratory: information in five tests about its model."""

import itertools
import math
import pathlib
import statistics
import time

from validation import fits
from validation.push import machine
from validation.runs import ROOT, fill, table

TEMPLATE = pathlib.Path(__file__).with_suffix(".md.in")
DATA = ROOT / "tests" / "data" / "best_2d_spine"
TESTS = (0, 2, 4, 6, 8)
AFTER_S = (2.1, 3.4)         # interval after a set point in which its pose is held
UP = (40, 118)               # set points of the upward motion; the record of the last pose is incomplete
X, Z, TURN = "node/v.o/position_x_m", "node/v.o/position_z_m", "body/v/rotation_y_rad"
UNITS = {X: 1e3, Z: 1e3, TURN: 180 / math.pi}   # factors from m, m, rad to mm, mm, degrees
SD = {X: 0.00074, Z: 0.0008, TURN: math.radians(0.62)}  # spread of the five tests
CAMERA = [f"{{channel: {X}, offset: {{sd: 0.002}}}}", f"{{channel: {Z}, offset: {{sd: 0.002}}}}",
          f"{{channel: {TURN}, offset: {{sd: 0.01}}}}"]
CAMERA_PER_TEST = [f"{{channel: {X}, offset: {{sd: 0.002}}, each: experiment}}",
                   f"{{channel: {Z}, offset: {{sd: 0.002}}, each: experiment}}",
                   f"{{channel: {TURN}, offset: {{sd: 0.01}}, each: experiment}}"]
FIRST = 10                   # set points of a held-out test that determine its camera offset
WOUND = "{parameter: wound, prior: {sd: 0.01}}"
MASS = "{parameter: mass_kg, low: 0.3, high: 2, scale: 0.03}"
MASS_PRIOR = "{parameter: mass_kg, prior: {sd: 0.033}}"
POSE = ["{parameter: calibrated_x_m, scale: 0.001}", "{parameter: calibrated_z_m, scale: 0.001}",
        "{parameter: calibrated_rad, scale: 0.01}"]
STIFFNESS = ["{parameter: k12_n_per_m, scale: 42}", "{parameter: k34_n_per_m, scale: 222}"]


class Data:
    """The five tests with taut's names, whole and split into halves of the stroke."""

    def __init__(self, folder):
        self.folder = folder
        commands = fits.rows_of(DATA / "commands.csv", 5)
        heights = [row[8] for row in commands]
        middle = statistics.median(heights[1:UP[1] + 1])
        for test in TESTS:
            poses = fits.rows_of(DATA / f"test{test}_measured_pose.csv", 2)
            rows, last = [], -math.inf
            for time_ms, x_cm, y_cm, turn in poses:
                if time_ms > last:   # skips a camera row that occurs twice
                    rows.append([time_ms * 1e-3, x_cm * 1e-2, y_cm * 1e-2, -math.radians(turn)])
                    last = time_ms
            head = ["time_s", X, Z, TURN]
            sent = [row[0] * 1e-3 for row in fits.rows_of(DATA / f"test{test}_setpoints.csv", 2)]
            fits.write_rows(folder / f"test{test}.csv", head, rows)
            fits.write_rows(folder / f"test{test}_setpoints.csv", ["time_s", "experiment_s"],
                            [[t, 2.0 * (i + 1)] for i, t in enumerate(sent)])
            for half, below in (("lower", True), ("upper", False)):
                spans = [(t + AFTER_S[0], t + AFTER_S[1]) for i, t in enumerate(sent[:UP[1]])
                         if (heights[i + 1] < middle) == below]
                kept = [row for row in rows if any(a <= row[0] <= b for a, b in spans)]
                fits.write_rows(folder / f"test{test}_{half}.csv", head, kept)

    def text(self, estimate, train, test, halves=("", "")):
        """Returns the text of a fit. `train`, `test`: test numbers; `halves`: of the stroke, for each."""
        entries = []
        for use, which, half in (("train", train, halves[0]), ("test", test, halves[1])):
            for number in which:
                entries.append(f"  - {{name: t{number}{half}, experiment: {self._beside('share/experiments/best_2d_spine.yaml')}, "
                               f"data: ../test{number}{half}.csv, setpoints: ../test{number}_setpoints.csv, "
                               f"forward: static, use: {use}}}\n")
        residuals = [f"  - {{channel: {c}, sd: {sd}, window: {{after_setpoint_s: [{AFTER_S[0]}, {AFTER_S[1]}]}}}}\n"
                     for c, sd in SD.items()]
        return ("experiments:\n" + "".join(entries) + "estimate:\n" + "".join(f"  - {e}\n" for e in estimate) +
                "residuals:\n" + "".join(residuals) + "search: {iterations: 40}\n")

    def _beside(self, path):
        return fits.beside(self.folder / "any", path)


def pooled(points, key):
    return [fits.rms(points, channel, key) * scale for channel, scale in UNITS.items()]


def errors(three):
    return [f"{three[0]:.2f}", f"{three[1]:.2f}", f"{three[2]:.2f}"]


def number(point):
    return int(point["where"].split()[-1])


class Repeated:
    """Spread of the measurements in all five tests, and the prediction of two tests by the mean of three."""

    def __init__(self, points):
        self.of = {(p["channel"], number(p), p["experiment"]): p["measured"] for p in points if number(p) <= UP[1]}

    def _tests(self, channel, i):
        return [self.of.get((channel, i, f"t{t}")) for t in TESTS]

    def spread(self, channel):
        rows = [self._tests(channel, i) for i in range(UP[0], UP[1] + 1)]
        return math.sqrt(statistics.mean(statistics.variance(row) for row in rows if None not in row)) * UNITS[channel]

    def floor(self, channel):
        squares = []
        for row in (self._tests(channel, i) for i in range(1, UP[1] + 1)):
            if None in row:
                continue
            for three in itertools.combinations(range(len(TESTS)), 3):
                mean = statistics.mean(row[i] for i in three)
                squares += [(x - mean) ** 2 for i, x in enumerate(row) if i not in three]
        return math.sqrt(statistics.mean(squares)) * UNITS[channel]


class Splits:
    """A model fitted to three tests, evaluated on the other two: all ten combinations."""

    def __init__(self, taut, data, name, estimate):
        points, self.fits = [], []
        for train in itertools.combinations(TESTS, 3):
            test = [t for t in TESTS if t not in train]
            fit = fits.run(taut, f"{name}_{''.join(map(str, train))}", data.text(estimate, train, test))
            points += [p for p in fit.points() if number(p) <= UP[1]]
            self.fits.append(fit)
        self.fitted, self.untuned = pooled(points, "fitted"), pooled(points, "untuned")
        self.poses = points


def offset(points, test, channel, last=None, key="fitted"):
    """Returns the mean of measured minus computed values of a test up to set point `last`."""
    return statistics.mean(p["measured"] - p[key] for p in points if p["experiment"] == test and
                           p["channel"] == channel and (last is None or number(p) <= last))


class CameraPerTest:
    """A camera offset for each test. The offsets of the two held-out tests come from their first set points, from the
    offsets of the three fitted tests, or from both; all other set points are predicted."""

    WAYS = ("untuned", "training", "first", "both", "all")

    def __init__(self, taut, data):
        points = {way: [] for way in self.WAYS}
        self.good = 0
        for train in itertools.combinations(TESTS, 3):
            test = [t for t in TESTS if t not in train]
            fit = fits.run(taut, f"per_test_{''.join(map(str, train))}",
                           data.text(CAMERA_PER_TEST + [WOUND], train, test))
            self.good += not [word for word in fit.judgements() if "held-out" not in word]
            fitted = [p for p in fit.points("train") if number(p) <= UP[1]]
            held = [p for p in fit.points() if number(p) <= UP[1]]
            for channel in UNITS:
                known = [fit.parameters[f"offset {channel} t{t}"]["value"] for t in train]
                # Variance between tests, and of the first set points about the whole test.
                between = statistics.variance(known)
                drift = statistics.mean(offset(fitted, f"t{t}", channel, FIRST) ** 2 for t in train)
                for name in {p["experiment"] for p in held}:
                    first = offset(held, name, channel, FIRST)
                    mean = statistics.mean(known)
                    offsets = {"training": mean, "first": first,
                               "both": mean + between / (between + drift) * (first - mean),
                               "all": offset(held, name, channel)}
                    for p in held:
                        if p["experiment"] != name or p["channel"] != channel or number(p) <= FIRST:
                            continue
                        points["untuned"].append(dict(p, fitted=p["untuned"]))
                        for way, x in offsets.items():
                            points[way].append(dict(p, fitted=p["fitted"] + x))
        self.errors = {way: pooled(points[way], "fitted") for way in self.WAYS}


def value(fit, name):
    p = fit.parameters[name]
    error = max(p["se"] or math.inf, p["se_jackknife"] or 0)
    return f"{p['value']:.4g} +- {error:.2g}" if math.isfinite(error) else f"{p['value']:.4g}"


def verdicts(fit):
    return "<br>".join(f"{name}: {p['verdict']}" for name, p in fit.parameters.items())


def page(taut):
    started = time.monotonic()
    data = Data(taut.folder.resolve())
    camera = Splits(taut, data, "camera", CAMERA + [WOUND])
    one = camera.fits[0]
    per_test = CameraPerTest(taut, data)
    repeated = Repeated(one.points("train") + one.points())
    untuned_up = {}
    for fit in camera.fits:
        for p in fit.points("train") + fit.points():
            if UP[0] <= number(p) <= UP[1]:
                untuned_up[(p["experiment"], p["channel"], p["where"])] = p
    models = {"camera and command scale": CAMERA + [WOUND],
              "camera, command scale and mass": CAMERA + [WOUND, MASS_PRIOR], "the mass alone": [MASS],
              "calibrated pose and stiffness": POSE + STIFFNESS}
    rows, halves = [], {}
    for name, estimate in models.items():
        fit = fits.run(taut, "half_" + name.replace(" ", "_"),
                       data.text(estimate, TESTS, TESTS, ("_lower", "_upper")), *(["--profile", "*"] if name ==
                       "camera and command scale" else []))
        halves[name] = fit
        rows.append([name, *errors(pooled(fit.points(), "fitted")),
                     "; ".join(fit.judgements()) or "good", verdicts(fit)])
    condition = halves["calibrated pose and stiffness"].summary["condition"]
    mass = halves["the mass alone"].parameters["mass_kg"]["value"]
    parameters = [[f"`{name}`", p["unit"], f"{p['start']:.4g}", value(one, name), p["verdict"]]
                  for name, p in one.parameters.items()]
    return fill(TEMPLATE.read_text(), {
        "version": taut("--version").split()[-1],
        "seconds": f"{time.monotonic() - started:.0f}", "machine": machine(),
        "untuned": table(["poses and model", "error in x [mm]", "error in y [mm]", "error in turn [degrees]"], [
            ["upward motion, five tests, untuned", *errors(pooled(list(untuned_up.values()), "untuned"))],
            ["all set points, two held-out tests, untuned", *errors(camera.untuned)],
            ["all set points, two held-out tests, fitted to the other three", *errors(camera.fitted)]]),
        "spread": " / ".join(errors([repeated.spread(c) for c in UNITS])),
        "floor": " / ".join(errors([repeated.floor(c) for c in UNITS])),
        "per_test": table(["offset of the camera in a held-out test", "error in x [mm]", "error in y [mm]",
                           "error in turn [degrees]"],
                          [[name, *errors(per_test.errors[way])] for name, way in (
                              ("none, untuned", "untuned"), ("mean offset of the three fitted tests", "training"),
                              (f"mean of its first {FIRST} set points", "first"),
                              ("both, weighted by their variances", "both"),
                              ("mean of all its set points (not a prediction)", "all"))]),
        "first": str(FIRST), "good": str(per_test.good),
        "parameters": table(["parameter", "unit", "nominal", "estimate", "verdict"], parameters),
        "judgement": "; ".join(one.judgements()) or "good",
        "halves": table(["parameters fitted to the lower half", "error in x [mm]", "error in y [mm]", "error in turn [degrees]",
                         "verdict on the fit", "verdicts on the parameters"], rows),
        "mass": f"{mass / 0.655:.2f}", "condition": f"{condition:.2g}" if condition else "infinite",
    })
