/// Pose and velocity of a kinematic body at any time, for code outside of steps.
#pragma once

#include "sim/data/view.h"

namespace taut::sim {

struct MotionSample {
  double slide_m, slide_rate, turn_rad, turn_rate;
  Vec3 position_m, velocity_m_per_s, spin_rad_per_s;
  Quat orientation;
};

MotionSample SampleMotion(const View& m, int motion, double time_s) noexcept;

}  // namespace taut::sim
