// Unsupported MJCF: every element is rejected by name and line, all of them at once.
#include <array>

#include "mjcf/mjcf_folder.h"

namespace taut::test {
namespace {

class MjcfRefusal : public MjcfFolder {};

/// Line 3 is in a free body, line 6 among tendons, line 8 among actuators, line 10 after them.
std::string With(const std::string& in_body, const std::string& in_tendons = "",
                 const std::string& in_actuators = "", const std::string& beside = "") {
  return "<mujoco><worldbody><site name=\"top\" pos=\"0 0 2\"/><body name=\"a\" pos=\"0 0 "
         "1\"><freejoint/>\n"
         "<geom name=\"g\" type=\"sphere\" size=\"0.1\"/><site name=\"s\"/>\n" +
         in_body +
         "\n</body></worldbody>\n<tendon><spatial name=\"c\" stiffness=\"9\" "
         "springlength=\"0 1\"><site site=\"top\"/><site site=\"s\"/></spatial>\n" +
         in_tendons + "\n</tendon><actuator>\n" + in_actuators + "\n</actuator>\n" + beside +
         "\n</mujoco>\n";
}

TEST_F(MjcfRefusal, NamesEachWithItsLine) {
  const std::string spatial = "<site site=\"top\"/><site site=\"s\"/></spatial>";
  const std::string tendon = "<spatial name=\"d\" stiffness=\"9\" springlength=\"1\" ";
  const auto with = [&](const std::string& keys) { return tendon + keys + ">" + spatial; };
  const std::vector<std::array<std::string, 5>> cases{
      {"<body name=\"b\"><joint name=\"h\" type=\"hinge\"/><geom size=\"0.1\"/></body>", "", "", "",
       "3: error: joint \"h\" of body \"b\" is of type hinge"},
      {"<body name=\"b\"><joint type=\"ball\"/><geom size=\"0.1\"/></body>", "", "", "",
       "3: error: joint of body \"b\" is of type ball"},
      {"<body name=\"b\"><joint type=\"slide\"/><geom size=\"0.1\"/></body>", "", "", "",
       "type slide"},
      {"<body name=\"b\"><freejoint/><geom size=\"0.1\"/></body>", "", "", "",
       "3: error: freejoint: a body inside another body cannot have a free joint"},
      {"<geom name=\"m\" type=\"mesh\" mesh=\"x\"/>", "", "", "",
       "3: error: geom \"m\": geoms of type mesh are not supported"},
      {"<geom type=\"hfield\" hfield=\"x\"/>", "", "", "",
       "3: error: geom: geoms of type hfield are not supported"},
      {"<geom type=\"ellipsoid\" size=\"1 1 1\"/>", "", "", "",
       "geoms of type ellipsoid are not supported"},
      {"<geom type=\"balloon\" size=\"1\"/>", "", "", "",
       "3: error: geom: there is no geom type \"balloon\""},
      {"<geom type=\"plane\" size=\"1 1 1\"/>", "", "", "",
       "3: error: geom: a plane cannot be part of a moving body"},
      {"<geom type=\"box\" size=\"1 1\"/>", "", "", "",
       "3: error: geom: a box needs 3 positive sizes"},
      {"<geom type=\"capsule\" size=\"0.1\"/>", "", "", "", "a capsule needs 2 positive sizes"},
      {"<geom size=\"0.1x\"/>", "", "", "",
       "3: error: geom: size must be 1 to 3 numbers, not \"0.1x\""},
      {"<geom size=\"nan\"/>", "", "", "", "size must be 1 to 3 numbers, not \"nan\""},
      {"<geom size=\"0.1\" mass=\"-1\"/>", "", "", "",
       "3: error: geom: the mass must not be negative"},
      {"<geom size=\"0.1\" collor=\"1\"/>", "", "", "",
       "3: error: geom has no attribute \"collor\" in MJCF"},
      {"<geom size=\"0.1\" size=\"0.2\"/>", "", "", "",
       "3: error: the file is not valid XML: an attribute is not key=\"value\", or occurs twice"},
      {"<geom size=\"0.1\" class=\"x\"/>", "", "", "", "3: error: there is no default class \"x\""},
      {"<geom size=\"0.1\" quat=\"0 0 0 0\"/>", "", "", "",
       "3: error: geom: quat must not be zero"},
      {"<geom size=\"0.1\" quat=\"1 0 0 0\" euler=\"1 2 3\"/>", "", "", "",
       "the orientation is given in several ways"},
      {"<composite type=\"cable\"/>", "", "", "", "3: error: composite in body is not supported"},
      {"<flexcomp/>", "", "", "", "3: error: flexcomp in body is not supported"},
      {"<replicate/>", "", "", "", "3: error: replicate in body is not supported"},
      {"<wheel/>", "", "", "", "3: error: body has no element \"wheel\" in MJCF"},
      {"<site name=\"s\"/>", "", "", "", "3: error: site \"s\" is defined twice"},
      {"", "<fixed name=\"f\"/>", "", "", "6: error: fixed \"f\" in tendon is not supported"},
      {"", "<spatial name=\"d\"><site site=\"top\"/><geom geom=\"g\"/><site site=\"s\"/></spatial>",
       "", "", "6: error: geom in spatial is not supported"},
      {"",
       "<spatial name=\"d\"><site site=\"top\"/><pulley divisor=\"2\"/><site "
       "site=\"s\"/></spatial>",
       "", "", "6: error: pulley in spatial is not supported"},
      {"", with("frictionloss=\"1\""), "", "",
       "6: error: tendon \"d\": frictionloss of a cable is not supported (leave it out with "
       "--without_frictionloss"},
      {"", with("frictionloss=\"-1\""), "", "",
       "6: error: spatial \"d\": frictionloss must not be negative"},
      {"", with("armature=\"1\""), "", "", "armature of a tendon is not supported"},
      {"", with("damping=\"-1\""), "", "", "6: error: spatial \"d\": damping must not be negative"},
      {"", "<spatial name=\"d\" damping=\"1\">" + spatial, "", "",
       "6: error: tendon \"d\" has damping but no stiffness"},
      {"", "<spatial name=\"d\" limited=\"true\" range=\"0 1\">" + spatial, "", "",
       "6: error: tendon \"d\" has a length limit (range) but no stiffness"},
      {"", "<spatial name=\"d\" stiffness=\"1\" springlength=\"0\">" + spatial, "", "",
       "6: error: the rest length of tendon \"d\" at the start must be positive and finite, got"},
      {"", "<spatial name=\"d\" stiffness=\"9\" springlength=\"0 1e308\">" + spatial, "", "",
       "6: error: the rest length of tendon \"d\" at the start must be positive and finite, got "
       "inf"},
      {"", "<spatial name=\"d\" stiffness=\"1\"><site site=\"top\"/></spatial>", "", "",
       "6: error: spatial \"d\" has fewer than two sites"},
      {"", "<spatial name=\"d\"><site site=\"tip\"/><site site=\"s\"/></spatial>", "", "",
       "6: error: there is no site \"tip\""},
      {"", "", "<muscle name=\"m\" tendon=\"c\"/>", "",
       "8: error: muscle \"m\": actuators of kind muscle are not supported"},
      {"", "", "<motor name=\"m\" joint=\"j\"/>", "",
       "8: error: motor \"m\": an actuator on a joint is not supported"},
      {"", "", "<general name=\"m\" tendon=\"c\" dyntype=\"user\"/>", "",
       "8: error: general \"m\": the actuator's dyntype is user"},
      {"", "", "<position name=\"m\" tendon=\"c\" kp=\"5\"/>",
       "<keyframe><key name=\"k\" act=\"0.5\"/></keyframe>", "act"},
      {"", "", "<general name=\"m\" tendon=\"c\" gaintype=\"affine\"/>", "",
       "the actuator's gaintype is affine"},
      {"", "", "<general name=\"m\" tendon=\"c\" biastype=\"muscle\"/>", "",
       "the actuator's biastype is muscle"},
      {"", "", "<position name=\"m\" tendon=\"c\" dampratio=\"1\"/>", "",
       "dampratio is not supported"},
      {"", "", "<position name=\"m\" tendon=\"c\" kv=\"-1\"/>", "", "kv must not be negative"},
      {"", "", "<position name=\"m\" tendon=\"c\"/>",
       "<default><position dampratio=\"1\"/></default>",
       "10: error: position \"m\": dampratio is not supported"},
      {"", "", "<general name=\"m\" tendon=\"c\"/>", "<default><muscle/></default>",
       "8: error: general \"m\": actuators of kind muscle are not supported; its class sets one in "
       "line "
       "10"},
      {"", "", "<intvelocity name=\"m\" tendon=\"c\"/>", "",
       "the actuator's dyntype is integrator"},
      {"", "", "<motor name=\"m\" tendon=\"c\" damping=\"1\"/>", "",
       "8: error: motor \"m\": damping of an actuator is not supported"},
      {"", "", "<motor name=\"m\" tendon=\"c\"/>", "<default><motor armature=\"1\"/></default>",
       "10: error: motor \"m\": armature of an actuator is not supported"},
      {"", "", "<motor name=\"m\" tendon=\"c\" group=\"2\"/>",
       "<option actuatorgroupdisable=\"1 2\"/>",
       "8: error: motor \"m\": the actuator's group is disabled"},
      {"", "",
       "<general name=\"m\" tendon=\"c\" dyntype=\"filter\" actlimited=\"true\" actrange=\"0 1\"/>",
       "", "actrange is not supported"},
      {"", "", "<position name=\"m\" tendon=\"c\" inheritrange=\"1\"/>", "",
       "inheritrange is given, but the actuator's tendon has no range"},
      {"", "", "<motor name=\"m\" tendon=\"c\" ctrlrange=\"1 0\"/>", "",
       "8: error: motor \"m\": ctrlrange must be two increasing numbers"},
      {"", "", "<pid name=\"m\" tendon=\"c\" kp=\"5\" ki=\"1\"/>", "",
       "8: error: pid \"m\": actuators of kind pid are not supported"},
      {"", with("springyield=\"1\""), "", "",
       "6: error: spatial \"d\": springyield is not supported"},
      {"", tendon.substr(0, tendon.find("springlength")) + "springlength=\"2 1\">" + spatial, "",
       "", "springlength must neither decrease nor be negative"},
      {"", "<spatial name=\"d\" frictionloss=\"1\">" + spatial, "", "",
       "6: error: tendon \"d\" has dry friction (frictionloss) but no stiffness"},
      {"<geom size=\"0.1\" adhesion=\"1\"/>", "", "", "",
       "3: error: geom: adhesion is not supported"},
      {"<geom size=\"0.1\" surfacevel=\"1 0 0\"/>", "", "", "",
       "3: error: geom: surfacevel is not supported"},
      {"", "", "", "<option><flag override=\"enable\"/></option>",
       "10: error: flag.override=\"enable\" is not supported"},
      {"", "", "",
       "<worldbody><geom name=\"f\" type=\"plane\" size=\"1 1 1\"/></worldbody><contact><pair "
       "geom1=\"f\" geom2=\"g\" friction=\"0.5\"/></contact>",
       "10: error: pair: friction that differs between the two tangential directions is not "
       "supported"},
      {"", "", "<motor name=\"m\" tendon=\"e\"/>", "", "8: error: there is no tendon \"e\""},
      {"", "<spatial name=\"d\">" + spatial, "<motor tendon=\"d\"/>", "",
       "6: error: tendon \"d\" has an actuator but no stiffness"},
      {"", "<spatial name=\"d\">" + spatial, "<position tendon=\"d\" kp=\"5\"/>",
       "<keyframe><key name=\"k\" ctrl=\"0.5\"/></keyframe>", "choose others with --keyframe k"},
      {"", "", "", "<equality><connect name=\"e\" body1=\"a\" anchor=\"0 0 0\"/></equality>",
       "10: error: the equality connect \"e\" is not supported"},
      {"", "", "", "<equality><weld body1=\"a\" relpose=\"0 0 1 1 0 0 0\"/></equality>",
       "10: error: weld: a weld with a relpose is not supported"},
      {"", "", "", "<extension><plugin plugin=\"x\"/></extension>",
       "10: error: extension in mujoco is not supported"},
      {"", "", "", "<deformable/>", "10: error: deformable in mujoco is not supported"},
      {"", "", "", "<option density=\"1.2\"/>",
       "10: error: option: a surrounding fluid is not supported"},
      {"", "", "", "<option><flag equality=\"disable\"/></option>",
       "10: error: flag.equality=\"disable\" is not supported"},
      {"", "", "", "<compiler angle=\"degrees\"/>",
       "10: error: compiler: angle has the unknown value \"degrees\" (did you mean"},
      {"", "", "", "<compiler eulerseq=\"xy\"/>", "eulerseq must be three of"},
      {"", "", "", "<keyframe><key qpos=\"1 2\"/></keyframe>",
       "10: error: key: qpos must be 7 numbers"},
      {"", "", "", "<contact><exclude body1=\"a\" body2=\"z\"/></contact>",
       "10: error: there is no body \"z\""},
      {"", "", "", "<include file=\"gone.xml\"/>", "10: error: the included file cannot be read"},
      {"", "", "", "<include file=\"model.xml\"/>", "10: error: \"model.xml\" is included twice"},
      {"", "", "", "<worldbody><body name=\"b\"><freejoint/></body></worldbody>",
       "10: error: the body \"b\" has no mass"},
      {"", "", "",
       "<worldbody><body name=\"b\"><freejoint/><inertial pos=\"0 0 0\" mass=\"1\" diaginertia=\"1 "
       "1 5\"/></body></worldbody>",
       "10: error: the moments of inertia of the body \"b\" are impossible"},
  };
  for (const auto& c : cases) {
    const std::string said = Refused(With(c[0], c[1], c[2], c[3]));
    EXPECT_NE(said.find(c[4]), std::string::npos) << c[4] << "\n" << said;
  }
}

TEST_F(MjcfRefusal, AGeomOfAnUnsupportedTypeExists) {
  const std::string pair = "<contact><pair geom1=\"g\" geom2=\"e\"/></contact>";
  const std::string refused =
      Refused(With("<geom name=\"e\" type=\"ellipsoid\" size=\"1 1 1\"/>", "", "", pair));
  EXPECT_NE(refused.find("3: error: geom \"e\": geoms of type ellipsoid"), refused.npos) << refused;
  EXPECT_EQ(refused.find("there is no geom"), refused.npos) << refused;
  // Contacts of a pair do not depend on contype and conaffinity.
  const std::string visual =
      Refused(With("<geom name=\"e\" type=\"ellipsoid\" size=\"1 1 1\" mass=\"0\" contype=\"0\" "
                   "conaffinity=\"0\"/>",
                   "", "", pair));
  EXPECT_NE(visual.find("10: error: pair: this geom has a type that is not supported"), visual.npos)
      << visual;
  EXPECT_EQ(visual.find("there is no geom"), visual.npos) << visual;
}

TEST_F(MjcfRefusal, AnEqualityOfJointsHasItsOwnAttributes) {
  const std::string said = Refused(With("", "", "",
                                        "<equality><joint joint1=\"a\" joint2=\"b\" polycoef=\"0 "
                                        "1\"/><tendon tendon1=\"c\"/></equality>"));
  EXPECT_NE(said.find("10: error: the equality joint is not supported"), said.npos) << said;
  EXPECT_NE(said.find("10: error: the equality tendon is not supported"), said.npos) << said;
  EXPECT_EQ(said.find("has no attribute"), said.npos) << said;
}

TEST_F(MjcfRefusal, SaysAllAtOnce) {
  const std::string said = Refused(With("<geom type=\"mesh\" mesh=\"m\"/>", "<fixed name=\"f\"/>",
                                        "<muscle tendon=\"c\"/>", "<deformable/>"));
  for (const char* line : {"xml:3: ", "xml:6: ", "xml:8: ", "xml:10: "}) {
    EXPECT_NE(said.find(line), std::string::npos) << said;
  }
}

TEST_F(MjcfRefusal, SpringsThatAreNoBarsAreNamedWhereTheyAreToPush) {
  const MjcfImport push{.slack = MjcfSlack::kAsMujoco};
  EXPECT_NE(
      Refused(With("",
                   "<spatial name=\"d\" stiffness=\"1\" springlength=\"1\"><site site=\"top\"/>"
                   "<site site=\"s\"/><site site=\"top\"/></spatial>"),
              push)
          .find("6: error: tendon \"d\" can push, but cannot become a bar:"),
      std::string::npos)
      << Said();
}

TEST_F(MjcfRefusal, WhatIsNoXmlOrNotMjcfIsSaid) {
  EXPECT_NE(Refused("").find("model.xml: error: the file is empty"), std::string::npos) << Said();
  EXPECT_NE(
      Refused("<mujoco>\n<worldbody>\n</mujoco>")
          .find("error: the file is not valid XML: the end tag of an element has another name"),
      std::string::npos)
      << Said();
  EXPECT_NE(Refused("taut: 1\nkind: model\n").find("the file is not valid XML"), std::string::npos)
      << Said();
  EXPECT_NE(Refused("<robot name=\"x\"/>")
                .find("the root element is \"robot\", not mujoco (this is URDF"),
            std::string::npos)
      << Said();
  EXPECT_NE(Refused("<mujoco/>").find("there is no body in this file"), std::string::npos)
      << Said();
  EXPECT_NE(Refused("<mujoco/><mujoco/>").find("the file has a second root element"),
            std::string::npos);
  EXPECT_NE(Refused("<mujoco model=\"&#27;[31m\"/>").find("contains control characters"),
            std::string::npos)
      << Said();
  EXPECT_NE(
      Refused(With("<site name=\"u\"/>"), {.keyframe = "z"}).find("there is no keyframe \"z\""),
      std::string::npos);
}

TEST_F(MjcfRefusal, SizesHaveLimits) {
  const auto many = [](int count, const std::string& text) {
    std::string all;
    for (int i = 0; i < count; ++i) all += text;
    return all;
  };
  EXPECT_EQ(Refused(many(1000, "<body>")),
            "model.xml:1: error: the file is not valid XML: elements are nested too deeply\n");
  const std::string elements =
      "model.xml: error: the model has more than 50000 elements and comments in all files up to "
      "this "
      "one\n";
  EXPECT_EQ(Refused("<mujoco>" + many(50'000, "<a/>") + "</mujoco>"), elements);
  EXPECT_EQ(Refused("<mujoco>" + many(50'000, "<!---->") + "</mujoco>"), elements);
  // Comments, CDATA and attribute values contain no elements.
  const std::string none = many(60'000, "<a>");
  EXPECT_EQ(Refused("<mujoco a='" + none + "'><!--" + none + "--><![CDATA[" + none + "]]></mujoco>")
                .find("more than"),
            std::string::npos);
  std::string attributes;
  for (int i = 0; i <= 200; ++i) attributes += " a" + std::to_string(i) + "=\"1\"";
  EXPECT_EQ(Refused("<mujoco" + attributes + "/>"),
            "model.xml:1: error: an element has more than 200 attributes\n");
  std::string files;
  for (int i = 0; i < 100; ++i) {
    const std::string name = std::to_string(i) + ".xml";
    Write(name, "<mujocoinclude/>");
    files += "<include file=\"" + name + "\"/>";
  }
  EXPECT_EQ(Refused("<mujoco>\n" + files + "</mujoco>"),
            "model.xml:2: error: the model has more than 100 files\n");
  std::filesystem::resize_file(Path("model.xml"), (64 << 20) + 1);
  out_ = {};
  EXPECT_FALSE(ImportMjcf(Path("model.xml"), {}, out_));
  EXPECT_EQ(Said(), "model.xml: error: the file is larger than 67 MB (expected an MJCF model)\n");
}

TEST_F(MjcfRefusal, TimestepsAreThoseOfExperiments) {
  for (const std::string step : {"0", "-1", "1e-10", "2", "1e308"}) {
    EXPECT_EQ(Refused("<mujoco>\n<option timestep=\"" + step + "\"/></mujoco>"),
              "model.xml:2: error: option: timestep must be within 1e-9..1\n");
  }
}

TEST_F(MjcfRefusal, FilesThatIncludeFilesHaveOneDepthTogether) {
  // Reading is recursive: without a common limit 50 files exhaust the stack.
  constexpr int kFiles = 50, kDeep = 90;
  std::string opened, closed;
  for (int i = 0; i < kDeep; ++i) opened += "<body>", closed += "</body>";
  for (int i = 1; i <= kFiles; ++i) {
    Write("part_" + std::to_string(i) + ".xml", "<mujoco>" + opened + "<include file=\"part_" +
                                                    std::to_string(i + 1) + ".xml\"/>" + closed +
                                                    "</mujoco>");
  }
  EXPECT_NE(Refused("<mujoco><worldbody><include file=\"part_1.xml\"/></worldbody></mujoco>")
                .find("part_6.xml:1: error: elements are nested more than 500 levels deep, across "
                      "all files"),
            std::string::npos)
      << Said();
}

TEST_F(MjcfRefusal, WhatTakesTheSquareOfItsNumberIsLimited) {
  std::string attributes, geoms;
  for (int i = 0; i <= 200; ++i) attributes += " a" + std::to_string(i) + "=\"<!-- > = --\"";
  EXPECT_NE(
      Refused("<mujoco>\n<!-- <a b=" + attributes + " -->\n<worldbody" + attributes + "/></mujoco>")
          .find("model.xml:3: error: an element has more than 200 attributes"),
      std::string::npos)
      << Said();
  for (int i = 0; i <= 5000; ++i) geoms += "<geom size=\"0.1\"/>";
  EXPECT_NE(Refused(With(geoms)).find("model.xml:3: error: there are more than 5000 geoms"),
            std::string::npos)
      << Said();
}

}  // namespace
}  // namespace taut::test
