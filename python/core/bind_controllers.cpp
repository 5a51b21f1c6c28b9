// `taut.control`: controllers of the library for `taut.Simulation` and `taut.run`.
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "python_control.h"
#include "taut/find.h"
#include "text.h"

namespace taut::python {
namespace {

/// Returns the indices of cables by name; all cables with an actuator for None. Raises KeyError.
std::vector<int> CablesOf(const RobotSpec& robot, const py::object& names) {
  std::vector<int> cables;
  if (names.is_none()) {
    for (std::size_t c = 0; c < robot.def.cables.size(); ++c) {
      if (robot.def.cables[c].actuator.kind != ActuatorDef::Kind::kNone) {
        cables.push_back(static_cast<int>(c));
      }
    }
    return cables;
  }
  for (const py::handle& name : names) {
    Diagnostics said;
    const auto cable = FindCable(robot.def, Text(name, "cables"), &said);
    if (!cable) RefuseName(said);
    cables.push_back(*cable);
  }
  return cables;
}

/// Returns a period; raises ValueError if it is too short.
double PeriodOf(double period_s) {
  if (std::isfinite(period_s) && period_s >= kLeastPeriodS) return period_s;
  throw py::value_error(
      fmt::format("period_s: {}; expected a number >= {} [s]", period_s, kLeastPeriodS));
}

/// Returns one number per cable, from an array or a single number for all.
std::vector<double> PerCable(const py::object& given, std::size_t count, const char* what,
                             bool may_be_negative) {
  const auto size = static_cast<py::ssize_t>(count);
  const py::object numbers =
      py::module_::import("numpy").attr("broadcast_to")(given, py::make_tuple(size));
  const Array a = Finite(numbers, {size}, what);
  std::vector<double> all(a.data(), a.data() + count);
  for (const double number : all) {
    if (number < 0 && !may_be_negative) {
      throw py::value_error(fmt::format("{}: {}; expected numbers >= 0", what, number));
    }
  }
  return all;
}

std::shared_ptr<LibrarySpec> Impedance(const RobotSpec& robot, const py::object& names,
                                       const py::object& tension_offset_n,
                                       const py::object& length_offset_m,
                                       const py::object& position_gain_n_per_m,
                                       const py::object& velocity_gain_n_s_per_m,
                                       const py::object& velocity_offset_m_per_s, double period_s,
                                       const py::object& differenced_rate) {
  const std::vector<int> cables = CablesOf(robot, names);
  const std::size_t n = cables.size();
  const auto tension = PerCable(tension_offset_n, n, "tension_offset_n", false);
  const auto length = PerCable(length_offset_m, n, "length_offset_m", false);
  const auto position = PerCable(position_gain_n_per_m, n, "position_gain_n_per_m", false);
  const auto velocity = PerCable(velocity_gain_n_s_per_m, n, "velocity_gain_n_s_per_m", false);
  const auto offset = PerCable(velocity_offset_m_per_s, n, "velocity_offset_m_per_s", true);
  auto made = std::make_shared<LibrarySpec>(LibrarySpec{{}, NamesOf(robot.def.cables)});
  ControllerSpec* const spec = &made->spec;
  spec->name = "impedance";
  spec->clock.period_s = PeriodOf(period_s);
  spec->impedance.emplace();
  spec->impedance->differenced_rate = Flag(differenced_rate, "differenced_rate");
  for (std::size_t i = 0; i < n; ++i) {
    spec->impedance->cables.push_back(
        {cables[i], tension[i], length[i], position[i], velocity[i], offset[i]});
  }
  return made;
}

std::shared_ptr<LibrarySpec> Position(const RobotSpec& robot, const py::dict& programs,
                                      double period_s) {
  auto made = std::make_shared<LibrarySpec>(LibrarySpec{{}, NamesOf(robot.def.cables)});
  ControllerSpec* const spec = &made->spec;
  spec->name = "position";
  spec->clock.period_s = PeriodOf(period_s);
  for (const auto& [name, points] : programs) {
    const std::string cable = Text(name, "programs");
    PositionProgram program;
    program.cable = CablesOf(robot, py::make_tuple(cable))[0];
    program.rest_length_m = points.cast<std::vector<std::pair<double, double>>>();
    double before_s = -std::numeric_limits<double>::infinity();
    for (const auto& [time_s, length_m] : program.rest_length_m) {
      if (!std::isfinite(time_s) || !(time_s > before_s) || !std::isfinite(length_m) ||
          length_m <= 0) {
        throw py::value_error(
            fmt::format("{}: ({}, {}); expected increasing times [s] and positive rest lengths [m]",
                        cable, time_s, length_m));
      }
      before_s = time_s;
    }
    if (program.rest_length_m.empty())
      throw py::value_error(cable +
                            ": the program is empty; expected (time [s], rest length [m]) pairs");
    spec->position.push_back(std::move(program));
  }
  if (spec->position.empty()) throw py::value_error("programs: empty; expected at least one cable");
  return made;
}

}  // namespace

void LibrarySpec::Check(const RobotSpec& robot, const std::string& where) const {
  const std::vector<std::string> names = NamesOf(robot.def.cables);
  const auto check = [&](int cable) {
    const auto i = static_cast<std::size_t>(cable);
    if (i < names.size() && names[i] == cables[i]) return;
    throw py::value_error(fmt::format(
        "{}: the controller was made for another robot, whose cable {} is \"{}\"{}", where, i,
        cables[i],
        i < names.size() ? fmt::format("; here it is \"{}\"", names[i]) : "; here there is none"));
  };
  if (spec.impedance) {
    for (const ImpedanceGains& gains : spec.impedance->cables) check(gains.cable);
  }
  for (const PositionProgram& program : spec.position) check(program.cable);
  const GaitInputSpec* const input = GaitInputOf(spec);
  if (input == nullptr) return;
  Diagnostics said;
  for (std::size_t g = 0; g <= input->others.size(); ++g) {
    ResolveGait(GaitOf(*input, g), robot, said);
  }
  if (said.ok()) return;
  throw py::value_error(where + ": " + said.items()[0].what);
}

void AddControllers(py::module_& module) {
  py::class_<LibrarySpec, std::shared_ptr<LibrarySpec>>(
      module, "ControllerSpec",
      "A controller of the library with its numbers, for `controllers=` of `taut.Simulation` and "
      "`taut.run`. Made by `taut.control`, or one of `Experiment.controllers`.")
      .def_property_readonly("name", [](const LibrarySpec& c) { return c.spec.name; })
      .def_property_readonly("period_s", [](const LibrarySpec& c) { return c.spec.clock.period_s; })
      .def("__repr__", [](const LibrarySpec& c) {
        return fmt::format("<taut.ControllerSpec \"{}\", every {:g} s>", c.spec.name,
                           c.spec.clock.period_s);
      });
  module.def("impedance", &Impedance);
  module.def("position", &Position);
}

}  // namespace taut::python
