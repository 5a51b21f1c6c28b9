/// Scenes of mechanics with a known answer. The tests run each of them, and
/// docs/validation/mechanics.md lists them with the expected and the measured values.
///
/// A file in this folder holds the scenes of one subject:
///
///     void Top(Report& report) {
///       ...
///       report.AtMost("energy error, 200 rad/s, 20 s", "J", error, 4e-3);
///     }
///     const SceneEntry kTop("joints", "Spinning top on a ball joint", "energy is conserved", Top);
#pragma once

#include <string>
#include <vector>

namespace taut::mechanics {

/// Measured and expected value of a quantity.
struct Finding {
  std::string quantity, unit;
  double expected;  ///< From the oracle; the bound where `is_bound`.
  double measured;
  double tolerance;  ///< Largest |measured - expected|; unused where `is_bound`.
  bool is_bound;     ///< `measured` has to be at most `expected`.

  bool Holds() const;  ///< False for values that are not finite.
};

/// Extent of a scene: samples for the tests, or all cases for the page.
enum class Effort { kSample, kFull };

/// Collects the findings of one scene. Not thread-safe.
class Report {
 public:
  explicit Report(Effort effort) : effort_(effort) {}

  bool IsFull() const { return effort_ == Effort::kFull; }
  const std::vector<Finding>& findings() const { return findings_; }

  void Near(std::string quantity, std::string unit, double measured, double expected,
            double tolerance);
  void AtMost(std::string quantity, std::string unit, double measured, double bound);
  /// Reports the order of convergence from the errors at a step and at the next finer one.
  void Order(std::string quantity, double coarse_error, double fine_error, double ratio_of_steps,
             double least_order);

 private:
  Effort effort_;
  std::vector<Finding> findings_;
};

/// A scene; constructing one at namespace scope adds it to the list.
struct SceneEntry {
  SceneEntry(const char* subject, const char* name, const char* oracle, void (*run)(Report&));

  const char *subject, *name;
  const char* oracle;  ///< Source of the expected values.
  void (*run)(Report&);
};

/// Returns all scenes, by subject and name.
std::vector<SceneEntry> AllScenes();

}  // namespace taut::mechanics
