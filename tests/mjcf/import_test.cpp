// MJCF import of tensegrity robots in common styles, each compared with MuJoCo 2.2.2 on the same
// text
#include "mjcf/mjcf_folder.h"
#include "mjcf/mujoco_model.h"
#include "taut/statics.h"

namespace taut::test {
namespace {

constexpr double kSame = 1e-12;

class MjcfImportTest : public MjcfFolder {
 protected:
  /// Imports the text and compares each body of the robot with MuJoCo's body of the same name, each
  /// node with its site, and each cable's length and tension with its tendon.
  std::optional<ImportedMjcf> Same(const std::string& xml, const MjcfImport& options = {},
                                   int key = -1, double inertia_share = kSame) {
    auto made = Import(xml, options);
    MujocoModel theirs(xml);
    if (!made || !theirs) return made;
    if (key >= 0) theirs.Key(key);
    const ModelDef& def = made->robot.def;
    for (const BodyDef& body : def.bodies) {
      SCOPED_TRACE(body.name);
      const int id = theirs.Id(mjOBJ_BODY, body.name);
      EXPECT_GT(id, 0);
      if (id <= 0 || body.fixed) continue;
      EXPECT_NEAR(body.mass_kg, theirs.model().body_mass[id], kSame * body.mass_kg);
      ExpectNear(body.com_m, theirs.Com(id), kSame);
      ExpectNear(body.inertia_kg_m2, theirs.InertiaOf(id), inertia_share);
    }
    for (const NodeDef& node : def.nodes) {
      const std::string site = node.name.substr(node.name.rfind('.') + 1);
      const int id = theirs.Id(mjOBJ_SITE, site);
      if (id >= 0) ExpectNear(node.position_m, theirs.SitePlace(id), kSame);
    }
    for (const CableDef& cable : def.cables) {
      SCOPED_TRACE(cable.name);
      const int id = theirs.Id(mjOBJ_TENDON, cable.name);
      EXPECT_GE(id, 0);
      if (id < 0) continue;
      const double size = 1 + cable.stiffness_n_per_m;
      EXPECT_NEAR(CableLength(cable), theirs.data().ten_length[id], kSame);
      EXPECT_NEAR(CableTension(cable), std::max(0.0, theirs.Tension(id)), kSame * size);
    }
    ExpectGeoms(*made, theirs);
    return made;
  }

  /// Compares shapes by their order within each kind, which both preserve within a body.
  static void ExpectGeoms(const ImportedMjcf& made, MujocoModel& theirs) {
    const ModelDef& def = made.robot.def;
    for (const BodyDef& body : def.bodies) {
      const int id = theirs.Id(mjOBJ_BODY, body.name);
      if (id <= 0) continue;
      const int mine = static_cast<int>(&body - def.bodies.data());
      std::vector<int> spheres, rods, boxes;
      for (int g = 0; g < theirs.model().ngeom; ++g) {
        if (theirs.model().geom_bodyid[g] != id) continue;
        const int type = theirs.model().geom_type[g];
        (type == mjGEOM_SPHERE ? spheres : type == mjGEOM_BOX ? boxes : rods).push_back(g);
      }
      const auto own = [&](const auto& list, const std::vector<int>& geoms, auto compare) {
        std::size_t next = 0;
        for (const auto& shape : list) {
          if (shape.body != mine) continue;
          ASSERT_LT(next, geoms.size());
          compare(shape, geoms[next++]);
        }
        EXPECT_EQ(next, geoms.size());
      };
      const auto size = [&](int g, int i) { return theirs.model().geom_size[3 * g + i]; };
      own(def.spheres, spheres, [&](const SphereDef& s, int g) {
        EXPECT_DOUBLE_EQ(s.radius_m, size(g, 0));
        ExpectNear(s.center_m, theirs.GeomPlace(g), kSame);
      });
      own(def.capsules, rods, [&](const CapsuleDef& c, int g) {
        EXPECT_DOUBLE_EQ(c.radius_m, size(g, 0));
        ExpectNear(0.5 * (c.from_m + c.to_m), theirs.GeomPlace(g), kSame);
        const Vec3 half = 0.5 * (c.to_m - c.from_m);
        const Vec3 want = size(g, 1) * theirs.GeomAxis(g, 2);
        ExpectNear(half, Dot(half, want) > 0 ? want : -1.0 * want, kSame);
      });
      own(def.boxes, boxes, [&](const BoxDef& b, int g) {
        ExpectNear(b.half_extents_m, {size(g, 0), size(g, 1), size(g, 2)}, kSame);
        ExpectNear(b.center_m, theirs.GeomPlace(g), kSame);
        ExpectNear(Rotate(b.orientation, {1, 0, 0}), theirs.GeomAxis(g, 0), kSame);
        ExpectNear(Rotate(b.orientation, {0, 1, 0}), theirs.GeomAxis(g, 1), kSame);
      });
    }
  }
};

/// Returns `parts` in a free body that is rotated and moved.
std::string Turned(const std::string& parts, const std::string& more = "") {
  return "<mujoco model=\"one\">" + more +
         "<worldbody><body name=\"one\" pos=\"0.3 -0.2 1\" euler=\"20 30 -40\"><freejoint/>" +
         parts + "</body></worldbody></mujoco>";
}

TEST_F(MjcfImportTest, EveryShapeWeighsWhatItDoesInMujoco) {
  for (const char* geom :
       {R"(<geom type="sphere" size="0.1" pos="0.1 0.2 0.3"/>)",
        R"(<geom type="capsule" size="0.02 0.3" pos="0.1 0 0" euler="10 20 30"/>)",
        R"(<geom type="capsule" size="0.02" fromto="0 0.1 0.2 0.4 -0.1 0.3" mass="0.7"/>)",
        R"(<geom type="cylinder" size="0.02 0.3" axisangle="1 2 3 50" density="400"/>)",
        R"(<geom type="cylinder" size="0.02" fromto="0 0.1 0.2 0.4 -0.1 0.3"/>)",
        R"(<geom type="box" size="0.1 0.2 0.3" quat="0.5 0.1 -0.7 0.2"/>)",
        R"(<geom type="box" size="0.1 0.2 0.3" xyaxes="1 1 0 0 1 1"/>)",
        R"(<geom type="box" size="0.1 0.2 0.3" zaxis="1 -2 3" mass="3"/>)",
        R"(<geom type="box" size="0.1" fromto="0 0.1 0.2 0.4 -0.1 0.3"/>)"}) {
    SCOPED_TRACE(geom);
    Same(Turned(geom));
    // MuJoCo computes principal axes of a sum to about 1e-9 only; therefore it gets two bodies.
    const std::string more = R"(<geom type="sphere" size="0.05" pos="-0.3 0.1 0"/>)";
    const auto both = Import(Turned(geom + more));
    ASSERT_TRUE(both);
    MujocoModel theirs(Turned(std::string("<body>") + geom + "</body><body>" + more + "</body>"));
    const MassProperties sum =
        Combine({{theirs.model().body_mass[2], theirs.Com(2), theirs.InertiaOf(2)},
                 {theirs.model().body_mass[3], theirs.Com(3), theirs.InertiaOf(3)}});
    const BodyDef& body = both->robot.def.bodies[0];
    EXPECT_NEAR(body.mass_kg, sum.mass_kg, kSame * sum.mass_kg);
    ExpectNear(body.com_m, sum.com_m, kSame);
    ExpectNear(body.inertia_kg_m2, sum.inertia_kg_m2, kSame);
  }
}

TEST_F(MjcfImportTest, OrientationsFollowTheCompilersSettings) {
  const std::string parts = R"(<geom type="box" size="0.1 0.2 0.3" euler="0.3 -0.4 0.5"/>)";
  for (const char* sequence : {"xyz", "zyx", "XYZ", "ZYX", "xZy", "yXy"}) {
    SCOPED_TRACE(sequence);
    Same(Turned(parts, "<compiler angle=\"radian\" eulerseq=\"" + std::string(sequence) + "\"/>"));
  }
}

TEST_F(MjcfImportTest, AnInertialCountsAsTheCompilerSays) {
  const std::string geom = R"(<geom type="capsule" size="0.02 0.3" mass="2"/>)";
  for (
      const char* inertial :
      {R"(<inertial pos="0.1 0 0" mass="0.5" diaginertia="0.02 0.03 0.04"/>)",
       R"(<inertial pos="0.1 0 0" euler="30 40 50" mass="0.5" diaginertia="0.02 0.03 0.04"/>)",
       R"(<inertial pos="0 0 0.1" mass="0.5" fullinertia="0.02 0.03 0.04 0.001 -0.002 0.003"/>)"}) {
    for (const char* how : {"auto", "true", "false"}) {
      SCOPED_TRACE(std::string(inertial) + how);
      // MuJoCo's principal axes of a full matrix are exact to about 1e-9 only.
      const bool is_full = std::string(inertial).find("full") != std::string::npos;
      const bool counts = std::string(how) != "true";
      const std::string xml =
          Turned(inertial + geom, "<compiler inertiafromgeom=\"" + std::string(how) + "\"/>");
      const auto made = Same(xml, {}, -1, is_full && counts ? 1e-8 : kSame);
      if (!made || !is_full || !counts) continue;
      MujocoModel theirs(xml);
      ExpectNear(made->robot.def.bodies[0].inertia_kg_m2,
                 taut::Turned(MujocoModel::QuatOf(theirs.data().xquat + 4),
                              {0.02, 0.03, 0.04, 0.001, -0.002, 0.003}),
                 kSame);
    }
  }
}

TEST_F(MjcfImportTest, BoundsGroupsAndATotalMassCountAsInMujoco) {
  const std::string parts =
      R"(<geom type="capsule" size="0.02 0.3"/><geom type="box" size="0.1 0.1 0.2" group="2" pos="1 0 0"/>)";
  for (const char* settings : {R"(boundmass="50")", R"(boundinertia="0.9")", R"(settotalmass="7")",
                               R"(inertiagrouprange="0 1")"}) {
    SCOPED_TRACE(settings);
    Same(Turned(parts, "<compiler " + std::string(settings) + "/>"));
  }
}

TEST_F(MjcfImportTest, GlobalCoordinatesAreThoseOfTheWorld) {
  Same(R"(<mujoco><compiler coordinate="global" angle="degree"/><worldbody>
    <body name="a"><freejoint/><geom type="capsule" fromto="0 0 1 0.3 0.4 1.5" size="0.02"/>
      <site name="a0" pos="0 0 1"/><site name="a1" pos="0.3 0.4 1.5"/></body>
    <body name="b" pos="1 1 1" euler="10 20 30"><freejoint/>
      <geom type="box" size="0.1 0.2 0.3" pos="1 0 1" euler="30 20 10"/>
      <inertial pos="1 0 1.1" mass="2" diaginertia="0.1 0.2 0.15" euler="3 4 5"/>
      <site name="b0" pos="1 0 1"/></body></worldbody>
    <tendon><spatial name="ab" stiffness="100" springlength="0.5"><site site="a1"/><site site="b0"/>
    </spatial></tendon></mujoco>)");
}

TEST_F(MjcfImportTest, ClassesGiveWhatAnElementDoesNotSay) {
  Same(R"(<mujoco><default><geom density="200" size="0.03 0.2"/><tendon stiffness="50" damping="1"/>
    <default class="strut"><geom type="capsule" density="700"/>
      <default class="thick"><geom size="0.05"/></default></default>
    <default class="strong"><tendon stiffness="500" springlength="0.2"/></default></default>
    <worldbody><site name="top" pos="0 0 2"/>
    <body name="a" childclass="strut" pos="0 0 1"><freejoint/><geom/><site name="s" pos="0 0 0.2"/></body>
    <body name="b" childclass="strut" pos="1 0 1"><freejoint/><geom class="thick"/><site name="t"/></body>
    <body name="c" pos="2 0 1"><freejoint/><geom type="sphere"/><site name="u"/></body></worldbody>
    <tendon><spatial name="one"><site site="top"/><site site="s"/></spatial>
    <spatial name="two" class="strong" stiffness="300"><site site="s"/><site site="t"/><site site="u"/></spatial>
    </tendon></mujoco>)");
  EXPECT_NE(yaml_.find("{name: two, nodes: [s, t, c.u], tags: [strong]}"), std::string::npos)
      << yaml_;
}

TEST_F(MjcfImportTest, FilesAreIncluded) {
  Write("parts.xml", R"(<mujoco><body name="a" pos="0 0 1"><freejoint/>
    <geom type="capsule" size="0.02 0.3"/></body></mujoco>)");
  const auto made =
      Import(R"(<mujoco><worldbody><include file="parts.xml"/></worldbody></mujoco>)");
  ASSERT_TRUE(made);
  EXPECT_EQ(made->robot.files.size(), 2u);
  EXPECT_NEAR(made->robot.def.bodies[0].com_m.z, 1, kSame);
}

TEST_F(MjcfImportTest, SpringsAndActuatorsOfATendonAreOneCable) {
  const auto k = [&](const std::string& xml, const MjcfImport& options = {}, int key = -1) {
    SCOPED_TRACE(xml);
    const auto made = Same(xml, options, key);
    return made && !made->robot.def.cables.empty() ? made->robot.def.cables[0] : CableDef{};
  };
  CableDef c = k(Hung(R"(stiffness="100" springlength="0.5" damping="3")"));
  EXPECT_EQ(c.stiffness_n_per_m, 100);
  EXPECT_EQ(c.damping_n_s_per_m, 3);
  EXPECT_EQ(c.actuator.kind, ActuatorDef::Kind::kNone);
  c = k(Hung(R"(stiffness="100")"));  // default: the length at the start
  EXPECT_NEAR(c.rest_length_m, 0.7, kSame);
  c = k(Pulled("", R"(<general tendon="c" gainprm="80" biastype="affine" biasprm="40 -80 -2"
                      forcelimited="true" forcerange="-1e12 0"/>)"));
  EXPECT_NEAR(c.rest_length_m, 0.5, kSame);
  EXPECT_EQ(c.damping_n_s_per_m, 2);
  EXPECT_EQ(c.actuator.kind, ActuatorDef::Kind::kIdeal);
  const std::string key = R"(<keyframe><key name="k" ctrl="0.4"/></keyframe>)";
  c = k(Pulled(R"(stiffness="100" springlength="0.5")",
               R"(<position tendon="c" kp="60" gear="2"/>)", key),
        {.keyframe = "k"}, 0);
  EXPECT_NEAR(c.stiffness_n_per_m, 340, kSame);
  k(Pulled(R"(stiffness="100" springlength="0.5")", R"(<motor tendon="c" gear="-3"/>)", key),
    {.keyframe = "0"}, 0);
  EXPECT_NE(yaml_.find("ideal: true"), std::string::npos);
  c = k(Pulled(R"(stiffness="100" springlength="0.5")", R"(<velocity tendon="c" kv="4"/>)", key),
        {.keyframe = "k"}, 0);
  EXPECT_EQ(c.damping_n_s_per_m, 4);
  c = k(Pulled("", R"(<position tendon="c" kp="60" ctrllimited="true" ctrlrange="0.1 0.3"/>)", key),
        {.keyframe = "k"}, 0);
  EXPECT_NEAR(c.rest_length_m, 0.3, kSame);
}

TEST_F(MjcfImportTest, AnActuatorWithALagIsWhatItHasComeTo) {
  const std::string lags = R"(<general tendon="c" gainprm="80" biastype="affine" biasprm="0 -80 -2"
                                       dyntype="filter" dynprm="0.3"/>)";
  const auto at = [&](const std::string& says) {
    const auto made = Same(Pulled("", lags, "<keyframe><key name=\"k\" " + says + "/></keyframe>"),
                           {.keyframe = "k"}, 0);
    return made ? made->robot.def.cables.at(0).rest_length_m : NAN;
  };
  EXPECT_NEAR(at("act=\"0.4\" ctrl=\"0.6\""), 0.4,
              kSame);  // as in MuJoCo, where it then changes to 0.6
  EXPECT_NE(Said().find("tendon \"c\" has actuators with a lag behind their controls (dyntype), of "
                        "up to 0.3 s; rest lengths of cables follow at once"),
            std::string::npos)
      << Said();
  const auto ctrl_only =
      Import(Pulled("", lags, R"(<keyframe><key ctrl="0.6"/></keyframe>)"), {.keyframe = "0"});
  ASSERT_TRUE(ctrl_only);
  EXPECT_NEAR(ctrl_only->robot.def.cables.at(0).rest_length_m, 0.6, kSame);  // the steady value
  EXPECT_TRUE(Import(Pulled("", R"(<position tendon="c" kp="60" timeconst="0.2"/>)",
                            R"(<keyframe><key ctrl="0.6"/></keyframe>)"),
                     {.keyframe = "0"}));
  EXPECT_NE(Said().find("up to 0.2 s"), std::string::npos) << Said();
}

TEST_F(MjcfImportTest, WhatWouldPushIsCounted) {
  Import(Hung(R"(stiffness="100" springlength="0.9" damping="1")"));
  EXPECT_NE(Said().find("1 tendon would push in MuJoCo when shorter than the rest length, but "
                        "cables only pull; 1 of them would push at the start"),
            std::string::npos)
      << Said();
  EXPECT_NE(Said().find("1 damper of tendons would also act on slack tendons in MuJoCo"),
            std::string::npos);
  const auto bar = Import(Hung(R"(stiffness="100" springlength="0.9" damping="1")"),
                          {.slack = MjcfSlack::kAsMujoco});
  ASSERT_TRUE(bar);
  ASSERT_EQ(bar->robot.def.joints.size(), 1u);
  EXPECT_TRUE(out_.warnings().empty()) << Said();
  const JointDef& j = bar->robot.def.joints[0];
  EXPECT_EQ(j.stiffness, 100);
  EXPECT_EQ(j.damping, 1);
  EXPECT_EQ(j.rest, 0.9);
  EXPECT_TRUE(j.collides);
  Import(Hung(R"(stiffness="100" springlength="0 0.9")"));  // MuJoCo 3's cable
  EXPECT_TRUE(out_.warnings().empty()) << Said();
  Import(Pulled("", R"(<general tendon="c" gainprm="80" biastype="affine" biasprm="40 -80 0"
                       forcelimited="true" forcerange="-50 0"/>)"));
  EXPECT_NE(Said().find("tendon \"c\" has a maximum tension (forcerange), which is left out"),
            std::string::npos)
      << Said();
}

TEST_F(MjcfImportTest, WhatIsWeldedIsOneBody) {
  const std::string inside = R"(<geom type="box" size="0.1 0.2 0.3"/>
      <body name="inner" pos="0 0.5 0" euler="10 0 0"><geom type="box" size="0.2 0.1 0.1"/>
        <site name="tip" pos="0 0 0.1"/></body>)";
  const auto nested = Import(Turned(inside));
  const auto welded = Import(
      R"(<mujoco model="one"><worldbody>
    <body name="one" pos="0.3 -0.2 1" euler="20 30 -40"><freejoint/><geom type="box" size="0.1 0.2 0.3"/></body>
    <body name="two" pos="2 0 1"><freejoint/><geom type="sphere" size="0.1" mass="1"/></body>
    </worldbody><equality><weld body1="one" body2="two"/></equality></mujoco>)");
  ASSERT_TRUE(nested && welded);
  MujocoModel theirs(Turned(inside));
  const ModelDef& def = nested->robot.def;
  ASSERT_EQ(def.bodies.size(), 1u);
  // MuJoCo keeps both bodies; compare with their subtree.
  const double mass = theirs.model().body_subtreemass[1];
  EXPECT_NEAR(def.bodies[0].mass_kg, mass, kSame * mass);
  ExpectNear(def.bodies[0].com_m, MujocoModel::Of(theirs.data().subtree_com + 3), kSame);
  const Inertia whole = Combine({{theirs.model().body_mass[1], theirs.Com(1), theirs.InertiaOf(1)},
                                 {theirs.model().body_mass[2], theirs.Com(2), theirs.InertiaOf(2)}})
                            .inertia_kg_m2;
  ExpectNear(def.bodies[0].inertia_kg_m2, whole, kSame);
  ASSERT_EQ(welded->robot.def.bodies.size(), 1u);
  EXPECT_NEAR(welded->robot.def.bodies[0].mass_kg, 1000 * 8 * 0.006 + 1, 1e-9);
}

TEST_F(MjcfImportTest, AKeyframeSaysWhereTheRobotIs) {
  const std::string xml = R"(<mujoco><worldbody><site name="top" pos="0 0 2"/>
    <body name="a" pos="0 0 1" euler="5 6 7"><freejoint/><geom type="box" size="0.1 0.2 0.3" pos="0.1 0 0"/>
      <inertial pos="0.05 0 0.1" mass="2" diaginertia="0.1 0.2 0.15"/><site name="s" pos="0.1 0 0.3"/></body>
    </worldbody><tendon><spatial name="c" stiffness="100"><site site="top"/><site site="s"/></spatial></tendon>
    <keyframe><key/><key name="moved" qpos="0.4 0.3 1.2 0.5 0.5 -0.5 0.5" qvel="1 2 3 0.4 0.5 0.6"/></keyframe>
    </mujoco>)";
  // The model has the name of its only body.
  const auto made = Same(xml, {.keyframe = "moved", .name = "a"}, 1);
  ASSERT_TRUE(made);
  MujocoModel theirs(xml);
  theirs.Key(1);
  mjtNum velocity[6];
  mj_objectVelocity(&theirs.model(), &theirs.data(), mjOBJ_BODY, 1, velocity, 0);
  ExpectNear(made->robot.def.bodies[0].velocity_m_per_s, MujocoModel::Of(velocity + 3), kSame);
  ExpectNear(made->robot.def.bodies[0].angular_velocity_rad_per_s, MujocoModel::Of(velocity),
             kSame);
  EXPECT_NE(Said().find("a model file has no velocities"), std::string::npos);
}

TEST_F(MjcfImportTest, UnitsAreScaledAndAskedFor) {
  const std::string xml = R"(<mujoco model="rod"><option gravity="0 0 -9.81"/><worldbody>
    <site name="top" pos="0 0 30"/><body name="rod" pos="0 0 20"><freejoint/>
    <geom type="cylinder" size="0.5 8" mass="60"/><site name="s" pos="0 0 8"/></body></worldbody>
    <tendon><spatial name="c" stiffness="100" springlength="0 1.5" damping="2"><site site="top"/><site site="s"/></spatial></tendon>
    </mujoco>)";
  Import(xml);
  EXPECT_NE(Said().find("a rod is 16 m long: check that 1 in this file is a meter"),
            std::string::npos);
  EXPECT_NE(Said().find("a body weighs 60 kg: check that 1 in this file is a kilogram"),
            std::string::npos);
  const auto made = Import(xml, {.length_unit_m = 0.1, .mass_unit_kg = 0.01});
  ASSERT_TRUE(made);
  EXPECT_EQ(Said(),
            "model.xml: warning: gravity is 0.981 m/s^2 with this unit of length, the value of the "
            "file (to change it, set gravity_m_per_s2 in the model)\n"
            "model.xml:4: warning: 1 damper of tendons would also act on slack tendons in MuJoCo; "
            "dampers of cables act only under tension\n");
  const ModelDef& def = made->robot.def;
  EXPECT_NEAR(def.gravity_m_per_s2.z, -0.981, kSame);
  EXPECT_NEAR(def.bodies[0].mass_kg, 0.6, kSame);
  ExpectNear(def.bodies[0].inertia_kg_m2,
             SolidCylinder({0, 0, 1.2}, {0, 0, 2.8}, 0.05, 0.6).inertia_kg_m2, kSame);
  EXPECT_NEAR(def.cables[0].stiffness_n_per_m, 1, kSame);
  EXPECT_NEAR(def.cables[0].damping_n_s_per_m, 0.02, kSame);
  EXPECT_NEAR(def.cables[0].rest_length_m, 0.15, kSame);
  EXPECT_NEAR(CableLength(def.cables[0]), 0.2, kSame);
}

}  // namespace
}  // namespace taut::test
