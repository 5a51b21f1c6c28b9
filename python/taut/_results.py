"""Results of the C++ module as tables, dicts and structured arrays."""

from __future__ import annotations

import json
import numbers
from typing import TYPE_CHECKING, Any, Callable, Mapping, Optional, Sequence, Union

import numpy as np

if TYPE_CHECKING:  # numpy.typing is younger than numpy 1.19
    import numpy.typing as npt

from taut import _core
from taut._core import Experiment, Fitted, Study

Objective = Union[str, Mapping[str, Any]]
World = Mapping[str, Any]


def _plain(thing):
    """Converts NumPy numbers and arrays for json."""
    if hasattr(thing, "tolist"):
        return thing.tolist()
    raise TypeError(f"objective: {thing!r}; expected a number, text, list or dict")


def _world(number: int, world: World, what: str = "worlds"):
    if not isinstance(world, Mapping):
        raise ValueError(f"{what}[{number}]: {world!r}; expected a dict of numbers by name, {{\"seed\": 3}}")
    seed, values = None, []
    for name, value in world.items():
        if not isinstance(value, numbers.Real) or isinstance(value, bool):
            raise ValueError(f"{what}[{number}][{name!r}]: {value!r}; expected a number")
        if name == "seed":
            if not isinstance(value, numbers.Integral) or not 0 <= int(value) < 2**64:
                raise ValueError(f"{what}[{number}][{name!r}]: {value!r}; expected a whole number, 0 to 2**64 - 1")
            seed = int(value)
        else:
            values.append((name, float(value)))
    return seed, values


def rollout(experiment: Experiment, objective: Objective, worlds: Union[int, Sequence[World]], *, threads: int = 1,
            simd: Optional[str] = None, progress: Optional[Callable[[int, int], object]] = None) -> npt.NDArray[np.void]:
    """Runs variants of an experiment in parallel and scores them, without traces.

        taut.rollout(experiment, {"measure": "heading", "direction": [1, 0, 0], "from_s": 2},
                     [{"model.friction": 0.5}, {"model.friction": 1.5, "seed": 7}])

    `objective`: dict with the keys of a study's objective (docs/formats/study.md), or the name of a measure:
    "distance". `worlds`: one dict per world, with values of parameters by name (listed by `taut.tunables`) and
    optionally its "seed"; other parameters keep the experiment's values. A number n creates n worlds with the
    experiment's seed, seed + 1, ... `threads`: number of threads; 0: one per core. `progress(done, worlds)` is called
    a few times per second.

    Returns a structured array (worlds,): `score` (more is better; NaN: the world failed), `failed` (reason, or empty),
    `distance_m`, `along_m`, `energy_j`, `max_tension_n`, `tracking_n`, `fell_s` (NaN: no fall), `state_hash`. Each
    world is bit-identical to `taut.run` of the same variant. Other Python threads run meanwhile; Ctrl-C ends the call.
    Raises one `taut.InputError` for all errors in objective and worlds.
    """
    if isinstance(objective, str):
        objective = {"measure": objective}
    if not isinstance(objective, Mapping):
        raise TypeError(f"objective: {objective!r}; expected a dict or the name of a measure")
    if isinstance(worlds, (int, np.integer)):
        if worlds < 0:
            raise ValueError(f"worlds: {worlds}; expected 0 or more")
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
    """Returns all parameters of an experiment that worlds of `taut.rollout` and studies may vary: a structured array
    of `name`, `unit`, `value`, `least`, `greatest`, as listed by `taut learn --parameters`."""
    found = _core.tunables(experiment)
    name, unit = (max([1, *map(len, column)]) for column in ([one[0] for one in found], [one[1] for one in found]))
    return np.array(found, [("name", f"U{name}"), ("unit", f"U{unit}"), ("value", "f8"), ("least", "f8"),
                            ("greatest", "f8")])


def study_to_pandas(study: Study) -> Any:
    """Returns a pandas.DataFrame with one row per evaluation and one column per parameter, followed by `score` and
    `failed`; `attrs` contains the parameters' units."""
    import pandas

    frame = pandas.DataFrame(study.values, columns=study.parameters)
    frame["score"], frame["failed"] = study.scores, study.failed
    frame.index.name = "evaluation"
    frame.attrs["units"] = study.units
    return frame


def fit_data(fitted: Fitted) -> dict[str, Any]:
    """All results as a dict, as in the summary.json of `taut fit`: `judgement`, `sentences`, `parameters` with their
    verdicts, `chi2`, `correlation`, `points` ... (docs/fit.md)."""
    return json.loads(fitted.json)


def fit_to_pandas(fitted: Fitted) -> Any:
    """Returns a pandas.DataFrame of the compared data, one row per datum: `experiment`, `channel`, `where`, `time_s`
    [s], `measured`, `sd`, `untuned`, `fitted`, and `held_out`."""
    import pandas

    points = fit_data(fitted)["points"]
    frames = [pandas.DataFrame(points[kind]).assign(held_out=kind == "test") for kind in ("train", "test") if points[kind]]
    return pandas.concat(frames, ignore_index=True) if frames else pandas.DataFrame()
