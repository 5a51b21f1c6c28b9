/// What a study or a learner wants more of.
#pragma once

#include <optional>

#include "taut/types.h"

namespace taut {

/// What the score of a world is before penalties; more is better.
enum class Measure {
  kDistance,           ///< Horizontal way of the centre of mass from `from_s` to the end [m].
  kHeading,            ///< The part of that way along `direction` [m]; backwards is negative.
  kDistancePerEnergy,  ///< Distance by the motors' work [m/J]: tension times winding in.
  kNearer,             ///< How much nearer to the goal the watched body is than at `from_s` [m].
  kTracking,           ///< Minus the root mean square of tension less set point [N].
  kNone,               ///< 0: only penalties count, or what a program says.
};

/// Takes `penalty_per_n` for every newton by which the largest tension of the world exceeds a
/// limit.
struct TensionLimit {
  double limit_n = 0.0;
  double penalty_per_n = 0.0;
};

/// A world has fallen once a body is tilted, or the centre of mass is, beyond these. Looked at
/// every 0.1 s.
struct FallSpec {
  double max_tilt_rad = 3.141592653589793;           ///< Of any body against its start, 0 to pi.
  std::optional<double> min_height_m, max_height_m;  ///< Of the centre of mass, world z.
  double penalty = 0.0;
};

struct ObjectiveSpec {
  Measure measure = Measure::kDistance;
  Vec3 direction{1.0, 0.0, 0.0};  ///< Unit vector in W.
  double from_s = 0.0;
  std::optional<TensionLimit> tension_limit;
  std::optional<FallSpec> fall;
  double max_speed_m_per_s = 100.0;  ///< Of a body: beyond it a world counts as blown up.
};

}  // namespace taut
