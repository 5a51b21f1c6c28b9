"""Results of the module in C++ as tables, dicts and arrays with names."""

import json
import numbers
from typing import Any, Callable, Mapping, Optional, Sequence, Union

import numpy as np
import numpy.typing as npt

from taut import _core
from taut._core import Experiment, Fitted, Study

Objective = Union[str, Mapping[str, Any]]
World = Mapping[str, Any]


def _plain(thing):
    """What json does not know: numbers and arrays of numpy's."""
    if hasattr(thing, "tolist"):
        return thing.tolist()
    raise TypeError(f"objective: {thing!r} is no number, text, list or dict")


def _world(number: int, world: World):
    if not isinstance(world, Mapping):
        raise ValueError(f"worlds[{number}]: {world!r}; a dict of numbers by name, {{\"seed\": 3}}")
    seed, values = None, []
    for name, value in world.items():
        if not isinstance(value, numbers.Real) or isinstance(value, bool):
            raise ValueError(f"worlds[{number}][{name!r}]: {value!r}; a number")
        if name == "seed":
            if not isinstance(value, numbers.Integral) or not 0 <= int(value) < 2**64:
                raise ValueError(f"worlds[{number}][{name!r}]: {value!r}; expected a whole number, 0 to 2**64 - 1")
            seed = int(value)
        else:
            values.append((name, float(value)))
    return seed, values


def rollout(experiment: Experiment, objective: Objective, worlds: Union[int, Sequence[World]], *, threads: int = 1,
            simd: Optional[str] = None, progress: Optional[Callable[[int, int], object]] = None) -> npt.NDArray[np.void]:
    """Variants of an experiment, side by side and scored along the way, without traces.

        taut.rollout(experiment, {"measure": "heading", "direction": [1, 0, 0], "from_s": 2},
                     [{"model.friction": 0.5}, {"model.friction": 1.5, "seed": 7}])

    `objective`: what a study has under its key of that name (docs/formats/study.md), as a dict, or a measure alone:
    "distance". `worlds`: a dict each of numbers by the names that `taut.tunables` lists, and of the "seed"; what is
    not there is as in the experiment. A number n: n worlds, whose seeds are the experiment's, that plus 1, ...

    A structured array (worlds,): `score` (more is better; NaN: it failed), `failed` (why; else empty), `distance_m`,
    `along_m`, `energy_j`, `max_tension_n`, `tracking_n`, `fell_s` (NaN: it did not), `state_hash`. A world goes
    through the bits that `taut.run` of it alone goes through. `threads`: 0 is one a core.
    `progress(done, worlds)` is called a few times a second. Other Python threads go on meanwhile; Ctrl-C ends it.
    Raises `taut.InputError` with all that is wrong with objective and worlds.
    """
    if isinstance(objective, str):
        objective = {"measure": objective}
    if isinstance(worlds, (int, np.integer)):
        if worlds < 0:
            raise ValueError(f"worlds: {worlds}; 0 or more")
        worlds = [{"seed": (experiment.seed + i) % 2**64} for i in range(worlds)]
    given = [_world(number, world) for number, world in enumerate(worlds)]
    columns = _core.rollout(experiment, json.dumps(dict(objective), default=_plain), given, threads, simd, progress)
    widest = max([1, *(len(why) for why in columns["failed"])])
    kinds = {"failed": f"U{widest}", "state_hash": "u8"}
    rows = np.zeros(len(given), [(name, kinds.get(name, "f8")) for name in columns])
    for name, column in columns.items():
        rows[name] = column
    return rows


def tunables(experiment: Experiment) -> npt.NDArray[np.void]:
    """All numbers of an experiment that worlds of `taut.rollout` and studies may differ in: a structured array of
    `name`, `unit`, `value`, `least`, `greatest`, as `taut learn --parameters` lists them."""
    found = _core.tunables(experiment)
    name, unit = (max([1, *map(len, column)]) for column in ([one[0] for one in found], [one[1] for one in found]))
    return np.array(found, [("name", f"U{name}"), ("unit", f"U{unit}"), ("value", "f8"), ("least", "f8"),
                            ("greatest", "f8")])


def study_to_pandas(study: Study) -> Any:
    """A pandas.DataFrame: a row an evaluation, a column a parameter, `score` and `failed` at the end; `attrs` has
    the parameters' units."""
    import pandas

    frame = pandas.DataFrame(study.values, columns=study.parameters)
    frame["score"], frame["failed"] = study.scores, study.failed
    frame.index.name = "evaluation"
    frame.attrs["units"] = study.units
    return frame


def fit_data(fitted: Fitted) -> dict[str, Any]:
    """All there is to say as `taut fit` writes it into summary.json: `judgement`, `sentences`, `parameters` with
    their verdicts, `chi2`, `correlation`, `points` ... (docs/fit.md)."""
    return json.loads(fitted.json)


def fit_to_pandas(fitted: Fitted) -> Any:
    """A pandas.DataFrame of what was compared: a row a datum, with `experiment`, `channel`, `where`, `time_s`,
    `measured`, `sd`, `untuned`, `fitted`, and `held_out`."""
    import pandas

    points = fit_data(fitted)["points"]
    frames = [pandas.DataFrame(points[kind]).assign(held_out=kind == "test") for kind in ("train", "test") if points[kind]]
    return pandas.concat(frames, ignore_index=True) if frames else pandas.DataFrame()
