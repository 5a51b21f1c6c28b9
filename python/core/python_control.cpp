// Controllers that are written in Python: `act(seen, commands)` for the worlds whose tick is due.
#include "python_control.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "taut/lane_state.h"

namespace taut::python {
namespace {

/// Calls f() with the GIL, whether this thread holds it or is within a `Released`.
template <class F>
void WithPython(F f) {
  if (PyGILState_Check() != 0) return f();
  const Acquired mine;
  f();
}

/// Shares a Python object among C++ objects that are copied and destroyed without the GIL.
std::shared_ptr<py::object> Shared(py::object object) {
  return {new py::object(std::move(object)),
          [](py::object* of) { WithPython([of] { delete of; }); }};
}

/// Rows of a plant as arrays (worlds, cables), of the worlds whose tick is due.
class DueRows {
 public:
  DueRows(std::vector<int> lanes, int plant_lanes, std::size_t cables)
      : lanes_(std::move(lanes)), plant_lanes_(plant_lanes), cables_(cables) {}

  py::ssize_t count() const { return static_cast<py::ssize_t>(lanes_.size()); }

  template <class T>
  Rows<T> Copy(const T* row) const {
    Rows<T> a({count(), static_cast<py::ssize_t>(cables_)});
    T* to = a.mutable_data();
    for (const int lane : lanes_) {
      for (std::size_t c = 0; c < cables_; ++c) *to++ = row[At(c, lane)];
    }
    return a;
  }

  /// Writes an array back. Raises ValueError if its shape or type has changed, or if a number is
  /// not finite.
  template <class T>
  void Back(const py::object& from, T* row, const char* name, bool at_least_zero = false) const {
    const auto a = Exactly<T>(from, {count(), static_cast<py::ssize_t>(cables_)},
                              ("commands." + std::string(name)).c_str(), false);
    const T* values = a.data();
    for (const int lane : lanes_) {
      for (std::size_t c = 0; c < cables_; ++c, ++values) {
        if (!std::isfinite(static_cast<double>(*values))) {
          throw py::value_error(fmt::format(
              "commands.{}: {} for cable {}; expected a finite number", name, *values, c));
        }
        if (at_least_zero && *values < 0) {
          throw py::value_error(fmt::format("commands.{}: {} for cable {}; expected a number >= 0",
                                            name, *values, c));
        }
        row[At(c, lane)] = *values;
      }
    }
  }

 private:
  std::size_t At(std::size_t cable, int lane) const {
    return cable * static_cast<std::size_t>(plant_lanes_) + static_cast<std::size_t>(lane);
  }

  std::vector<int> lanes_;
  int plant_lanes_;
  std::size_t cables_;
};

py::object Namespace() { return py::module_::import("types").attr("SimpleNamespace"); }

/// Returns the commands as a Python object. Each attribute is `array(row)` of one row of commands.
template <class Array>
py::object CommandsOf(const Commands& commands, Array array) {
  return Namespace()(py::arg("rest_length_m") = array(commands.rest_length_m),
                     py::arg("set_point_n") = array(commands.set_point_n),
                     py::arg("velocity_input_m_per_s") = array(commands.velocity_input_m_per_s),
                     py::arg("signal") = array(commands.signal));
}

/// Controller in Python.
class PythonController final : public Controller {
 public:
  PythonController(const ControlSetup& setup, std::shared_ptr<py::object> of, ClockSpec clock,
                   std::shared_ptr<Callbacks> callbacks)
      : of_(std::move(of)),
        clock_(clock),
        callbacks_(std::move(callbacks)),
        first_world_(setup.first_world),
        worlds_(setup.worlds < 0 ? static_cast<int>(setup.lanes.size()) : setup.worlds),
        cables_(setup.experiment.robot.def.cables.size()) {}

  ClockSpec clock() const override { return clock_; }

  void Act(const Tick& tick, const Observation& seen, Commands& commands) override {
    std::vector<int> lanes;
    for (int j = 0; j < worlds_; ++j) {
      if (Has(tick.due, j)) lanes.push_back(j);
    }
    if (lanes.empty()) return;
    callbacks_->Call([&] { Act(tick, std::move(lanes), seen, commands); });
  }

  /// Saves or restores the memory of the Python object, by its methods `save` and `restore`.
  void Serialize(plant::LaneState& state) override {
    if (state.lane() >= worlds_) return;
    const int world = first_world_ + state.lane();
    std::string bytes;
    if (!state.reads()) callbacks_->Call([&] { bytes = SaveOf(world); });
    std::uint64_t size = bytes.size();
    state.Value(size);
    if (state.reads() && size > state.left()) return state.Fail();
    bytes.resize(static_cast<std::size_t>(size));
    for (char& byte : bytes) state.Value(byte);
    if (!state.reads()) return;
    callbacks_->Call([&] {
      if (HasMemory()) CallPython(of_->attr("restore"), world, py::bytes(bytes));
    });
    if (callbacks_->failed()) state.Fail();
  }

 private:
  void Act(const Tick& tick, std::vector<int> lanes, const Observation& seen, Commands& commands) {
    const auto count = static_cast<py::ssize_t>(lanes.size());
    Rows<std::int64_t> worlds(count), ticks(count);
    Rows<double> time_s(count);
    for (py::ssize_t i = 0; i < count; ++i) {
      const int lane = lanes[static_cast<std::size_t>(i)];
      worlds.mutable_data()[i] = first_world_ + lane;
      ticks.mutable_data()[i] = tick.number[lane];
      time_s.mutable_data()[i] = seen.time_s[lane];
    }
    const DueRows rows(std::move(lanes), seen.lanes, cables_);
    const py::object what =
        Namespace()(py::arg("world") = worlds, py::arg("tick") = ticks, py::arg("time_s") = time_s,
                    py::arg("cable_length_m") = rows.Copy(seen.cables.length_m),
                    py::arg("cable_rate_m_per_s") = rows.Copy(seen.cables.rate_m_per_s),
                    py::arg("rest_length_m") = rows.Copy(seen.cables.rest_length_m),
                    py::arg("tension_n") = rows.Copy(seen.cables.tension_n),
                    py::arg("elastic_n") = rows.Copy(seen.cables.elastic_n),
                    py::arg("stiffness_n_per_m") = rows.Copy(seen.cables.stiffness_n_per_m));
    const py::object now = CommandsOf(commands, [&](const double* row) { return rows.Copy(row); });
    CallPython(of_->attr("act"), what, now);
    rows.Back(now.attr("rest_length_m"), commands.rest_length_m, "rest_length_m", true);
    rows.Back(now.attr("set_point_n"), commands.set_point_n, "set_point_n");
    rows.Back(now.attr("velocity_input_m_per_s"), commands.velocity_input_m_per_s,
              "velocity_input_m_per_s");
    rows.Back(now.attr("signal"), commands.signal, "signal");
  }

  bool HasMemory() const { return py::hasattr(*of_, "save") && py::hasattr(*of_, "restore"); }
  /// Returns the bytes of `save(world)`; none if the object is stateless.
  std::string SaveOf(int world) const {
    const auto name = py::str(py::type::of(*of_).attr("__name__")).cast<std::string>();
    if (!HasMemory() && !IsStateless()) {
      throw py::type_error(
          name +
          ": its state cannot be saved; define save(world), which returns bytes, and "
          "restore(world, bytes), or set `stateless = True` if the controller has no memory");
    }
    if (!HasMemory()) return {};
    const py::object saved = CallPython(of_->attr("save"), world);
    if (!py::isinstance<py::bytes>(saved)) {
      Unexpected(saved, name + ".save", "bytes");
    }
    return saved.cast<py::bytes>();
  }
  bool IsStateless() const {
    return py::hasattr(*of_, "stateless") && Flag(py::object(of_->attr("stateless")), "stateless");
  }

  std::shared_ptr<py::object> of_;
  ClockSpec clock_;
  std::shared_ptr<Callbacks> callbacks_;
  int first_world_, worlds_;
  std::size_t cables_;
};

/// Returns whether an object has a callable attribute of this name.
bool HasMethod(const py::object& of, const char* name) {
  return py::hasattr(of, name) && PyCallable_Check(of.attr(name).ptr()) != 0;
}

/// Returns an attribute as a number, or `otherwise` if it is absent. Raises TypeError if it is not
/// a number, ValueError if it is not finite or too small.
double NumberOf(const py::object& of, const char* name, const std::string& where, double otherwise,
                bool may_be_zero) {
  if (!py::hasattr(of, name)) return otherwise;
  const double value = Number(py::object(of.attr(name)), where + "." + name, "a number [s]");
  const double least = may_be_zero ? 0 : kLeastPeriodS;
  if (!std::isfinite(value) || value < least) {
    throw py::value_error(
        fmt::format("{}.{}: {}; expected a number >= {} [s]", where, name, value, least));
  }
  return value;
}

/// Plant in Python.
class CallingPlant final : public PythonPlant {
 public:
  CallingPlant(py::object of, const RobotSpec& robot, std::shared_ptr<Callbacks> callbacks)
      : of_(Shared(std::move(of))),
        callbacks_(std::move(callbacks)),
        cables_(robot.def.cables.size()),
        rows_(10 * cables_),
        mode_(cables_, CommandMode::kRestLength) {
    seen_.time_s = &time_s_;
    seen_.cables = {Row(0), Row(1), Row(2), Row(3), Row(4), Row(5)};
    commands_ = {1, Row(6), Row(7), Row(8), Row(9), mode_.data(), &gait_};
    for (std::size_t c = 0; c < cables_; ++c) {
      Row(5)[c] = robot.def.cables[c].stiffness_n_per_m;
      Row(6)[c] = robot.def.cables[c].rest_length_m;
    }
    Read();
  }

  const Observation& Observe() override { return seen_; }
  Commands& commands() override { return commands_; }
  void Advance(const double* step_s, const double* to_s) override {
    callbacks_->Call([&] {
      CallPython(of_->attr("advance"), *step_s, *to_s,
                 CommandsOf(commands_, [&](const double* row) {
                   return Rows<double>(static_cast<py::ssize_t>(cables_), row);
                 }));
    });
    time_s_ = *to_s;
    Read();
  }
  void Restart(int) override { time_s_ = 0; }
  bool IsRunning(int) const override { return running_ && !callbacks_->failed(); }

 private:
  double* Row(std::size_t i) { return rows_.data() + i * cables_; }

  /// Reads the observation: a dict, or an object with these attributes.
  void Read() {
    callbacks_->Call([&] {
      const py::object now = CallPython(of_->attr("observe"));
      const auto read = [&](const char* name, double* to, bool required) {
        const bool dict = py::isinstance<py::dict>(now);
        const bool has = dict ? now.cast<py::dict>().contains(name) : py::hasattr(now, name);
        if (!has && !required) return;
        if (!has)
          throw py::value_error(
              fmt::format("observe(): \"{}\" is missing; expected rest_length_m, cable_length_m, "
                          "cable_rate_m_per_s and tension_n",
                          name));
        const py::object given = dict ? py::object(now[name]) : py::object(now.attr(name));
        const Array a = Finite(given, {static_cast<py::ssize_t>(cables_)}, name);
        std::copy_n(a.data(), cables_, to);
      };
      read("rest_length_m", Row(0), true);
      read("cable_length_m", Row(1), true);
      read("cable_rate_m_per_s", Row(2), true);
      read("tension_n", Row(3), true);
      std::copy_n(Row(3), cables_, Row(4));
      read("elastic_n", Row(4), false);
      running_ = !py::hasattr(*of_, "is_running") ||
                 Flag(CallPython(of_->attr("is_running")), "is_running()");
    });
  }

  std::shared_ptr<py::object> of_;
  std::shared_ptr<Callbacks> callbacks_;
  std::size_t cables_;
  std::vector<double> rows_;  ///< Readings, followed by commands.
  std::vector<CommandMode> mode_;
  int gait_ = -1;
  double time_s_ = 0;
  bool running_ = true;
  Observation seen_;
  Commands commands_;
};

}  // namespace

void Callbacks::Call(const std::function<void()>& f) {
  if (failed()) return;
  WithPython([&] {
    try {
      f();
    } catch (const abi::__forced_unwind&) {  // end of the thread, not an exception of f
      EndOfProgram::Sleep();
    } catch (...) {
      const std::lock_guard lock(mutex_);
      raised_ = std::current_exception();
    }
  });
}

bool Callbacks::failed() const {
  const std::lock_guard lock(mutex_);
  return raised_ != nullptr;
}

void Callbacks::Rethrow() {
  std::exception_ptr raised;
  {
    const std::lock_guard lock(mutex_);
    raised = std::exchange(raised_, nullptr);
  }
  if (raised) std::rethrow_exception(raised);
}

Extensions ExtensionsOf(const py::object& controllers, const RobotSpec& robot,
                        const std::shared_ptr<Callbacks>& callbacks) {
  Extensions extensions;
  if (controllers.is_none()) return extensions;
  if (!py::isinstance<py::list>(controllers) && !py::isinstance<py::tuple>(controllers)) {
    Unexpected(controllers, "controllers", "a list of controllers");
  }
  std::size_t number = 0;
  for (const py::handle& item : controllers) {
    const auto of = py::reinterpret_borrow<py::object>(item);
    const std::string where = fmt::format("controllers[{}]", number++);
    if (py::isinstance<LibrarySpec>(of)) {
      const auto& given = of.cast<const LibrarySpec&>();
      given.Check(robot, where);
      for (auto& factory : ControllersOf(given.spec)) {
        extensions.controllers.push_back(std::move(factory));
      }
      continue;
    }
    if (!HasMethod(of, "act") || !py::hasattr(of, "period_s")) {
      Unexpected(of, where,
                 "an object with period_s and act(seen, commands), or a controller of "
                 "taut.control");
    }
    for (const char* const name : {"save", "restore"}) {
      if (py::hasattr(of, name)) CallableOrNone(py::object(of.attr(name)), where + "." + name);
    }
    if (py::hasattr(of, "stateless")) Flag(py::object(of.attr("stateless")), where + ".stateless");
    callbacks->is_used = true;
    const ClockSpec clock{NumberOf(of, "period_s", where, 0, false),
                          NumberOf(of, "phase_s", where, 0, true)};
    extensions.controllers.push_back(
        [shared = Shared(of), clock, callbacks](const ControlSetup& setup) {
          return std::make_unique<PythonController>(setup, shared, clock, callbacks);
        });
  }
  return extensions;
}

std::unique_ptr<PythonPlant> PythonPlant::Of(const py::object& plant, const RobotSpec& robot,
                                             std::shared_ptr<Callbacks> callbacks) {
  for (const char* name : {"observe", "advance"}) {
    if (!HasMethod(plant, name)) {
      Unexpected(plant, "plant",
                 "an object with observe() and advance(step_s, time_s, commands), or a "
                 "taut.Replay");
    }
  }
  return std::make_unique<CallingPlant>(plant, robot, std::move(callbacks));
}

}  // namespace taut::python
