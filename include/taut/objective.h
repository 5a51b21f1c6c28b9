/// Objectives of studies and reinforcement learning: measure, penalties and failure conditions.
#pragma once

#include <optional>

#include "taut/types.h"

namespace taut {

/// Score of a world before penalties; more is better.
enum class Measure {
  kDistance,  ///< Horizontal displacement of the center of mass from `from_s` to the end [m].
  kHeading,   ///< Component of this displacement along `direction` [m]; backwards is negative.
  kDistancePerEnergy,  ///< Distance divided by the motors' work [m/J]: tension times winding-in
                       ///< length.
  kNearer,             ///< Decrease of the watched body's distance to the goal since `from_s` [m].
  kTracking,           ///< Negative root mean square of tension minus set point [N].
  kNone,               ///< 0: only penalties or a custom score count.
};

/// Penalty on tension: subtracts `penalty_per_n` for each newton by which the largest tension of
/// the world exceeds a limit.
struct TensionLimit {
  double limit_n = 0.0;
  double penalty_per_n = 0.0;
};

/// Fall condition: a world has fallen once the tilt of a body or the height of the center of mass
/// is outside these limits. Checked every 0.1 s.
struct FallSpec {
  double max_tilt_rad = 3.141592653589793;  ///< Of any body relative to its start, 0 to pi.
  std::optional<double> min_height_m, max_height_m;  ///< Of the center of mass, world z.
  double penalty = 0.0;
};

struct ObjectiveSpec {
  Measure measure = Measure::kDistance;
  Vec3 direction{1.0, 0.0, 0.0};  ///< Unit vector in W.
  double from_s = 0.0;
  std::optional<TensionLimit> tension_limit;
  std::optional<FallSpec> fall;
  double max_speed_m_per_s = 100.0;  ///< Of a body: a world with a faster body counts as diverged.
};

}  // namespace taut
