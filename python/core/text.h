/// Conversions and checks common to the parts of the Python module.
#pragma once

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gil.h"
#include "taut/diagnostics.h"
#include "taut/matrix.h"
#include "taut/spec.h"
#include "taut/world_batch.h"

namespace taut::python {

namespace py = pybind11;

/// Each function adds one file's part to `module`.
void AddDescriptions(py::module_& module);
void AddBatch(py::module_& module);
void AddSimulation(py::module_& module);
void AddControllers(py::module_& module);
void AddRuns(py::module_& module);
void AddEnvironments(py::module_& module);
void AddRollouts(py::module_& module);
void AddStudies(py::module_& module);
void AddFits(py::module_& module);
void AddAnalyses(py::module_& module);
void AddLinear(py::module_& module);
void AddLiveViews(py::module_& module);
void AddCommand(py::module_& module);  ///< Only in wheels.

/// Returns the folder of the files that come with taut, if it exists.
std::optional<std::string> DataFolder();
/// Returns the path of an input file of one of `kinds`, given by path, folder or name
/// (`ResolveInput`).
std::string InputPath(const std::string& path, const std::vector<std::string>& kinds,
                      Diagnostics& out);

/// Raises `taut.InputError` with all errors, if there are any; issues warnings by `warnings.warn`
/// as `taut.InputWarning`. The GIL must be held.
void Tell(const Diagnostics& said);

/// Raises `taut.InputError` unconditionally.
[[noreturn]] void Refuse(const Diagnostics& said);

/// Raises TypeError: "progress: 5; expected a function".
[[noreturn]] void Unexpected(const py::handle& given, const std::string& what,
                             const std::string& expected);

/// Raises KeyError for a name that a search did not find. `said`: error of the search.
[[noreturn]] void RefuseName(const Diagnostics& said);

/// Returns a copy of an experiment's robot without `experiment_parts`, so that `Batch` does not
/// warn about ignored controllers and events.
std::shared_ptr<RobotSpec> WithoutExperiment(const RobotSpec& robot);

/// Converts Python's keyword arguments to overrides: `edge_m=0.3`, `tau="2 * pi"`.
Overrides OverridesOf(const py::kwargs& values);

/// Returns the instruction set of a name, nothing for None; raises ValueError otherwise.
std::optional<Simd> SimdOf(const std::optional<std::string>& name);

/// Returns `value`; raises ValueError, which contains `what`, unless it is a positive number.
inline double Positive(double value, const char* what) {
  if (!(value > 0) || !std::isfinite(value)) {
    throw py::value_error(fmt::format("{}: {}; expected a positive number", what, value));
  }
  return value;
}

/// Returns `step_s`; raises ValueError unless it is a step length of experiment files.
double StepLength(double step_s);

/// Returns `given`; raises TypeError, which contains `what`, unless it is None or callable.
py::object CallableOrNone(const py::object& given, const std::string& what);

/// Returns a bool of Python or NumPy; raises TypeError, which contains `what`, for other values.
/// Their truth value is rarely intended: "no" and 0.5 count as true.
bool Flag(const py::handle& given, const std::string& what);

/// Returns a real number; raises TypeError, which contains `what` and `expected`, for other values
/// and for bools.
double Number(const py::handle& given, const std::string& what, const char* expected = "a number");

/// Returns a text; raises TypeError, which contains `what`, for other values.
std::string Text(const py::handle& given, const std::string& what);

/// Returns a seed: an integer, not a bool, from 0 to 2^64 - 1; raises ValueError otherwise.
std::uint64_t Seed(const py::object& given);

/// Returns a number of threads: 0 (one per core) to 1024, as for `--threads` of the command; raises
/// ValueError otherwise.
int Threads(py::ssize_t threads);

/// Returns an index below `count`; negative ones count from the end. Raises IndexError, which
/// contains `what`, otherwise.
int Index(py::ssize_t index, int count, const char* what);

using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// Formats a shape: "(3, 4)".
std::string ShapeText(const std::vector<py::ssize_t>& shape);

/// Returns `given` as an array of exactly this shape; raises ValueError with both shapes otherwise.
/// `what`: the argument's name.
Array Shaped(const py::object& given, const std::vector<py::ssize_t>& shape, const char* what);

/// Same as `Shaped` for finite numbers; the ValueError contains the first other number.
Array Finite(const py::object& given, const std::vector<py::ssize_t>& shape, const char* what);

/// Raises ValueError, with the actual and the expected properties, unless `given` is a contiguous
/// array of exactly this type and shape, and writeable if `written`. `what`: the argument's name.
void CheckArray(const py::object& given, const py::dtype& kind,
                const std::vector<py::ssize_t>& shape, const char* what, bool written);

template <class T>
using Rows = py::array_t<T, py::array::c_style>;

/// Returns `given` itself if it passes `CheckArray`.
template <class T>
Rows<T> Exactly(const py::object& given, const std::vector<py::ssize_t>& shape, const char* what,
                bool written) {
  CheckArray(given, py::dtype::of<T>(), shape, what, written);
  return py::reinterpret_borrow<Rows<T>>(given);
}

/// Returns `out`, which must be a writeable float64 array of exactly this shape; a new array if it
/// is None.
inline Rows<double> Output(const py::object& out, const std::vector<py::ssize_t>& shape) {
  return out.is_none() ? Rows<double>(shape) : Exactly<double>(out, shape, "out", true);
}

inline void Put(const Vec3& v, double* to) { to[0] = v.x, to[1] = v.y, to[2] = v.z; }

/// Returns a new array (count,).
inline Rows<double> ArrayOf(const std::vector<double>& numbers) {
  return Rows<double>(static_cast<py::ssize_t>(numbers.size()), numbers.data());
}
/// Returns a new array (count, 3).
inline Rows<double> ArrayOf(const std::vector<Vec3>& vectors) {
  Rows<double> a({static_cast<py::ssize_t>(vectors.size()), py::ssize_t{3}});
  double* to = a.mutable_data();
  for (const Vec3& v : vectors) Put(v, to), to += 3;
  return a;
}
/// Returns a new array (rows, columns).
inline Rows<double> ArrayOf(const Matrix& m) {
  return Rows<double>({m.rows, m.columns}, m.values.data());
}

/// Returns a view of bytes.
inline std::span<const std::uint8_t> BytesOf(const py::bytes& bytes) {
  const auto text = static_cast<std::string_view>(bytes);
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}
/// Returns a copy as Python's bytes.
inline py::bytes BytesFrom(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Returns a dict of arrays in the form of `Batch.contacts`.
py::dict ContactsOf(const std::vector<ContactState>& touching);

/// Returns the names of the elements, in order.
template <class List>
std::vector<std::string> NamesOf(const List& list) {
  std::vector<std::string> names;
  for (const auto& one : list) names.push_back(one.name);
  return names;
}

}  // namespace taut::python
