/// Newton's method for the final velocities of an implicit stage. Its initial guess is rest, for
/// which cable lengths and tensions are exact (docs/theory/cables.md, section 3).
#pragma once

#include "sim/constraint/links.h"
#include "sim/data/implicit_memory.h"
#include "sim/data/island.h"
#include "sim/solve/implicit_island.inl"
#include "simd/vec3.h"

namespace taut::sim {

template <class W>
double ImplicitIsland<W>::Norm(const Num* d) const noexcept {
  Num sum = Num::Splat(0.0), mass = sum;
  for (int k = 0; k < count(); ++k) {
    const ImplicitBody<Num>& b = mem_.body[k];
    const Twist<Num> t = island_.Load(d + kDofs * k);
    sum += b.mass * Dot(t.v, t.v) + Dot(t.w, b.inertia * t.w);
    mass += b.mass;
  }
  return Sqrt(sum / mass)[0];
}

template <class W>
double ImplicitIsland<W>::Noise() const noexcept {
  Num far = Num::Splat(0.0), lightest = Num::Splat(1e300);
  for (int k = 0; k < count(); ++k) {
    if (!mem_.body[k].turns) continue;
    far = Max(Norm1(mem_.body[k].x), far);
    lightest = Min(mem_.body[k].mass, lightest);
  }
  constexpr double kTensions = 8e-15, kPlaces = 1e-15;
  const double h = stage_.h[0];
  const Num most = Max(cables_.most_tension, joints_.MostForce(stage_));
  return kTensions * h * most[0] / lightest[0] + kPlaces * far[0] / h;
}

template <class W>
bool ImplicitIsland<W>::Step(const Num* res, bool given, Num* step) noexcept {
  for (int i = 0; i < size(); ++i) step[i] = -res[i];
  if (given) AddImpulses(step);
  joints_.AddGaps(stage_, step);
  matrix_.Solve(step);
  if (given || island_.rows == 0) {
    joints_.TakeStep(stage_, step);
    return true;
  }
  StoreVelocities(mem_.back, &Unknown<Num>::free, [&](int k) {
    const Twist<Num> at = island_.Load(mem_.U + kDofs * k), d = island_.Load(step + kDofs * k);
    return EndVelocityOf(k, {at.v + d.v, at.w + d.w});
  });
  const bool fits = laws_.Solve(matrix_, mem_.back, step);
  joints_.TakeStep(stage_, step);
  return fits;
}

template <class W>
void ImplicitIsland<W>::AddImpulses(Num* f) noexcept {
  island_.pools.ForEach(
      [&](auto& law, auto&, int row, int) { island_.AddForce(law, island_.m.l + row, f); });
}

template <class W>
bool ImplicitIsland<W>::Newton(bool given) noexcept {
  const Num zero = Num::Splat(0.0);
  Num *const U = mem_.U, *const trial = mem_.trial, *const d = mem_.step;
  for (int k = 0; k < count(); ++k) island_.Store(VelocityOf(k), U + kDofs * k);
  const double speed = kLeastSpeedMPerS + Norm(U);
  for (int k = 0; k < count(); ++k) {
    for (int i = 0; i < kDofs && mem_.body[k].turns; ++i) U[kDofs * k + i] = zero;
  }
  Evaluate(U, 0, mem_.res);
  double before = 1e300;
  for (int i = 0; i < kMostSteps; ++i) {
    for (int j = 0; j < size(); ++j) mem_.back[j] = -mem_.res[j];
    if (given || i > 0) AddImpulses(mem_.back);
    matrix_.Clear(island_.bodies, false);
    cables_.AddTo(stage_, mem_.back, matrix_);
    joints_.AddTo(stage_, matrix_);
    if (IsExhausted()) return false;
    ++work_done_.linear_solves;
    if (!matrix_.Factor() || !Step(mem_.res, given, d)) return false;
    const double noise = Noise(), now = Norm(d), least = kTolerance * speed + noise;
    if (!(now - now == 0)) return false;
    const double near = 1e-7 * speed + 30 * noise;
    const bool converges = i > 0 && now < 0.1 * before;
    // Quadratic convergence: the length of the next step would be now^3 / before^2.
    const bool solved = converges && now * now * now <= 1e-4 * least * before * before;
    const bool stays = i > 3 && now > 0.5 * before && now < near && before < near;
    before = now;
    double way = 1;
    for (int tries = 0;; ++tries) {
      const Num part = Num::Splat(way);
      for (int j = 0; j < size(); ++j) trial[j] = U[j] + part * d[j];
      Evaluate(trial, way, mem_.trial_res);
      if (stays || converges || tries == 11) break;
      if (now <= 1e3 * kTolerance * speed + 10 * Noise()) break;
      for (int j = 0; j < size(); ++j) mem_.back[j] = -mem_.trial_res[j];
      AddImpulses(mem_.back);
      cables_.SeenThere(mem_.back);
      joints_.AddGaps(stage_, mem_.back);
      matrix_.Solve(mem_.back);
      // Natural monotonicity test: the simplified Newton step must be shorter.
      if (Norm(mem_.back) <= (1 - 0.25 * way) * now) break;
      way *= 0.5;
    }
    for (int j = 0; j < size(); ++j) U[j] = trial[j], mem_.res[j] = mem_.trial_res[j];
    joints_.Accept();
    if (stays || solved || (way == 1 && now <= least)) {
      if (!given) return true;
      StoreVelocities(mem_.ends, &Unknown<Num>::free,
                      [&](int k) { return EndVelocityOf(k, island_.Load(mem_.U + kDofs * k)); });
      island_.Measure(mem_.ends, island_.m.u);
      return true;
    }
  }
  return false;
}

}  // namespace taut::sim
