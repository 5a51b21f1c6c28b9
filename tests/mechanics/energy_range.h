/// Changes of energy and joint gaps over a run.
#pragma once

#include <algorithm>

#include "tests/physics/world.h"

namespace taut::mechanics {

/// Largest and smallest energy relative to the start, and status bits.
struct EnergyRange {
  double gain_j = 0, loss_j = 0;
  double flagged = 0, unsolved = 0;  ///< Steps with any status bit, and unsolved steps.
  double gap_m = 0;

  double Off() const { return std::max(gain_j, loss_j); }
};

inline EnergyRange Run(WorldBatch& world, double step_s, double time_s) {
  EnergyRange seen;
  const double start = test::EnergyOf(world);
  const int joints = static_cast<int>(world.model().def().joints.size());
  for (int n = test::StepsIn(time_s, step_s); n > 0; --n) {
    world.Step(step_s);
    const double change = test::EnergyOf(world) - start;
    // NaN counts as a gain.
    if (!(change <= seen.gain_j)) seen.gain_j = change;
    seen.loss_j = std::max(seen.loss_j, -change);
    for (int i = 0; i < joints; ++i) seen.gap_m = std::max(seen.gap_m, world.Joint(0, i).gap_m);
    if (world.Status(0).bits == kStatusOk) continue;
    ++seen.flagged;
    if ((world.Status(0).bits & kStatusNotConverged) != 0) ++seen.unsolved;
    world.ClearStatus(0);
  }
  return seen;
}

}  // namespace taut::mechanics
