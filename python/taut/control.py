"""Controllers of the library, for `controllers=` of `taut.Simulation` and `taut.run`.

    hold = taut.control.impedance(robot, tension_offset_n=5, length_offset_m=0.2, position_gain_n_per_m=60)
    sim = taut.Simulation(robot, controllers=[hold])

A custom controller is an object with `period_s` and `act(seen, commands)`; see `taut.Simulation`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Mapping, Optional, Sequence, Union

from taut import _core
from taut._core import ControllerSpec, Robot

if TYPE_CHECKING:  # numpy.typing is younger than numpy 1.19
    import numpy.typing as npt

    PerCable = Union[float, npt.ArrayLike]

__all__ = ["ControllerSpec", "impedance", "position"]


def impedance(robot: Robot, cables: Union[str, Sequence[str], None] = None, *, tension_offset_n: PerCable = 0.0,
              length_offset_m: PerCable = 0.0, position_gain_n_per_m: PerCable = 0.0,
              velocity_gain_n_s_per_m: PerCable = 0.0, velocity_offset_m_per_s: PerCable = 0.0,
              period_s: float = 0.001, differenced_rate: bool = False) -> ControllerSpec:
    """Impedance control (Mirletz et al. 2015, eq. 3): tension T0 + K (L - L0) + B (V - V0), at least 0.

    `cables`: one name or several names of controlled cables; None: all cables with an actuator. Each offset or gain is one
    number for all cables, or one per cable. `period_s`: time between two ticks. `differenced_rate`: compute the rate V from the
    difference of two successive lengths, as motor boards do.
    """
    if isinstance(cables, str):
        cables = [cables]
    return _core.impedance(robot, cables, tension_offset_n, length_offset_m, position_gain_n_per_m,
                           velocity_gain_n_s_per_m, velocity_offset_m_per_s, period_s, differenced_rate)


def position(robot: Robot, programs: Mapping[str, Sequence[tuple[float, float]]], *,
             period_s: float = 0.001) -> ControllerSpec:
    """Position control: rest lengths [m] that follow piecewise linear programs in time [s], one per cable.

        taut.control.position(robot, {"outer_top_1": [(0, 0.25), (2, 0.20)]})
    """
    return _core.position(robot, dict(programs), period_s)
