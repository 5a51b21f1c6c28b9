// MJCF import: surroundings, contact pairs, and elements that are ignored
#include <cmath>

#include "math/vec.h"
#include "mjcf/mjcf_folder.h"
#include "mjcf/mujoco_model.h"

namespace taut::test {
namespace {

constexpr double kSameWorld = 1e-12;

class MjcfWorld : public MjcfFolder {};

TEST_F(MjcfWorld, WhatTouchesNothingDoesNotCollide) {
  const auto made = Import(
      R"(<mujoco><worldbody><geom name="floor" type="plane" size="1 1 1" friction="0.4" pos="0 0 -1" zaxis="0 1 1"/>
    <geom name="step" type="box" size="0.1 0.2 0.3" euler="0 0 30" friction="0.7"/>
    <body name="a" pos="0 0 1"><freejoint/><geom type="sphere" size="0.1" friction="0.4"/></body>
    <body name="b" pos="0 0 2"><freejoint/><geom type="sphere" size="0.1" friction="0.4"/></body>
    <body name="c" pos="0 0 3"><freejoint/><geom type="sphere" size="0.1" contype="0" conaffinity="0"/></body>
    </worldbody><contact><exclude body1="a" body2="b"/></contact></mujoco>)");
  ASSERT_TRUE(made);
  const ModelDef& def = made->robot.def;
  ASSERT_EQ(def.spheres.size(), 3u);
  EXPECT_TRUE(def.spheres[0].collides && def.spheres[1].collides);
  EXPECT_FALSE(def.spheres[2].collides);
  ASSERT_EQ(def.apart.size(), 1u);
  EXPECT_EQ(def.apart[0].body_a + def.apart[0].body_b, 1);
  EXPECT_EQ(def.friction_combine, CombineRule::kMaximum);
  ASSERT_EQ(def.planes.size(), 1u);
  ExpectNear(def.planes[0].normal, {0, std::sqrt(0.5), std::sqrt(0.5)}, kSameWorld);
  EXPECT_EQ(def.planes[0].material.kinetic_friction, 0.4);
  ASSERT_EQ(def.terrain_boxes.size(), 1u);
  EXPECT_TRUE(out_.warnings().empty()) << Said();
  Write("model.yaml", yaml_);
  Write("on_ground.yaml", MjcfExperimentYaml(*made, "model.yaml"));
  Diagnostics out;
  const auto experiment = LoadExperiment(Path("on_ground.yaml"), {}, out);
  ASSERT_TRUE(experiment) << out.Format();
  EXPECT_EQ(experiment->step_s, 0.002);
  const ModelDef& on = experiment->robot.def;
  ExpectNear(on.planes[0].point_m, def.planes[0].point_m, kSameWorld);
  ExpectNear(on.planes[0].normal, def.planes[0].normal, kSameWorld);
  ExpectNear(on.terrain_boxes[0].half_extents_m, {0.1, 0.2, 0.3}, kSameWorld);
  ExpectNear(Rotate(on.terrain_boxes[0].orientation, {1, 0, 0}),
             Rotate(def.terrain_boxes[0].orientation, {1, 0, 0}), kSameWorld);
  EXPECT_EQ(on.terrain_boxes[0].material.kinetic_friction, 0.7);
}

TEST_F(MjcfWorld, AGroundOfHigherPrioritySaysTheFriction) {
  const auto friction = [&](const char* floor) {
    const auto made =
        Import("<mujoco><worldbody><geom name=\"floor\" type=\"plane\" size=\"1 1 1\" " +
               std::string(floor) +
               "/><body name=\"a\" pos=\"0 0 1\"><freejoint/><geom type=\"sphere\" size=\"0.1\" "
               "friction=\"0.4\"/></body></worldbody></mujoco>");
    const ModelDef def = made ? made->robot.def : ModelDef{};
    const double a = def.spheres[0].material.kinetic_friction,
                 b = def.planes[0].material.kinetic_friction;
    return def.friction_combine == CombineRule::kMaximum ? std::max(a, b) : std::sqrt(a * b);
  };
  EXPECT_NEAR(friction("friction=\"0.2\""), 0.4, kSameWorld);
  EXPECT_NEAR(friction("friction=\"0.2\" priority=\"1\""), 0.2, kSameWorld);
  EXPECT_NEAR(friction("friction=\"0.9\" priority=\"1\""), 0.9, kSameWorld);
  EXPECT_TRUE(out_.warnings().empty()) << Said();
}

TEST_F(MjcfWorld, WhatIsLeftOutIsToldInALine) {
  const auto made = Import(
      R"(<mujoco><visual><map znear="0.1"/></visual><asset><mesh name="m" file="no.stl"/></asset>
    <worldbody><light pos="0 0 3"/><camera name="c"/><body name="a" pos="0 0 1"><freejoint/>
    <geom type="sphere" size="0.1" rgba="1 0 0 1" solref="0.01 1"/>
    <geom type="mesh" mesh="m" contype="0" conaffinity="0" mass="0"/><site name="s"/></body><site name="t"/></worldbody>
    <tendon><spatial name="shown" width="0.01"><site site="s"/><site site="t"/></spatial></tendon>
    <sensor><tendonpos tendon="shown"/></sensor></mujoco>)");
  ASSERT_TRUE(made);
  EXPECT_TRUE(made->robot.def.cables.empty());
  ASSERT_GE(made->notes.size(), 2u);
  EXPECT_EQ(made->notes[0],
            "left out: asset, camera, geom.rgba, light, sensor, spatial.width, visual, visual geom "
            "of type mesh");
  EXPECT_EQ(made->notes[1], "left out: 1 visual tendon without stiffness and actuator");
  EXPECT_EQ(Said(),
            "model.xml:3: warning: geom.solref is left out: contacts are rigid in taut; in MuJoCo "
            "these values make them soft\n");
}

TEST_F(MjcfWorld, WhatChangesAForceOrAPlaceIsAWarningWithItsLine) {
  const std::string a = R"(<mujoco><worldbody><geom name="f" type="plane" size="1 1 1"/>
    <body name="a" pos="0 0 1"><freejoint/>
    <geom name="g" type="sphere" size="0.1" )";
  const std::string end = R"(/></body></worldbody></mujoco>)";
  const std::pair<const char*, const char*> cases[] = {
      {"solimp=\"0.8 0.9 0.01\"",
       "model.xml:3: warning: geom.solimp is left out: contacts are rigid"},
      {"margin=\"0.01\"",
       "model.xml:3: warning: geom.margin is left out: contacts begin where shapes touch; in "
       "MuJoCo"},
      {"margin=\"0.01\" gap=\"0.01\"", "geom.margin and 1 more are left out"},
      {"condim=\"4\"", "model.xml:3: warning: torsional and rolling friction (condim above 3)"},
  };
  for (const auto& [attributes, said] : cases) {
    Import(a + attributes + end);
    EXPECT_NE(Said().find(said), std::string::npos) << attributes << "\n" << Said();
  }
  Import(a + "solref=\"0.02\" solimp=\"0.9 0.95\" margin=\"0\" condim=\"6\" friction=\"1 0 0\"" +
         end);
  EXPECT_TRUE(out_.warnings().empty()) << Said();
}

TEST_F(MjcfWorld, APairThatGivesNoFrictionHasOne) {
  // Neither MuJoCo 2.2.2 nor 4.0.0 uses the geoms' friction, here 0.4, for a pair without friction.
  const auto said = [&](const std::string& of_pair, const std::string& defaults = "") {
    Import("<mujoco>" + defaults + R"(<worldbody>
    <geom name="f" type="plane" size="1 1 1" friction="0.3"/><body name="a" pos="0 0 1">
    <freejoint/><geom name="g" type="sphere" size="0.1" friction="0.4"/></body></worldbody>
    <contact><pair geom1="f" geom2="g" )" +
           of_pair + "/></contact></mujoco>");
    return Said();
  };
  const std::string another = "the friction of 1 pair of geoms differs from that in MuJoCo";
  EXPECT_NE(said("").find(another), std::string::npos) << Said();
  EXPECT_EQ(said("friction=\"0.4 0.4\""), "");
  EXPECT_EQ(said("", "<default><pair friction=\"0.4 0.4\"/></default>"), "");
}

TEST_F(MjcfWorld, DryFrictionOfATendonIsABarsOrLeftOutWhenAsked) {
  const std::string rough = Hung(R"(stiffness="100" springlength="0.9" frictionloss="0.5")");
  const auto cable = Import(rough, {.without_frictionloss = true});
  ASSERT_TRUE(cable);
  EXPECT_NE(Said().find("tendon \"c\" has dry friction (frictionloss), which is left out"),
            std::string::npos)
      << Said();
  const auto bar = Import(rough, {.length_unit_m = 0.1, .slack = MjcfSlack::kAsMujoco});
  ASSERT_TRUE(bar);
  EXPECT_NEAR(bar->robot.def.joints.at(0).friction, 0.05, kSameWorld);
}

TEST_F(MjcfWorld, ATendonInOneBodyIsLeftOut) {
  const std::string two = R"(<body name="lonely" pos="2 0 1"><freejoint/><geom size="0.1"/>
      <site name="left" pos="-0.1 0 0"/><site name="right" pos="0.1 0 0"/></body>)";
  std::string xml = Hung(R"(stiffness="100" springlength="0.5")");
  xml.insert(xml.find("</worldbody>"), two);
  xml.insert(xml.find("</tendon>"), R"(<spatial name="own" stiffness="9" springlength="0.1">
      <site site="left"/><site site="right"/></spatial>)");
  const auto made = Import(xml);
  ASSERT_TRUE(made);
  EXPECT_EQ(made->robot.def.cables.size(), 1u);
  EXPECT_NE(Said().find("tendon \"own\" has all sites in one body and no effect: left out"),
            std::string::npos)
      << Said();
}

}  // namespace
}  // namespace taut::test
