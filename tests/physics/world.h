/// Common helpers of the physics tests: worlds from scenes, distances, bounds of rounding errors.
#pragma once

#include <cmath>
#include <limits>
#include <stdexcept>

#include "math/vec.h"
#include "taut/world_batch.h"

namespace taut::test {

inline WorldBatch MakeBatch(const ModelDef& def, const WorldBatchOptions& options = {}) {
  Diagnostics complaints;
  const auto model = Model::Compile(def, complaints);
  if (model == nullptr) throw std::runtime_error(complaints.Format());
  return WorldBatch(model, options);
}

/// 4 kHz, 1 kHz and 250 Hz.
inline constexpr double kThreeStepsS[] = {1.0 / 4000, 1.0 / 1000, 1.0 / 250};

inline int StepsIn(double time_s, double step_s) {
  return static_cast<int>(std::lround(time_s / step_s));
}

/// Returns a bound of rounding errors. A sum of `n` terms, each rounded to a relative half epsilon
/// and no partial sum above `size`, is off by at most n size eps / 2. A position gets two additions
/// a step, and its velocity's error n speed eps / 2 adds up to n (time speed) eps / 4; products
/// contribute as much again. So this bounds both, with `size` at least the largest position and the
/// largest path.
inline double RoundOff(int steps, double size) {
  return 4 * steps * std::numeric_limits<double>::epsilon() * size;
}

/// Returns a bound of the accumulated error of n contact solves [m/s]. A residual is the change by
/// one step of the natural map (docs/theory/contact.md, eq. 16), and below the tolerance. The
/// distance from the solution may be larger where contacts share loads: a factor of ten is assumed.
inline double SolverError(int solves,
                          double tolerance_m_per_s = WorldBatchOptions().tolerance_m_per_s) {
  return 10 * solves * tolerance_m_per_s;
}

/// Returns the energy of world 0: kinetic, gravity and elastic [J].
inline double EnergyOf(const WorldBatch& world) {
  const Energy e = world.TotalEnergy(0);
  return e.kinetic_j + e.gravity_j + e.elastic_j;
}

inline double Norm(const Vec3& a) { return std::sqrt(Dot(a, a)); }
inline double Distance(const Vec3& a, const Vec3& b) { return Norm(a - b); }

/// Returns the upward acceleration of a body in the second half of a time span, after the initial
/// transient [m/s^2].
inline double AccelerationOf(WorldBatch& world, int body, double time_s) {
  const int steps = StepsIn(time_s, 1e-3);
  world.Step(1e-3, steps / 2);
  const double t0 = world.Time(0), v0 = world.Body(0, body).velocity_m_per_s.z;
  world.Step(1e-3, steps - steps / 2);
  return (world.Body(0, body).velocity_m_per_s.z - v0) / (world.Time(0) - t0);
}

}  // namespace taut::test
