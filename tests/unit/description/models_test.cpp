// Shipped models. Reference numbers: NTRT's robot, dumped from a running TetraSpineStaticModel_hf
// (reference data of the paper's model); its (x, y, z) is our (y, z, x), its lengths are cm, its
// floor is 1.5 cm above its origin.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "math/vec.h"
#include "taut/spec.h"
#include "taut/statics.h"
#include "taut/world_batch.h"

namespace taut {
namespace {

RobotSpec Load(const std::string& name, const Overrides& overrides = {}) {
  Diagnostics out;
  const auto robot = LoadRobot(TAUT_SOURCE_DIR "/share/models/" + name + ".yaml", overrides, out);
  EXPECT_EQ(out.Format(), "") << name;
  return robot.value_or(RobotSpec{});
}

const CableDef& Cable(const RobotSpec& robot, const std::string& name) {
  static const CableDef kNone{};
  for (const CableDef& cable : robot.def.cables) {
    if (cable.name == name) return cable;
  }
  ADD_FAILURE() << "no cable " << name;
  return kNone;
}

const NodeDef& Node(const RobotSpec& robot, const std::string& name) {
  static const NodeDef kNone{};
  for (const NodeDef& node : robot.def.nodes) {
    if (node.name == name) return node;
  }
  ADD_FAILURE() << "no node " << name;
  return kNone;
}

double Size(const Vec3& v) { return std::sqrt(Dot(v, v)); }

/// Returns the largest force or torque of the cables alone on any body.
double WorstLoad(const ModelDef& def) {
  double worst = 0.0;
  for (const BodyLoad& load : StartLoads(def)) {
    worst = std::max({worst, Size(load.cable_force_n), Size(load.cable_torque_n_m)});
  }
  return worst;
}

TEST(Models, OfTenThousandRodsAreReadAndCompiled) {
  // A field of upright rods, each tied to two neighbors at both ends, in a file of 2 MB.
  constexpr int kRods = 10'000, kSide = 100;
  std::string text = "taut: 1\nkind: model\nname: field\nnodes:\n";
  std::string pairs, cables;
  for (int i = 0; i < kRods; ++i) {
    const std::string number = std::to_string(i);
    const std::string at = std::to_string(i % kSide) + ", " + std::to_string(i / kSide) + ", ";
    text += "  a" + number + ": [" + at + "0.1]\n  b" + number + ": [" + at + "0.6]\n";
    pairs +=
        "  - {name: r" + number + ", nodes: [a" + number + ", b" + number + "], tags: [rod]}\n";
    for (const int k : {i + 1, i + kSide}) {
      if (k >= kRods || (k == i + 1 && k % kSide == 0)) continue;
      for (const std::string end : {"a", "b"}) {
        cables += (cables.empty() ? "[" : ", [") + end;
        cables += number + ", " + end + std::to_string(k) + "]";
      }
    }
  }
  text += "pairs:\n" + pairs + "  - {tags: [cable], each: [" + cables + "]}\n" +
          "builders:\n  - match: rod\n    rod: {radius_m: 0.01, density_kg_per_m3: 700}\n"
          "  - match: cable\n    cable: {stiffness_n_per_m: 1000, prestress_n: 10}\n";
  const std::string path = testing::TempDir() + "field_of_rods.yaml";
  std::ofstream(path) << text;
  Diagnostics out;
  const auto robot = LoadRobot(path, {}, out);
  std::filesystem::remove(path);
  ASSERT_TRUE(robot) << out.Format();
  EXPECT_EQ(robot->def.bodies.size(), 10'000u);
  EXPECT_EQ(robot->def.cables.size(), 4u * kSide * (kSide - 1));
  EXPECT_NE(Model::Compile(robot->def, out), nullptr) << out.Format();
}

TEST(Models, AreAllGood) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(TAUT_SOURCE_DIR "/share/models")) {
    if (entry.path().extension() != ".yaml") continue;
    ++count;
    const RobotSpec robot = Load(entry.path().stem().string());
    EXPECT_EQ(robot.def.name, entry.path().stem().string());
    EXPECT_FALSE(robot.def.bodies.empty());
  }
  EXPECT_GE(count, 6);
}

TEST(Tetraspine3, HasNtrtsMassesAndCentres) {
  const RobotSpec robot = Load("tetraspine3");
  const double mass_kg[] = {0.713080883, 0.9130808711, 0.7230808735};
  // NTRT [cm]: y up, z forward
  const double up_cm[] = {14.0464993, 13.810629, 14.4108747};
  const double forward_cm[] = {79.3275917, 58.0081456, 36.061344};
  ASSERT_EQ(robot.def.bodies.size(), 3u);
  for (int i = 0; i < 3; ++i) {
    const BodyDef& body = robot.def.bodies[i];
    EXPECT_EQ(body.name, "segment_" + std::to_string(i));
    EXPECT_NEAR(body.mass_kg, mass_kg[i], 3e-8);  // NTRT's mass is a float
    EXPECT_NEAR(body.com_m.x, forward_cm[i] / 100, 1e-8);
    EXPECT_NEAR(body.com_m.y, 0.0, 1e-15);
    // NTRT rounds the triangles' height up by 4.7e-8 m, part of which remains here.
    EXPECT_NEAR(body.com_m.z, (up_cm[i] - 1.5) / 100, 4.7e-8);
    EXPECT_FALSE(body.fixed);
  }
}

// The paper's table: 0.73, 0.91, 0.73 kg. The published node masses and rod densities sum to
// slightly different values.
TEST(Tetraspine3, IsWithinThreePercentOfThePapersMasses) {
  const RobotSpec robot = Load("tetraspine3");
  EXPECT_NEAR(robot.def.bodies[0].mass_kg / 0.73, 1 - 0.023, 5e-4);
  EXPECT_NEAR(robot.def.bodies[1].mass_kg / 0.91, 1 + 0.003, 5e-4);
  EXPECT_NEAR(robot.def.bodies[2].mass_kg / 0.73, 1 - 0.009, 5e-4);
}

TEST(Tetraspine3, HasTheTrueInertiaOfItsParts) {
  const RobotSpec robot = Load("tetraspine3");
  // NTRT's axes [kg cm^2]: Ixx, Iyy, Izz, Iyz
  const double true_kg_cm2[3][4] = {{148.116, 157.366, 241.188, 1.787},
                                    {216.380, 225.449, 299.138, 3.078},
                                    {155.406, 168.339, 188.770, 5.275}};
  for (int i = 0; i < 3; ++i) {
    const Inertia& inertia = robot.def.bodies[i].inertia_kg_m2;
    EXPECT_NEAR(1e4 * inertia.yy, true_kg_cm2[i][0], 1e-3);
    EXPECT_NEAR(1e4 * inertia.zz, true_kg_cm2[i][1], 1e-3);
    EXPECT_NEAR(1e4 * inertia.xx, true_kg_cm2[i][2], 1e-3);
    EXPECT_NEAR(1e4 * inertia.xz, true_kg_cm2[i][3], 1e-3);
    EXPECT_NEAR(inertia.xy, 0.0, 1e-15);
    EXPECT_NEAR(inertia.yz, 0.0, 1e-15);
  }
}

// NTRT's robot had the inertia of the solid bounding box of each segment.
TEST(Tetraspine3, HasNtrtsInertiaWithTheBoundingBoxLaw) {
  const std::string path = ::testing::TempDir() + "taut_tetraspine3_box.yaml";
  std::ofstream(path) << "taut: 1\nkind: model\nname: box\ninertia: bounding_box\n"
                      << "base: " << TAUT_SOURCE_DIR << "/share/models/tetraspine3.yaml\n";
  Diagnostics out;
  const auto robot = LoadRobot(path, {}, out);
  std::remove(path.c_str());
  ASSERT_EQ(out.Format(), "");
  const double ntrt_kg_cm2[3][3] = {{106.32264, 127.97549, 156.19757},
                                    {136.14328, 163.86917, 200.00678},
                                    {107.81367, 129.77017, 158.38803}};
  for (int i = 0; i < 3; ++i) {
    const Inertia& inertia = robot->def.bodies[i].inertia_kg_m2;
    EXPECT_NEAR(1e4 * inertia.yy, ntrt_kg_cm2[i][0], 3e-5);
    EXPECT_NEAR(1e4 * inertia.zz, ntrt_kg_cm2[i][1], 3e-5);
    EXPECT_NEAR(1e4 * inertia.xx, ntrt_kg_cm2[i][2], 3e-5);
    EXPECT_EQ(inertia.xz, 0.0);
  }
}

TEST(Tetraspine3, IsNotMirrored) {
  const RobotSpec robot = Load("tetraspine3");
  EXPECT_GT(Cable(robot, "outer_left_1").attachments[0].position_m.y, 0.18);
  EXPECT_LT(Cable(robot, "outer_right_1").attachments[0].position_m.y, -0.18);
  EXPECT_GT(robot.def.bodies[0].com_m.x, robot.def.bodies[2].com_m.x);  // segment 0 is in front
  EXPECT_GT(Node(robot, "segment_0.tip").position_m.x, 1.0);            // its tip points forward
  EXPECT_GT(Node(robot, "segment_0.top").position_m.z, 0.33);
}

struct NtrtCable {
  const char* name;
  int from, to;
  Vec3 from_cm, to_cm;  ///< NTRT's frame.
  double length_cm, rest_cm;
};
// NTRT wrote its coordinates with about seven digits.
const NtrtCable kNtrtCables[] = {
    {"outer_right_1", 0, 1, {-19, 2, 76.6825}, {-19, 2, 54.3175}, 22.365, 19.3103657},
    {"outer_left_1", 0, 1, {19, 2, 76.6825}, {19, 2, 54.3175}, 22.365, 19.3103657},
    {"outer_top_1", 0, 1, {0, 34.90897, 76.6825}, {0, 34.90897, 54.3175}, 22.365, 13.6374734},
    {"inner_right_1",
     0,
     1,
     {-18.7261724, 2.15809446, 77.028824},
     {-0.273827632, 12.8115607, 78.971176},
     21.3952822,
     18.3406479},
    {"inner_left_1",
     0,
     1,
     {18.7261724, 2.15809446, 77.028824},
     {0.273827632, 12.8115607, 78.971176},
     21.3952822,
     18.3406479},
    {"inner_top_1",
     0,
     1,
     {0, 34.5927811, 77.028824},
     {0, 13.285844, 78.971176},
     21.3952868,
     12.6677602},
    {"outer_right_2", 1, 2, {-19, 2, 53.6825}, {-19, 2, 31.3175}, 22.365, 19.3103657},
    {"outer_left_2", 1, 2, {19, 2, 53.6825}, {19, 2, 31.3175}, 22.365, 19.3103657},
    {"outer_top_2", 1, 2, {0, 34.90897, 53.6825}, {0, 34.90897, 31.3175}, 22.365, 13.6374734},
    {"inner_right_2",
     1,
     2,
     {-18.7261724, 2.15809446, 54.028824},
     {-0.273827632, 12.8115607, 55.971176},
     21.3952822,
     18.3406479},
    {"inner_left_2",
     1,
     2,
     {18.7261724, 2.15809446, 54.028824},
     {0.273827632, 12.8115607, 55.971176},
     21.3952822,
     18.3406479},
    {"inner_top_2",
     1,
     2,
     {0, 34.5927811, 54.028824},
     {0, 13.285844, 55.971176},
     21.3952868,
     12.6677602},
};

TEST(Tetraspine3, HasNtrtsCablesInNtrtsOrder) {
  const RobotSpec robot = Load("tetraspine3");
  ASSERT_EQ(robot.def.cables.size(), 12u);
  for (int i = 0; i < 12; ++i) {
    const NtrtCable& ntrt = kNtrtCables[i];
    const CableDef& cable = robot.def.cables[i];
    EXPECT_EQ(cable.name, ntrt.name);
    EXPECT_EQ(cable.attachments[0].body, ntrt.from);
    EXPECT_EQ(cable.attachments[1].body, ntrt.to);
    const auto expect_at = [&](const Vec3& got, const Vec3& cm) {
      EXPECT_NEAR(got.x, cm.z / 100, 1e-7) << ntrt.name;
      EXPECT_NEAR(got.y, cm.x / 100, 1e-7) << ntrt.name;
      EXPECT_NEAR(got.z, (cm.y - 1.5) / 100, 1e-7) << ntrt.name;
    };
    expect_at(cable.attachments[0].position_m, ntrt.from_cm);
    expect_at(cable.attachments[1].position_m, ntrt.to_cm);
    EXPECT_NEAR(CableLength(cable), ntrt.length_cm / 100, 1e-7) << ntrt.name;
    EXPECT_NEAR(cable.rest_length_m, ntrt.rest_cm / 100, 1e-7) << ntrt.name;
    const bool top = std::string(ntrt.name).find("top") != std::string::npos;
    EXPECT_NEAR(CableTension(cable), top ? 20.0 : 7.0, 1e-12);
    EXPECT_EQ(cable.stiffness_n_per_m, 229.16);
    EXPECT_EQ(cable.damping_n_s_per_m, 20.0);
    EXPECT_EQ(cable.actuator.kind, ActuatorDef::Kind::kLimited);
    EXPECT_EQ(cable.actuator.max_speed_m_per_s, 0.07);
    EXPECT_EQ(cable.actuator.max_force_n, 50.0);
    EXPECT_TRUE(std::isinf(cable.actuator.max_acceleration_m_per_s2));
    EXPECT_EQ(cable.actuator.min_rest_length_m, 0.01);
    EXPECT_EQ(cable.actuator.min_length_m, 0.01);
  }
}

TEST(Tetraspine3, CarriesItsTagsForControllersAndEvents) {
  const RobotSpec robot = Load("tetraspine3");
  const auto has = [](const Tags& tags, const char* tag) {
    return std::find(tags.begin(), tags.end(), tag) != tags.end();
  };
  EXPECT_TRUE(has(robot.cable_tags[2], "outer"));
  EXPECT_TRUE(has(robot.cable_tags[2], "top"));
  EXPECT_TRUE(has(robot.cable_tags[2], "outer_top_1"));
  EXPECT_TRUE(has(robot.cable_tags[2], "first"));
  EXPECT_TRUE(has(robot.cable_tags[8], "last"));
  EXPECT_EQ(robot.def.nodes[3].name, "segment_0.tip");
  EXPECT_TRUE(has(robot.node_tags[3], "segment_0.tip"));
  EXPECT_TRUE(has(robot.node_tags[3], "tip"));
  EXPECT_EQ(robot.cable_sources[2].line, robot.cable_sources[8].line);
  EXPECT_EQ(robot.parameters.at("segments"), 3.0);
  EXPECT_EQ(robot.def.friction_combine, CombineRule::kProduct);
  EXPECT_EQ(robot.def.spheres.size(), 18u);
  EXPECT_EQ(robot.def.capsules.size(), 24u);
  EXPECT_EQ(robot.def.capsules[0].material.static_friction, 0.15);
  EXPECT_EQ(robot.def.capsules[0].material.restitution, 0.2);
}

TEST(Tetraspine12, IsTheSameFileWithAnotherNumber) {
  const RobotSpec three = Load("tetraspine3"), twelve = Load("tetraspine12");
  ASSERT_EQ(twelve.def.bodies.size(), 12u);
  EXPECT_EQ(twelve.def.cables.size(), 66u);
  EXPECT_EQ(twelve.def.bodies[11].mass_kg, three.def.bodies[2].mass_kg);
  EXPECT_NEAR(twelve.def.bodies[5].mass_kg, three.def.bodies[1].mass_kg, 1e-16);
  EXPECT_EQ(twelve.files.size(), 2u);
  const RobotSpec set = Load("tetraspine3", {{"segments", "12"}});
  EXPECT_EQ(set.def.cables[65].rest_length_m, twelve.def.cables[65].rest_length_m);
}

TEST(Prism, HoldsItsShapeByPrestressAloneWhateverItsStruts) {
  const RobotSpec prism = Load("prism3");
  EXPECT_EQ(prism.def.bodies.size(), 3u);
  EXPECT_EQ(prism.def.cables.size(), 9u);
  EXPECT_LT(WorstLoad(prism.def), 1e-13);
  EXPECT_GT(CableTension(Cable(prism, "lower_1")), 9.0);
  for (const char* struts : {"4", "5", "8"}) {
    EXPECT_LT(WorstLoad(Load("prism3", {{"struts", struts}}).def), 1e-12) << struts;
  }
  // No equilibrium at another angle
  EXPECT_GT(WorstLoad(Load("prism3", {{"twist_rad", "2.5"}}).def), 0.1);
}

TEST(Prism, TurnsItsTopBy150DegreesBetweenTheEndsOfAStrut) {
  const RobotSpec prism = Load("prism3");
  const Vec3 bottom = Node(prism, "strut_0.bottom").position_m,
             top = Node(prism, "strut_0.top").position_m;
  EXPECT_NEAR(std::atan2(top.y, top.x) - std::atan2(bottom.y, bottom.x), 5 * std::acos(-1.0) / 6,
              1e-15);
}

TEST(SixStrut, HasNtrtsNumbers) {
  const RobotSpec ball = Load("six_strut");
  ASSERT_EQ(ball.def.bodies.size(), 6u);
  ASSERT_EQ(ball.def.cables.size(), 24u);
  for (const BodyDef& body : ball.def.bodies) EXPECT_NEAR(body.mass_kg, 3.498, 5e-4);
  for (const CableDef& cable : ball.def.cables) EXPECT_NEAR(CableTension(cable), 245.2, 1e-10);
  EXPECT_LT(WorstLoad(Load("six_strut", {{"spacing_m", "rod_length_m / 4"}}).def), 1e-12);
}

TEST(Puppy, IsASpineOfFourVertebraeWithFourLegs) {
  const RobotSpec puppy = Load("puppy");
  EXPECT_EQ(puppy.def.bodies.size(), 4u + 2 * 4u);
  EXPECT_EQ(puppy.def.cables.size(), 3 * 8u + 4 * 6u);
  EXPECT_EQ(puppy.def.joints.size(), 2 * 4u);  // hip and knee of each leg
  double mass_kg = 0;
  for (const BodyDef& body : puppy.def.bodies) mass_kg += body.mass_kg;
  EXPECT_NEAR(mass_kg, 2.144, 1e-3);
  // The vertebrae without legs are held by prestress alone.
  const std::vector<BodyLoad> loads = StartLoads(puppy.def);
  for (const std::size_t i : {1u, 2u}) {
    EXPECT_EQ(puppy.def.bodies[i].name, "vertebra_" + std::to_string(i));
    EXPECT_LT(Size(loads[i].cable_force_n), 1e-12);
    EXPECT_LT(Size(loads[i].cable_torque_n_m), 1e-13);
  }
}

TEST(HangingMass, HangsStill) {
  const RobotSpec robot = Load("hanging_mass");
  ASSERT_EQ(robot.def.bodies.size(), 1u);
  EXPECT_NEAR(CableTension(robot.def.cables[0]), 0.5 * 9.81, 1e-12);
  EXPECT_EQ(robot.def.cables[0].attachments[0].body, kWorld);
}

TEST(Rod, IsASolidCylinder) {
  const RobotSpec robot = Load("rod");
  ASSERT_EQ(robot.def.bodies.size(), 1u);
  EXPECT_EQ(robot.def.bodies[0].name, "rod");
  EXPECT_NEAR(robot.def.bodies[0].inertia_kg_m2.xx, 0.5 * 0.1 * 0.005 * 0.005, 1e-18);
  EXPECT_NEAR(robot.def.bodies[0].inertia_kg_m2.yy, 0.1 / 12 * (3 * 0.005 * 0.005 + 0.25), 1e-16);
}

}  // namespace
}  // namespace taut
