/// Static equilibrium against closed forms and against settled simulations

#include <gtest/gtest.h>

#include <cmath>

#include "analysis/minimum.h"
#include "math/vec.h"
#include "taut/analysis.h"
#include "taut/world_batch.h"
#include "tests/scenes/rod.h"
#include "tests/unit/analysis/analysis_scenes.h"

namespace taut::test {
namespace {

/// Equation of half a rope: a point between two cables of rest length L and stiffness k, each with
/// a span of 1 m, sags by w under F: F = 2 k (l - L) w / l, l = sqrt(1 + w^2). Solved by bisection.
double Sag(double k, double rest, double force) {
  double low = 0, high = 1;
  for (int i = 0; i < 200; ++i) {
    const double w = 0.5 * (low + high), l = std::sqrt(1 + w * w);
    (2 * k * (l - rest) * w / l < force ? low : high) = w;
  }
  return low;
}

TEST(Equilibrium, ATightRopeSagsAsItsEquationSaysAtAnyMass) {
  const double ea = 100e9 * 50e-6, rest = ea / (ea + 20000);
  struct {
    double force_n, sag_m, tension_n;
  } const cases[] = {{5109, 0.0750685, 34124.7}, {9988, 0.1052325, 47718.9}};
  for (const auto& c : cases) {
    for (const double mass : {1e-6, 0.001, 1.0, 1000.0}) {
      ModelDef def = Rope(mass, ea / rest, rest);
      LoadCaseSpec loads;
      loads.weight = false;
      loads.forces.push_back({0, {0, 0, -c.force_n}});
      const Equilibrium e = FindEquilibrium(def, loads);
      ASSERT_TRUE(e.found) << e.why;
      EXPECT_EQ(e.way, EquilibriumWay::kNewton);
      EXPECT_NEAR(-e.pose.bodies[0].position_m.z, c.sag_m, 5e-8);
      EXPECT_NEAR(-e.pose.bodies[0].position_m.z, Sag(ea / rest, rest, c.force_n), 1e-12);
      EXPECT_NEAR(e.cable_tension_n[0], c.tension_n, 0.05);
    }
  }
}

// Aluminum prism of 3 m (Feron, Rhode-Barbarigos and Latteur, 2023): prestressed by lengthening the
// struts by 0.75 mm, under its largest load of 2.084 kN on each top node. Elastic struts and
// supports as built.
TEST(Equilibrium, TheT3PrismCarriesWhatItsTrussDoes) {
  constexpr double kMm = 1e-3;
  const Vec3 at[6] = {{0, -2.0438, 0},          {0, 0, 0},
                      {1.770, -1.0219, 0},      {0.590, -2.2019, 1.95},
                      {-0.4319, -0.4319, 1.95}, {1.6119, -0.4319, 1.95}};
  ModelDef def;
  for (int n = 0; n < 6; ++n) AddPoint(def, "n" + std::to_string(n), at[n], 1);
  def.bodies[1].fixed = true;
  AddJoint(def, JointKind::kLine, kWorld, at[0], 0, at[0], {0, 1, 0});
  AddJoint(def, JointKind::kPlane, kWorld, at[2], 2, at[2], {0, 0, 1});
  LoadCaseSpec loads;
  loads.weight = false;
  for (const auto& [a, b] : {std::pair{2, 4}, {1, 3}, {0, 5}}) {
    loads.bars.push_back({static_cast<int>(def.joints.size()), 0.75 * kMm});
    const double length = 2999.8 * kMm;
    // The strain refers to the set length: k = E A / (l + 0.75 mm).
    AddBar(def, a, at[a], b, at[b], 70390e6 * 364.4e-6 / (length + 0.75 * kMm), length);
  }
  const auto cable = [&](int a, int b, double young, double length) {
    AddCable(def, {{a, at[a]}, {b, at[b]}}, young * 50.3e-6 / length, length);
  };
  for (const auto& [a, b] : {std::pair{2, 5}, {1, 4}, {0, 3}}) cable(a, b, 72190e6, 2043.4 * kMm);
  for (const auto& [a, b] : {std::pair{4, 5}, {3, 4}, {3, 5}, {1, 2}, {0, 1}, {0, 2}}) {
    cable(a, b, 71750e6, 2043.8 * kMm);
  }
  for (int n = 0; n < 6; ++n) {
    loads.forces.push_back({n, {0, 0, n < 3 ? -45.7 : -41.6 - 2084.0}});
  }
  const Equilibrium e = FindEquilibrium(def, loads);
  ASSERT_TRUE(e.found) << e.why;
  EXPECT_EQ(e.way, EquilibriumWay::kNewton);
  for (std::size_t j = 2; j < 5; ++j) EXPECT_NEAR(e.bar_force_n[j], -10815.4, 0.5);
  // The vertical reactions of two of the three supports are below the whole load.
  const double held = e.joint_loads[0].force_n.z + e.joint_loads[1].force_n.z;
  EXPECT_LT(held, 3 * (45.7 + 41.6 + 2084));
  EXPECT_GT(held, 0);
}

TEST(Equilibrium, ARodOnABallAndACableIsWhatHandStaticsSays) {
  ModelDef def;  // a horizontal rod of 2 m and 3 kg, held at its end and by a vertical cable
  scenes::AddRod(def, "rod", 3, 0.01, {0, 0, 0}, {2, 0, 0}, {});
  AddJoint(def, JointKind::kBall, kWorld, {0, 0, 0}, 0, {0, 0, 0});
  const double half = 0.5 * 3 * 9.81;
  AddCable(def, {{0, {2, 0, 0}}, {kWorld, {2, 0, 1}}}, 1e3, 1 - half / 1e3);
  def.bodies[0].com_m = {1, 0, 0};
  const Equilibrium e = FindEquilibrium(def);
  ASSERT_TRUE(e.found) << e.why;
  EXPECT_NEAR(e.cable_tension_n[0], half, 1e-8);
  EXPECT_NEAR(e.joint_loads[0].force_n.z, half, 1e-8);
  EXPECT_NEAR(e.pose.bodies[0].position_m.z, 0, 1e-10);
}

TEST(Equilibrium, AHeldRodHangsWhereverItBegins) {
  for (const Vec3 end : {Vec3{0.8, 0, 0.1}, Vec3{0.1, 0, 0.8}, Vec3{0.3, -0.5, -0.5}}) {
    ModelDef def;
    scenes::AddRod(def, "rod", 2, 0.01, {0, 0, 0}, end, {});
    AddJoint(def, JointKind::kBall, kWorld, {0, 0, 0}, 0, {0, 0, 0});
    const Equilibrium e = FindEquilibrium(def);
    ASSERT_TRUE(e.found) << e.why;
    EXPECT_NEAR(e.pose.bodies[0].position_m.z, -0.5 * std::sqrt(Dot(end, end)), 1e-10);
    EXPECT_NEAR(e.joint_loads[0].force_n.z, 2 * 9.81, 1e-7);
  }
}

TEST(Equilibrium, SettlementsAndLongerMembersStrainWhatHoldsAgainstThem) {
  ModelDef def;  // a bar between two fixed points
  for (const double x : {0.0, 2.0}) {
    const int p = AddPoint(def, "p", {x, 0, 0}, 1);
    AddJoint(def, JointKind::kBall, kWorld, {x, 0, 0}, p, {x, 0, 0});
  }
  AddBar(def, 0, {0, 0, 0}, 1, {2, 0, 0}, 5e4, 2);
  AddCable(def, {{0, {0, 0, 0}}, {1, {2, 0, 0}}}, 1e3, 1.9);
  LoadCaseSpec loads;
  loads.weight = false;
  loads.settlements.push_back({1, {3e-3, 0, 0}});
  loads.bars.push_back({2, 1e-3});
  loads.cables.push_back({0, 0.2});
  const Equilibrium e = FindEquilibrium(def, loads);
  ASSERT_TRUE(e.found) << e.why;
  EXPECT_NEAR(e.bar_force_n[2], 5e4 * 2e-3, 1e-7);
  EXPECT_NEAR(e.joint_loads[1].force_n.x, 5e4 * 2e-3, 1e-7);
  EXPECT_EQ(e.cable_tension_n[0], 0);
  EXPECT_NEAR(e.pose.rest_lengths_m[0], 2.1, 1e-15);
}

TEST(Equilibrium, ARodThatFallsLiesOnThePlaneWithHalfItsWeightAtEachEnd) {
  ModelDef def;
  scenes::AddRod(def, "rod", 2, 0.01, {0, 0, 0.3}, {0.4, 0.1, 0.9}, {});
  def.planes.push_back({"ground", {0, 0, 1}, {0, 0, 0}, {}});
  const Equilibrium e = FindEquilibrium(def);
  ASSERT_TRUE(e.found) << e.why;
  ASSERT_EQ(e.contacts.size(), 2U);
  for (const ContactState& c : e.contacts) {
    EXPECT_NEAR(c.force_n.z, 9.81, 1e-7);
    EXPECT_NEAR(c.point_m.z, 0, 1e-10);
    EXPECT_EQ(c.body_a, 0);
  }
  EXPECT_NEAR(e.pose.bodies[0].position_m.z, 0.01, 1e-10);
}

// Compared with a simulated prism without friction, brought to rest
TEST(Equilibrium, WhatStandsOnAPlaneStandsAsItSettlesInASimulation) {
  Diagnostics out;
  auto robot = LoadRobot(TAUT_SOURCE_DIR "/share/models/prism3.yaml", {}, out);
  ASSERT_TRUE(robot.has_value()) << out.Format();
  ModelDef& def = robot->def;
  def.planes.push_back({"ground", {0, 0, 1}, {0, 0, 0}, {}});
  def.planes[0].material.static_friction = def.planes[0].material.kinetic_friction = 0;
  for (CapsuleDef& rod : def.capsules) {
    rod.material.static_friction = rod.material.kinetic_friction = 0;
  }
  const Equilibrium e = FindEquilibrium(def);
  ASSERT_TRUE(e.found) << e.why;
  double pushes = 0;
  for (const ContactState& c : e.contacts) pushes += c.force_n.z;
  EXPECT_NEAR(pushes, 9.81 * TotalMass(def), 1e-7);

  WorldBatch world(Model::Compile(def, out), {});
  ASSERT_TRUE(Settle(world, 0, 1e-3));
  for (int c = 0; c < static_cast<int>(def.cables.size()); ++c) {
    EXPECT_NEAR(world.Cable(0, c).elastic_n, e.cable_tension_n[static_cast<std::size_t>(c)], 1e-5);
  }
  for (int b = 0; b < 3; ++b) {
    EXPECT_NEAR(world.Body(0, b).position_m.z,
                e.pose.bodies[static_cast<std::size_t>(b)].position_m.z, 1e-7);
  }
}

TEST(Equilibrium, WhatIsInTheAirAndAslantIsPutDownAndTipsUntilItStandsAsUpright) {
  Diagnostics out;
  const auto aslant = LoadExperiment(TAUT_SOURCE_DIR "/examples/my_first_experiment.yaml", {}, out);
  auto upright = LoadRobot(TAUT_SOURCE_DIR "/examples/my_first_robot.yaml", {}, out);
  ASSERT_TRUE(aslant && upright) << out.Format();
  upright->def.planes = aslant->robot.def.planes;
  const Equilibrium tipped = FindEquilibrium(aslant->robot.def);
  const Equilibrium stands = FindEquilibrium(upright->def);
  ASSERT_TRUE(tipped.found && stands.found) << tipped.why << stands.why;
  EXPECT_EQ(tipped.contacts.size(), 3u);
  for (std::size_t c = 0; c < stands.cable_tension_n.size(); ++c) {
    EXPECT_NEAR(tipped.cable_tension_n[c], stands.cable_tension_n[c], 1e-6);
  }
  for (const ContactState& c : tipped.contacts) {
    EXPECT_NEAR(c.force_n.z, 9.81 * TotalMass(upright->def) / 3, 1e-8);
    EXPECT_NEAR(c.point_m.z, 0, 1e-9);
  }
}

TEST(Equilibrium, WhatNothingHoldsIsSaidWithItsResultant) {
  ModelDef def;
  scenes::AddRod(def, "rod", 2, 0.01, {0, 0, 0}, {1, 0, 0}, {});
  const Equilibrium floats = FindEquilibrium(def);
  EXPECT_FALSE(floats.found);
  EXPECT_EQ(floats.why,
            "weight and loads have the resultant (0, 0, -19.62) N, and no support holds the robot "
            "in the world");
  const Vec3 slope{0.1 / std::sqrt(1.01), 0, 1 / std::sqrt(1.01)};
  def.planes.push_back({"slope", slope, {0, 0, -1}, {}});
  EXPECT_NE(FindEquilibrium(def).why.find("no support holds the robot along the plane"),
            std::string::npos);
  def.gravity_m_per_s2 = 9.81 * slope;
  EXPECT_NE(FindEquilibrium(def).why.find("the plane can push only in the opposite direction"),
            std::string::npos);
  EquilibriumOptions without;
  without.contact = false;
  EXPECT_NE(FindEquilibrium(def, {}, without).why.find("no support holds"), std::string::npos);
}

TEST(Equilibrium, WhatGoesOnForeverIsSaid) {
  ModelDef def;  // a point on a vertical guide
  AddPoint(def, "p", {0, 0, 0}, 1);
  AddJoint(def, JointKind::kLine, kWorld, {0, 0, 0}, 0, {0, 0, 0});
  const Equilibrium e = FindEquilibrium(def);
  EXPECT_FALSE(e.found);
  EXPECT_EQ(e.why, "the robot moves away without limit: no support or cable stops it");
}

TEST(Equilibrium, WhatWouldRestOnABoxIsRefused) {
  ModelDef def = Rope(1, 10, 0.9);
  def.spheres.push_back({"ball", 0, {0, 0, 0}, 0.1, {}});
  EXPECT_TRUE(FindEquilibrium(def).found);
  def.terrain_boxes.push_back({"step", {0, 0, -1.0}, {}, {0.5, 0.5, 0.6}, {}});
  const Equilibrium e = FindEquilibrium(def);
  EXPECT_FALSE(e.found);
  EXPECT_NE(e.why.find("the sphere \"ball\" and the terrain \"step\""), std::string::npos) << e.why;
}

TEST(Equilibrium, BeginsWhereItIsTold) {
  ModelDef def = Rope(1, 400, 0.9);
  const Equilibrium first = FindEquilibrium(def);
  ASSERT_TRUE(first.found);
  EquilibriumOptions options;
  options.from = first.pose;
  const Equilibrium again = FindEquilibrium(def, {}, options);
  EXPECT_TRUE(again.found);
  EXPECT_EQ(again.iterations, 0);
  options.from->rest_lengths_m = {0.8, 0.8};
  const Equilibrium shorter = FindEquilibrium(def, {}, options);
  EXPECT_GT(shorter.cable_tension_n[0], first.cable_tension_n[0] + 1);
  EXPECT_EQ(shorter.pose.rest_lengths_m[0], 0.8);
}

TEST(Equilibrium, LoadsInStepsLeadThereWhereOneSystemAfterTheOtherDoesNot) {
  ModelDef def = Rope(1, 400, 0.999);
  LoadCaseSpec loads;
  loads.weight = false;
  loads.forces.push_back({0, {0, 0, -50}});
  const Equilibrium whole = FindEquilibrium(def, loads);
  EquilibriumOptions few;
  few.most_iterations = whole.iterations - 1;
  const Equilibrium steps = FindEquilibrium(def, loads, few);
  ASSERT_TRUE(steps.found) << steps.why;
  EXPECT_EQ(steps.way, EquilibriumWay::kLoadSteps);
  EXPECT_NEAR(steps.pose.bodies[0].position_m.z, whole.pose.bodies[0].position_m.z, 1e-9);
  EXPECT_NEAR(-whole.pose.bodies[0].position_m.z, Sag(400, 0.999, 50), 1e-12);
}

TEST(Equilibrium, RelaxationComesNearWhatNewtonFinds) {
  const ModelDef def = Rope(1, 400, 0.9);
  const LoadCaseSpec loads;
  const analysis::Structure s(def, loads, false);
  analysis::Search search;
  search.at = s.start;
  search.holding = {Eigen::VectorXd(0), Eigen::VectorXd(0)};
  analysis::Relax(s, 4000, search);
  EXPECT_NEAR(-search.at.center_m[0].z, Sag(400, 0.9, 9.81), 1e-4);
}

TEST(Equilibrium, QuestionsWithoutAMeaningAreAnswered) {
  ModelDef def = Rope(1, 400, 0.9);
  AddPoint(def, "other", {0, 1, 0}, 1);
  AddJoint(def, JointKind::kBall, 0, {0, 0, 0}, 1, {0, 0, 0});
  const auto why = [&](const auto& change) {
    LoadCaseSpec loads;
    EquilibriumOptions options;
    change(loads, options);
    const Equilibrium e = FindEquilibrium(def, loads, options);
    EXPECT_FALSE(e.found);
    return e.why;
  };
  EXPECT_EQ(why([](auto& l, auto&) {
              l.forces.push_back({7, {}});
            }),
            "the load case has a force on a node that does not exist");
  EXPECT_EQ(why([](auto& l, auto&) {
              l.cables.push_back({-1, 0});
            }),
            "the load case lengthens a cable that does not exist");
  EXPECT_EQ(why([](auto& l, auto&) {
              l.bars.push_back({1, 0});
            }),
            "the load case lengthens a bar that does not exist");
  EXPECT_EQ(why([](auto& l, auto&) {
              l.bars.push_back({0, 0});
            }),
            "the load case lengthens joint \"joint0\", which is not a bar");
  EXPECT_EQ(why([](auto& l, auto&) {
              l.settlements.push_back({2, {}});
            }),
            "the load case moves a support that does not exist");
  EXPECT_EQ(why([](auto& l, auto&) {
              l.settlements.push_back({0, {}});
            }),
            "the load case moves joint \"joint0\", which is not a support");
  EXPECT_EQ(why([](auto&, auto& o) { o.from = Pose(); }),
            "the start pose belongs to another model");
}

// Features that the equilibrium ignores are reported by name.
TEST(Equilibrium, WhatIsLeftOutIsNamed) {
  ModelDef def = Rope(1, 400, 0.9);
  def.cables[0].touches = CableTouches::kTerrain;
  AddJoint(def, JointKind::kHinge, kWorld, {0, 0, 0}, 0, {0, 0, 0}).friction = 0.1;
  const Equilibrium e = FindEquilibrium(def);
  ASSERT_EQ(e.left_out.size(), 2U);
  EXPECT_EQ(e.left_out[0], "obstacles along the path of cable cable0");
  EXPECT_EQ(e.left_out[1], "friction of joint joint0");
}

}  // namespace
}  // namespace taut::test
