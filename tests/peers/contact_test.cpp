// Differences between the contact laws of the engines, and their causes; docs/validation/peers.md
// shows their size on robots.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "math/vec.h"
#include "tests/peers/engine_test.h"
#include "tests/peers/sled.h"
#include "tests/scenes/block_on_slope.h"

namespace taut::peers {
namespace {

constexpr double kStepS = 0.001;

class ContactOf : public EngineTest {
 protected:
  static double WayOf(double heading_rad) {
    const auto world = Make(test::Sled(1, heading_rad));
    world->Step(kStepS, 2000);
    const Vec3 p = world->Body(0).position_m;
    return std::hypot(p.x, p.y);
  }
};

TEST_P(ContactOf, SlidingStopsAsCoulombSaysAlongAnAxis) {
  // Moving by the velocity before or after the step differs by half a step's travel; MuJoCo's soft
  // contact changes the distance by less than that.
  EXPECT_NEAR(WayOf(0), 1 / (2 * 0.5 * 9.81), kStepS);
}

TEST_P(ContactOf, SlidingOnTheDiagonalShowsTheShapeOfItsCone) {
  // |f| is mu N in every direction only if the cone is round. A pyramid with its corners on the
  // axes has 1 / sqrt(2) of it on the diagonals; a box has sqrt(2).
  const bool pyramid = GetParam().engine == Engine::kMujoco && !GetParam().options.elliptic;
  const bool box = GetParam().engine == Engine::kOde;
  const double mu = 0.5 * (pyramid ? std::sqrt(0.5) : box ? std::sqrt(2.0) : 1);
  EXPECT_NEAR(WayOf(std::numbers::pi / 4), 1 / (2 * mu * 9.81), kStepS);
}

TEST_P(ContactOf, OnlyBulletSlidesUnderACouple) {
  // Bullet's friction omits the velocity that external torques will add to a body in the step,
  // (I^-1 torque) h at the lever of the contact: every contact slips by exactly this, for any
  // friction coefficient.
  const ModelDef def = test::Turned(test::Sled());
  Options options = GetParam().options;
  options.iterations = 1000;  // so that the iterations converge
  const auto world = MakeWorld(GetParam().engine, def, options);
  world->Step(kStepS, 1000);
  const double lever_m = def.bodies[0].com_m.z;
  const double slip = kStepS * test::kCoupleNm / def.bodies[0].inertia_kg_m2.yy * lever_m;
  const double speed = -world->Body(0).velocity_m_per_s.x;
  if (GetParam().engine == Engine::kBullet) {
    EXPECT_NEAR(speed, slip, 1e-3 * slip);
  } else {
    EXPECT_NEAR(speed, 0, 1e-3 * slip);
  }
}

TEST_P(ContactOf, BoxesLieAsTheyAreTurned) {
  // On a slope of 0.3 rad a block lies flat, rough enough not to slide: with a wrong orientation it
  // would stand on an edge and fall. The lower of two blocks carries the other.
  scenes::BlockOnSlope scene;
  scene.slope.angle_rad = 0.3;
  scene.slope.material = scene.material = {0.8, 0.8, 0.0};
  ModelDef def = scene.Def();
  const Vec3 normal = scene.slope.normal(), half = scene.half_m;
  def.bodies.push_back(def.bodies[0]);
  def.bodies[1].com_m = 3 * half.z * normal;
  def.boxes.push_back(def.boxes[0]);
  def.boxes[1].body = 1;
  def.boxes[1].center_m = def.bodies[1].com_m;
  const auto world = Make(def);
  world->Step(kStepS, 300);
  for (int i = 0; i < 2; ++i) {
    const BodyState state = world->Body(i);
    EXPECT_NEAR(Dot(state.position_m, normal), (2 * i + 1) * half.z, 0.001) << i;
    EXPECT_LT(std::abs(Dot(state.position_m, scene.slope.downhill())), 0.002) << i;
    EXPECT_GT(std::abs(state.orientation.w), std::cos(0.01)) << i;
  }
}

std::string CaseName(const testing::TestParamInfo<Setting>& info) {
  return std::string(Name(info.param.engine)) + "_" + info.param.name;
}

INSTANTIATE_TEST_SUITE_P(Peers, ContactOf, testing::ValuesIn(kSettings), CaseName);

/// The same for taut.
TEST(PeersContact, OursDoesNeither) {
  Diagnostics complaints;
  for (const double heading_rad : {0.0, std::numbers::pi / 4, std::numbers::pi / 2}) {
    WorldBatch world(Model::Compile(test::Sled(1, heading_rad), complaints), {});
    world.Step(kStepS, 2000);
    const Vec3 p = world.Body(0, 0).position_m;
    EXPECT_NEAR(std::hypot(p.x, p.y), 1 / (2 * 0.5 * 9.81), 1e-6) << heading_rad;
  }
  WorldBatch world(Model::Compile(test::Turned(test::Sled()), complaints), {});
  world.Step(kStepS, 1000);
  EXPECT_NEAR(world.Body(0, 0).velocity_m_per_s.x, 0, 1e-9);
}

}  // namespace
}  // namespace taut::peers
