// `taut.linear_system`: linearization of the simulated robot.
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "interruptible.h"
#include "taut/minimal_experiment.h"
#include "taut/start.h"
#include "taut/state_space.h"
#include "text.h"

namespace taut::python {
namespace {

using System = std::shared_ptr<StateSpace>;

System Find(const ExperimentSpec& experiment, const py::object& differences) {
  LinearOptions options;
  options.differences = Flag(differences, "differences");
  Diagnostics said;
  CheckStart(experiment.robot, StartKind::kSettled, said);
  Tell(said);
  auto system = std::make_shared<StateSpace>();
  Diagnostics later;
  Interruptible([&](const std::atomic<bool>& stop) {
    options.go_on = [&] { return !stop; };
    *system = FindStateSpace(experiment, options, later);
  });
  Tell(later);
  if (!system->found) {
    throw std::runtime_error("there is no linear system: " + system->why +
                             (system->hint.empty() ? "" : " (" + system->hint + ")"));
  }
  return system;
}

py::list UnitsOf(const std::vector<LinearSignal>& signals) {
  py::list units;
  for (const LinearSignal& signal : signals) units.append(signal.unit);
  return units;
}

Rows<double> ValuesOf(const std::vector<LinearSignal>& signals) {
  std::vector<double> at;
  for (const LinearSignal& signal : signals) at.push_back(signal.at);
  return ArrayOf(at);
}

/// Returns the index of a signal; raises KeyError, with the closest name, if there is none.
int NumberOf(const std::vector<LinearSignal>& signals, const std::string& name, const char* kind) {
  if (const auto found = FindSignal(signals, name)) return *found;
  const std::vector<std::string> names = NamesOf(signals);
  const std::string_view close = ClosestMatch(name, names);
  throw py::key_error(std::string("no ") + kind + " \"" + name + "\"" +
                      (close.empty() ? "" : "; did you mean \"" + std::string(close) + "\"?"));
}

py::tuple Respond(const StateSpace& s, const std::string& input, const std::string& output,
                  const py::object& frequencies_hz) {
  const int from = NumberOf(s.inputs, input, "input"), to = NumberOf(s.outputs, output, "output");
  const py::array given = py::array::ensure(frequencies_hz);
  if (!given || given.ndim() != 1) {
    PyErr_Clear();
    throw py::value_error("frequencies_hz: expected an array (n,) of numbers");
  }
  const Array real = Shaped(frequencies_hz, {given.size()}, "frequencies_hz");
  const std::vector<double> all(real.data(), real.data() + real.size());
  for (const double f : all) {
    if (!(f >= 0 && f <= 0.5 / s.period_s * (1 + 1e-9))) {
      throw py::value_error(fmt::format(
          "frequencies_hz: {}; expected 0 to half the tick frequency, {} Hz", f, 0.5 / s.period_s));
    }
  }
  FrequencyResponse response;
  {
    const Released others;
    response = ResponseOf(s, from, to, all);
  }
  return py::make_tuple(ArrayOf(response.magnitude), ArrayOf(response.phase_rad));
}

template <class Type>
void AddSignals(Type& type, const char* name, std::vector<LinearSignal> StateSpace::*of,
                const char* words) {
  const std::string plural = name, one = plural.substr(0, plural.size() - 1);
  type.def_property_readonly(
      name, [of](const StateSpace& s) { return NamesOf(s.*of); }, words);
  type.def_property_readonly((one + "_units").c_str(),
                             [of](const StateSpace& s) { return UnitsOf(s.*of); });
  type.def_property_readonly(
      (one + "_at").c_str(), [of](const StateSpace& s) { return ValuesOf(s.*of); },
      "(n,) float64: values at the equilibrium, in their units; 0 for small rotations.");
}

}  // namespace

void AddLinear(py::module_& module) {
  py::class_<StateSpace, System> type(
      module, "LinearSystem",
      "Robot linearized about its rest state, in discrete time with one tick per step: x' = A x + "
      "B u, y = C x + D u, where x, u, y are deviations from the equilibrium. SI units.");
  const auto matrix = [&](const char* name, Matrix StateSpace::*of, const char* words) {
    type.def_property_readonly(
        name, [of](const StateSpace& s) { return ArrayOf(s.*of); }, words);
  };
  matrix("A", &StateSpace::A, "(states, states) float64.");
  matrix("B", &StateSpace::B, "(states, inputs) float64.");
  matrix("C", &StateSpace::C, "(outputs, states) float64.");
  matrix("D", &StateSpace::D, "(outputs, inputs) float64.");
  AddSignals(type, "states", &StateSpace::states, "Names.");
  AddSignals(type, "inputs", &StateSpace::inputs, "Names of the inputs: node/NAME/force_x ...");
  AddSignals(type, "outputs", &StateSpace::outputs,
             "Names of the outputs: node/NAME/position_x ...");
  type.def_readonly("period_s", &StateSpace::period_s,
                    "Period of a tick: of the controllers, or a step [s].");
  type.def_readonly("remarks", &StateSpace::remarks,
                    "Omissions of the linearization, in sentences.");
  type.def_readonly("disagreement", &StateSpace::disagreement,
                    "Largest difference of an entry between exact derivatives and finite "
                    "differences, relative to the largest entry of its kind.");
  type.def("response", &Respond, py::arg("input"), py::arg("output"), py::arg("frequencies_hz"),
           "Returns magnitude and phase [rad] of an output's response to a sinusoidal input, each "
           "an array over `frequencies_hz` [Hz].");

  const char* const words =
      "Linearizes the simulated robot about the rest state that it reaches under its controllers, "
      "as `taut analyze --linear` does. `differences`: finite differences of steps instead of "
      "exact derivatives. Returns a `taut.LinearSystem`. Raises RuntimeError, with the reason, if "
      "there is no linear system. Ctrl-C ends the call.";
  module.def("linear_system", &Find, py::arg("experiment"), py::arg("differences") = false, words);
  module.def(
      "linear_system",
      [](const RobotSpec& robot, const py::object& differences) {
        ExperimentSpec alone = MinimalExperiment(robot);
        // A robot without supports is linearized without weight, as in statics.
        if (!IsHeld(robot.def)) alone.robot.def.gravity_m_per_s2 = {};
        return Find(alone, differences);
      },
      py::arg("robot"), py::arg("differences") = false, words);
}

}  // namespace taut::python
