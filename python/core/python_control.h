/// Controllers and plants that are written in Python, or made from the library's in Python.
#pragma once

#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "taut/plant.h"
#include "text.h"

namespace taut::python {

/// Exceptions of Python code that the simulator calls. The first one ends all further calls.
class Callbacks {
 public:
  /// Calls f() with the GIL, on any thread; keeps its exception. Does nothing after an exception.
  void Call(const std::function<void()>& f);
  bool failed() const;
  /// Raises the exception that was kept, if any. The GIL must be held.
  void Rethrow();

 private:
  mutable std::mutex mutex_;  ///< Guards `raised_`.
  std::exception_ptr raised_;
};

/// Shortest period of a controller: times that differ by 1e-9 s count as equal.
inline constexpr double kLeastPeriodS = 1e-6;

/// Controller of the library, with the names of the cables that its indices mean.
struct LibrarySpec {
  ControllerSpec spec;
  std::vector<std::string> cables;  ///< All cables of the robot that it was made for.

  /// Raises ValueError, which contains `where`, if the robot has other cables in these places.
  void Check(const RobotSpec& robot, const std::string& where) const;
};

/// Returns the controllers of a list: each is a `taut.control` specification, or an object with
/// `period_s` and `act(seen, commands)`. Raises TypeError or ValueError, with its place in the
/// list, otherwise.
/// `in_python`: set if one of them is written in Python.
Extensions ExtensionsOf(const py::object& controllers, const RobotSpec& robot,
                        const std::shared_ptr<Callbacks>& callbacks, bool& in_python);

/// Plant of one lane in Python.
class PythonPlant : public Plant {
 public:
  /// Returns the plant of an object with `observe()` and `advance(step_s, time_s, commands)`, for
  /// the cables of a robot. The object must outlive it.
  static std::unique_ptr<PythonPlant> Of(const py::object& plant, const RobotSpec& robot,
                                         std::shared_ptr<Callbacks> callbacks);
};

}  // namespace taut::python
