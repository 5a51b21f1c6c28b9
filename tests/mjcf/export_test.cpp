// MJCF export, checked in MuJoCo 2.2.2 and by importing the file again
#include <map>

#include "mjcf/mjcf_folder.h"
#include "mjcf/mujoco_model.h"
#include "mjcf/shipped_robots.h"
#include "sim/contacts/combine.h"
#include "taut/statics.h"
#include "taut/world_batch.h"

namespace taut::test {
namespace {

constexpr double kSameExport = 1e-12;

class Shipment : public MjcfFolder, public testing::WithParamInterface<const char*> {
 protected:
  RobotSpec robot_ = Shipped(GetParam());
};
INSTANTIATE_TEST_SUITE_P(MjcfExport, Shipment, testing::ValuesIn(kExportable));

TEST_P(Shipment, HasItsMassesLengthsAndTensionsInMujoco) {
  const ModelDef& def = robot_.def;
  for (const bool keyframe : {false, true}) {
    MujocoModel theirs(Exported(def, {.keyframe = keyframe}));
    ASSERT_TRUE(theirs);
    if (keyframe) theirs.Key(0);
    for (const BodyDef& body : def.bodies) {
      SCOPED_TRACE(body.name);
      const int id = theirs.Id(mjOBJ_BODY, body.name);
      ASSERT_GT(id, 0);
      EXPECT_NEAR(theirs.model().body_mass[id], body.mass_kg, kSameExport * body.mass_kg);
      ExpectNear(theirs.Com(id), body.com_m, kSameExport);
      ExpectNear(theirs.InertiaOf(id), body.inertia_kg_m2, kSameExport);
    }
    for (const CableDef& cable : def.cables) {
      SCOPED_TRACE(cable.name);
      const int id = theirs.Id(mjOBJ_TENDON, cable.name);
      ASSERT_GE(id, 0);
      EXPECT_NEAR(theirs.data().ten_length[id], CableLength(cable), kSameExport);
      EXPECT_NEAR(theirs.Tension(id), CableTension(cable), kSameExport * cable.stiffness_n_per_m);
    }
    for (const NodeDef& node : def.nodes) {
      ExpectNear(theirs.SitePlace(theirs.Id(mjOBJ_SITE, node.name)), node.position_m, kSameExport);
    }
    EXPECT_EQ(theirs.model().opt.gravity[2], def.gravity_m_per_s2.z);
  }
}

/// Both engines use one small step. The remaining difference is the error of MuJoCo's first-order
/// integrator.
TEST_P(Shipment, MovesFreelyAsItDoesInMujoco) {
  ModelDef def = robot_.def;
  for (SphereDef& s : def.spheres) s.collides = false;
  for (CapsuleDef& c : def.capsules) c.collides = false;
  for (HullDef& h : def.hulls) h.collides = false;
  // Puts all bodies in motion, without slack cables, whose dampers would pull in MuJoCo.
  for (CableDef& cable : def.cables) cable.rest_length_m *= 0.98;
  const double step_s = 2e-5;
  const int steps = 5000;
  MujocoModel theirs(Exported(def));
  ASSERT_TRUE(theirs);
  theirs.Step(step_s, steps);
  Diagnostics out;
  WorldBatch ours(Model::Compile(def, out), {});
  ours.Step(step_s, steps);
  for (std::size_t b = 0; b < def.bodies.size(); ++b) {
    SCOPED_TRACE(def.bodies[b].name);
    const Vec3 p = ours.Body(0, static_cast<int>(b)).position_m;
    ExpectNear(theirs.Com(theirs.Id(mjOBJ_BODY, def.bodies[b].name)), p, 1e-4);
  }
}

bool HasHulls(const ModelDef& def) { return !def.hulls.empty(); }

TEST_P(Shipment, ComesBackAsTheSameRobot) {
  const ModelDef& def = robot_.def;
  if (HasHulls(def)) {
    Write("model.xml", Exported(def));
    EXPECT_NE(Refused(Exported(def)).find("geoms of type mesh are not supported"),
              std::string::npos);
    return;
  }
  const auto made = Import(Exported(def), {.name = def.name});
  ASSERT_TRUE(made);
  const ModelDef& back = made->robot.def;
  EXPECT_EQ(back.name, def.name);
  ASSERT_EQ(back.bodies.size(), def.bodies.size());
  std::map<std::string, const BodyDef*> bodies;
  for (const BodyDef& body : back.bodies) bodies[body.name] = &body;
  const auto name_of = [](const ModelDef& of, int body) {
    return body == kWorld ? "" : of.bodies[static_cast<std::size_t>(body)].name;
  };
  for (const BodyDef& body : def.bodies) {
    SCOPED_TRACE(body.name);
    ASSERT_TRUE(bodies.contains(body.name));
    EXPECT_NEAR(bodies[body.name]->mass_kg, body.mass_kg, kSameExport * body.mass_kg);
    ExpectNear(bodies[body.name]->com_m, body.com_m, kSameExport);
    ExpectNear(bodies[body.name]->inertia_kg_m2, body.inertia_kg_m2, kSameExport);
  }
  // Nodes and shapes by name, with their bodies by name.
  const auto each = [&](const auto& a, const auto& b, auto compare) {
    for (const auto& x : a) {
      SCOPED_TRACE(x.name);
      const auto y =
          std::find_if(b.begin(), b.end(), [&](const auto& o) { return o.name == x.name; });
      ASSERT_TRUE(y != b.end());
      if constexpr (requires { x.body; }) {
        EXPECT_EQ(name_of(back, y->body), name_of(def, x.body));
      }
      compare(x, *y);
    }
  };
  each(def.nodes, back.nodes, [&](const NodeDef& x, const NodeDef& y) {
    ExpectNear(y.position_m, x.position_m, kSameExport);
  });
  EXPECT_EQ(back.spheres.size(), def.spheres.size());
  each(def.spheres, back.spheres, [&](const SphereDef& x, const SphereDef& y) {
    ExpectNear(y.center_m, x.center_m, kSameExport);
    EXPECT_EQ(y.radius_m, x.radius_m);
  });
  EXPECT_EQ(back.capsules.size(), def.capsules.size());
  each(def.capsules, back.capsules, [&](const CapsuleDef& x, const CapsuleDef& y) {
    ExpectNear(y.from_m, x.from_m, kSameExport);
    ExpectNear(y.to_m, x.to_m, kSameExport);
    EXPECT_EQ(y.radius_m, x.radius_m);
  });
  EXPECT_EQ(back.cables.size(), def.cables.size());
  each(def.cables, back.cables, [&](const CableDef& x, const CableDef& y) {
    ASSERT_EQ(y.attachments.size(), x.attachments.size());
    for (std::size_t i = 0; i < x.attachments.size(); ++i) {
      ExpectNear(y.attachments[i].position_m, x.attachments[i].position_m, kSameExport);
      EXPECT_EQ(name_of(back, y.attachments[i].body), name_of(def, x.attachments[i].body));
    }
    EXPECT_NEAR(y.stiffness_n_per_m, x.stiffness_n_per_m, kSameExport * x.stiffness_n_per_m);
    EXPECT_NEAR(y.damping_n_s_per_m, x.damping_n_s_per_m, kSameExport * x.damping_n_s_per_m);
    EXPECT_NEAR(y.rest_length_m, x.rest_length_m, kSameExport);
  });
  ExpectNear(back.gravity_m_per_s2, def.gravity_m_per_s2, kSameExport);
}

TEST(MjcfExport, SpringsHaveADeadBandFromZeroToTheRestLength) {
  const ModelDef def = Shipped("prism3").def;
  const std::string text = Exported(def, {.cables = MjcfCables::kSpring});
  EXPECT_NE(text.find("springlength=\"0 "), std::string::npos);
  EXPECT_EQ(text.find("<actuator>"), std::string::npos);
}

/// Returns a model with every part besides rods and spheres, on every terrain except height fields
/// and meshes.
ModelDef Everything() {
  ModelDef def;
  def.name = "everything";
  const Inertia j{0.02, 0.03, 0.04, 0.001, 0.002, 0.003};
  def.bodies = {{.name = "a",
                 .mass_kg = 1,
                 .com_m = {0.1, 0.2, 1},
                 .inertia_kg_m2 = j,
                 .velocity_m_per_s = {1, 2, 3},
                 .angular_velocity_rad_per_s = {0.1, 0.2, 0.3}},
                {.name = "b",
                 .mass_kg = 2,
                 .com_m = {0, 0, 2},
                 .inertia_kg_m2 = j,
                 .velocity_m_per_s = {},
                 .angular_velocity_rad_per_s = {}},
                {.name = "held",
                 .mass_kg = 0,
                 .com_m = {1, 0, 3},
                 .inertia_kg_m2 = {},
                 .velocity_m_per_s = {},
                 .angular_velocity_rad_per_s = {},
                 .fixed = true}};
  const auto rubbing = [](double mu) {
    Material m;
    m.static_friction = m.kinetic_friction = mu;
    return m;
  };
  const Quat q{0.5, 0.5, -0.5, 0.5};
  def.boxes = {{"ba", 0, {0.1, 0.2, 1.1}, q, {0.1, 0.2, 0.3}, rubbing(0.9), true}};
  def.capsules = {{.name = "rb",
                   .body = 1,
                   .from_m = {0, 0, 2},
                   .to_m = {0.3, 0, 2},
                   .radius_m = 0.01,
                   .material = rubbing(0.3)},
                  {.name = "rh",
                   .body = 2,
                   .from_m = {1, 0, 3},
                   .to_m = {1.3, 0, 3},
                   .radius_m = 0.02,
                   .material = rubbing(0.3)}};
  def.hulls = {
      {"hb", 1, {{0, 0, 2}, {0.2, 0, 2}, {0, 0.3, 2}, {0.05, 0.1, 2.4}}, rubbing(0.5), true}};
  def.nodes = {{"n", 0, {0.1, 0.2, 1}}, {"m", 1, {0.3, 0, 2}}};
  CableDef& cable = def.cables.emplace_back();
  cable.name = "c";
  cable.attachments = {{0, {0.1, 0.2, 1}}, {1, {0.3, 0, 2}}, {kWorld, {0, 0, 4}}};
  cable.stiffness_n_per_m = 100, cable.damping_n_s_per_m = 2, cable.rest_length_m = 0.8;
  JointDef bar;
  bar.name = "bar", bar.kind = JointKind::kDistance, bar.body_a = kWorld, bar.body_b = 0;
  bar.from_m = {0, 0, 0}, bar.to_m = {0.1, 0.2, 1}, bar.collides = true;
  bar.stiffness = 500, bar.damping = 3, bar.rest = 1.1;
  def.joints = {bar};
  def.apart = {{0, 1}};
  def.planes = {{"slope", {0, 0.6, 0.8}, {0, 0, -1}, rubbing(0.4)}};
  def.terrain_boxes = {{"step", {2, 0, 0}, q, {0.3, 0.2, 0.1}, rubbing(0.7)}};
  return def;
}

TEST(MjcfExport, BoxesHullsBarsFixedBodiesAndTerrainAreThere) {
  const ModelDef def = Everything();
  MujocoModel theirs(Exported(def, {.keyframe = true}));
  ASSERT_TRUE(theirs);
  theirs.Key(0);
  const auto geom = [&](const char* name) { return theirs.Id(mjOBJ_GEOM, name); };
  for (const auto& [name, center, q, half] :
       {std::tuple{"ba", def.boxes[0].center_m, def.boxes[0].orientation,
                   def.boxes[0].half_extents_m},
        std::tuple{"step", def.terrain_boxes[0].center_m, def.terrain_boxes[0].orientation,
                   def.terrain_boxes[0].half_extents_m}}) {
    const int g = geom(name);
    ASSERT_GE(g, 0);
    ExpectNear(theirs.GeomPlace(g), center, kSameExport);
    ExpectNear(theirs.GeomAxis(g, 0), Rotate(q, {1, 0, 0}), kSameExport);
    ExpectNear(theirs.GeomAxis(g, 2), Rotate(q, {0, 0, 1}), kSameExport);
    ExpectNear(MujocoModel::Of(theirs.model().geom_size + 3 * g), half, kSameExport);
  }
  ExpectNear(theirs.GeomAxis(geom("slope"), 2), def.planes[0].normal, kSameExport);
  // MuJoCo stores corners in single precision.
  const int hull = geom("hb"), mesh = theirs.model().geom_dataid[hull];
  const float* const corners = theirs.model().mesh_vert + 3 * theirs.model().mesh_vertadr[mesh];
  ASSERT_EQ(theirs.model().mesh_vertnum[mesh], 4);
  for (int i = 0; i < 4; ++i) {
    Vec3 p = theirs.GeomPlace(hull);
    for (int axis = 0; axis < 3; ++axis) {
      p = p + static_cast<double>(corners[3 * i + axis]) * theirs.GeomAxis(hull, axis);
    }
    double nearest = 1;
    for (const Vec3& corner : def.hulls[0].corners_m) {
      nearest = std::min(nearest, std::sqrt(Dot(corner - p, corner - p)));
    }
    EXPECT_LT(nearest, 1e-6);
  }
  EXPECT_EQ(theirs.model().nv, 12);  // "held" is static
  const int bar = theirs.Id(mjOBJ_TENDON, "bar");
  const double length = std::sqrt(0.01 + 0.04 + 1);
  EXPECT_NEAR(theirs.data().ten_length[bar], length, kSameExport);
  EXPECT_NEAR(theirs.Tension(bar), 500 * (length - 1.1), 500 * kSameExport);
  EXPECT_EQ(theirs.model().tendon_damping[bar], 3);
  ExpectNear(MujocoModel::Of(theirs.data().qvel), {1, 2, 3}, 0);
  ExpectNear(MujocoModel::Of(theirs.data().qvel + 3), {0.1, 0.2, 0.3}, 0);
  EXPECT_EQ(theirs.model().nexclude, 1);
}

bool Meet(MujocoModel& m, const std::string& one, const std::string& two) {
  const int a = m.Id(mjOBJ_GEOM, one), b = m.Id(mjOBJ_GEOM, two);
  const int *type = m.model().geom_contype, *with = m.model().geom_conaffinity;
  return (type[a] & with[b]) != 0 || (type[b] & with[a]) != 0;
}

/// A rod whose ends carry spheres contacts the ground with these spheres
/// (mechanics/contact_roles.h).
TEST(MjcfExport, ShapesMeetWhatTheyMeetInTaut) {
  ModelDef def = Everything();
  def.boxes.push_back(def.boxes[0]);
  def.boxes[1].name = "ghost", def.boxes[1].collides = false;
  MujocoModel all(Exported(def));
  for (const char* other : {"slope", "step", "rb", "rh", "hb"}) EXPECT_TRUE(Meet(all, "ba", other));
  for (const char* other : {"slope", "step", "rb"}) EXPECT_FALSE(Meet(all, "ghost", other));
  ModelDef spine = Shipped("tetraspine3").def;
  spine.planes = {{"ground", {0, 0, 1}, {}, {}}};
  MujocoModel on_ground(Exported(spine));
  EXPECT_FALSE(Meet(on_ground, "segment_0.right-left", "ground"));
  EXPECT_TRUE(Meet(on_ground, "segment_0.right-left", "segment_1.right-left"));
  EXPECT_TRUE(Meet(on_ground, "segment_0.right", "ground"));
  EXPECT_FALSE(Meet(on_ground, "segment_0.right", "segment_1.left"));
}

/// Returns MuJoCo's friction of two geoms: of their contact pair, else of the geom with the higher
/// priority, else the larger value.
double Theirs(MujocoModel& m, const std::string& one, const std::string& two) {
  const int a = m.Id(mjOBJ_GEOM, one), b = m.Id(mjOBJ_GEOM, two);
  for (int i = 0; i < m.model().npair; ++i) {
    const int p = m.model().pair_geom1[i], q = m.model().pair_geom2[i];
    if ((p == a && q == b) || (p == b && q == a)) return m.model().pair_friction[5 * i];
  }
  const double f = m.model().geom_friction[3 * a], g = m.model().geom_friction[3 * b];
  const int x = m.model().geom_priority[a], y = m.model().geom_priority[b];
  return x > y ? f : y > x ? g : std::max(f, g);
}

TEST(MjcfExport, EveryPairHasTautsFriction) {
  ModelDef def = Everything();
  def.apart.clear();
  for (const CombineRule rule : {CombineRule::kProduct, CombineRule::kGeometricMean,
                                 CombineRule::kMinimum, CombineRule::kMaximum}) {
    def.friction_combine = rule;
    MujocoModel theirs(Exported(def));
    ASSERT_TRUE(theirs);
    const std::vector<std::pair<std::string, Material>> all{
        {"ba", def.boxes[0].material},
        {"rb", def.capsules[0].material},
        {"rh", def.capsules[1].material},
        {"slope", def.planes[0].material},
        {"step", def.terrain_boxes[0].material}};
    for (const auto& [a, b] : {std::pair{0, 1}, {0, 2}, {0, 3}, {0, 4}, {1, 2}, {1, 3}, {1, 4}}) {
      SCOPED_TRACE(all[a].first + " " + all[b].first + " " +
                   std::to_string(static_cast<int>(rule)));
      EXPECT_NEAR(Theirs(theirs, all[a].first, all[b].first),
                  sim::Combined(def, all[a].second, all[b].second).kinetic_friction, 1e-14);
    }
  }
}

std::string Why(const ModelDef& def, const MjcfExport& options = {}) {
  Diagnostics out;
  EXPECT_FALSE(ExportMjcf(def, options, out));
  return out.Format();
}

TEST(MjcfExport, ABodyNamedWorldGetsAnotherName) {
  ModelDef def = Everything();
  def.bodies[0].name = "world";
  MujocoModel theirs(Exported(def));
  ASSERT_TRUE(theirs);
  EXPECT_GE(theirs.Id(mjOBJ_BODY, "world_2"), 1);
}

TEST(MjcfExport, WhatMjcfCannotSayIsRefusedByName) {
  ModelDef def = Everything();
  def.cables[0].touches = CableTouches::kRods;
  def.cables.push_back(def.cables[0]);
  def.cables[1].name = "rubs", def.cables[1].attachments[1].friction = 0.1;
  def.joints[0].kind = JointKind::kHinge;
  def.motions.emplace_back().body = 1;
  def.height_fields.push_back({.name = "hills",
                               .columns = 2,
                               .rows = 2,
                               .cell_m = 1,
                               .origin_m = {},
                               .height_m = {0, 0, 0, 0},
                               .material = {}});
  def.terrain_meshes.push_back({.name = "rock", .corners_m = {}, .triangles = {}, .material = {}});
  const std::string why = Why(def);
  for (const char* part : {"the cable \"c\": it wraps around obstacles",
                           "the cable \"rubs\": it has friction or runs over wheels",
                           "the joint \"bar\"", "the motion of the body \"b\"",
                           "the height field \"hills\"", "the terrain mesh \"rock\""}) {
    EXPECT_NE(why.find(part), std::string::npos) << part << "\n" << why;
  }
  EXPECT_NE(Why(Everything(), {.cables = MjcfCables::kSpring, .keyframe = true})
                .find("no controls, which a keyframe needs"),
            std::string::npos);
}

TEST(MjcfExport, WhatIsLeftOutIsAWarning) {
  ModelDef def = Everything();
  def.boxes[0].material.restitution = 0.2;
  def.boxes[0].material.static_friction = 1;
  def.cables[0].actuator.kind = ActuatorDef::Kind::kLimited;
  def.cables[0].damping_law = DampingLaw::kClamped;
  def.friction_law = FrictionLaw::kAlongSlip;
  Diagnostics out;
  ASSERT_TRUE(ExportMjcf(def, {}, out));
  EXPECT_EQ(
      out.Format(),
      "warning: left out: `friction_law: along_slip` (MuJoCo's friction acts in both tangential "
      "directions)\n"
      "warning: left out: restitution of \"ba\"\n"
      "warning: left out: static friction other than kinetic friction, of \"ba\"\n"
      "warning: left out: the initial velocity (export a keyframe to keep it) of \"a\"\n"
      "warning: left out: the limit of the damper force to the spring force (`damping_law: "
      "clamped`) of \"c\"\n"
      "warning: left out: the motor's limits of \"c\"\n");
}

}  // namespace
}  // namespace taut::test
