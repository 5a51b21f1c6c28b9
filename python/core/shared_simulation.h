/// C++ part of `taut.Simulation`, for the files that add its methods.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "owner.h"
#include "python_control.h"
#include "taut/find.h"
#include "taut/simulation.h"
#include "text.h"
#include "variants.h"
#include "worlds.h"

namespace taut::python {

/// Simulation that all Python threads share; one thread at a time has access.
class SharedSimulation : public OwnedWorlds<Simulation> {
 public:
  SharedSimulation(const ExperimentSpec& experiment, int worlds,
                   const std::optional<std::vector<GivenVariant>>& given, int threads,
                   const std::optional<std::string>& simd, const py::object& controllers);

  const ModelDef& def() const { return peek().def(); }
  py::ssize_t bodies() const { return static_cast<py::ssize_t>(def().bodies.size()); }
  py::ssize_t cables() const { return static_cast<py::ssize_t>(def().cables.size()); }
  py::ssize_t nodes() const { return static_cast<py::ssize_t>(def().nodes.size()); }

  /// Returns the index of an element given by name or index. Raises KeyError or IndexError.
  template <class Elements>
  int ElementOf(const py::object& given, const Elements& elements, const char* kind,
                std::optional<int> (*find)(const ModelDef&, std::string_view, Diagnostics*)) const {
    if (!py::isinstance<py::str>(given)) {
      if (PyIndex_Check(given.ptr()) == 0 || py::isinstance<py::bool_>(given)) {
        Unexpected(given, kind, "a name or an index");
      }
      return Index(given.cast<py::ssize_t>(), static_cast<int>(elements.size()), kind);
    }
    Diagnostics said;
    if (const auto found = find(def(), given.cast<std::string>(), &said)) return *found;
    RefuseName(said);
  }
  int Cable(const py::object& given) const {
    return ElementOf(given, def().cables, "cable", FindCable);
  }
  int Body(const py::object& given) const {
    return ElementOf(given, def().bodies, "body", FindBody);
  }
  int Node(const py::object& given) const {
    return ElementOf(given, def().nodes, "node", FindNode);
  }
  int Joint(const py::object& given) const {
    return ElementOf(given, def().joints, "joint", FindJoint);
  }
  /// Returns the index of an element, found by a member function such as `Cable`; nothing for None.
  std::optional<int> OneOf(int (SharedSimulation::*find)(const py::object&) const,
                           const py::object& given) const {
    if (given.is_none()) return std::nullopt;
    return (this->*find)(given);
  }

  /// Returns an array of shape (worlds, count, width), without `width` if it is 1, and without
  /// `count` for a single element.
  template <class Put>
  py::array_t<double> Read(std::optional<int> element, py::ssize_t count, py::ssize_t width,
                           Put put) {
    std::vector<py::ssize_t> shape{worlds()};
    if (!element) shape.push_back(count);
    if (width > 1) shape.push_back(width);
    Rows<double> a(shape);
    double* to = a.mutable_data();
    const int first = element.value_or(0), last = element ? first + 1 : static_cast<int>(count);
    Look([&](Simulation& s) {
      for (int w = 0; w < s.worlds(); ++w) {
        for (int i = first; i < last; ++i, to += width) put(s, w, i, to);
      }
    });
    return a;
  }

  /// Runs `step(simulation)` until it returns false, while other Python threads run.
  template <class StepOnce>
  void Run(StepOnce step) {
    const bool done = With([&](Simulation& s) {
      Signals signals;
      while (step(s)) {
        ShowIfRequested(s);
        if (callbacks_->failed()) return true;
        if (signals.Raised()) return false;
      }
      return true;
    });
    if (!done) throw py::error_already_set();
    callbacks_->Rethrow();
  }

  std::shared_ptr<Callbacks> callbacks() const { return callbacks_; }

 private:
  std::shared_ptr<Callbacks> callbacks_;
};

using SimulationType = py::class_<SharedSimulation, std::shared_ptr<SharedSimulation>>;

/// Adds the methods that read and command.
void AddReadings(SimulationType& type);
void AddCommands(SimulationType& type);

}  // namespace taut::python
