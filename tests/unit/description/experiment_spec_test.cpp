// Experiment files: values read
#include <cmath>
#include <map>

#include "math/vec.h"
#include "taut/run.h"
#include "unit/description/experiment_fixture.h"

namespace taut::test {
namespace {

using Points = std::vector<std::pair<double, double>>;
class ExperimentReading : public ExperimentFolder {};

std::string Shipped(const std::string& name) {
  return std::string(TAUT_SOURCE_DIR) + "/share/experiments/" + name + ".yaml";
}

ExperimentSpec LoadShipped(const std::string& name, const Overrides& overrides = {}) {
  Diagnostics out;
  const auto experiment = LoadExperiment(Shipped(name), overrides, out);
  EXPECT_TRUE(experiment) << out.Format();
  return experiment.value_or(ExperimentSpec{});
}

std::map<std::string, ImpedanceGains> GainsByCable(const ExperimentSpec& experiment) {
  std::map<std::string, ImpedanceGains> gains;
  for (const ImpedanceGains& g : experiment.controllers.at(0).impedance->cables) {
    gains[experiment.robot.def.cables.at(static_cast<std::size_t>(g.cable)).name] = g;
  }
  return gains;
}

void ExpectGains(const ImpedanceGains& gains, double tension_n, double length_m, double k,
                 double b) {
  EXPECT_EQ(gains.tension_offset_n, tension_n);
  EXPECT_EQ(gains.length_offset_m, length_m);
  EXPECT_EQ(gains.position_gain_n_per_m, k);
  EXPECT_EQ(gains.velocity_gain_n_s_per_m, b);
  EXPECT_EQ(gains.velocity_offset_m_per_s, 0.0);
}

void ExpectVector(const Vec3& v, double x, double y, double z, double tolerance = 1e-15) {
  EXPECT_NEAR(v.x, x, tolerance);
  EXPECT_NEAR(v.y, y, tolerance);
  EXPECT_NEAR(v.z, z, tolerance);
}

TEST(ShippedExperiments, ThePushHasTwelveGainsThreePushesAndThreePhases) {
  const ExperimentSpec push = LoadShipped("push_20n");
  EXPECT_EQ(push.name, "push_20n");
  EXPECT_EQ(push.step_s, 0.001);
  EXPECT_EQ(push.duration_s, 60.0);
  EXPECT_EQ(push.record.rate_hz, 100.0);
  ASSERT_EQ(push.controllers.size(), 1u);
  EXPECT_EQ(push.controllers[0].clock.period_s, 0.001);
  const auto gains = GainsByCable(push);
  ASSERT_EQ(gains.size(), 12u);
  ExpectGains(gains.at("inner_top_1"), 28, 0.190, 500, 150);
  ExpectGains(gains.at("inner_top_2"), 10, 0.180, 500, 150);
  ExpectGains(gains.at("inner_left_1"), 15, 0.215, 100, 100);
  ExpectGains(gains.at("inner_left_2"), 10, 0.225, 100, 100);
  ExpectGains(gains.at("inner_right_1"), 18, 0.215, 100, 100);
  ExpectGains(gains.at("inner_right_2"), 8, 0.225, 100, 100);
  ExpectGains(gains.at("outer_top_1"), 15, 0.185, 500, 150);
  ExpectGains(gains.at("outer_top_2"), 6, 0.198, 500, 150);
  ExpectGains(gains.at("outer_left_1"), 11, 0.192, 100, 100);
  ExpectGains(gains.at("outer_left_2"), 8, 0.188, 100, 100);
  ExpectGains(gains.at("outer_right_1"), 10, 0.193, 100, 100);
  ExpectGains(gains.at("outer_right_2"), 4, 0.192, 100, 100);

  ASSERT_EQ(push.pushes.size(), 3u);
  const double push_n = 2.3 * 9.81;
  EXPECT_EQ(push.pushes[0].force_n, (Points{{30, 0}, {35, push_n}, {40, push_n}, {45, 0}}));
  double sum_n = 0;
  for (const PushSpec& p : push.pushes) sum_n += p.direction.x * p.force_n[1].second;
  EXPECT_NEAR(sum_n, 0.0, 1e-14);
  EXPECT_EQ(push.robot.def.nodes.at(static_cast<std::size_t>(push.pushes[2].node)).name,
            "segment_2.tip");

  ASSERT_EQ(push.phases.size(), 3u);
  EXPECT_EQ(push.phases[1].name, "during");
  EXPECT_EQ(push.phases[1].from_s, 35.0);
  EXPECT_EQ(push.phases[1].to_s, 40.0);
  ASSERT_EQ(push.robot.def.planes.size(), 1u);
  EXPECT_EQ(push.robot.def.planes[0].material.kinetic_friction, 0.5);
}

TEST(ShippedExperiments, TwelveSegmentsTakeTheSameControl) {
  const auto gains = GainsByCable(LoadShipped("push_20n", {{"segments", "12"}}));
  EXPECT_EQ(gains.size(), 66u);
  ExpectGains(gains.at("inner_top_1"), 28, 0.190, 500, 150);
  for (const char* number : {"2", "6", "11"}) {
    ExpectGains(gains.at(std::string("inner_top_") + number), 10, 0.180, 500, 150);
    ExpectGains(gains.at(std::string("outer_right_") + number), 4, 0.192, 100, 100);
  }
}

TEST(ShippedExperiments, TableOneChangesTheTopCablesDampingOnly) {
  const auto with_code = GainsByCable(LoadShipped("push_20n"));
  const ExperimentSpec table = LoadShipped("push_20n_table1");
  EXPECT_EQ(table.name, "push_20n_table1");
  EXPECT_EQ(table.duration_s, 60.0);
  for (const auto& [name, gains] : GainsByCable(table)) {
    const bool top = name.find("top") != std::string::npos;
    ExpectGains(gains, with_code.at(name).tension_offset_n, with_code.at(name).length_offset_m,
                top ? 500 : 100, 100);
  }
}

TEST(ShippedExperiments, NtrtsLawsAreOptions) {
  const ExperimentSpec ours = LoadShipped("push_20n"), ntrt = LoadShipped("push_20n_ntrt");
  EXPECT_EQ(ours.robot.def.friction_law, FrictionLaw::kCone);
  EXPECT_EQ(ntrt.robot.def.friction_law, FrictionLaw::kAlongSlip);
  EXPECT_EQ(ntrt.robot.def.friction_combine, CombineRule::kProduct);
  for (const CableDef& cable : ntrt.robot.def.cables) {
    EXPECT_EQ(cable.damping_law, DampingLaw::kClamped);
  }
  const ImpedanceSpec& control = *ntrt.controllers.at(0).impedance;
  EXPECT_TRUE(control.differenced_rate);
  EXPECT_TRUE(control.start_from_rest_length);
  EXPECT_FALSE(ours.controllers.at(0).impedance->differenced_rate);
  const auto gains = GainsByCable(ours);
  for (const auto& [name, same] : GainsByCable(ntrt)) {
    ExpectGains(gains.at(name), same.tension_offset_n, same.length_offset_m,
                same.position_gain_n_per_m, same.velocity_gain_n_s_per_m);
  }
  // The inertia that NTRT logs [kg cm^2], its axes (z, x, y) as taut's. NTRT rounds the height of
  // its tetrahedra to 32.90897 cm, a relative error of 1.4e-7.
  const Inertia& inertia = ntrt.robot.def.bodies.at(0).inertia_kg_m2;
  EXPECT_NEAR(inertia.xx, 156.19757e-4, 3e-9);
  EXPECT_NEAR(inertia.yy, 106.32264e-4, 3e-9);
  EXPECT_NEAR(inertia.zz, 127.97549e-4, 3e-9);
  EXPECT_GT(ours.robot.def.bodies.at(0).inertia_kg_m2.xx, 1.5 * inertia.xx);
}

TEST_F(ExperimentReading, WhatAFileDoesNotSayHasADefault) {
  Write("least.yaml", "taut: 1\nkind: experiment\nname: least\nmodel: model.yaml\nduration_s: 0\n");
  const ExperimentSpec least = Load("least.yaml");
  EXPECT_EQ(least.duration_s, 0.0);
  EXPECT_EQ(least.step_s, 0.001);
  EXPECT_EQ(least.seed, 0u);
  EXPECT_EQ(least.start, StartKind::kAsDescribed);
  EXPECT_EQ(least.record.rate_hz, 100.0);
  EXPECT_TRUE(least.record.channels.empty());
  EXPECT_TRUE(least.controllers.empty());
  EXPECT_TRUE(least.robot.def.planes.empty());
  EXPECT_FALSE(least.compare_with);
  EXPECT_EQ(least.robot.def.gravity_m_per_s2.z, -9.81);
  EXPECT_EQ(least.files, (std::vector<std::string>{Path("least.yaml"), Path("model.yaml")}));
}

TEST_F(ExperimentReading, OrdinaryKeysAreTaken) {
  Write("run.csv", "time_s\n0\n");
  Change("duration_s: 10",
         "duration_s: 10\nstep_s: 0.004\nseed: 7\nstart: settled_floating\ncompare_with: run.csv\n"
         "gravity_m_per_s2: [0, 0, -1.62]\ndescription: on the moon");
  const ExperimentSpec experiment = Load();
  EXPECT_EQ(experiment.step_s, 0.004);
  EXPECT_EQ(experiment.seed, 7u);
  EXPECT_EQ(experiment.start, StartKind::kSettledFloating);
  EXPECT_EQ(experiment.compare_with, Path("run.csv"));
  EXPECT_EQ(experiment.robot.def.gravity_m_per_s2.z, -1.62);
  EXPECT_EQ(experiment.description, "on the moon");
  ExpectVector(experiment.pushes.at(0).direction, 0, 0, 1);
}

TEST_F(ExperimentReading, ReferencesSayWhatOthersFound) {
  Change("record:",
         "reference:\n  - {source: a robot, cables_n: {right: 2 * push_n, left: 3}}\n"
         "  - {source: a book, quantity: elastic, statistic: min, phase: before, "
         "cables_n: {left: 1}}\nrecord:");
  const ExperimentSpec experiment = Load();
  ASSERT_EQ(experiment.references.size(), 2u);
  const ReferenceSpec& robot = experiment.references[0];
  EXPECT_EQ(robot.source, "a robot");
  EXPECT_EQ(robot.quantity, ReferenceSpec::Quantity::kTension);
  EXPECT_EQ(robot.statistic, ReferenceSpec::Statistic::kMax);
  EXPECT_EQ(robot.phase, "");
  ASSERT_EQ(robot.values.size(), 2u);
  EXPECT_EQ(experiment.robot.def.cables[robot.values[0].cable].name, "right");
  EXPECT_EQ(robot.values[0].force_n, 20);
  const ReferenceSpec& book = experiment.references[1];
  EXPECT_EQ(book.quantity, ReferenceSpec::Quantity::kElastic);
  EXPECT_EQ(book.statistic, ReferenceSpec::Statistic::kMin);
  EXPECT_EQ(book.phase, "before");
}

TEST_F(ExperimentReading, OverridesGoToTheExperimentFirstAndThenToTheModel) {
  Change("{push_n: 10}", "{push_n: 10, height_m: 2 * push_n}");
  const ExperimentSpec experiment =
      Load("trial.yaml", {{"height_m", "0.7"}, {"push_n", "5 + 1"}, {"stiffness_n_per_m", "300"}});
  EXPECT_EQ(experiment.parameters.at("height_m"), 0.7);
  EXPECT_EQ(experiment.parameters.at("push_n"), 6.0);
  EXPECT_EQ(experiment.pushes.at(0).force_n.at(1).second, 6.0);
  EXPECT_EQ(experiment.robot.parameters.at("height_m"),
            0.3);  // the override set the experiment's parameter
  EXPECT_EQ(experiment.robot.def.cables.at(0).stiffness_n_per_m, 300.0);
}

TEST_F(ExperimentReading, SetPassesNumbersToTheModelUnlessTheCommandLineDoes) {
  Change("duration_s: 10", "set: {stiffness_n_per_m: 20 * push_n, height_m: 0.4}\nduration_s: 10");
  const ExperimentSpec experiment = Load("trial.yaml", {{"height_m", "0.5"}});
  EXPECT_EQ(experiment.robot.def.cables.at(0).stiffness_n_per_m, 200.0);
  EXPECT_EQ(experiment.robot.def.nodes.at(2).position_m.z, 0.5);
}

TEST_F(ExperimentReading, ABaseGivesWhatTheFileLacks) {
  std::filesystem::create_directory(Path("variants"));
  Write("variants/soft.yaml",
        "taut: 1\nkind: experiment\nbase: ../trial.yaml\nname: soft\n"
        "parameters: {extra: 3}\nset: {height_m: 0.1 * extra}\nterrain: []\n");
  Write("variants/softer.yaml",
        "taut: 1\nkind: experiment\nbase: soft.yaml\nname: softer\n"
        "parameters: {push_n: 4}\nset: {stiffness_n_per_m: 50}\n");
  const ExperimentSpec softer = Load("variants/softer.yaml");
  EXPECT_EQ(softer.name, "softer");
  EXPECT_EQ(softer.duration_s, 10.0);
  EXPECT_EQ(softer.parameters.at("push_n"), 4.0);
  EXPECT_EQ(softer.pushes.at(0).force_n.at(1).second, 4.0);
  EXPECT_NEAR(softer.robot.parameters.at("height_m"), 0.3, 1e-15);  // `set` is merged by name;
  EXPECT_EQ(softer.robot.parameters.at("stiffness_n_per_m"), 50.0);
  EXPECT_TRUE(softer.robot.def.planes.empty());  // a list is replaced
  EXPECT_EQ(softer.files.size(), 4u);
}

TEST_F(ExperimentReading, TerrainLiesAsDescribed) {
  Change("{name: ground, plane: {height_m: 0, friction: 0.5}}",
         "{name: ground, plane: {height_m: 0.2, static_friction: 0.6, kinetic_friction: 0.4, "
         "restitution: 0.1}}\n"
         "  - {name: slope, plane: {slope_rad: pi / 6, slope_direction: [0, 3, 0], point_m: [1, 2, "
         "3]}}\n"
         "  - {name: wall, plane: {normal: [-2, 0, 0]}}\n"
         "  - {name: step, box: {center_m: [1, 0, 0], size_m: [2, 4, 6], friction: 0, rotate: "
         "{axis: z, angle_rad: pi / 2}}}");
  const ModelDef def = Load().robot.def;
  ASSERT_EQ(def.planes.size(), 3u);
  ExpectVector(def.planes[0].point_m, 0, 0, 0.2);
  EXPECT_EQ(def.planes[0].material.static_friction, 0.6);
  EXPECT_EQ(def.planes[0].material.kinetic_friction, 0.4);
  EXPECT_EQ(def.planes[0].material.restitution, 0.1);
  ExpectVector(def.planes[1].normal, 0, -0.5, std::sqrt(0.75));  // it rises toward +y
  ExpectVector(def.planes[1].point_m, 1, 2, 3);
  ExpectVector(def.planes[2].normal, -1, 0, 0);
  EXPECT_EQ(def.planes[2].material.kinetic_friction, 0.5);
  ASSERT_EQ(def.terrain_boxes.size(), 1u);
  ExpectVector(def.terrain_boxes[0].half_extents_m, 1, 2, 3);
  ExpectVector(Rotate(def.terrain_boxes[0].orientation, {1, 0, 0}), 0, 1, 0);
  EXPECT_EQ(def.terrain_boxes[0].material.static_friction, 0.0);
}

TEST_F(ExperimentReading, PlaceTurnsTheRobotAboutItsOriginThenMovesIt) {
  const ModelDef before = Load().robot.def;
  Change("duration_s: 10",
         "place: {at_m: [10, 20, 1], rotate: {axis: z, angle_rad: pi / 2}}\nduration_s: 10");
  const ModelDef after = Load().robot.def;
  const auto moved = [](const Vec3& p) { return Vec3{10 - p.y, 20 + p.x, 1 + p.z}; };
  for (std::size_t i = 0; i < before.nodes.size(); ++i) {
    const Vec3 p = moved(before.nodes[i].position_m);
    ExpectVector(after.nodes[i].position_m, p.x, p.y, p.z, 1e-14);
  }
  for (std::size_t i = 0; i < before.bodies.size(); ++i) {
    const Vec3 p = moved(before.bodies[i].com_m);
    ExpectVector(after.bodies[i].com_m, p.x, p.y, p.z, 1e-14);
    EXPECT_NEAR(after.bodies[i].inertia_kg_m2.xx, before.bodies[i].inertia_kg_m2.yy, 1e-16);
    EXPECT_NEAR(after.bodies[i].inertia_kg_m2.yy, before.bodies[i].inertia_kg_m2.xx, 1e-16);
    EXPECT_NEAR(after.bodies[i].inertia_kg_m2.zz, before.bodies[i].inertia_kg_m2.zz, 1e-16);
  }
  for (std::size_t i = 0; i < before.cables.size(); ++i) {
    const Vec3 p = moved(before.cables[i].attachments[1].position_m);
    ExpectVector(after.cables[i].attachments[1].position_m, p.x, p.y, p.z, 1e-14);
    EXPECT_EQ(after.cables[i].rest_length_m, before.cables[i].rest_length_m);
  }
  const Vec3 end = moved(before.capsules[0].to_m);
  ExpectVector(after.capsules[0].to_m, end.x, end.y, end.z, 1e-14);
  ExpectVector(after.planes[0].point_m, 0, 0, 0);
}

TEST_F(ExperimentReading, PlaceTurnsProductsOfInertia) {
  // A rod along x and one along y, rotated about x and then about z.
  Change("duration_s: 10",
         "place: {rotate: [{axis: x, angle_rad: 0.5}, {axis: z, angle_rad: 1}]}\nduration_s: 10");
  const BodyDef rod = Load().robot.def.bodies.at(0);
  const Vec3 u{std::cos(1.0), std::sin(1.0), 0};  // of the rod that was along x
  const Inertia& i = rod.inertia_kg_m2;
  const Vec3 along{i.xx * u.x + i.xy * u.y, i.xy * u.x + i.yy * u.y, i.xz * u.x + i.yz * u.y};
  const double spin = 0.5 * 1.0 * 0.01 * 0.01;  // m r^2 / 2: u is a principal axis with this moment
  ExpectVector(along, spin * u.x, spin * u.y, 0, 1e-16);
  EXPECT_NEAR(i.xx + i.yy + i.zz, spin + 2 * (1.0 / 12 + 0.25 * 0.01 * 0.01), 1e-15);
}

TEST_F(ExperimentReading, PlaceGivesTheWholeRobotOneMotion) {
  Change("duration_s: 10",
         "place: {velocity_m_per_s: [1, 2, 3], angular_velocity_rad_per_s: [2, 0, 0]}\nduration_s: "
         "10");
  const ModelDef def = Load().robot.def;
  ASSERT_EQ(def.bodies.size(), 2u);  // of equal mass, 0.2 m apart along z
  ExpectVector(def.bodies[0].velocity_m_per_s, 1, 2 + 0.2, 3);
  ExpectVector(def.bodies[1].velocity_m_per_s, 1, 2 - 0.2, 3);
  ExpectVector(def.bodies[0].angular_velocity_rad_per_s, 2, 0, 0);
}

TEST_F(ExperimentReading, PositionProgramsAreConstantsCoursesAndChanges) {
  std::string text = kExperiment;
  const std::size_t from = text.find("    impedance:"), to = text.find("timeline:");
  Write("trial.yaml",
        text.replace(from, to - from,
                     "    period_s: 0.02\n    phase_s: 0.01\n    position:\n      programs:\n"
                     "        - {cables: left, rest_length_m: [[1, 0.15], [3, 0.1]]}\n"
                     "        - {cables: right, change_m: 0.01}\n"));
  const ControllerSpec controller = Load().controllers.at(0);
  EXPECT_FALSE(controller.impedance);
  EXPECT_EQ(controller.clock.period_s, 0.02);
  EXPECT_EQ(controller.clock.phase_s, 0.01);
  ASSERT_EQ(controller.position.size(), 2u);
  EXPECT_EQ(controller.position[0].cable, 0);
  EXPECT_EQ(controller.position[0].rest_length_m, (Points{{1, 0.15}, {3, 0.1}}));
  EXPECT_EQ(controller.position[1].rest_length_m, (Points{{0, 0.15 + 0.01}}));
}

TEST_F(ExperimentReading, PidAndDifferencedRate) {
  Change("      gains:",
         "      conversion: pid\n      rate: differenced\n"
         "      pid: {proportional_m_per_s_n: 0.1, integral_m_per_s2_n: 0.2, derivative_m_per_n: "
         "0.3}\n"
         "      gains:");
  const ImpedanceSpec control = *Load().controllers.at(0).impedance;
  EXPECT_EQ(control.conversion, TensionConversion::kPid);
  EXPECT_EQ(control.pid.proportional_m_per_s_n, 0.1);
  EXPECT_EQ(control.pid.integral_m_per_s2_n, 0.2);
  EXPECT_EQ(control.pid.derivative_m_per_n, 0.3);
  EXPECT_TRUE(control.differenced_rate);
  EXPECT_FALSE(control.start_from_rest_length);
}

TEST_F(ExperimentReading, DragsAndScaledPushes) {
  Change("name: tap,", "name: tap, scale: -0.5,");
  EXPECT_EQ(Load().pushes.at(0).scale, -0.5);
  std::string text = kExperiment;
  Write("trial.yaml",
        text.replace(text.find("    - push:"), 0,
                     "    - drag: {name: scale, node: b1, velocity_m_per_s: [0.1, 0, 0], "
                     "stiffness_n_per_m: 100, damping_n_s_per_m: 2, from_s: 1, to_s: 12}\n"));
  const ExperimentSpec experiment = Load();
  ASSERT_EQ(experiment.drags.size(), 1u);
  const DragSpec& drag = experiment.drags[0];
  EXPECT_EQ(drag.name, "scale");
  EXPECT_EQ(drag.node, 3);
  ExpectVector(drag.velocity_m_per_s, 0.1, 0, 0);
  EXPECT_EQ(drag.stiffness_n_per_m, 100.0);
  EXPECT_EQ(drag.damping_n_s_per_m, 2.0);
  EXPECT_EQ(drag.from_s, 1.0);
  EXPECT_EQ(drag.to_s, 12.0);
}

}  // namespace
}  // namespace taut::test
