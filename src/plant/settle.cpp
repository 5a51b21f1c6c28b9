#include <cmath>

#include "math/vec.h"
#include "taut/start.h"

namespace taut {
namespace {

void Stop(WorldBatch& batch, int world) {
  for (std::size_t b = 0; b < batch.model().def().bodies.size(); ++b) {
    BodyState state = batch.Body(world, static_cast<int>(b));
    state.velocity_m_per_s = state.angular_velocity_rad_per_s = {};
    batch.SetBodyState(world, static_cast<int>(b), state);
  }
}

/// Returns the largest speed of any node or center of mass.
double GreatestSpeed(const WorldBatch& batch, int world) {
  double greatest = 0;
  for (std::size_t n = 0; n < batch.model().def().nodes.size(); ++n) {
    const Vec3 v = batch.NodeVelocity(world, static_cast<int>(n));
    greatest = std::max(greatest, std::sqrt(Dot(v, v)));
  }
  for (std::size_t b = 0; b < batch.model().def().bodies.size(); ++b) {
    const Vec3 v = batch.Body(world, static_cast<int>(b)).velocity_m_per_s;
    greatest = std::max(greatest, std::sqrt(Dot(v, v)));
  }
  return greatest;
}

}  // namespace

bool Settle(WorldBatch& batch, int world, double step_s, const std::function<bool()>& go_on,
            int max_steps) {
  constexpr double kAtRestMPerS = 1e-9;
  const double time_s = batch.Time(world);
  // Settle before t = 0, where kinematic bodies do not move yet.
  if (!batch.model().def().motions.empty()) batch.SetTime(world, -(max_steps + 1) * step_s);
  Stop(batch, world);
  double energy_before = 0;
  bool first_after_stop = true, settled = false;
  for (int i = 0; i < max_steps && !settled; ++i) {
    if (go_on && !go_on()) break;
    batch.Step(step_s);
    if (batch.Status(world).bits & kStatusNonFinite) break;
    const double energy = batch.TotalEnergy(world).kinetic_j;
    // One step after a stop, the speed is the effect of unbalanced forces in this step only.
    settled = first_after_stop && GreatestSpeed(batch, world) < kAtRestMPerS;
    first_after_stop = energy < energy_before;
    if (first_after_stop || settled) {
      Stop(batch, world);
      energy_before = 0;
    } else {
      energy_before = energy;
    }
  }
  batch.SetTime(world, time_s);
  return settled;
}

}  // namespace taut
