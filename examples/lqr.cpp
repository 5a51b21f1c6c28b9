// Example of a user-defined controller: a linear quadratic regulator (LQR) of rest lengths.
//
// A ball of 1 kg hangs from four cables whose motors set their rest lengths. A push of 5 N for 0.1
// s leaves it swinging, since the cables hardly damp. The motion over one period is linearized by
// differences of the simulation, and the gains follow from the Riccati equation. The same class
// then controls one world, a live run and eight worlds of a batch, with identical bits. The example
// asserts this, and that the regulator reduces the swing to less than a hundredth.
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <vector>

#include "taut/live.h"
#include "taut/plant.h"
#include "taut/rollout.h"
#include "taut/run.h"

namespace {

constexpr int kStates = 6, kInputs = 4;  // position and velocity; rest lengths
constexpr int kStepsAPeriod = 10;
constexpr double kStepS = 0.001, kPeriodS = kStepsAPeriod * kStepS;

template <int Rows, int Columns>
struct Matrix {
  double x[Rows][Columns] = {};
  double* operator[](int row) { return x[row]; }
  const double* operator[](int row) const { return x[row]; }
};

template <int N, int M, int K>
Matrix<N, K> operator*(const Matrix<N, M>& a, const Matrix<M, K>& b) {
  Matrix<N, K> out{};
  for (int i = 0; i < N; ++i)
    for (int k = 0; k < M; ++k)
      for (int j = 0; j < K; ++j) out[i][j] += a[i][k] * b[k][j];
  return out;
}

template <int N, int M>
Matrix<M, N> Transposed(const Matrix<N, M>& a) {
  Matrix<M, N> out{};
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < M; ++j) out[j][i] = a[i][j];
  return out;
}

/// Returns x of a x = b, for a positive definite a: no pivots needed.
template <int N, int M>
Matrix<N, M> Solve(Matrix<N, N> a, Matrix<N, M> b) {
  for (int k = 0; k < N; ++k) {
    for (int i = 0; i < N; ++i) {
      if (i == k) continue;
      const double f = a[i][k] / a[k][k];
      for (int j = k; j < N; ++j) a[i][j] -= f * a[k][j];
      for (int j = 0; j < M; ++j) b[i][j] -= f * b[k][j];
    }
  }
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < M; ++j) b[i][j] /= a[i][i];
  return b;
}

taut::ExperimentSpec HangingBall() {
  taut::ExperimentSpec experiment;
  taut::ModelDef& def = experiment.robot.def;
  def.name = experiment.name = "hanging_ball";
  taut::BodyDef ball;
  ball.name = "ball";
  ball.mass_kg = 1.0;
  ball.inertia_kg_m2 = {0.004, 0.004, 0.004, 0.0, 0.0, 0.0};
  def.bodies.push_back(ball);
  def.nodes.push_back({"center", 0, {}});
  for (int i = 0; i < kInputs; ++i) {
    taut::CableDef cable;
    cable.name = "cable_" + std::to_string(i);
    const double x = i % 2 == 0 ? 1.0 : -1.0, y = i < 2 ? 1.0 : -1.0;
    cable.attachments = {{taut::kWorld, {x, y, 1.0}}, {0, {}}};
    cable.stiffness_n_per_m = 400.0;
    cable.damping_n_s_per_m = 0.05;
    cable.rest_length_m = 1.7;
    cable.actuator.kind = taut::ActuatorDef::Kind::kIdeal;
    def.cables.push_back(cable);
  }
  experiment.step_s = kStepS;
  experiment.duration_s = 5.0;
  experiment.start = taut::StartKind::kSettled;
  taut::PushSpec push;
  push.name = "push";
  push.direction = {0.6, 0.8, 0.0};
  push.force_n = {{0.5, 0.0}, {0.5, 5.0}, {0.6, 5.0}, {0.6, 0.0}};
  experiment.pushes.push_back(push);
  return experiment;
}

std::array<double, kStates> StateOf(const taut::BodyState& body, const taut::Vec3& rest_m) {
  const taut::Vec3 &p = body.position_m, &v = body.velocity_m_per_s;
  return {p.x - rest_m.x, p.y - rest_m.y, p.z - rest_m.z, v.x, v.y, v.z};
}

/// Operating point and gain of the regulator.
struct Plan {
  taut::Vec3 rest_m;                          ///< Position of the ball at rest.
  std::array<double, kInputs> rest_length_m;  ///< Rest lengths that hold it there.
  Matrix<kInputs, kStates> gain;
};

/// Computes, from the simulation, the state of rest, the linearized motion about it, and the
/// regulator that weights a position error of a centimeter like 5 mm of rest length.
Plan Regulator(const taut::ExperimentSpec& experiment) {
  taut::Diagnostics out;
  taut::WorldBatch batch(taut::Model::Compile(experiment.robot.def, out), {});
  taut::Settle(batch, 0, kStepS);
  const std::vector<std::uint8_t> rest = batch.Save(0);
  Plan found;
  found.rest_m = batch.Body(0, 0).position_m;
  for (int c = 0; c < kInputs; ++c) found.rest_length_m[c] = batch.RestLengthTarget(0, c);

  const auto after_period = [&](int state, int input, double change) {
    batch.Restore(0, rest);
    taut::BodyState body = batch.Body(0, 0);
    double* const numbers[] = {&body.position_m.x,       &body.position_m.y,
                               &body.position_m.z,       &body.velocity_m_per_s.x,
                               &body.velocity_m_per_s.y, &body.velocity_m_per_s.z};
    if (state >= 0) *numbers[state] += change;
    batch.SetBodyState(0, 0, body);
    if (input >= 0) batch.SetRestLengthTarget(0, input, found.rest_length_m[input] + change);
    batch.Step(kStepS, kStepsAPeriod);
    return StateOf(batch.Body(0, 0), found.rest_m);
  };
  constexpr double kChange = 1e-4;
  Matrix<kStates, kStates> a{}, q{};
  Matrix<kStates, kInputs> b{};
  Matrix<kInputs, kInputs> r{};
  for (int j = 0; j < kStates + kInputs; ++j) {
    const int state = j < kStates ? j : -1, input = j < kStates ? -1 : j - kStates;
    const auto more = after_period(state, input, kChange);
    const auto less = after_period(state, input, -kChange);
    for (int i = 0; i < kStates; ++i) {
      (state >= 0 ? a[i][state] : b[i][input]) = (more[i] - less[i]) / (2.0 * kChange);
    }
  }
  for (int i = 0; i < 3; ++i) q[i][i] = 1.0 / (0.01 * 0.01);
  for (int i = 3; i < kStates; ++i) q[i][i] = 1.0 / (0.1 * 0.1);
  for (int i = 0; i < kInputs; ++i) r[i][i] = 1.0 / (0.005 * 0.005);

  Matrix<kStates, kStates> p = q;
  for (int i = 0; i < 2000; ++i) {  // iterates the discrete Riccati equation to its fixed point
    const auto pa = p * a;
    const auto pb = p * b;
    auto weight = Transposed(b) * pb;
    for (int k = 0; k < kInputs; ++k) weight[k][k] += r[k][k];
    found.gain = Solve(weight, Transposed(b) * pa);
    const auto less = Transposed(pb) * a;
    const auto keep = Transposed(a) * pa;
    const auto taken = Transposed(less) * found.gain;
    for (int k = 0; k < kStates; ++k)
      for (int l = 0; l < kStates; ++l) p[k][l] = q[k][l] + keep[k][l] - taken[k][l];
  }
  return found;
}

/// Controller: rest lengths = values at rest - gain * state. `numbers[0]` of a world, if present,
/// is a factor of the gain.
class Lqr final : public taut::Controller {
 public:
  Lqr(const Plan& plan, const taut::ControlSetup& setup) : plan_(plan) {
    for (const taut::RolloutWorld* world : setup.lanes) {
      factor_.push_back(world->numbers.empty() ? 1.0 : world->numbers[0]);
    }
  }
  taut::ClockSpec clock() const override { return {kPeriodS, 0.0}; }
  void Act(const taut::Tick& tick, const taut::Observation& seen,
           taut::Commands& commands) override {
    for (int lane = 0; lane < seen.lanes; ++lane) {
      if (!taut::Has(tick.due, lane)) continue;
      const auto state = StateOf(seen.bodies->Body(lane, 0), plan_.rest_m);
      for (int c = 0; c < kInputs; ++c) {
        double change_m = 0.0;
        for (int i = 0; i < kStates; ++i) change_m -= plan_.gain[c][i] * state[i];
        commands.rest_length_m[c * seen.lanes + lane] =
            plan_.rest_length_m[c] + factor_[static_cast<std::size_t>(lane)] * change_m;
      }
    }
  }
  void Restart(int lane, const taut::RolloutWorld& world) override {
    factor_[static_cast<std::size_t>(lane)] = world.numbers.empty() ? 1.0 : world.numbers[0];
  }

 private:
  Plan plan_;
  std::vector<double> factor_;
};

/// Returns the ball's distance from rest at the end, with its speed counted at 6 rad/s [m].
double Swing(const taut::ExperimentSpec& experiment, const taut::Extensions& extensions,
             const taut::Vec3& rest_m, std::uint64_t& hash) {
  taut::Diagnostics out;
  const auto run = taut::LiveRun::Start(experiment, out, {}, extensions);
  if (!run) return NAN;
  while (run->time_s() < experiment.duration_s - 1e-9 && run->Step()) continue;
  hash = run->world()->Hash(0);
  const auto state = StateOf(run->world()->Body(0, 0), rest_m);
  double sum = 0.0;
  for (int i = 0; i < kStates; ++i) {
    const double length_m = i < 3 ? state[i] : state[i] / 6.0;
    sum += length_m * length_m;
  }
  return std::sqrt(sum);
}

}  // namespace

int main() {
  const taut::ExperimentSpec experiment = HangingBall();
  const Plan plan = Regulator(experiment);
  taut::Extensions extensions;
  extensions.controllers.push_back(
      [&](const taut::ControlSetup& setup) { return std::make_unique<Lqr>(plan, setup); });
  std::uint64_t live = 0, ignored = 0;
  const double with_m = Swing(experiment, extensions, plan.rest_m, live);
  const double without_m = Swing(experiment, {}, plan.rest_m, ignored);

  taut::Diagnostics out;
  taut::RunOptions options;
  options.extensions = extensions;
  const auto alone = taut::RunExperiment(experiment, options, out);
  taut::RolloutOptions side_by_side;
  side_by_side.extensions = extensions;
  const auto rollouts = taut::Rollouts::Create(experiment, {}, side_by_side, out);
  if (!alone || !rollouts) {
    std::fputs(out.Format().c_str(), stderr);
    return 1;
  }
  std::vector<taut::RolloutWorld> worlds(8, taut::WorldOf(experiment));
  for (std::size_t i = 0; i < worlds.size(); ++i) worlds[i].numbers = {1.0 + 0.1 * double(i)};
  const auto results = rollouts->Run(worlds);

  std::printf("swing after 5 s: %.2g m with the regulator, %.2g m without\n", with_m, without_m);
  const bool same = live == alone->state_hash && live == results[0].state_hash;
  std::printf("alone, live and the first of eight worlds: %s\n", same ? "the same bits" : "differ");
  const bool others_differ = results[1].state_hash != live;
  return same && others_differ && with_m < 0.01 * without_m ? 0 : 1;
}
