// Checks for model features that MJCF cannot express or that the export omits.
#include <algorithm>

#include "mjcf/write.h"
#include "taut/shape_kinds.h"

namespace taut::mjcf {
namespace {

bool IsSpecial(const Material& m) { return m.stribeck || m.directions; }

/// Calls `f` with the name and material of every shape and ground that collides.
template <class F>
void ForMaterials(const ModelDef& def, F f) {
  EachShape(def, [&](const auto& shape) {
    if (shape.collides) f(shape.name, shape.material);
  });
  const auto all = [&](const auto& list) {
    for (const auto& part : list) f(part.name, part.material);
  };
  all(def.planes), all(def.terrain_boxes), all(def.height_fields);
}

class Refuser {
 public:
  Refuser(const ModelDef& def, const WriteOptions& options, Diagnostics& out)
      : def_(def), options_(options), out_(out) {}

  void Run() {
    for (const CableDef& cable : def_.cables) LookAt(cable);
    for (const JointDef& joint : def_.joints) {
      if (IsBar(joint) && !joint.least && !joint.most && joint.friction == 0 && joint.rest > 0) {
        continue;
      }
      Refuse("the joint \"" + joint.name + "\"",
             IsBar(joint)
                 ? "of bars only the spring, the damper and a rest length above 0 can be exported"
                 : "only bars can be exported");
    }
    for (const MotionDef& motion : def_.motions) {
      Refuse("the motion of the body \"" + def_.bodies[static_cast<std::size_t>(motion.body)].name +
             "\"");
    }
    for (const TerrainMeshDef& mesh : def_.terrain_meshes) {
      Refuse("the terrain mesh \"" + mesh.name + "\"",
             "MuJoCo would replace it by its convex hull");
    }
    for (const HeightFieldDef& field : def_.height_fields) {
      if (options_.as_peer) continue;
      Refuse("the height field \"" + field.name + "\"",
             "MuJoCo 2.2.2 reads heights only from a file");
    }
    if (options_.cables == MjcfCables::kSpring && options_.keyframe) {
      out_.Error("mjcf.springs_without_keyframe", {},
                 "cables exported as springs have no controls, which a keyframe needs");
    }
  }

 private:
  void Refuse(const std::string& what, const std::string& hint = {}) {
    out_.Error("mjcf.not_expressible", {}, "MJCF cannot express " + what, hint);
  }

  void LookAt(const CableDef& cable) {
    const std::string name = "the cable \"" + cable.name + "\": ";
    if (cable.touches != CableTouches::kNone) {
      Refuse(name + "it wraps around obstacles");
    }
    for (const AttachmentDef& at : cable.attachments) {
      if (!at.wheel && at.friction == 0) continue;
      Refuse(name + "it has friction or runs over wheels");
      break;
    }
  }

  const ModelDef& def_;
  const WriteOptions& options_;
  Diagnostics& out_;
};

/// Returns "x" or "x and 3 more".
std::string Some(const std::vector<std::string>& names) {
  std::string text = "\"" + names.front() + "\"";
  if (names.size() > 1) text += " and " + std::to_string(names.size() - 1) + " more";
  return text;
}

}  // namespace

void RefuseWhatMjcfLacks(const ModelDef& def, const WriteOptions& options, Diagnostics& out) {
  Refuser(def, options, out).Run();
}

void WarnOfWhatIsLeftOut(const ModelDef& def, const WriteOptions& options, Diagnostics& out) {
  const auto warn = [&](const std::vector<std::string>& names, const std::string& what) {
    if (!names.empty())
      out.Warning("mjcf.left_out", {}, "left out: " + what + " of " + Some(names));
  };
  std::vector<std::string> restitution, sticking, special, motors, dampers, speeds;
  ForMaterials(def, [&](const std::string& name, const Material& m) {
    if (m.restitution > 0) restitution.push_back(name);
    if (m.static_friction != m.kinetic_friction) sticking.push_back(name);
    if (IsSpecial(m)) special.push_back(name);
  });
  warn(restitution, "restitution");
  warn(sticking, "static friction other than kinetic friction,");
  warn(special, "dependence on speed or direction of the friction");
  for (const CableDef& cable : def.cables) {
    const ActuatorDef::Kind kind = cable.actuator.kind;
    const bool moves = kind != ActuatorDef::Kind::kNone;
    const bool ideal = kind == ActuatorDef::Kind::kIdeal;
    if (options.cables == MjcfCables::kSpring ? moves : moves && !ideal) {
      motors.push_back(cable.name);
    }
    if (cable.damping_law == DampingLaw::kClamped && cable.damping_n_s_per_m > 0) {
      dampers.push_back(cable.name);
    }
  }
  warn(motors, options.cables == MjcfCables::kSpring ? "the motor" : "the motor's limits");
  warn(dampers, "the limit of the damper force to the spring force (`damping_law: clamped`)");
  for (const BodyDef& body : def.bodies) {
    const Vec3 &v = body.velocity_m_per_s, &w = body.angular_velocity_rad_per_s;
    const bool moves = v.x != 0 || v.y != 0 || v.z != 0 || w.x != 0 || w.y != 0 || w.z != 0;
    if (!body.fixed && moves) speeds.push_back(body.name);
  }
  if (!options.keyframe) warn(speeds, "the initial velocity (export a keyframe to keep it)");
  if (options.cables == MjcfCables::kSpring) {
    const auto damped = std::find_if(def.cables.begin(), def.cables.end(),
                                     [](const CableDef& c) { return c.damping_n_s_per_m > 0; });
    if (damped != def.cables.end()) {
      out.Warning("mjcf.dampers_of_slack_tendons", {},
                  "dampers of MuJoCo's tendons also act on slack cables, and push",
                  "export cables as actuators, which do not push");
    }
  }
  if (def.friction_law != FrictionLaw::kCone)
    out.Warning("mjcf.friction_along_slip", {}, "left out: `friction_law: along_slip`",
                "MuJoCo's friction acts in both tangential directions");
}

}  // namespace taut::mjcf
