"""`taut.Simulation`: steps an experiment with its controllers and events from Python."""

import os
from typing import Any, Optional, Sequence, Union

from taut import _core, _live
from taut._core import Experiment, Robot
from taut._results import World, _world


class Simulation(_core.Simulation):
    """An experiment with its start, controllers, sensors and events, in one or many worlds.

        sim = taut.Simulation("experiments/push_20n.yaml")
        sim.run_until(1.0)
        print(sim.tension_n("outer_right_1"))

    `experiment`: an `Experiment`, a `Robot`, or the path of an experiment or model file. `worlds`: number of equal
    worlds. `variants`: instead of `worlds`, a list with one dict per world: values of parameters by name
    (`taut.tunables`), and optionally a "seed". `threads`: number of threads; 0: one per core. `simd`: as in
    `taut.Batch`.

    `controllers`: list of controllers that act after those of the experiment. Each is a controller of the
    library (`taut.control`), or an object like the following one, which requires `threads=1`:

        class Hold:
            period_s = 0.01
            def act(self, seen, commands):
                commands.rest_length_m[:] = seen.cable_length_m - 0.02

    `act` is called every `period_s`, with the n worlds whose tick is due. `seen` has arrays of shape (n,): `world`,
    `tick` (number of earlier ticks since the start) and `time_s`. It also has the readings of the experiment's sensors,
    of shape (n, cables): `cable_length_m`, `cable_rate_m_per_s`, `rest_length_m`, `tension_n`, `elastic_n`,
    `stiffness_n_per_m`. `commands` has `rest_length_m`, `set_point_n`, `velocity_input_m_per_s` and `signal`, of shape
    (n, cables); change these arrays in place.

    If your program changes nothing, each world is bit-identical to `taut.run`, independent of the other worlds,
    the number of threads and the instruction set.

    Several Python threads may use one simulation: calls wait for each other, so `act` must not
    wait for a thread that uses this simulation. An exception in `act` ends the call (`step`, `run_until`) after the
    present step. If a controller needs a reference to its simulation, use `weakref`; otherwise neither is freed. Raises
    `taut.InputError` if a start cannot be found.
    """

    def __init__(self, experiment: Union[str, "os.PathLike[str]", Experiment, Robot], worlds: int = 1, *,
                 variants: Optional[Sequence[World]] = None, threads: int = 1, simd: Optional[str] = None,
                 controllers: Optional[Sequence[Any]] = None) -> None:
        if not isinstance(experiment, (str, os.PathLike, Experiment, Robot)):
            raise TypeError(f"experiment: {experiment!r}; expected an Experiment, a Robot or the path of an experiment or model file")
        what = _core.load(os.fspath(experiment)) if isinstance(experiment, (str, os.PathLike)) else experiment
        given = None if variants is None else [_world(number, one, "variants") for number, one in enumerate(variants)]
        if given is not None and not given:
            raise ValueError("variants: empty; expected at least one dict")
        if given is not None and worlds not in (1, len(given)):
            raise ValueError(f"worlds: {worlds}, but there are {len(given)} variants; pass either `worlds` or `variants`")
        super().__init__(what, worlds, given, threads, simd, controllers)

    show = _live.show_simulation

    def __repr__(self) -> str:
        return f"<taut.Simulation: {self.worlds} world{'s' if self.worlds != 1 else ''}, {self.time_s().min():g} s>"
