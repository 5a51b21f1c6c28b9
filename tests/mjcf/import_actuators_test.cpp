// MJCF actuators and tendons with class defaults. tests/mjcf/compare_with_mujoco.py compares random
// files of this kind with MuJoCo.
#include "mjcf/mjcf_folder.h"

namespace taut::test {
namespace {

class MjcfActuators : public MjcfFolder {};

TEST_F(MjcfActuators, ActuatorsInheritEachParameterOfTheirClasses) {
  // Stiffness, damping and rest length computed from biasprm and gainprm of models compiled by
  // MuJoCo 4.0.0
  struct Case {
    const char *defaults, *actuator;
    double stiffness, damping, rest;
  };
  const Case cases[] = {
      {"<position kp=\"200\" kv=\"5\"/>", "<position tendon=\"c\"/>", 200, 5, 0.6},
      {"<position kp=\"200\" kv=\"5\"/>", "<position tendon=\"c\" kp=\"100\"/>", 100, 5, 0.6},
      {"<position kv=\"5\"/><default class=\"k\"><position kv=\"7\"/><default "
       "class=\"l\"/></default>",
       "<position tendon=\"c\" class=\"l\" kp=\"100\"/>", 100, 7, 0.6},
      {"<general biastype=\"affine\" gainprm=\"30\" biasprm=\"0 -80 -3\"/>",
       "<position tendon=\"c\"/>", 30, 3, 0.6},
      {"<general biastype=\"affine\" gainprm=\"30\" biasprm=\"10 -80 -3\"/>",
       "<general tendon=\"c\" biasprm=\"6\"/>", 80, 3, (30 * 0.6 + 6) / 80},
      {"<velocity/>", "<position tendon=\"c\" kp=\"100\" kv=\"4\"/>", 100, 4, 0.6},
      {"<cylinder area=\"50\" bias=\"0 -50 -2\"/>", "<cylinder tendon=\"c\"/>", 50, 2, 0.6},
      {"<intvelocity kp=\"100\" kv=\"3\"/>", "<general tendon=\"c\" dyntype=\"none\"/>", 100, 3,
       0.6},
      {"<position kv=\"5\"/></default><default class=\"main\"><position kp=\"90\"/>",
       "<position tendon=\"c\"/>", 90, 5, 0.6},
      {"<position kv=\"5\"/><default class=\"k\"/></default><default><position kp=\"90\"/>",
       "<position tendon=\"c\" class=\"k\"/>", 1, 5, 0.6},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.defaults + std::string(c.actuator));
    const auto made = Import(Pulled("", c.actuator,
                                    std::string("<default>") + c.defaults +
                                        "</default><keyframe><key ctrl=\"0.6\"/></keyframe>"),
                             {.keyframe = "0"});
    ASSERT_TRUE(made);
    const CableDef& cable = made->robot.def.cables.at(0);
    EXPECT_DOUBLE_EQ(cable.stiffness_n_per_m, c.stiffness);
    EXPECT_DOUBLE_EQ(cable.damping_n_s_per_m, c.damping);
    EXPECT_DOUBLE_EQ(cable.rest_length_m, c.rest);
  }
}

TEST_F(MjcfActuators, WhereVersionsOfMujocoInheritOtherParametersTheActuatorIsRefused) {
  const std::pair<const char*, const char*> cases[] = {
      {"<velocity kv=\"4\"/>", "<position name=\"a\" tendon=\"c\" kp=\"100\"/>"},
      {"<position kp=\"200\" kv=\"5\"/>", "<velocity name=\"a\" tendon=\"c\"/>"},
      {"<general biastype=\"affine\" biasprm=\"10 -80 -3\"/>",
       "<position name=\"a\" tendon=\"c\"/>"},
      {"<general biasprm=\"0 -80 -3\"/><motor/>",
       "<general name=\"a\" tendon=\"c\" biastype=\"affine\"/>"},
      {"<general dyntype=\"filter\"/>", "<position name=\"a\" tendon=\"c\"/>"},
      {"<position kv=\"5\"/><motor/>", "<position name=\"a\" tendon=\"c\" kp=\"100\"/>"},
  };
  for (const auto& [defaults, actuator] : cases) {
    EXPECT_NE(Refused(Pulled("stiffness=\"9\" springlength=\"0 0.5\"", actuator,
                             "\n<default>" + std::string(defaults) + "</default>"))
                  .find("\"a\": versions of MuJoCo differ in its defaults: gain "),
              std::string::npos)
        << defaults << "\n"
        << Said();
  }
}

TEST_F(MjcfActuators, OneSpringLengthReplacesBothOfAClass) {
  const auto made = Import(Hung("stiffness=\"100\" springlength=\"0.5\"",
                                "<default><tendon springlength=\"0 0.6\"/></default>"),
                           {.slack = MjcfSlack::kAsMujoco});
  ASSERT_TRUE(made);
  ASSERT_EQ(made->robot.def.joints.size(), 1u);  // A dead band would not become a bar.
  EXPECT_EQ(made->robot.def.joints[0].rest, 0.5);
}

TEST_F(MjcfActuators, AnEmptyRangeLimitsNothing) {
  const auto made = Import(Pulled("", "<position tendon=\"c\" kp=\"60\" ctrlrange=\"0 0\"/>",
                                  "<default><position ctrlrange=\"0.1 "
                                  "0.2\"/></default><keyframe><key ctrl=\"0.6\"/></keyframe>"),
                           {.keyframe = "0"});
  ASSERT_TRUE(made);
  EXPECT_EQ(made->robot.def.cables.at(0).rest_length_m, 0.6);
}

TEST_F(MjcfActuators, InheritedRangesOfTendonsLimitControls) {
  const auto made =
      Import(Pulled("range=\"0.2 0.8\"", "<position tendon=\"c\" kp=\"60\" inheritrange=\"0.5\"/>",
                    "<keyframe><key ctrl=\"0.7\"/></keyframe>"),
             {.keyframe = "0"});
  ASSERT_TRUE(made);
  EXPECT_DOUBLE_EQ(made->robot.def.cables.at(0).rest_length_m, 0.65);
}

TEST_F(MjcfActuators, TensionsAtTheStartThatNoCableHasAreRefused) {
  // MuJoCo: 80 (0.7 - 0.6) - 2, because the spring alone is slack; the actuator's limit is 5.
  EXPECT_NE(Refused(Pulled("stiffness=\"50\" springlength=\"0 0.9\"",
                           "<general tendon=\"c\" biastype=\"affine\" biasprm=\"0 -80 0\"/>"))
                .find("model.xml:1: error: tendon \"c\" starts with a tension of 56 in MuJoCo, but "
                      "46 as a cable"),
            std::string::npos)
      << Said();
  EXPECT_NE(Refused(Pulled("stiffness=\"50\" springlength=\"0 0.5\"",
                           "<general tendon=\"c\" biastype=\"affine\" biasprm=\"0 -80 0\" "
                           "forcerange=\"-5 0\"/>"))
                .find("starts with a tension of 15 in MuJoCo, but 66 as a cable"),
            std::string::npos)
      << Said();
}

TEST_F(MjcfActuators, DisabledFrictionAndLimitsDoNotAct) {
  const auto made =
      Import(Hung("stiffness=\"100\" springlength=\"0 0.6\" frictionloss=\"1\" range=\"0 1\"",
                  "<option><flag frictionloss=\"disable\" limit=\"disable\"/></option>"));
  ASSERT_TRUE(made);
  EXPECT_TRUE(out_.warnings().empty()) << Said();
}

}  // namespace
}  // namespace taut::test
