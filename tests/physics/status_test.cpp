/// Status of a world: error conditions are reported and do not affect other worlds.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "tests/constants.h"
#include "tests/instruction_sets.h"
#include "tests/physics/world.h"
#include "tests/scenes/ball.h"
#include "tests/scenes/tetraspine3.h"

namespace taut::test {
namespace {

constexpr double kInfiniteForce = std::numeric_limits<double>::infinity();

bool Finite(const WorldBatch& batch, int world, int body) {
  const BodyState state = batch.Body(world, body);
  return std::isfinite(Norm(state.position_m) + Norm(state.velocity_m_per_s) +
                       Norm(state.angular_velocity_rad_per_s) + state.orientation.w +
                       state.orientation.x + state.orientation.y + state.orientation.z);
}

/// Breaks world 1 of three after 0.05 s and checks that it reports the error and halts, and that
/// the other worlds are unaffected.
void BreaksAlone(const std::function<void(WorldBatch&)>& breaks, int body) {
  for (const auto& [name, simd] : kInstructionSets) {
    SCOPED_TRACE(name);
    WorldBatchOptions options;
    options.worlds = 3;
    options.simd = simd;
    const ModelDef def = scenes::Tetraspine().Def();
    WorldBatch batch = MakeBatch(def, options), healthy = MakeBatch(def, options);
    batch.Step(1e-3, 50);
    healthy.Step(1e-3, 50);
    breaks(batch);
    batch.Step(1e-3);
    healthy.Step(1e-3);
    const WorldStatus status = batch.Status(1);
    EXPECT_EQ(status.bits & kStatusNonFinite, kStatusNonFinite);
    EXPECT_EQ(status.body, body);
    EXPECT_NEAR(status.first_time_s, 0.05, RoundOff(50, 0.05));
    // The world keeps its state before the step that broke it.
    for (int b = 0; b < 3; ++b) EXPECT_TRUE(Finite(batch, 1, b)) << b;
    EXPECT_EQ(batch.Time(1), status.first_time_s);
    const std::uint64_t hash = batch.Hash(1);
    batch.Step(1e-3, 100);
    healthy.Step(1e-3, 100);
    EXPECT_EQ(batch.Hash(1), hash);
    EXPECT_EQ(batch.Time(1), status.first_time_s);
    for (const int world : {0, 2}) {
      EXPECT_EQ(batch.Hash(world), healthy.Hash(world)) << batch.lanes() << " lanes";
      EXPECT_EQ(batch.Status(world).bits, kStatusOk);
    }
  }
}

TEST(Status, AForceThatIsNotANumberStopsItsWorldAndNamesTheBody) {
  BreaksAlone([](WorldBatch& batch) { batch.SetNodeForce(1, 6 * 2 + 3, {0, kNan, 0}); }, 2);
  BreaksAlone(
      [](WorldBatch& batch) {
        batch.SetNodeForce(1, 6 * 1 + 3, {kInfiniteForce, 0, 0});
      },
      1);
}

TEST(Status, ACommandThatIsNotANumberNamesTheCable) {
  ModelDef def = scenes::Tetraspine().Def();
  for (CableDef& cable : def.cables) cable.actuator.kind = ActuatorDef::Kind::kIdeal;
  WorldBatch world = MakeBatch(def);
  world.SetRestLengthTarget(0, 7, kNan);
  world.Step(1e-3);
  EXPECT_EQ(world.Status(0).bits & kStatusNonFinite, kStatusNonFinite);
  EXPECT_EQ(world.Status(0).cable, 7);
  for (int b = 0; b < 3; ++b) EXPECT_TRUE(Finite(world, 0, b)) << b;
  EXPECT_EQ(world.Cable(0, 7).rest_length_m, def.cables[7].rest_length_m);
}

TEST(Status, AWorldThatIsMendedGoesOn) {
  const ModelDef def = scenes::Tetraspine().Def();
  WorldBatch world = MakeBatch(def), healthy = MakeBatch(def);
  world.Step(1e-3, 50);
  healthy.Step(1e-3, 50);
  world.SetNodeForce(0, 3, {kNan, 0, 0});
  world.Step(1e-3, 20);
  ASSERT_NE(world.Status(0).bits, kStatusOk);
  world.SetNodeForce(0, 3, {});
  world.ClearStatus(0);
  EXPECT_EQ(world.Status(0).bits, kStatusOk);
  world.Step(1e-3, 50);
  healthy.Step(1e-3, 50);
  EXPECT_EQ(world.Status(0).bits, kStatusOk);
  // Without the impulses for the warm start, the motion is the same, but not its bits.
  EXPECT_LE(Distance(world.Body(0, 0).position_m, healthy.Body(0, 0).position_m), 1e-5);
}

TEST(Status, ASolveThatIsCutShortSaysSoAndNamesABodyInContact) {
  WorldBatchOptions options;
  options.max_linear_solves = 1;
  ModelDef def;
  const Material material{0.5, 0.5, 0};
  scenes::AddGround(def, material);
  // One sweep does not propagate a weight through four contacts. The gaps avoid position
  // projection.
  const double gap_m = 1e-9;
  for (int i = 0; i < 4; ++i) {
    scenes::AddBall(def, "ball", 0.1, 0.1, {0, 0, 0.1 + gap_m + (0.2 + gap_m) * i}, material);
  }
  WorldBatch hasty = MakeBatch(def, options);
  hasty.Step(1e-3);
  EXPECT_EQ(hasty.Status(0).bits, kStatusNotConverged);
  EXPECT_EQ(hasty.Status(0).first_time_s, 0);
  EXPECT_EQ(hasty.Status(0).linear_solves, 1);
  EXPECT_GT(hasty.Status(0).residual_m_per_s, options.tolerance_m_per_s);
  EXPECT_GE(hasty.Status(0).body, 0);
  EXPECT_LT(hasty.Status(0).body, 4);
  hasty.ClearStatus(0);
  EXPECT_EQ(hasty.Status(0).bits, kStatusOk);

  WorldBatch thorough = MakeBatch(def);
  thorough.Step(1e-3, 100);
  EXPECT_EQ(thorough.Status(0).bits, kStatusOk);
  EXPECT_LE(thorough.Status(0).residual_m_per_s, options.tolerance_m_per_s);
}

TEST(Status, ATurnTooFastForItsQuaternionHaltsTheWorldInTheSameStep) {
  // The square of the rotation quaternion overflows before any number of the state does.
  ModelDef def;
  scenes::AddBall(def, "ball", 0.1, 0.1, {0, 0, 1}, {});
  def.bodies[0].inertia_kg_m2 = scenes::BoxInertia(0.1, {0.1, 0.2, 0.25});
  def.nodes.push_back({"node", 0, {0.1, 0.05, 1.02}});
  int halted = 0;
  for (int i = 0; i < 400; ++i) {
    WorldBatch world = MakeBatch(def);
    world.SetNodeForce(0, 1, std::pow(10, 15 + 0.1 * i) * Vec3{0.1, 0.5, 1});
    world.Step(1e-3);
    const Quat q = world.Body(0, 0).orientation;
    EXPECT_NEAR(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z, 1, 1e-12) << i;
    halted += world.Status(0).bits == kStatusNonFinite;
  }
  EXPECT_GT(halted, 0);
  EXPECT_LT(halted, 400);
}

TEST(Status, PushingOutCountsAsWorkOfItsOwn) {
  // The same column with overlaps of 1 mm: one linear system for velocities, one for displacements.
  WorldBatchOptions options;
  options.max_linear_solves = 1;
  ModelDef def;
  const Material material{0.5, 0.5, 0};
  scenes::AddGround(def, material);
  for (int i = 0; i < 4; ++i) {
    scenes::AddBall(def, "ball", 0.1, 0.1, {0, 0, 0.099 + 0.199 * i}, material);
  }
  WorldBatch hasty = MakeBatch(def, options);
  hasty.Step(1e-3);
  EXPECT_EQ(hasty.Status(0).linear_solves, 2);
}

TEST(Status, MoreContactsThanRoomAreSaidAndTheOthersStillHold) {
  // A body of 60 balls on a moving box: more contacts than a model of two bodies has room for.
  ModelDef def;
  const Material material{0.5, 0.5, 0};
  scenes::AddGround(def, material);
  const Vec3 half{2, 2, 0.5};
  BodyDef table;
  table.name = "table";
  table.mass_kg = 1000;
  table.com_m = {0, 0, 0.5};
  table.inertia_kg_m2 = scenes::BoxInertia(1000, half);
  def.bodies.push_back(table);
  def.boxes.push_back({"table", 0, table.com_m, {}, half, material});
  scenes::Parts parts;
  for (int i = 0; i < 60; ++i) {
    const Vec3 p{0.1 * (i % 10), 0.1 * (i / 10), 1.02};
    parts.AddSphere(0.01, p, 0.02);
    def.spheres.push_back({"ball", 1, p, 0.02, material});
  }
  def.bodies.push_back(parts.Body("carpet"));
  WorldBatch world = MakeBatch(def);
  world.Step(1e-3, 100);
  EXPECT_EQ(world.Status(0).bits & kStatusContactOverflow, kStatusContactOverflow);
  EXPECT_LT(world.Contacts(0).size(), 60u);
  EXPECT_GE(world.Contacts(0).size(), 3u);
  EXPECT_TRUE(Finite(world, 0, 0));
}

}  // namespace
}  // namespace taut::test
