"""Simulation of tensegrity robots.

    import taut
    ran = taut.run(taut.load("experiments/push_20n.yaml"))
    print(ran.trace["cable/outer_top_1/tension_n"].max())

SI units throughout; names of quantities end with the unit. World frame W: right-handed, z up. Arrays of many worlds
have the shape (worlds, ...).
"""

import enum as _enum

import numpy as _numpy

try:
    from taut import _core
except ImportError as error:
    import pathlib as _pathlib
    import sys as _sys

    _built = sorted(file.name for file in _pathlib.Path(__file__).parent.glob("_core.*.so"))
    _this = f"this is Python {_sys.version_info.major}.{_sys.version_info.minor} ({_sys.implementation.cache_tag})"
    if _built and not any(f".{_sys.implementation.cache_tag}-" in name for name in _built):
        raise ImportError(f"taut is built for another Python: {', '.join(_built)}; {_this}") from None
    raise ImportError(f"{error}; {_this}\nIf taut is not built yet: script/build release taut_python") from None
if int(_numpy.__version__.split(".")[0]) >= 2 and not _core.supports_numpy_2:
    raise ImportError(f"this build of taut needs NumPy 1, because it was built with a pybind11 before 2.12; this is "
                      f"NumPy {_numpy.__version__} (pip install 'numpy<2')")
from taut import _live, _results, _tables, control
from taut._core import (Analysis, Batch, ControllerSpec, Experiment, Fitted, LinearSystem, Replay, Robot, Rows, Run, Study,
                        Trace, analyze, fit, learn, linear_system, load, read_study, read_trace, run)
from taut._data import data_path
from taut._errors import Complaint, InputError, InputWarning
from taut._live import LiveView
from taut._results import rollout, tunables
from taut._simulation import Simulation
from taut._view import View, view

Status = _enum.IntFlag("Status", _core.status_bits)  # type: ignore[misc]
Status.__doc__ = "Condition bits of a world; 0: no error."

__version__ = _core.version
__all__ = ["Analysis", "Batch", "Complaint", "Experiment", "Fitted", "InputError", "InputWarning", "LinearSystem",
           "ControllerSpec", "LiveView", "Replay", "Robot", "Rows", "Run", "Simulation", "Status", "Study", "Trace", "View",
           "analyze", "control", "data_path", "fit", "learn", "linear_system", "load", "read_study", "read_trace", "rollout",
           "run", "tunables", "view"]

Batch.show = _live.show_batch
Trace.to_pandas = _tables.to_pandas
Trace.to_xarray = _tables.to_xarray
Study.to_pandas = _results.study_to_pandas
Fitted.data = property(_results.fit_data)  # type: ignore[assignment]
Fitted.to_pandas = _results.fit_to_pandas
for _public in (Analysis, Batch, ControllerSpec, Experiment, Fitted, LinearSystem, LiveView, Replay, Robot, Rows, Run,
                Simulation, Study, Trace, View):
    _public.__module__ = "taut"
del _public
