/// What the parts of the Python module share.
#pragma once

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gil.h"
#include "taut/batch.h"
#include "taut/diagnostics.h"
#include "taut/matrix.h"
#include "taut/spec.h"

namespace taut::python {

namespace py = pybind11;

/// Fills `module` with its part. One a file.
void AddDescriptions(py::module_& module);
void AddBatch(py::module_& module);
void AddRuns(py::module_& module);
void AddEnvironments(py::module_& module);
void AddRollouts(py::module_& module);
void AddStudies(py::module_& module);
void AddFits(py::module_& module);
void AddAnalyses(py::module_& module);
void AddLinear(py::module_& module);

/// The folder of the files that come with taut, if there is one.
std::optional<std::string> DataFolder();
/// A path to an input file, looked up in that folder if it is not in the current one (`FindInput`).
std::string InputPath(const std::string& path);

/// Raises `taut.InputError` with all that is wrong, if anything is; tells warnings by
/// `warnings.warn` as `taut.InputWarning`. The GIL must be held.
void Tell(const Diagnostics& said);

/// Raises `taut.InputError` in any case.
[[noreturn]] void Refuse(const Diagnostics& said);

/// Python's keyword arguments as overrides: `edge_m=0.3`, `tau="2 * pi"`.
Overrides OverridesOf(const py::kwargs& values);

/// An instruction set by its name, nothing for None; else ValueError.
std::optional<Simd> SimdOf(const std::optional<std::string>& name);

/// `value`; ValueError, which names `what`, unless it is a positive number.
inline double Positive(double value, const char* what) {
  if (!(value > 0) || !std::isfinite(value)) {
    throw py::value_error(fmt::format("{}: {}; expected a positive number", what, value));
  }
  return value;
}

/// A seed: a whole number, no bool, below 2^64; else ValueError.
std::uint64_t Seed(const py::object& given);

/// A number of threads: 0 (one a core) to 1024, as `--threads` of the command; else ValueError.
int Threads(py::ssize_t threads);

/// An index that is less than `count`, those below 0 counted from the end; else IndexError, which
/// names `what`.
int Index(py::ssize_t index, int count, const char* what);

using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// "(3, 4)".
std::string ShapeText(const std::vector<py::ssize_t>& shape);

/// `given` if it is an array of exactly this shape; else ValueError, which names both. `what` is
/// what the caller calls it.
Array Shaped(const py::object& given, const std::vector<py::ssize_t>& shape, const char* what);

/// The same, of finite numbers; else ValueError, which names the first that is not.
Array Finite(const py::object& given, const std::vector<py::ssize_t>& shape, const char* what);

/// ValueError, which names what is there and what is expected, unless `given` is an array of
/// exactly this kind and shape, contiguous, and writeable if it is to be `written`. `what` is what
/// the caller calls it.
void CheckArray(const py::object& given, const py::dtype& kind,
                const std::vector<py::ssize_t>& shape, const char* what, bool written);

template <class T>
using Rows = py::array_t<T, py::array::c_style>;

/// `given` as it is, if it is as `CheckArray` asks.
template <class T>
Rows<T> Exactly(const py::object& given, const std::vector<py::ssize_t>& shape, const char* what,
                bool written) {
  CheckArray(given, py::dtype::of<T>(), shape, what, written);
  return py::reinterpret_borrow<Rows<T>>(given);
}

/// `out`, exactly a float64 array of this shape that can be written; a new one if it is None.
inline Rows<double> Output(const py::object& out, const std::vector<py::ssize_t>& shape) {
  return out.is_none() ? Rows<double>(shape) : Exactly<double>(out, shape, "out", true);
}

inline void Put(const Vec3& v, double* to) { to[0] = v.x, to[1] = v.y, to[2] = v.z; }

/// A new array (count,).
inline Rows<double> ArrayOf(const std::vector<double>& numbers) {
  return Rows<double>(static_cast<py::ssize_t>(numbers.size()), numbers.data());
}
/// A new array (count, 3).
inline Rows<double> ArrayOf(const std::vector<Vec3>& vectors) {
  Rows<double> a({static_cast<py::ssize_t>(vectors.size()), py::ssize_t{3}});
  double* to = a.mutable_data();
  for (const Vec3& v : vectors) Put(v, to), to += 3;
  return a;
}
/// A new array (rows, columns).
inline Rows<double> ArrayOf(const Matrix& m) {
  return Rows<double>({m.rows, m.columns}, m.values.data());
}

/// A dict of arrays, as `Batch.contacts` gives it.
py::dict ContactsOf(const std::vector<ContactState>& touching);

/// Of things that have names, in their order.
template <class List>
std::vector<std::string> NamesOf(const List& list) {
  std::vector<std::string> names;
  for (const auto& one : list) names.push_back(one.name);
  return names;
}

}  // namespace taut::python
