"""taut: tensegrity robots, simulated.

    import taut
    ran = taut.run(taut.load("experiments/push_20n.yaml"))
    print(ran.trace["cable/outer_top_1/tension_n"].max())

SI units everywhere; the unit is at the end of a name. Frame W: z upwards. Arrays of many worlds have
the shape (worlds, ...).
"""

import enum as _enum

try:
    from taut import _core
except ImportError as error:
    raise ImportError(f"{error}\nIf taut is not built yet: script/build release taut_python") from None
from taut import _tables
from taut._core import Batch, Experiment, Robot, Run, Trace, load, read_trace, run
from taut._errors import Complaint, InputError, InputWarning

Status = _enum.IntFlag("Status", _core.status_bits)  # type: ignore[misc]
Status.__doc__ = "What a world has to say for itself; 0 is good."

__version__ = _core.version
__all__ = ["Batch", "Complaint", "Experiment", "InputError", "InputWarning", "Robot", "Run", "Status", "Trace",
           "load", "read_trace", "run"]

Trace.to_pandas = _tables.to_pandas
Trace.to_xarray = _tables.to_xarray
for _public in (Batch, Experiment, Robot, Run, Trace):
    _public.__module__ = "taut"
del _public
