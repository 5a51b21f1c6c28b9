#include "taut/statics.h"

#include <cmath>

#include "math/vec.h"

namespace taut {
namespace {

double Length(const Vec3& a) { return std::sqrt(Dot(a, a)); }

}  // namespace

double CableLength(const CableDef& cable) {
  double length = 0.0;
  for (std::size_t i = 1; i < cable.attachments.size(); ++i) {
    length += Length(cable.attachments[i].position_m - cable.attachments[i - 1].position_m);
  }
  return length;
}

double CableTension(const CableDef& cable) {
  return std::fmax(0.0, cable.stiffness_n_per_m * (CableLength(cable) - cable.rest_length_m));
}

std::vector<BodyLoad> StartLoads(const ModelDef& def) {
  std::vector<BodyLoad> loads(def.bodies.size());
  const auto pull = [&](const AttachmentDef& at, const Vec3& force) {
    if (at.body == kWorld) return;
    BodyLoad& load = loads[at.body];
    load.cable_force_n = load.cable_force_n + force;
    load.cable_torque_n_m =
        load.cable_torque_n_m + Cross(at.position_m - def.bodies[at.body].com_m, force);
  };
  for (const CableDef& cable : def.cables) {
    const double tension = CableTension(cable);
    for (std::size_t i = 1; i < cable.attachments.size(); ++i) {
      const AttachmentDef& a = cable.attachments[i - 1];
      const AttachmentDef& b = cable.attachments[i];
      const Vec3 leg = b.position_m - a.position_m;
      const double length = Length(leg);
      if (length == 0.0) continue;
      const Vec3 force = (tension / length) * leg;
      pull(a, force);
      pull(b, -1.0 * force);
    }
  }
  for (std::size_t body = 0; body < loads.size(); ++body) {
    loads[body].weight_n = def.bodies[body].mass_kg * def.gravity_m_per_s2;
  }
  return loads;
}

double TotalMass(const ModelDef& def) {
  double mass = 0.0;
  for (const BodyDef& body : def.bodies) {
    if (!body.fixed) mass += body.mass_kg;
  }
  return mass;
}

std::vector<ShapeCount> CollidingShapes(const ModelDef& def) {
  std::vector<ShapeCount> counts(def.bodies.size());
  for (const CapsuleDef& shape : def.capsules) counts[shape.body].capsules += shape.collides;
  for (const SphereDef& shape : def.spheres) counts[shape.body].spheres += shape.collides;
  for (const BoxDef& shape : def.boxes) counts[shape.body].boxes += shape.collides;
  return counts;
}

}  // namespace taut
