/// Implicit integration of an island of one lane with stiff cables: Newton's method on the exact
/// lengths and directions at the end of the step, with contacts inside (docs/theory/cables.md,
/// section 3).
///
/// A step has one stage, or two if a stiff cable has a damper. If Newton's method fails, the step
/// is divided into 2, 4, ... 128 substeps, up to the limit of linear systems per step.
#pragma once

#include "sim/data/rows.h"
#include "sim/solve/body_matrix.inl"
#include "sim/solve/impacts.inl"
#include "sim/solve/implicit_cables.inl"
#include "sim/solve/implicit_joints.inl"
#include "sim/solve/implicit_laws.inl"

namespace taut::sim {

template <class W>
class ImplicitIsland {
  using Num = simd::Lane<W>;
  using Problem = Island<Num, StepPools<Num>>;
  /// End of the first stage in steps with dampers: TR-BDF2 with a shifted middle, which is L-stable
  /// for all values.
  static constexpr double kMiddle = 0.9;
  static constexpr double kTolerance = 1e-9, kLeastSpeedMPerS = 1e-3;
  static constexpr int kMostSteps = 40, kMostHalvings = 7;
  /// Work limit: contact systems per linear system of bodies.
  static constexpr int kContactSystems = 5;

 public:
  ImplicitIsland(const View& m, const Rows<W>& s, Scratch<W>& work, Problem& island, Target target,
                 int lane, double step_s, SolverWork& solver_work) noexcept
      : m_(m),
        s_(s),
        work_(work),
        mem_(work.implicit),
        island_(island),
        work_done_(solver_work),
        contact_work_{0, kContactSystems * solver_work.limit},
        laws_(mem_, island, target, contact_work_),
        cables_(mem_, island.bodies, island.pattern.count),
        joints_(mem_),
        matrix_(island.pattern, island.m.blocks),
        target_(target),
        lane_(lane),
        step_s_(step_s) {}

  /// Returns whether the velocities after Solve violate the laws by more than 1e-6 m/s.
  bool failed() const noexcept { return failed_; }

  /// Adds the stiff cable `row`, or the constrained rows of joint `i`, to the island
  /// (implicit_gather.inl). `number`: index of a body in the island, or -1.
  template <class Number>
  void AddCable(int row, const Number& number) noexcept;
  template <class Number>
  void AddJoint(int i, const Number& number) noexcept;
  bool has_cables() const noexcept { return cables_.cable_count > 0; }

  /// Solves the step. Results: impulses and velocities in island.m.l and .v, and final poses.
  /// Returns the residual [m/s].
  double Solve() noexcept {
    Gather();
    double residual = Integrate();
    KeepMomentum();
    if (damped_) {
      cables_.Begin();
      // After a snatch, the extrapolation of the second stage may add energy; the first stage never
      // does.
      if (Gains()) {
        damped_ = false;
        residual = Integrate();
        KeepMomentum();
      }
    }
    for (int i = 0; i < island_.rows; ++i) island_.m.l[i] = mem_.total[i];
    for (int k = 0; k < count(); ++k) {
      const ImplicitBody<Num>& b = mem_.body[k];
      island_.Store(Twist<Num>{b.v, b.w}, island_.m.v + kDofs * k);
    }
    return residual;
  }

  /// Call it after the impulses are stored. Stores momenta without the later contact impulses
  /// (`pending`), and final poses.
  template <class Pending>
  void Finish(const Pending& pending) noexcept {
    const Num h = Num::Splat(step_s_);
    for (int c = 0; c < cables_.cable_count; ++c) {
      const ImplicitCable<Num>& cable = mem_.list[c];
      StiffCable<W>& row = work_.stiff[cable.source];
      SetLane(s_.tension[row.cable], cable.impulse / h, lane_);
      SetLane(s_.mean_elastic[row.cable], cable.elastic_impulse / h, lane_);
      s_.mean_step[0].Set(lane_, step_s_);
      row.live.Set(lane_, 0.0);
      row.l[0].Set(lane_, 0.0);
    }
    for (int r = 0; r < joints_.row_count; ++r) {
      const ImplicitJointRow<Num>& row = mem_.joint_rows[r];
      SetLane(work_.joints[row.source].l[0], row.impulse, lane_);
    }
    for (int k = 0; k < count(); ++k) {
      const ImplicitBody<Num>& b = mem_.body[k];
      if (!b.turns) continue;
      const int body = island_.bodies[k].body;
      SetLane(s_.mom[body], b.L - pending(body), lane_);
      SetLane(mem_.end_pos[body], b.x, lane_);
      SetLane(mem_.end_quat[body], b.q, lane_);
      mem_.ended[body].Set(lane_, 1.0);
    }
  }

  // Interface for impacts.inl.
  template <class F>
  void ForEach(F&& f) noexcept {
    island_.pools.ForEach([&](auto& law, auto&, int row, int) { f(law, row); });
  }
  Num* u() noexcept { return island_.m.u; }
  Num* l() noexcept { return island_.m.l; }
  ImpactRows<Num> impacts() noexcept { return island_.m.impacts; }
  void MeasureBefore() noexcept {
    StoreVelocities(mem_.ends, &Unknown<Num>::before, [&](int k) { return VelocityOf(k); });
    island_.Measure(mem_.ends, island_.m.impacts.before);
  }
  void SolveAgain(MaskOf<Num>) noexcept { good_ = Newton(false) && good_; }
  void Update() noexcept { good_ = Newton(true) && good_; }

 private:
  int count() const noexcept { return island_.pattern.count; }
  int size() const noexcept { return kDofs * island_.pattern.count; }

  bool IsExhausted() const noexcept {
    return work_done_.linear_solves >= work_done_.limit ||
           contact_work_.linear_solves >= contact_work_.limit;
  }
  /// Returns the velocity at the start of the stage.
  Twist<Num> VelocityOf(int k) const noexcept { return {mem_.body[k].v, mem_.body[k].w}; }
  /// Returns the velocity at the end of the stage, from the unknowns of the body.
  Twist<Num> EndVelocityOf(int k, const Twist<Num>& at) const noexcept {
    const ImplicitBody<Num>& b = mem_.body[k];
    return {b.ahead * at.v + b.behind * b.v, b.ahead * at.w + b.behind * b.w};
  }
  /// Sets `to` to the velocities of all bodies: own(k) for integrated, `prescribed` for other
  /// bodies.
  template <class Own>
  void StoreVelocities(Num* to, Twist<Num> Unknown<Num>::*prescribed,
                       const Own& own) const noexcept {
    for (int k = 0; k < island_.body_count; ++k) {
      island_.Store(k < count() ? own(k) : island_.bodies[k].*prescribed, to + kDofs * k);
    }
  }

  /// Solves the whole step with as many substeps as necessary. Returns the residual [m/s].
  double Integrate() noexcept {
    double residual = 0;
    for (int halvings = 0; halvings <= kMostHalvings; ++halvings) {
      const int parts = 1 << halvings;
      const bool last = !alone_ || halvings == kMostHalvings;
      Restart();
      residual = 0;
      bool good = true, converged = true;
      is_jammed_ = false;
      for (int i = 0; i < parts && (good || last) && !is_jammed_; ++i) {
        converged = Part(step_s_ / parts, 1.0 / parts, residual) && converged && !is_jammed_;
        good = good && converged && residual <= target_.tolerance;
      }
      failed_ = !good && !(last && converged && residual <= kDisagreementMPerS);
      if (good) break;
      if (!(residual > target_.tolerance)) residual = 2 * target_.tolerance;
      if (last || is_jammed_ || IsExhausted()) break;
    }
    return residual;
  }

  /// Loads the state at the start of the step.
  void LoadStart(int body, ImplicitBody<Num>& b) const noexcept;

  /// For free islands. The second stage conserves angular momentum only to second order, the first
  /// stage up to the residual of Newton's method. A common rotation of all bodies corrects the
  /// error.
  void KeepMomentum() noexcept;

  /// Stores kinetic and elastic energy [J] of the state after Begin.
  void Energy(Num& kinetic, Num& elastic) const noexcept;

  /// Returns whether the step gains energy in addition to the work of all forces except contacts.
  bool Gains() const noexcept;

  /// Sets the data that all attempts share. SaveStart has stored pos, quat, vel, mom.
  void Gather() noexcept {
    const auto* const mom = reinterpret_cast<const V3<W>*>(work_.start + 10 * m_.body_count);
    for (int k = 0; k < count(); ++k) {
      ImplicitBody<Num>& b = mem_.body[k];
      const int body = island_.bodies[k].body;
      const BodyWork<W>& from = work_.bodies[body];
      b.turns = mem_.bodies[body][lane_] > 0;
      b.mass = island_.bodies[k].mass;
      b.moments = OfLane<Num>(s_.inertia[body], lane_);
      b.inv_moments = OfLane<Num>(s_.inv_inertia[body], lane_);
      b.force = b.mass * OfLane<Num>(from.v - from.v0, lane_);
      b.torque = OfLane<Num>(from.mom_free, lane_) - OfLane<Num>(mom[body], lane_);
    }
    // Laws of a whole step are not valid for substeps.
    const Pool<ContactPoint<Num, 2>>& contacts = island_.pools;
    alone_ = island_.rows == 3 * contacts.count;
    damped_ = damped_ && alone_;
    for (int i = 0; i < island_.rows; ++i) mem_.bias[i] = Num::Splat(0.0);
    for (int i = 0; i < contacts.count; ++i) mem_.bias[3 * i] = contacts.items[i].bias[0];
    for (int i = 0; i < island_.rows; ++i) mem_.start[i] = island_.m.l[i];
  }

  /// Restores the state at the start of the step.
  void Restart() noexcept {
    for (int k = 0; k < count(); ++k) {
      LoadStart(island_.bodies[k].body, mem_.body[k]);
      mem_.body[k].inertia = island_.bodies[k].inertia;
    }
    cables_.Begin();
    joints_.Restart();
    for (int c = 0; c < cables_.cable_count; ++c) {
      ImplicitCable<Num>& cable = mem_.list[c];
      cable.rest = cable.l0 - cable.stretch;
      cable.impulse = cable.elastic_impulse = Num::Splat(0.0);
    }
    Energy(kinetic_, elastic_);
    const Num zero = Num::Splat(0.0), h = Num::Splat(step_s_), half = Num::Splat(0.5);
    for (int i = 0; i < island_.rows; ++i) {
      mem_.total[i] = mem_.gap[i] = zero;
      island_.m.l[i] = mem_.start[i];
    }
    if (island_.rows == 0) return;
    // Move the biases from the middle of the step, where gaps are measured, to its start.
    MeasureBefore();
    const Pool<ContactPoint<Num, 2>>& contacts = island_.pools;
    for (int i = 0; i < contacts.count; ++i) {
      const Num b = mem_.bias[3 * i];
      if (Any(b > zero)) mem_.gap[3 * i] = h * (b - half * island_.m.impacts.before[3 * i]);
    }
  }

  /// Solves a substep of one or two stages. `share`: its fraction of all other impulses.
  bool Part(double h, double share, double& residual) noexcept {
    const Num half = Num::Splat(0.5);
    const double first = damped_ ? kMiddle : 1.0;
    stage_ = {Num::Splat(first * h), false};
    cables_.Begin();
    joints_.Begin(stage_, false);
    for (int k = 0; k < count(); ++k) {
      ImplicitBody<Num>& b = mem_.body[k];
      b.share = Num::Splat(first * share);
      b.ahead = Num::Splat(b.turns ? 2.0 : 1.0);
      b.behind = Num::Splat(b.turns ? -1.0 : 0.0);
    }
    good_ = true;
    if (island_.rows > 0) {
      PrepareContacts();
      laws_.Begin();
      MeasureFree();
      const bool impacts = ExpectImpacts(*this);
      good_ = Newton(false);
      if (impacts && good_) Impacts();
      if (laws_.residual > residual) residual = laws_.residual;
    } else {
      good_ = Newton(false);
    }
    is_jammed_ = is_jammed_ || laws_.is_jammed;
    const double passed = damped_ ? 1 + Extrapolates() : 1;
    for (int i = 0; i < island_.rows; ++i) {
      const Num mean = half * (island_.m.impacts.before[i] + island_.m.u[i]);
      mem_.gap[i] += (Num::Splat(passed) * stage_.h) * mean;
      mem_.total[i] += island_.m.l[i];
    }
    EndStage(passed);
    if (!damped_ || !good_) return good_;
    return SecondStage(h, share, residual) && good_;
  }

  static constexpr double Extrapolates() noexcept {
    return (1 - kMiddle) * (1 - kMiddle) / (kMiddle * (2 - kMiddle));
  }

  bool SecondStage(double h, double share, double& residual) noexcept {
    const Num zero = Num::Splat(0.0), one = Num::Splat(1.0);
    constexpr double kRest = (1 - kMiddle) / (2 - kMiddle);
    stage_ = {Num::Splat(kRest * h), true};
    cables_.Begin();
    joints_.Begin(stage_, true);
    for (int k = 0; k < count(); ++k) {
      ImplicitBody<Num>& b = mem_.body[k];
      b.share = Num::Splat((b.turns ? kRest : 1 - kMiddle) * share);
      b.ahead = one, b.behind = zero;
    }
    Pool<ContactPoint<Num, 2>>& contacts = island_.pools;
    for (int i = 0; i < contacts.count; ++i) {
      contacts.items[i].bias[0] = Max(mem_.gap[3 * i], zero) / stage_.h;
    }
    laws_.Begin();
    good_ = Newton(false);
    is_jammed_ = is_jammed_ || laws_.is_jammed;
    if (laws_.residual > residual) residual = laws_.residual;
    for (int i = 0; i < island_.rows; ++i) {
      mem_.gap[i] += stage_.h * island_.m.u[i];
      mem_.total[i] += island_.m.l[i];
    }
    EndStage(1);
    return good_;
  }

  /// Sets the biases of a stage from gaps and velocities at its start.
  void PrepareContacts() noexcept {
    const Num zero = Num::Splat(0.0), half = Num::Splat(0.5);
    MeasureBefore();
    Pool<ContactPoint<Num, 2>>& contacts = island_.pools;
    for (int i = 0; i < contacts.count; ++i) {
      ContactPoint<Num, 2>& c = contacts.items[i];
      c.before = island_.m.impacts.before[3 * i];
      c.bias[0] = mem_.bias[3 * i];
      if (Any(c.bias[0] > zero)) {
        c.bias[0] = Max(mem_.gap[3 * i] / stage_.h + half * c.before, zero);
      }
    }
  }

  /// Computes velocities under all forces except cables, for rebounds.
  void MeasureFree() noexcept {
    StoreVelocities(mem_.ends, &Unknown<Num>::free, [&](int k) {
      const ImplicitBody<Num>& b = mem_.body[k];
      const Unknown<Num>& body = island_.bodies[k];
      return Twist<Num>{b.v + (b.share * body.inv_mass) * b.force,
                        b.w + b.share * (body.inv_inertia * b.torque)};
    });
    island_.Measure(mem_.ends, island_.m.u);
  }

  void Impacts() noexcept {
    const auto hit = SolveImpacts<Num>(*this, island_.rows, MaskOf<Num>::Splat(true));
    if (!Any(hit) || (good_ && laws_.residual <= target_.tolerance)) return;
    // Friction prevents these rebounds: restore the impulses without rebounds.
    for (int i = 0; i < island_.rows; ++i) island_.m.l[i] = island_.m.impacts.l[i];
    good_ = true;
    Update();
    laws_.residual = 0;
  }

  /// Sets the state after `passed` times the stage length, and the start of the second stage.
  void EndStage(double passed) noexcept;

  // Newton's method of one stage (implicit_newton.inl).

  /// Returns the mass-weighted norm of a change of the unknowns, as a velocity.
  double Norm(const Num* d) const noexcept;
  /// Returns the effect of rounding errors on the unknowns of a stage [m/s].
  double Noise() const noexcept;
  /// Sets `step` to the change of the unknowns for the residual `res`. `given`: impulses are given;
  /// otherwise this function solves for them, too.
  bool Step(const Num* res, bool given, Num* step) noexcept;
  void AddImpulses(Num* f) noexcept;
  /// Solves a stage. `given`: impulses are given.
  bool Newton(bool given) noexcept;
  /// Returns the position of a body at the start of the step.
  V3<Num> StartPosition(int body) const noexcept {
    return OfLane<Num>(reinterpret_cast<const V3<W>*>(work_.start)[body], lane_);
  }
  Q4<Num> StartRotation(int body) const noexcept {
    const auto* const quat = reinterpret_cast<const Q4<W>*>(work_.start + 3 * m_.body_count);
    return OfLane<Num>(quat[body], lane_);
  }
  /// Sets a point of `body`, whose index in the island is `number`. If the body is not in the
  /// island (-1), the point is at the start of the step.
  void SetPoint(int body, int number, const double* own_P, ImplicitPoint<Num>& p) noexcept;
  /// Sets `res` to the residual at the velocities U and at the fraction `way` of the joints' last
  /// Newton step.
  void Evaluate(const Num* U, double way, Num* res) noexcept {
    cables_.Evaluate(stage_, U, res);
    joints_.Evaluate(stage_, way, res);
  }

  const View& m_;
  const Rows<W>& s_;
  Scratch<W>& work_;
  ImplicitMemory<W>& mem_;
  Problem& island_;
  SolverWork& work_done_;
  SolverWork contact_work_;  ///< Work of the contact laws, whose systems are smaller.
  ImplicitLaws<W> laws_;
  ImplicitCables<W> cables_;
  ImplicitJoints<W> joints_;
  BodyMatrix<Num> matrix_;
  Target target_;
  int lane_;
  double step_s_;
  Num kinetic_{}, elastic_{};  ///< Energies at the start of the step [J].
  ImplicitStage<Num> stage_{};
  bool damped_ = false, alone_ = true, good_ = true, failed_ = false, is_jammed_ = false;
};

}  // namespace taut::sim

#include "sim/solve/implicit_gather.inl"
#include "sim/solve/implicit_newton.inl"
#include "sim/solve/implicit_state.inl"
