/// Controllers and plants that are written in Python, and controllers of the library that Python
/// programs configure.
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

/// Calls of Python code by the simulator. After the first exception, no further call is made.
class Callbacks {
 public:
  /// Calls f() with the GIL, which this thread holds or has released, and stores its exception.
  /// Does nothing after the first exception.
  void Call(const std::function<void()>& f);
  bool failed() const;
  /// Raises the exception that was kept, if any. The GIL must be held.
  void Rethrow();

  bool is_used = false;  ///< Whether a controller is written in Python.

 private:
  mutable std::mutex mutex_;  ///< Guards `raised_`.
  std::exception_ptr raised_;
};

/// Shortest period of a controller [s]; well above 1e-9 s, below which times count as equal.
inline constexpr double kLeastPeriodS = 1e-6;

/// Controller of the library, with the names of the cables to which its indices refer.
struct LibrarySpec {
  ControllerSpec spec;
  std::vector<std::string> cables;  ///< All cables of the robot that it was made for.

  /// Raises ValueError, with `where` in its message, if the robot has other cables at these
  /// indices.
  void Check(const RobotSpec& robot, const std::string& where) const;
};

/// Returns the controllers of a list: each is a `taut.control` specification, or an object with
/// `period_s` and `act(seen, commands)`. For other items, raises TypeError or ValueError with their
/// place in the list.
Extensions ExtensionsOf(const py::object& controllers, const RobotSpec& robot,
                        const std::shared_ptr<Callbacks>& callbacks);

/// Plant of one lane in Python.
class PythonPlant : public Plant {
 public:
  /// Returns the plant of an object with `observe()` and `advance(step_s, time_s, commands)`, for
  /// the cables of a robot. The object must outlive the plant.
  static std::unique_ptr<PythonPlant> Of(const py::object& plant, const RobotSpec& robot,
                                         std::shared_ptr<Callbacks> callbacks);
};

}  // namespace taut::python
