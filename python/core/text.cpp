#include "text.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "taut/input_names.h"
#include "taut/instruction_sets.h"
#include "taut/shipped.h"
#include "taut/time_limits.h"

namespace taut::python {
namespace {

py::list Items(const std::vector<Diagnostic>& said) {
  const py::object item = py::module_::import("taut._errors").attr("Complaint");
  py::list items;
  for (const Diagnostic& d : Sorted(said)) {
    items.append(item(d.at.file, d.at.line, d.at.column, d.what, d.hint, std::string(d.id)));
  }
  return items;
}

std::string TextOf(const std::vector<py::ssize_t>& shape, const char* format) {
  return fmt::format("{} of shape {}", format, ShapeText(shape));
}

std::string TextOf(const py::array& a) {
  return TextOf({a.shape(), a.shape() + a.ndim()}, py::str(a.dtype()).cast<std::string>().c_str());
}

/// Returns why `given` is not an array of real numbers, or an empty string. NumPy would convert the
/// refused ones silently: complex numbers lose a part, times and texts become numbers, and masked
/// entries get the values under their mask.
std::string NotReal(const py::object& given, const py::array& a) {
  const char kind = a.dtype().kind();
  if (std::string_view("biufO").find(kind) == std::string_view::npos) return TextOf(a);
  if (py::hasattr(given, "mask") &&
      py::module_::import("numpy").attr("ma").attr("is_masked")(given).cast<bool>()) {
    return "masked entries";
  }
  return {};
}

}  // namespace

void Unexpected(const py::handle& given, const std::string& what, const std::string& expected) {
  throw py::type_error(what + ": " + py::repr(given).cast<std::string>() + "; expected " +
                       expected);
}

std::optional<Simd> SimdOf(const std::optional<std::string>& name) {
  if (!name) return std::nullopt;
  std::string known;
  for (const InstructionSet& set : InstructionSets()) {
    if (*name == set.name) return set.simd;
    known += (known.empty() ? "" : ", ") + std::string(set.name);
  }
  throw py::value_error("simd: \"" + *name + "\"; expected one of: " + known);
}

namespace {

std::string ModulePath() {
  Dl_info module{};
  return dladdr(reinterpret_cast<const void*>(&ModulePath), &module) != 0 ? module.dli_fname : "";
}

}  // namespace

std::optional<std::string> DataFolder() { return ShippedFolder(ModulePath()); }

std::string InputPath(const std::string& path, const std::vector<std::string>& kinds,
                      Diagnostics& out) {
  return ResolveInput(path, kinds, out, ModulePath());
}

void Tell(const Diagnostics& said) {
  if (!said.ok()) Refuse(said);
  if (said.warnings().empty()) return;
  const py::object warn = py::module_::import("taut._errors").attr("warn");
  for (const py::handle item : Items(said.warnings())) warn(item);
}

void Refuse(const Diagnostics& said) {
  const py::object error = py::module_::import("taut._errors").attr("InputError");
  const py::object raised = error(Items(said.items()));
  PyErr_SetObject(error.ptr(), raised.ptr());
  throw py::error_already_set();
}

py::dict ContactsOf(const std::vector<ContactState>& touching) {
  const auto n = static_cast<py::ssize_t>(touching.size());
  py::array_t<int> bodies({n, py::ssize_t{2}});
  py::array_t<double> points({n, py::ssize_t{3}}), normals({n, py::ssize_t{3}});
  py::array_t<double> forces({n, py::ssize_t{3}}), gaps(n);
  for (py::ssize_t i = 0; i < n; ++i) {
    const ContactState& c = touching[static_cast<std::size_t>(i)];
    bodies.mutable_at(i, 0) = c.body_a, bodies.mutable_at(i, 1) = c.body_b;
    Put(c.point_m, points.mutable_data(i, 0));
    Put(c.normal, normals.mutable_data(i, 0));
    Put(c.force_n, forces.mutable_data(i, 0));
    gaps.mutable_at(i) = c.gap_m;
  }
  py::dict all;
  all["bodies"] = bodies, all["point_m"] = points, all["normal"] = normals;
  all["force_n"] = forces, all["gap_m"] = gaps;
  return all;
}

void RefuseName(const Diagnostics& said) {
  throw py::key_error(said.items()[0].what + " (" + said.items()[0].hint + ")");
}

Overrides OverridesOf(const py::kwargs& values) {
  Overrides overrides;
  for (const auto& [key, value] : values) {
    const auto name = key.cast<std::string>();
    overrides.emplace_back(name,
                           py::isinstance<py::str>(value)
                               ? value.cast<std::string>()
                               : fmt::format("{}", Number(value, name, "a number or a text")));
  }
  return overrides;
}

double StepLength(double step_s) {
  if (step_s >= kShortestStep_s && step_s <= kLongestStep_s) return step_s;
  throw py::value_error(fmt::format("step_s: {}; expected a number from {:g} to {:g} [s]", step_s,
                                    kShortestStep_s, kLongestStep_s));
}

py::object CallableOrNone(const py::object& given, const std::string& what) {
  if (!given.is_none() && PyCallable_Check(given.ptr()) == 0) {
    Unexpected(given, what, "a function or another callable");
  }
  return given;
}

bool Flag(const py::handle& given, const std::string& what) {
  py::detail::make_caster<bool> flag;
  if (!flag.load(given, false)) Unexpected(given, what, "True or False");
  return py::detail::cast_op<bool>(flag);
}

double Number(const py::handle& given, const std::string& what, const char* expected) {
  if (PyNumber_Check(given.ptr()) == 0 || PyBool_Check(given.ptr())) {
    Unexpected(given, what, expected);
  }
  const double number = PyFloat_AsDouble(given.ptr());
  if (PyErr_Occurred() == nullptr) return number;
  PyErr_Clear();
  Unexpected(given, what, expected);
}

std::string Text(const py::handle& given, const std::string& what) {
  if (!py::isinstance<py::str>(given)) Unexpected(given, what, "a text");
  return given.cast<std::string>();
}

std::uint64_t Seed(const py::object& given) {
  const auto whole = py::reinterpret_steal<py::object>(
      PyBool_Check(given.ptr()) ? nullptr : PyNumber_Index(given.ptr()));
  const auto seed = whole ? PyLong_AsUnsignedLongLong(whole.ptr()) : 0;
  if (whole && PyErr_Occurred() == nullptr) return seed;
  PyErr_Clear();
  throw py::value_error(fmt::format("seed: {}; expected a whole number, 0 to 2**64 - 1",
                                    py::repr(given).cast<std::string>()));
}

int Threads(py::ssize_t threads) {
  constexpr int kMost = 1024;
  if (threads < 0 || threads > kMost) {
    throw py::value_error(
        fmt::format("threads: {}; expected 0 (one per core) to {}", threads, kMost));
  }
  return static_cast<int>(threads);
}

int Index(py::ssize_t index, int count, const char* what) {
  const py::ssize_t from_start = index < 0 ? index + count : index;
  if (from_start < 0 || from_start >= count) {
    throw py::index_error(fmt::format("{} {} is out of range: there are {}", what, index, count));
  }
  return static_cast<int>(from_start);
}

std::shared_ptr<RobotSpec> WithoutExperiment(const RobotSpec& robot) {
  auto copy = std::make_shared<RobotSpec>(robot);
  copy->def.experiment_parts.clear();
  return copy;
}

std::string ShapeText(const std::vector<py::ssize_t>& shape) {
  std::string text = "(";
  for (std::size_t i = 0; i < shape.size(); ++i) {
    text += fmt::format("{}{}", i > 0 ? ", " : "", shape[i]);
  }
  return text + (shape.size() == 1 ? ",)" : ")");
}

Array Shaped(const py::object& given, const std::vector<py::ssize_t>& shape, const char* what) {
  const py::array raw = py::array::ensure(given);
  const std::string wrong = raw ? NotReal(given, raw) : "not numbers";
  Array a = wrong.empty() ? Array::ensure(raw) : Array();
  if (!wrong.empty() || !a) {
    PyErr_Clear();
    throw py::value_error(fmt::format("{}: {}; expected {}", what,
                                      wrong.empty() ? "not numbers" : wrong,
                                      TextOf(shape, "float64")));
  }
  const std::vector<py::ssize_t> has(a.shape(), a.shape() + a.ndim());
  if (has != shape) {
    throw py::value_error(
        fmt::format("{}: {}; expected {}", what, TextOf(a), TextOf(shape, "float64")));
  }
  return a;
}

Array Finite(const py::object& given, const std::vector<py::ssize_t>& shape, const char* what) {
  Array a = Shaped(given, shape, what);
  const double* const end = a.data() + a.size();
  const double* const bad = std::find_if(a.data(), end, [](double x) { return !std::isfinite(x); });
  if (bad == end) return a;
  std::vector<py::ssize_t> at(shape.size());
  py::ssize_t rest = bad - a.data();
  for (std::size_t i = shape.size(); i-- > 0; rest /= shape[i]) at[i] = rest % shape[i];
  throw py::value_error(
      fmt::format("{}: {} at {}; expected finite numbers", what, *bad, ShapeText(at)));
}

void CheckArray(const py::object& given, const py::dtype& kind,
                const std::vector<py::ssize_t>& shape, const char* what, bool written) {
  const std::string expected = TextOf(shape, ((written ? "contiguous, writeable " : "contiguous ") +
                                              py::str(py::object(kind)).cast<std::string>())
                                                 .c_str());
  if (!py::isinstance<py::array>(given)) {
    throw py::value_error(fmt::format("{}: not an array; expected {}", what, expected));
  }
  const py::array a = py::reinterpret_borrow<py::array>(given);
  const std::vector<py::ssize_t> has(a.shape(), a.shape() + a.ndim());
  const bool frozen = written && !a.writeable();
  if (!a.dtype().equal(kind) || has != shape || frozen || !(a.flags() & py::array::c_style)) {
    throw py::value_error(fmt::format("{}: {}{}; expected {}", what, TextOf(a),
                                      frozen ? ", not writeable" : "", expected));
  }
}

}  // namespace taut::python
