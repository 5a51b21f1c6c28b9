// Motion of a robot in empty space or between ceiling and floor, in taut and in MuJoCo, Bullet and
// ODE. Nothing is tuned: with decreasing steps all engines must converge to the same trajectory,
// and the bound at a given step follows from the change when the step is halved.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "math/vec.h"
#include "tests/peers/peers_robots.h"

namespace taut::peers {
namespace {

constexpr double kTimeS = 0.25;

/// Positions [m] and velocities [m/s, rad/s] of all bodies, and tensions [N], as one vector.
using Trajectory = std::vector<double>;

void Append(Trajectory& out, const Vec3& v) { out.insert(out.end(), {v.x, v.y, v.z}); }

/// Returns the values of `engine.Body` and `engine.Cable`, for a World or taut.
template <class BodyOf, class CableOf>
Trajectory Look(const ModelDef& def, BodyOf body, CableOf cable) {
  Trajectory out;
  for (std::size_t b = 0; b < def.bodies.size(); ++b) {
    const BodyState state = body(static_cast<int>(b));
    Append(out, state.position_m);
    for (const Vec3& axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
      Append(out, Rotate(state.orientation, axis));
    }
    Append(out, state.velocity_m_per_s);
    Append(out, state.angular_velocity_rad_per_s);
  }
  for (std::size_t c = 0; c < def.cables.size(); ++c) {
    out.push_back(cable(static_cast<int>(c)).length_m);
  }
  return out;
}

Trajectory Theirs(Engine engine, const ModelDef& def, int steps) {
  const auto world = MakeWorld(engine, def);
  world->Step(kTimeS / steps, steps);
  return Look(
      def, [&](int b) { return world->Body(b); }, [&](int c) { return world->Cable(c); });
}

Trajectory Ours(const ModelDef& def, int steps) {
  Diagnostics complaints;
  WorldBatch world(Model::Compile(def, complaints), {});
  world.Step(kTimeS / steps, steps);
  EXPECT_EQ(world.Status(0).bits, kStatusOk);
  return Look(
      def, [&](int b) { return world.Body(0, b); }, [&](int c) { return world.Cable(0, c); });
}

double Distance(const Trajectory& a, const Trajectory& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum);
}

/// Returns the limit of a first-order scheme for a step of zero, from two steps of ratio two.
Trajectory Limit(const Trajectory& coarse, const Trajectory& fine) {
  Trajectory out(coarse.size());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = 2 * fine[i] - coarse[i];
  return out;
}

class Swing : public testing::TestWithParam<std::tuple<Engine, std::string, bool>> {
 protected:
  void SetUp() override {
    if (!Available(engine())) GTEST_SKIP() << Name(engine()) << " is not built in";
    def_ = test::Swinging(test::Robot(std::get<1>(GetParam())), 0.02, 0.1);
    if (std::get<2>(GetParam())) def_ = test::Moored(def_);
  }
  Engine engine() const { return std::get<0>(GetParam()); }
  ModelDef def_;
};

TEST_P(Swing, KeepsAllCablesTautAndTouchesNothing) {
  // Excludes contact and MuJoCo's different law for slack cables.
  Diagnostics complaints;
  WorldBatch world(Model::Compile(def_, complaints), {});
  for (int i = 0; i < 1000; ++i) {
    world.Step(kTimeS / 1000);
    ASSERT_TRUE(world.Contacts(0).empty()) << world.Time(0);
    for (std::size_t c = 0; c < def_.cables.size(); ++c) {
      ASSERT_GT(world.Cable(0, static_cast<int>(c)).tension_n, 0)
          << def_.cables[c].name << " at " << world.Time(0);
    }
  }
}

TEST_P(Swing, AllComeToTheSameTrajectoryAsTheStepGoesToZero) {
  constexpr int kSteps = 4000;
  const Trajectory theirs[3] = {Theirs(engine(), def_, kSteps), Theirs(engine(), def_, 2 * kSteps),
                                Theirs(engine(), def_, 4 * kSteps)};
  const Trajectory ours[2] = {Ours(def_, 2 * kSteps), Ours(def_, 4 * kSteps)};

  // The engines are of first order: halving the step halves the error.
  const double first = Distance(theirs[0], theirs[1]), second = Distance(theirs[1], theirs[2]);
  EXPECT_NEAR(first / second, 2.0, 0.2);
  // They converge to `limit`, with an error of second order that is a third of the last change;
  // taut, of second order, likewise. Three times these errors are allowed in sum.
  const Trajectory coarse = Limit(theirs[0], theirs[1]), limit = Limit(theirs[1], theirs[2]);
  const double theirs_off = Distance(coarse, limit), ours_off = Distance(ours[0], ours[1]);
  const double rounding = 4 * kSteps * 64 * std::numeric_limits<double>::epsilon();
  const double apart = Distance(limit, ours[1]);
  SCOPED_TRACE(testing::Message() << "h and h/2 are " << first << " apart, the limits " << apart);
  EXPECT_LE(apart, theirs_off + ours_off + rounding);
  // The bound is meaningful: it is far below the change by one engine's step alone.
  EXPECT_LT(theirs_off + ours_off, first / 20);
}

std::string SwingCaseName(const testing::TestParamInfo<Swing::ParamType>& info) {
  return std::string(Name(std::get<0>(info.param))) + "_" + std::get<1>(info.param) +
         (std::get<2>(info.param) ? "_moored" : "_free");
}

INSTANTIATE_TEST_SUITE_P(Peers, Swing,
                         testing::Combine(testing::ValuesIn(kEngines),
                                          testing::Values("tetraspine3", "six_strut", "prism3"),
                                          testing::Bool()),
                         SwingCaseName);

}  // namespace
}  // namespace taut::peers
