/// What the parts of the Python module share.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "taut/batch.h"
#include "taut/diagnostics.h"
#include "taut/spec.h"

namespace taut::python {

namespace py = pybind11;

/// Fills `module` with its part. One a file.
void AddDescriptions(py::module_& module);
void AddBatch(py::module_& module);
void AddRuns(py::module_& module);
void AddEnvironments(py::module_& module);

/// Raises `taut.InputError` with all that is wrong, if anything is; tells warnings by
/// `warnings.warn` as `taut.InputWarning`. The GIL must be held.
void Tell(const Diagnostics& said);

/// Raises `taut.InputError` in any case.
[[noreturn]] void Refuse(const Diagnostics& said);

/// Python's keyword arguments as overrides: `edge_m=0.3`, `tau="2 * pi"`.
Overrides OverridesOf(const py::kwargs& values);

/// An instruction set by its name, nothing for None; else ValueError.
std::optional<Simd> SimdOf(const std::optional<std::string>& name);

/// An index that is less than `count`, those below 0 counted from the end; else IndexError, which
/// names `what`.
int Index(py::ssize_t index, int count, const char* what);

using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// "(3, 4)".
std::string ShapeText(const std::vector<py::ssize_t>& shape);

/// `given` if it is an array of exactly this shape; else ValueError, which names both. `what` is
/// what the caller calls it.
Array Shaped(const py::object& given, const std::vector<py::ssize_t>& shape, const char* what);

/// `out` if it is given, and float64, contiguous, writeable and of this shape, else ValueError; a
/// new array if it is None.
py::array_t<double> Output(const py::object& out, const std::vector<py::ssize_t>& shape);

}  // namespace taut::python
