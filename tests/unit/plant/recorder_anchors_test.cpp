// Recorded reactions of anchored bodies: weights, tensions, contacts, and momentum balance
#include <cmath>

#include "tests/constants.h"
#include "tests/scenes/ball.h"
#include "unit/plant/recorder_fixture.h"

namespace taut::test {
namespace {

/// Adds a fixed box of 2 kg about `center_m`, with a node at its center.
void AddFixedBox(ModelDef& def, const std::string& name, const Vec3& center_m, const Vec3& half_m,
                 const Material& material = {}) {
  const int index = static_cast<int>(def.bodies.size());
  BodyDef body;
  body.name = name;
  body.mass_kg = 2;
  body.com_m = center_m;
  body.inertia_kg_m2 = scenes::BoxInertia(2, half_m);
  body.fixed = true;
  def.bodies.push_back(body);
  def.boxes.push_back({name, index, center_m, {}, half_m, material});
  def.nodes.push_back({name, index, center_m});
}

/// A ball of 0.5 kg on a cable from the end of a fixed beam
ModelDef Hanging(const Vec3& ball_m) {
  ModelDef def;
  def.name = "hanging";
  AddFixedBox(def, "beam", {0, 0, 2}, {0.5, 0.05, 0.05});
  scenes::AddBall(def, "ball", 0.5, 0.05, ball_m, {});
  def.cables.push_back(SoftCable("cable", {{0, {0.5, 0, 1.95}}, {1, ball_m}}, 400, 0.9));
  return def;
}

TEST(RecordedAnchor, CarriesWhatHangsFromIt) {
  ModelDef def = Hanging({0.5, 0, 1.05 - 0.5 * kG / 400});
  const Recording run(RecordedExperiment(def, 0.1, {"anchor/*"}));
  ASSERT_EQ(run.trace.channels.size(), 6u);
  for (const std::size_t row : {std::size_t{0}, run.rows() - 1}) {
    ExpectNear(run.VectorAt("anchor/beam/force_", "_n", row), {0, 0, 2.5 * kG}, 1e-9, "force");
    // The support holds the beam's end up: a torque from +x toward +z is about -y.
    ExpectNear(run.VectorAt("anchor/beam/torque_", "_n_m", row), {0, -0.5 * 0.5 * kG, 0}, 1e-9,
               "torque");
  }
}

TEST(RecordedAnchor, InMotionItHoldsAgainstTheTension) {
  const ModelDef def = Hanging({1.0, 0.3, 1.2});
  const Recording run(RecordedExperiment(def, 0.5, {"*"}));
  double furthest_n = 0;
  for (std::size_t row = 0; row < run.rows(); ++row) {
    const Vec3 from{0.5, 0, 1.95};
    const Vec3 to = run.VectorAt("node/ball/position_", "_m", row);
    const Vec3 d = to - from;
    const Vec3 pull = (run.At("cable/cable/tension_n", row) / std::sqrt(Dot(d, d))) * d;
    ExpectNear(run.VectorAt("anchor/beam/force_", "_n", row), Vec3{0, 0, 2 * kG} - pull, 1e-9,
               std::to_string(row));
    ExpectNear(run.VectorAt("anchor/beam/torque_", "_n_m", row),
               -1.0 * Cross(from - Vec3{0, 0, 2}, pull), 1e-9, std::to_string(row));
    furthest_n = std::max(furthest_n, std::fabs(pull.x));
  }
  EXPECT_GT(furthest_n, 1);
}

/// At a fixed eyelet a cable arrives horizontally and leaves downward: it pulls in both directions.
TEST(RecordedAnchor, ACablePullsAtAnEyeletBothWays) {
  ModelDef def;
  def.name = "eyelet";
  AddFixedBox(def, "eyelet", {0, 0, 2}, {0.05, 0.05, 0.05});
  scenes::AddBall(def, "ball", 0.5, 0.05, {0, 0, 1}, {});
  def.cables.push_back(
      SoftCable("cable", {{kWorld, {-1, 0, 2}}, {0, {0, 0, 2}}, {1, {0, 0, 1}}}, 100, 1.5));
  const Recording run(RecordedExperiment(def, 0, {"anchor/*", "cable/*"}));
  EXPECT_NEAR(run.At("cable/cable/tension_n", 0), 50, 1e-12);
  ExpectNear(run.VectorAt("anchor/eyelet/force_", "_n", 0), {50, 0, 50 + 2 * kG}, 1e-12, "");
}

TEST(RecordedAnchor, AForceOnItsNodeIsHeld) {
  ModelDef def;
  def.name = "pushed";
  AddFixedBox(def, "box", {0, 0, 2}, {0.05, 0.05, 0.05});
  def.nodes.push_back({"corner", 0, {0.05, 0, 2.05}});
  ExperimentSpec experiment = RecordedExperiment(def, 0.2, {"anchor/*"});
  experiment.pushes.push_back({"push", 1, {0, 1, 0}, 1, {{0, 3}, {1, 3}}});
  const Recording run(experiment);
  ExpectNear(run.VectorAt("anchor/box/force_", "_n", run.rows() - 1), {0, -3, 2 * kG}, 1e-12, "");
  ExpectNear(run.VectorAt("anchor/box/torque_", "_n_m", run.rows() - 1),
             -3.0 * Cross({0.05, 0, 0.05}, {0, 1, 0}), 1e-12, "");
}

/// A box of 1 kg on a fixed box, off center
ModelDef BoxOnTable(double gap_m, const Vec3& velocity_m_per_s) {
  ModelDef def;
  def.name = "table";
  const Material material{0.4, 0.4, 0.0};
  AddFixedBox(def, "table", {0, 0, 1}, {1, 1, 0.1}, material);
  BodyDef body;
  body.name = "box";
  body.mass_kg = 1;
  body.com_m = {0.5, 0.2, 1.15 + gap_m};
  body.inertia_kg_m2 = scenes::BoxInertia(1, {0.1, 0.1, 0.05});
  body.velocity_m_per_s = velocity_m_per_s;
  def.bodies.push_back(body);
  def.boxes.push_back({"box", 1, body.com_m, {}, {0.1, 0.1, 0.05}, material});
  return def;
}

TEST(RecordedAnchor, ATableCarriesWhatLiesOnIt) {
  const Recording run(RecordedExperiment(BoxOnTable(0, {}), 0.5, {"anchor/*", "system/*"}));
  const std::size_t last = run.rows() - 1;
  EXPECT_GE(run.At("system/contact_count", last), 3);
  ExpectNear(run.VectorAt("anchor/table/force_", "_n", last), {0, 0, 3 * kG}, 1e-6, "force");
  ExpectNear(run.VectorAt("anchor/table/torque_", "_n_m", last), {0.2 * kG, -0.5 * kG, 0}, 1e-6,
             "torque");
}

/// The change of the world's momentum over a step equals the impulse of gravity and the support.
TEST(RecordedAnchor, ActionIsReactionThroughImpactAndFriction) {
  const Recording run(RecordedExperiment(BoxOnTable(0.05, {2, -1, 0}), 0.4, {"*"}));
  double hardest_n = 0, friction_n = 0;
  for (std::size_t row = 1; row < run.rows(); ++row) {
    const double step_s = run.trace.time_s[row] - run.trace.time_s[row - 1];
    const Vec3 change = run.VectorAt("body/box/velocity_", "_m_per_s", row) -
                        run.VectorAt("body/box/velocity_", "_m_per_s", row - 1);
    const Vec3 support = run.VectorAt("anchor/table/force_", "_n", row);
    ExpectNear((1 / step_s) * change, support + Vec3{0, 0, -3 * kG}, 1e-8, std::to_string(row));
    hardest_n = std::max(hardest_n, support.z);
    friction_n = std::max(friction_n, std::fabs(support.x));
  }
  EXPECT_GT(hardest_n, 500) << "an impact";
  EXPECT_GT(friction_n, 3);
}

/// Rows hold the tension at their time: over a step the mean of two rows is accurate to second
/// order, so that half the step gives a quarter of the error.
TEST(RecordedAnchor, ActionIsReactionOfACableToSecondOrder) {
  double error_n[2] = {0, 0};
  for (int half = 0; half < 2; ++half) {
    ExperimentSpec experiment = RecordedExperiment(Hanging({0.9, 0.3, 1.2}), 0.4, {"*"});
    experiment.step_s = half == 0 ? 0.002 : 0.001;
    const Recording run(experiment);
    for (std::size_t row = 1; row < run.rows(); ++row) {
      const double step_s = run.trace.time_s[row] - run.trace.time_s[row - 1];
      const Vec3 change = run.VectorAt("body/ball/velocity_", "_m_per_s", row) -
                          run.VectorAt("body/ball/velocity_", "_m_per_s", row - 1);
      if (run.At("cable/cable/elastic_n", row) == 0 ||
          run.At("cable/cable/elastic_n", row - 1) == 0)
        continue;  // at a kink the order is lost
      const Vec3 support = 0.5 * (run.VectorAt("anchor/beam/force_", "_n", row) +
                                  run.VectorAt("anchor/beam/force_", "_n", row - 1));
      const Vec3 off = (0.5 / step_s) * change - support - Vec3{0, 0, -2.5 * kG};
      error_n[half] = std::max(error_n[half], std::sqrt(Dot(off, off)));
    }
  }
  EXPECT_GT(error_n[0], 1e-6);
  EXPECT_NEAR(error_n[0] / error_n[1], 4, 0.3);
}

TEST(RecordedAnchor, OnlyFixedBodiesHaveTheChannels) {
  const Recording run(RecordedExperiment(Hanging({0.5, 0, 1}), 0, {"*"}));
  EXPECT_TRUE(run.Has("anchor/beam/torque_z_n_m"));
  EXPECT_FALSE(run.Has("anchor/ball/force_x_n"));
  EXPECT_EQ(run.trace.channels[*run.trace.Find("anchor/beam/torque_z_n_m")].unit, "N m");
}

}  // namespace
}  // namespace taut::test
