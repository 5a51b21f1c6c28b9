#include "benchmarks/peers/peer.h"

#include <stdexcept>

#include "benchmarks/peers/adapters.h"
#include "sim/contacts/combine.h"

namespace taut::peers {
namespace {

struct Entry {
  const char* name;
  std::unique_ptr<World> (*make)(const ModelDef&, const Options&);
  std::string (*version)();
};

const Entry& Of(Engine engine) {
  static const Entry kMujoco{"mujoco",
#ifdef TAUT_PEER_MUJOCO
                             MakeMujoco, MujocoVersion
#else
                             nullptr, nullptr
#endif
  };
  static const Entry kBullet{"bullet",
#ifdef TAUT_PEER_BULLET
                             MakeBullet, BulletVersion
#else
                             nullptr, nullptr
#endif
  };
  static const Entry kOde{"ode",
#ifdef TAUT_PEER_ODE
                          MakeOde, OdeVersion
#else
                          nullptr, nullptr
#endif
  };
  return engine == Engine::kMujoco ? kMujoco : engine == Engine::kBullet ? kBullet : kOde;
}

bool Same(const Material& a, const Material& b) {
  return a.static_friction == b.static_friction && a.kinetic_friction == b.kinetic_friction &&
         a.restitution == b.restitution;
}

/// Returns the material of the first shape that collides; null without one.
const Material* FirstMaterial(const ModelDef& def) {
  for (const SphereDef& s : def.spheres) {
    if (s.collides) return &s.material;
  }
  for (const CapsuleDef& c : def.capsules) {
    if (c.collides) return &c.material;
  }
  for (const BoxDef& b : def.boxes) {
    if (b.collides) return &b.material;
  }
  return nullptr;
}

/// Returns the materials of all kinds of ground that peers support.
std::vector<const Material*> Grounds(const ModelDef& def) {
  std::vector<const Material*> found;
  for (const PlaneDef& p : def.planes) found.push_back(&p.material);
  for (const HeightFieldDef& f : def.height_fields) found.push_back(&f.material);
  return found;
}

Contact Between(const ModelDef& def, const Material& a, const Material& b) {
  const sim::Coefficients both = sim::Combined(def, a, b);
  return {both.kinetic_friction, both.restitution};
}

}  // namespace

const char* Name(Engine engine) { return Of(engine).name; }
bool Available(Engine engine) { return Of(engine).make != nullptr; }
std::string Version(Engine engine) {
  return Available(engine) ? Of(engine).version() : "not built in";
}

std::string Unsupported(const ModelDef& def) {
  if (!def.terrain_boxes.empty()) return "terrain boxes";
  if (!def.terrain_meshes.empty()) return "terrain meshes";
  if (def.height_fields.size() > 1) return "more than one height field";
  for (const HeightFieldDef& f : def.height_fields) {  // MuJoCo and ODE divide all cells alike
    if (f.split != HeightFieldDef::Split::kSame) return "height fields whose `split` is not `same`";
  }
  if (!def.hulls.empty()) return "hulls";
  for (const CableDef& cable : def.cables) {
    if (cable.touches != CableTouches::kNone) return "cables with `touches`";
    for (const AttachmentDef& at : cable.attachments) {
      if (at.wheel || at.friction > 0) return "cables with friction or over wheels";
    }
  }
  if (!def.motions.empty()) return "kinematic bodies";
  if (!def.joints.empty() || !def.apart.empty()) return "joints, and bodies that are kept apart";
  for (const BodyDef& body : def.bodies) {
    if (body.fixed) return "the fixed body " + body.name;
  }
  for (const CableDef& cable : def.cables) {
    if (cable.damping_law != DampingLaw::kExact) return "the damping law of cable " + cable.name;
  }
  const Material* const material = FirstMaterial(def);
  const auto special = [](const Material& m) { return m.stribeck || m.directions; };
  for (const Material* const ground : Grounds(def)) {
    if (special(*ground)) return "friction by speed or by direction";
  }
  if (material != nullptr && special(*material)) return "friction by speed or by direction";
  const auto fits = [&](const Material& m) { return Same(m, *material) && !special(m); };
  for (const SphereDef& s : def.spheres) {
    if (s.collides && !fits(s.material)) return "shapes of different materials";
  }
  for (const CapsuleDef& c : def.capsules) {
    if (c.collides && !fits(c.material)) return "shapes of different materials";
  }
  for (const BoxDef& b : def.boxes) {
    if (b.collides && !fits(b.material)) return "shapes of different materials";
  }
  for (const Material* const ground : Grounds(def)) {
    if (ground->static_friction != ground->kinetic_friction) {
      return "static friction that differs from kinetic friction";
    }
  }
  if (material != nullptr && material->static_friction != material->kinetic_friction) {
    return "static friction that differs from kinetic friction";
  }
  if (def.friction_law != FrictionLaw::kCone) return "the friction law along_slip";
  return "";
}

Contact BetweenBodies(const ModelDef& def) {
  const Material* const m = FirstMaterial(def);
  return m == nullptr ? Contact{} : Between(def, *m, *m);
}

Contact WithGround(const ModelDef& def, const Material& ground) {
  const Material* const m = FirstMaterial(def);
  return m == nullptr ? Contact{} : Between(def, *m, ground);
}

std::unique_ptr<World> MakeWorld(Engine engine, const ModelDef& def, const Options& options) {
  if (!Available(engine)) {
    throw std::invalid_argument(std::string(Name(engine)) + " is not built in");
  }
  const std::string why = Unsupported(def);
  if (!why.empty()) throw std::invalid_argument("the other engines do not support " + why);
  return Of(engine).make(def, options);
}

}  // namespace taut::peers
