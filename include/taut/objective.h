/// Objectives of studies and of reinforcement learning: measure, penalties and failure conditions.
#pragma once

#include <optional>

#include "taut/types.h"

namespace taut {

/// Score of a world before penalties; higher is better.
enum class Measure {
  kDistance,  ///< Horizontal displacement of the center of mass from `from_s` to the end [m].
  kHeading,   ///< Component of this displacement along `direction` [m]; may be negative.
  kDistancePerEnergy,  ///< Distance divided by motor work [m/J]: tension times length wound in.
  kNearer,    ///< Decrease of the distance from `GoalSpec::body` to the goal since `from_s` [m].
  kTracking,  ///< Minus the root mean square of tension minus set point [N].
  kNone,      ///< Always 0; for penalties or a custom score only.
};

/// Penalty on tension: `penalty_per_n` for each newton of the world's largest tension above a
/// limit.
struct TensionLimit {
  double limit_n = 0.0;
  double penalty_per_n = 0.0;
};

/// Fall condition: a world has fallen if a body's tilt or the height of the center of mass is
/// outside these limits. Checked every 0.1 s.
struct FallSpec {
  /// Largest tilt of any body relative to its start, 0 to pi.
  double max_tilt_rad = 3.141592653589793;
  std::optional<double> min_height_m, max_height_m;  ///< Height of the center of mass in W.
  double penalty = 0.0;
};

struct ObjectiveSpec {
  Measure measure = Measure::kDistance;
  Vec3 direction{1.0, 0.0, 0.0};  ///< Unit vector in W.
  double from_s = 0.0;
  std::optional<TensionLimit> tension_limit;
  std::optional<FallSpec> fall;
  double max_speed_m_per_s = 100.0;  ///< Speed of a body above which the world counts as diverged.
};

}  // namespace taut
