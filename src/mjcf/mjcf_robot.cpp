// Conversion of an MJCF scene to a robot: initial state, units, and a report of omitted elements.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/brief.h"
#include "math/vec.h"
#include "mechanics/placed_parts.h"
#include "mjcf/mjcf_build.h"

namespace taut::mjcf {
namespace {

/// Motion of bodies from qpos0 to the poses of the keyframe.
struct ToKey {
  std::vector<Pose> motions;  ///< Per body of the robot.
  std::vector<Vec3> coms;     ///< Centers of mass in the described pose.
  bool Moves(int body) const { return body != kWorld; }
  Vec3 Moved(int body, const Vec3& p) const {
    return (motions[Scene::Index(body)] * Pose{p, {}}).p;
  }
  const Quat& Turned(int body) const { return motions[Scene::Index(body)].q; }
};

/// Returns the requested keyframe. Null without an error if none was requested.
const Key* FindKey(const Scene& scene, const std::string& asked, const std::string& path,
                   Diagnostics& out) {
  if (asked.empty()) return nullptr;
  std::vector<std::string> known;
  for (const Key& key : scene.keys) {
    if (key.name == asked) return &key;
    known.push_back(key.name.empty() ? std::to_string(known.size()) : key.name);
  }
  for (std::size_t i = 0; i < scene.keys.size(); ++i) {
    if (std::to_string(i) == asked) return &scene.keys[i];
  }
  out.Error("mjcf.unknown_key", {path}, "there is no keyframe \"" + asked + '"',
            known.empty() ? "the file has no keyframes" : DidYouMean(asked, known));
  return nullptr;
}

void SetTotalMass(Scene& scene) {
  if (!(scene.settings.settotalmass > 0)) return;
  double total = 0;
  for (const Body& body : scene.bodies) total += body.mass.mass_kg;
  if (!(total > 0)) return;
  const double s = scene.settings.settotalmass / total;
  for (Body& body : scene.bodies) {
    Inertia& j = body.mass.inertia_kg_m2;
    body.mass.mass_kg *= s;
    j = {s * j.xx, s * j.yy, s * j.zz, s * j.xy, s * j.xz, s * j.yz};
  }
}

void TellWhatIsLeftOut(Building& b) {
  std::string text;
  for (const auto& [what, count] : b.scene.left_out) {
    text +=
        (text.empty() ? "" : ", ") + what + (count > 1 ? " (" + std::to_string(count) + ")" : "");
  }
  if (!text.empty()) b.Note("left out: " + text);
  if (const auto& twisting = b.scene.twisting; !twisting.empty()) {
    b.out.Warning("mjcf.torsional_friction", twisting[0],
                  "torsional and rolling friction (condim above 3) is left out" +
                      (twisting.size() > 1
                           ? " here and in " + std::to_string(twisting.size() - 1) + " more places"
                           : std::string()));
  }
  if (b.scene.pictures > 0) {
    b.Note("left out: " + Count(static_cast<std::size_t>(b.scene.pictures), "visual tendon") +
           " without stiffness and actuator");
  }
  std::vector<std::string> renamed;
  for (const Rigid& rigid : b.rigids) {
    if (rigid.body == kWorld) continue;
    const std::string& was = b.scene.bodies[Scene::Index(rigid.root)].name;
    const std::string& is = b.def().bodies[Scene::Index(rigid.body)].name;
    if (was != is) renamed.push_back(was + " is " + is);
  }
  if (!renamed.empty()) {
    b.Note("renamed bodies: " + renamed[0] +
           (renamed.size() > 1 ? " and " + std::to_string(renamed.size() - 1) + " more" : ""));
  }
}

}  // namespace

void PutAt(const Key* key, Building& b) {
  if (!key || (key->qpos.empty() && key->qvel.empty())) return;
  ModelDef& def = b.def();
  ToKey to{std::vector<Pose>(def.bodies.size()), {}};
  std::size_t free = 0;
  for (std::size_t i = 0; i < b.scene.bodies.size(); ++i) {
    const Body& body = b.scene.bodies[i];
    if (!body.is_free) continue;
    const std::size_t q = 7 * free, v = 6 * free;
    ++free;
    if (body.root != static_cast<int>(i)) continue;  // moves with the body to which it is welded
    if (body.aligned) {
      b.out.Error("mjcf.aligned_free_joint", body.at,
                  "the free joint of body \"" + body.name +
                      "\" has align=\"true\", which is not supported with poses of keyframes",
                  "set align=\"false\" to keep the frame of the body");
      return;
    }
    const int made = b.RigidOf(static_cast<int>(i)).body;
    Pose now = body.frame;
    if (!key->qpos.empty()) {
      const double* n = key->qpos.data() + q;
      const double size = std::sqrt(n[3] * n[3] + n[4] * n[4] + n[5] * n[5] + n[6] * n[6]);
      if (size < 1e-14) {
        b.out.Error(
            "mjcf.zero_orientation", key->at,
            "the keyframe \"" + key->name + "\" has an orientation quaternion without length");
        return;
      }
      now = {{n[0], n[1], n[2]}, {n[3] / size, n[4] / size, n[5] / size, n[6] / size}};
    }
    const Quat turn = now.q * Conjugate(body.frame.q);
    to.motions[Scene::Index(made)] = {now.p - Rotate(turn, body.frame.p), turn};
    if (key->qvel.empty()) continue;
    // MuJoCo's qvel: velocity of the body's origin in W, angular velocity in the body's axes.
    const double* n = key->qvel.data() + v;
    BodyDef& its = def.bodies[Scene::Index(made)];
    const Vec3 w = Rotate(now.q, {n[3], n[4], n[5]});
    const Vec3 com = to.Moved(made, its.com_m);
    its.velocity_m_per_s = Vec3{n[0], n[1], n[2]} + Cross(w, com - now.p);
    its.angular_velocity_rad_per_s = w;
  }
  if (!key->qpos.empty()) {
    MoveParts(to, def);
    for (std::size_t i = 0; i < def.bodies.size(); ++i) {
      const int body = static_cast<int>(i);
      def.bodies[i].com_m = to.Moved(body, def.bodies[i].com_m);
      def.bodies[i].inertia_kg_m2 = Turned(to.Turned(body), def.bodies[i].inertia_kg_m2);
    }
    for (SolidsSpec::PointMass& mass : b.made.robot.solids->point_masses) {
      const int body = def.nodes[Scene::Index(mass.node)].body;
      if (mass.inertia_kg_m2) mass.inertia_kg_m2 = Turned(to.Turned(body), *mass.inertia_kg_m2);
    }
  }
  const bool moving =
      std::any_of(key->qvel.begin(), key->qvel.end(), [](double n) { return n != 0; });
  if (moving)
    b.out.Warning("mjcf.key_velocities", key->at,
                  "the velocities of the keyframe are left out: a model file has no velocities");
}

void ScaleUnits(Building& b) {
  ModelDef& def = b.def();
  const double l = b.options.length_unit_m.value_or(1), m = b.options.mass_unit_kg.value_or(1);
  const auto scale = [&](Vec3& v) { v = l * v; };
  const auto scale_inertia = [&](Inertia& j) {
    const double s = m * l * l;
    j = {s * j.xx, s * j.yy, s * j.zz, s * j.xy, s * j.xz, s * j.yz};
  };
  for (BodyDef& body : def.bodies) {
    body.mass_kg *= m;
    scale(body.com_m), scale_inertia(body.inertia_kg_m2), scale(body.velocity_m_per_s);
  }
  for (SphereDef& s : def.spheres) scale(s.center_m), s.radius_m *= l;
  for (CapsuleDef& c : def.capsules) scale(c.from_m), scale(c.to_m), c.radius_m *= l;
  for (BoxDef& box : def.boxes) scale(box.center_m), scale(box.half_extents_m);
  for (NodeDef& node : def.nodes) scale(node.position_m);
  for (CableDef& cable : def.cables) {
    for (AttachmentDef& at : cable.attachments) scale(at.position_m);
    cable.stiffness_n_per_m *= m, cable.damping_n_s_per_m *= m, cable.rest_length_m *= l;
  }
  for (JointDef& bar : def.joints) {
    scale(bar.from_m), scale(bar.to_m);
    bar.stiffness *= m, bar.damping *= m, bar.rest *= l, bar.friction *= m * l;
  }
  for (PlaneDef& p : def.planes) scale(p.point_m);
  for (TerrainBoxDef& box : def.terrain_boxes) scale(box.center_m), scale(box.half_extents_m);
  scale(def.gravity_m_per_s2);
  SolidsSpec& solids = *b.made.robot.solids;
  for (auto* list : {&solids.spheres, &solids.capsules, &solids.boxes}) {
    for (SolidMass& mass : *list) mass.value *= m;
  }
  for (SolidsSpec::PointMass& mass : solids.point_masses) {
    mass.mass_kg *= m;
    if (mass.inertia_kg_m2) scale_inertia(*mass.inertia_kg_m2);
  }

  // Above these values, the file probably uses other units.
  constexpr double kLong_m = 2, kHeavy_kg = 50, kEarth = 9.81;
  double longest = 0, heaviest = 0;
  for (const CapsuleDef& rod : def.capsules)
    longest = std::max(longest, Length(rod.to_m - rod.from_m));
  for (const BodyDef& body : def.bodies) heaviest = std::max(heaviest, body.mass_kg);
  const SourceRef whole{b.scene.bodies.front().at.file, 0, 0};
  const double g = Length(def.gravity_m_per_s2);
  if (longest > kLong_m && !b.options.length_unit_m) {
    b.out.Warning(
        "mjcf.length_unit", whole,
        "a rod is " + base::Brief(longest, 3) + " m long: check that 1 in this file is a meter",
        "set --length_unit_m");
  }
  if (heaviest > kHeavy_kg && !b.options.mass_unit_kg) {
    b.out.Warning(
        "mjcf.mass_unit", whole,
        "a body weighs " + base::Brief(heaviest) + " kg: check that 1 in this file is a kilogram",
        "set --mass_unit_kg");
  }
  if (l != 1 && g > 0 && std::fabs(g / kEarth - 1) > 0.02) {
    b.out.Warning("mjcf.gravity", whole,
                  "gravity is " + base::Brief(g, 3) +
                      " m/s^2 with this unit of length, the value of the file",
                  "to change it, set gravity_m_per_s2 in the model");
  }
}

std::optional<ImportedMjcf> BuildRobot(Scene& scene, const std::string& path,
                                       const MjcfImport& options, Diagnostics& out) {
  const std::size_t errors_before = out.items().size();
  ImportedMjcf made;
  Building b{scene, options, made, out, {}, {}, {}, {}, {}, {}, {}};
  const std::string stem = std::filesystem::path(path).stem().string();
  made.robot.def.name = ToName(!options.name.empty()  ? options.name
                               : !scene.model.empty() ? scene.model
                                                      : stem,
                               "robot");
  made.robot.def.gravity_m_per_s2 = scene.gravity;
  made.step_s = scene.timestep;
  const Key* const key = FindKey(scene, options.keyframe, path, out);
  SetTotalMass(scene);
  FindWhatCollides(b);
  FindRigids(b);
  BuildBodies(b);
  if (out.items().size() != errors_before) return std::nullopt;
  NameBodies(b);
  BuildContacts(b);
  PutAt(key, b);
  if (out.items().size() != errors_before) return std::nullopt;
  BuildCables(key, b);
  if (made.robot.def.bodies.empty())
    out.Error("mjcf.no_body", {path}, "there is no body in this file");
  if (out.items().size() != errors_before) return std::nullopt;
  ScaleUnits(b);
  TellWhatIsLeftOut(b);
  return made;
}

}  // namespace taut::mjcf
