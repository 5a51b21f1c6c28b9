// Axial force in struts, against closed forms and against Newton's law for the other half
// (docs/theory/loads.md)
#include <cmath>

#include "taut/statics.h"
#include "tests/constants.h"
#include "tests/scenes/ball.h"
#include "tests/scenes/rod.h"
#include "unit/plant/recorder_fixture.h"

namespace taut::test {
namespace {

/// A rod of 0.3 kg and 0.4 m with balls at its ends, through `middle_m` along `along`
ModelDef Rod(const Vec3& middle_m, const Vec3& along, double start_kg = 0, double end_kg = 0) {
  ModelDef def;
  def.name = "rod";
  const Vec3 from = middle_m - 0.2 * along, to = middle_m + 0.2 * along;
  scenes::Parts parts;
  parts.AddCylinder(0.3, from, to, 0.01);
  if (start_kg > 0) parts.AddSphere(start_kg, from, 0.02);
  if (end_kg > 0) parts.AddSphere(end_kg, to, 0.015);
  def.bodies.push_back(parts.Body("rod"));
  def.capsules.push_back({"rod", 0, from, to, 0.01, {}});
  def.nodes.push_back({"rod.from", 0, from});
  def.nodes.push_back({"rod.to", 0, to});
  return def;
}

Recording Record(const ModelDef& def, double duration_s = 0) {
  return Recording(RecordedExperiment(def, duration_s, {"*"}, 8));
}

TEST(RecordedStrut, AHangingRodIsPulledByTheWeightOfItsLowerHalf) {
  for (const double ends_kg : {0.0, 0.1}) {
    ModelDef def = Rod({0, 0, 1}, {0, 0, 1}, ends_kg, ends_kg);
    const double mass_kg = 0.3 + 2 * ends_kg;
    def.cables.push_back(
        SoftCable("cable", {{kWorld, {0, 0, 2}}, {0, {0, 0, 1.2}}}, 1e3, 0.8 - mass_kg * kG / 1e3));
    const Recording run = Record(def, 0.01);
    EXPECT_NEAR(run.At("strut/rod/axial_n", 0), 0.5 * mass_kg * kG, 1e-9);
    EXPECT_NEAR(run.Last("strut/rod/axial_n"), 0.5 * mass_kg * kG, 1e-6);
  }
}

TEST(RecordedStrut, AStandingRodIsPressedByTheWeightOfItsUpperHalf) {
  ModelDef def = Rod({0, 0, 0.21}, {0, 0, 1});
  scenes::AddGround(def, {});
  EXPECT_NEAR(Record(def, 0.02).Last("strut/rod/axial_n"), -0.15 * kG, 1e-7);
}

TEST(RecordedStrut, AFallingRodCarriesNothing) {
  const Recording run = Record(Rod({0, 0, 1}, {0, 0, 1}), 0.1);
  EXPECT_EQ(run.Last("strut/rod/axial_n"), 0.0);
}

TEST(RecordedStrut, ARodBetweenTwoCablesCarriesTheirTension) {
  ModelDef def = Rod({0, 0, 0}, {0.6, 0, 0.8});
  def.gravity_m_per_s2 = {};
  def.cables.push_back(
      SoftCable("low", {{kWorld, {-0.6, 0, -0.8}}, {0, {-0.12, 0, -0.16}}}, 50, 0.5));
  def.cables.push_back(SoftCable("high", {{0, {0.12, 0, 0.16}}, {kWorld, {0.6, 0, 0.8}}}, 50, 0.5));
  const Recording run = Record(def);
  EXPECT_NEAR(run.At("cable/low/tension_n", 0), 15, 1e-12);
  EXPECT_NEAR(run.At("strut/rod/axial_n", 0), 15, 1e-12);
}

/// Mass of one half times w^2 times the distance of its center of mass from the common one.
TEST(RecordedStrut, ASpinningRodIsPulledByItsHalves) {
  for (const auto& [start_kg, end_kg] :
       {std::pair(0.0, 0.0), {0.1, 0.1}, {0.05, 0.2}, {0.1, 0.0}}) {
    ModelDef def = Rod({0.3, 0.2, 0.1}, {0, 0.6, 0.8}, start_kg, end_kg);
    def.gravity_m_per_s2 = {};
    // 7 rad/s perpendicular to the rod; spin about its axis causes no axial force.
    def.bodies[0].angular_velocity_rad_per_s = {7, 3 * 0.6, 3 * 0.8};
    const double mass_kg = 0.3 + start_kg + end_kg;
    const double center_m = 0.2 * (end_kg - start_kg) / mass_kg;
    const double upper_kg = 0.15 + end_kg;
    const double upper_m = (0.15 * 0.1 + end_kg * 0.2) / upper_kg - center_m;
    const Recording run = Record(def, 0.05);
    EXPECT_NEAR(run.At("strut/rod/axial_n", 0), upper_kg * 49 * upper_m, 1e-10) << end_kg;
    EXPECT_NEAR(run.Last("strut/rod/axial_n"), upper_kg * 49 * upper_m, 1e-9) << end_kg;
    if (start_kg == 0 && end_kg == 0) {
      EXPECT_NEAR(run.Last("strut/rod/axial_n"), 0.3 * 49 * 0.4 / 8, 1e-9);  // m w^2 l / 8
    }
  }
}

TEST(RecordedStrut, AFactorOnItsMassCounts) {
  ModelDef def = Rod({}, {1, 0, 0});
  def.gravity_m_per_s2 = {};
  def.bodies[0].angular_velocity_rad_per_s = {0, 0, 7};
  ExperimentSpec experiment = RecordedExperiment(def, 0, {"strut/*"});
  experiment.scales.push_back({ScaleSpec::Quantity::kMass, {}, 2.0});
  EXPECT_NEAR(Recording(experiment).At("strut/rod/axial_n", 0), 2 * 0.3 * 49 * 0.4 / 8, 1e-12);
}

/// The support pulls one half down and the other up: the recorded force is the mean of both sides
/// of the node.
TEST(RecordedStrut, AForceInTheMiddleBelongsToBothHalves) {
  ModelDef def = Rod({0, 0, 1}, {0, 0, 1});
  def.nodes.push_back({"middle", 0, {0, 0, 1}});
  def.cables.push_back(
      SoftCable("cable", {{kWorld, {0, 0, 2}}, {0, {0, 0, 1}}}, 1e3, 1 - 0.3 * kG / 1e3));
  EXPECT_NEAR(Record(def).At("strut/rod/axial_n", 0), 0, 1e-12);
}

/// In self-stress the force per length of a strut is minus the value of a side cable, and the cable
/// forces from statics balance at each end.
TEST(RecordedStrut, ThePrismsSelfStressIsThatOfStatics) {
  Diagnostics out;
  const auto robot = LoadRobot(TAUT_SOURCE_DIR "/share/models/prism3.yaml", {}, out);
  ASSERT_TRUE(robot) << out.Format();
  ExperimentSpec experiment = RecordedExperiment(robot->def, 0, {"strut/*"});
  experiment.robot = *robot;
  experiment.robot.def.gravity_m_per_s2 = {};
  const ModelDef& def = experiment.robot.def;
  const Recording run(experiment);
  ASSERT_EQ(run.trace.channels.size(), 9u);
  double per_length = 0;
  for (const CableDef& cable : def.cables) {
    if (cable.name.find("side") != std::string::npos) {
      per_length = CableTension(cable) / CableLength(cable);
    }
  }
  ASSERT_GT(per_length, 0);
  for (std::size_t b = 0; b < 3; ++b) {
    const Vec3 d = def.capsules[b].to_m - def.capsules[b].from_m;
    const double pressed_n = per_length * std::sqrt(Dot(d, d));
    EXPECT_NEAR(run.trace.values[3 * b][0], -pressed_n, 1e-9);      // in the middle
    EXPECT_NEAR(run.trace.values[3 * b + 1][0], -pressed_n, 1e-9);  // least,
    EXPECT_NEAR(run.trace.values[3 * b + 2][0], -pressed_n, 1e-9);  // and greatest
    EXPECT_NEAR(Dot(StartLoads(def)[b].cable_force_n, d), 0, 1e-9);
  }
}

/// Newton's law for the half of the rod that the channel does not use, from the other channels of
/// the row: its acceleration follows from the forces on the whole rod and from its rotation.
class OtherHalf {
 public:
  OtherHalf(const Recording& run, std::size_t row, double start_kg, double end_kg) {
    along_ = Rotate(run.OrientationAt("rod", row), {0, 0.6, 0.8});
    const Vec3 from = run.VectorAt("node/rod.from/position_", "_m", row);
    const Vec3 to = run.VectorAt("node/rod.to/position_", "_m", row);
    middle_ = 0.5 * (from + to);
    const double mass_kg = 0.3 + start_kg + end_kg;
    const Vec3 center = middle_ + (0.2 * (end_kg - start_kg) / mass_kg) * along_;
    const auto add = [&](const Vec3& point, const Vec3& force) {
      force_ = force_ + force;
      if (Dot(point - middle_, along_) < 0) on_lower_ = on_lower_ + force;
    };
    const Vec3 up = Vec3{0.3, 0, 1.5} - to;
    add(to, (run.At("cable/up/tension_n", row) / std::sqrt(Dot(up, up))) * up);
    const Vec3 side = Vec3{-1, 0, 0.3} - from;
    add(from, (run.At("cable/side/tension_n", row) / std::sqrt(Dot(side, side))) * side);
    if (row > 0) add(to, run.At("push/tap/force_n", row) * Vec3{1, 0, 0});
    for (int k = 0; k < 8; ++k) {
      const std::string contact = "contact/" + std::to_string(k) + "/";
      if (std::isnan(run.At(contact + "body_a", row))) continue;
      touches = true;
      add(run.VectorAt(contact + "point_", "_m", row), run.VectorAt(contact + "force_", "_n", row));
    }
    const Vec3 weight{0, 0, -kG};
    acceleration = (1 / mass_kg) * force_ + weight;
    const double lower_kg = 0.15 + start_kg;
    const double lower_m = -(0.15 * 0.1 + start_kg * 0.2) / lower_kg;
    const Vec3 arm = middle_ + lower_m * along_ - center;
    const Vec3 w = run.VectorAt("body/rod/angular_velocity_", "_rad_per_s", row);
    // Contributions of torques to this are perpendicular to the rod.
    const Vec3 of_lower = acceleration + Cross(w, Cross(w, arm));
    const Vec3 rest = on_lower_ + lower_kg * weight - lower_kg * of_lower;
    axial_n = -Dot(rest, along_);  // the upper half pulls on the lower half with + axial
  }
  double axial_n = 0;
  bool touches = false;
  Vec3 acceleration;

 private:
  Vec3 along_, middle_, force_, on_lower_;
};

TEST(RecordedStrut, InMotionBothHalvesSayTheSame) {
  const double start_kg = 0.05, end_kg = 0.12;
  ModelDef def = Rod({0, 0, 0.4}, {0, 0.6, 0.8}, start_kg, end_kg);
  scenes::AddGround(def, {0.6, 0.6, 0.3});
  const Vec3 from = def.capsules[0].from_m, to = def.capsules[0].to_m;
  def.spheres.push_back({"ball", 0, from, 0.02, {0.6, 0.6, 0.3}});
  def.cables.push_back(SoftCable("up", {{0, to}, {kWorld, {0.3, 0, 1.5}}}, 5, 0.4));
  def.cables.push_back(SoftCable("side", {{kWorld, {-1, 0, 0.3}}, {0, from}}, 8, 0.7));
  def.bodies[0].angular_velocity_rad_per_s = {3, -4, 5};
  def.bodies[0].velocity_m_per_s = {0.5, 0.2, -1};
  ExperimentSpec experiment = RecordedExperiment(def, 1, {"*"}, 8);
  experiment.pushes.push_back({"tap", 1, {1, 0, 0}, 1, {{0.1, 0}, {0.2, 4}, {0.6, 0}}});
  const Recording run(experiment);
  int touching = 0;
  double largest_n = 0;
  for (std::size_t row = 0; row < run.rows(); ++row) {
    const OtherHalf other(run, row, start_kg, end_kg);
    const double axial_n = run.At("strut/rod/axial_n", row);
    ASSERT_NEAR(axial_n, other.axial_n, 1e-9 * std::max(1.0, std::fabs(axial_n)))
        << run.trace.time_s[row];
    touching += other.touches;
    largest_n = std::max(largest_n, std::fabs(axial_n));
  }
  EXPECT_GT(touching, 3);
  EXPECT_GT(largest_n, 50) << "it should have fallen onto its end";
}

/// The force is computed with the acceleration of the step, also in the step of an impact.
TEST(RecordedStrut, TheAccelerationIsThatOfTheStep) {
  ModelDef def = Rod({0, 0, 0.4}, {0, 0.6, 0.8});
  scenes::AddGround(def, {0.6, 0.6, 0.3});
  def.cables.push_back(SoftCable("up", {{0, {0, 0.12, 0.56}}, {kWorld, {0.3, 0, 1.5}}}, 1, 100));
  def.cables.push_back(SoftCable("side", {{kWorld, {-1, 0, 0.3}}, {0, {0, 0, 0}}}, 1, 100));
  ExperimentSpec experiment = RecordedExperiment(def, 0.5, {"*"}, 8);
  experiment.pushes.push_back({"tap", 1, {1, 0, 0}, 1, {{0.1, 0}, {0.2, 4}, {0.6, 0}}});
  const Recording run(experiment);
  double largest = 0;
  for (std::size_t row = 1; row < run.rows(); ++row) {
    const double step_s = run.trace.time_s[row] - run.trace.time_s[row - 1];
    const Vec3 change = run.VectorAt("body/rod/velocity_", "_m_per_s", row) -
                        run.VectorAt("body/rod/velocity_", "_m_per_s", row - 1);
    const OtherHalf other(run, row, 0, 0);
    ExpectNear((1 / step_s) * change, other.acceleration, 1e-8, std::to_string(row));
    largest = std::max(largest, other.acceleration.z);
  }
  EXPECT_GT(largest, 500) << "an impact";
}

/// A rod that hangs on a ball joint from the beam: the joint pulls at its end, and at the beam.
TEST(RecordedStrut, AJointPullsAtIt) {
  ModelDef def = Rod({0, 0, 0.8}, {0, 0, -1});  // its start is up
  def.bodies.push_back(BodyDef{});
  BodyDef& beam = def.bodies.back();
  beam.name = "beam", beam.mass_kg = 2, beam.com_m = {0, 0, 1.1}, beam.fixed = true;
  JointDef pin;
  pin.name = "pin", pin.kind = JointKind::kBall, pin.body_a = 1, pin.body_b = 0;
  pin.from_m = pin.to_m = {0, 0, 1};
  def.joints.push_back(pin);
  const Recording run(RecordedExperiment(def, 0.05, {"*"}));
  EXPECT_NEAR(run.Last("strut/rod/axial_n"), 0.15 * kG, 1e-6);
  EXPECT_NEAR(run.Last("strut/rod/axial_greatest_n"), 0.3 * kG, 1e-6);
  EXPECT_NEAR(run.Last("strut/rod/axial_least_n"), 0, 1e-9);
  EXPECT_NEAR(run.Last("anchor/beam/force_z_n"), 2.3 * kG, 1e-6);
}

/// The summary contains the extremes of all rows of a run that records every step.
TEST(RecordedStrut, TheSummaryHasTheExtremesOfTheRun) {
  ModelDef def = Rod({0, 0, 0.4}, {0, 0.6, 0.8}, 0.05, 0.12);
  scenes::AddGround(def, {0.6, 0.6, 0.3});
  def.bodies[0].angular_velocity_rad_per_s = {3, -4, 5};
  BodyDef beam;
  beam.name = "beam", beam.mass_kg = 2, beam.com_m = {0, 0, 1.5}, beam.fixed = true;
  def.bodies.push_back(beam);
  def.cables.push_back(SoftCable("up", {{0, def.capsules[0].to_m}, {1, {0, 0, 1.5}}}, 5, 0.4));
  const Recording run(RecordedExperiment(def, 0.5, {"*"}));
  double least = 0, greatest = 0, held = 0;
  for (std::size_t row = 0; row < run.rows(); ++row) {
    least = std::min(least, run.At("strut/rod/axial_least_n", row));
    greatest = std::max(greatest, run.At("strut/rod/axial_greatest_n", row));
    const Vec3 force = run.VectorAt("anchor/beam/force_", "_n", row);
    held = std::max(held, std::sqrt(Dot(force, force)));
    EXPECT_LE(run.At("strut/rod/axial_least_n", row), run.At("strut/rod/axial_n", row) + 1e-12);
    EXPECT_GE(run.At("strut/rod/axial_greatest_n", row), run.At("strut/rod/axial_n", row) - 1e-12);
  }
  ASSERT_EQ(run.summary.struts.size(), 1u);
  EXPECT_EQ(run.summary.struts[0].name, "rod");
  EXPECT_EQ(run.summary.struts[0].least_n, least);
  EXPECT_EQ(run.summary.struts[0].greatest_n, greatest);
  EXPECT_LT(least, -10);
  EXPECT_GT(greatest, 1);
  ASSERT_EQ(run.summary.anchors.size(), 1u);
  EXPECT_EQ(run.summary.anchors[0].max_force_n, held);
}

TEST(RecordedStrut, OnlyBodiesThatAreOneRodHaveTheChannel) {
  const auto has = [](const ModelDef& def) {
    return Recording(RecordedExperiment(def, 0, {"*"})).Has("strut/rod/axial_n");
  };
  const ModelDef rod = Rod({}, {0, 0.6, 0.8}, 0.1, 0.2);
  ModelDef changed = rod;
  EXPECT_TRUE(has(rod));
  changed.bodies[0].fixed = true;
  EXPECT_FALSE(has(changed));
  changed = rod;
  changed.capsules.push_back(changed.capsules[0]);
  changed.capsules[1].name = "second";
  EXPECT_FALSE(has(changed));
  changed = rod;
  changed.spheres.push_back({"ball", 0, {0, 0, 0}, 0.02, {}});
  EXPECT_FALSE(has(changed));
  changed = rod;
  changed.boxes.push_back({"box", 0, {0, 0, 0}, {}, {0.01, 0.01, 0.01}, {}});
  EXPECT_FALSE(has(changed));
  changed = rod;  // another node, whose mass may be anywhere
  changed.nodes.push_back({"middle", 0, {0, 0, 0}});
  EXPECT_FALSE(has(changed));
  changed = rod;  // inertia of another shape
  changed.bodies[0].inertia_kg_m2.xx *= 1.01;
  EXPECT_FALSE(has(changed));
  changed = Rod({}, {0, 0.6, 0.8});
  changed.bodies[0].com_m.x += 0.01;
  EXPECT_FALSE(has(changed));
}

}  // namespace
}  // namespace taut::test
