#include "peers/peer.h"

#include <stdexcept>

#include "peers/adapters.h"
#include "sim/combine.h"

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

/// The material of the first shape that collides; nothing without one.
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
  if (!def.height_fields.empty() || !def.terrain_meshes.empty()) return "height fields and meshes";
  if (!def.motions.empty()) return "bodies that a program moves";
  if (!def.joints.empty() || !def.apart.empty()) return "joints, and bodies that are kept apart";
  for (const BodyDef& body : def.bodies) {
    if (body.fixed) return "the fixed body " + body.name;
  }
  for (const CableDef& cable : def.cables) {
    if (cable.damping_law != DampingLaw::kExact) return "the damping law of cable " + cable.name;
  }
  const Material* const material = FirstMaterial(def);
  const auto special = [](const Material& m) { return m.stribeck || m.directions; };
  for (const PlaneDef& p : def.planes) {
    if (special(p.material)) return "friction by speed or by direction";
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
  for (const PlaneDef& p : def.planes) {
    if (p.material.static_friction != p.material.kinetic_friction) {
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

Contact WithPlane(const ModelDef& def, int plane) {
  const Material* const m = FirstMaterial(def);
  return m == nullptr ? Contact{}
                      : Between(def, *m, def.planes[static_cast<std::size_t>(plane)].material);
}

std::unique_ptr<World> MakeWorld(Engine engine, const ModelDef& def, const Options& options) {
  if (!Available(engine)) {
    throw std::invalid_argument(std::string(Name(engine)) + " is not built in");
  }
  const std::string why = Unsupported(def);
  if (!why.empty()) throw std::invalid_argument("the peers do not know " + why);
  return Of(engine).make(def, options);
}

}  // namespace taut::peers
