#include "taut/statics.h"

#include <cmath>

#include "math/cable_law.h"
#include "math/described_path.h"

namespace taut {
double WheelStartAngle(const CableDef& cable, std::size_t i) { return math::StartAngle(cable, i); }

double CableLength(const CableDef& cable) { return math::DescribedPath(cable).length_m(); }

double CableTension(const CableDef& cable) {
  return std::fmax(
      0.0, math::CableLaw{cable.stiffness_n_per_m}.Force(CableLength(cable) - cable.rest_length_m));
}

std::vector<BodyLoad> StartLoads(const ModelDef& def) {
  struct Sum {
    Vec3 force, torque;  ///< About the center of mass of the body.
  };
  std::vector<Sum> sums(def.bodies.size() + 1);  // the last one is the world
  const auto index = [&](int body) {
    return body == kWorld ? def.bodies.size() : static_cast<std::size_t>(body);
  };
  for (const CableDef& cable : def.cables) {
    math::DescribedPath path(cable);
    const auto body = [&](int i) { return cable.attachments[path.attachment(i)].body; };
    for (int i = 0; i < path.count(); ++i) {
      const Vec3 origin = body(i) == kWorld ? Vec3{} : def.bodies[index(body(i))].com_m;
      path.points()[i].arm = path.points()[i].p - origin;
    }
    PullBodies(path.count(), path.points(), CableTension(cable),
               [&](int i) -> Sum& { return sums[index(body(i))]; });
  }
  std::vector<BodyLoad> loads(def.bodies.size());
  for (std::size_t body = 0; body < loads.size(); ++body) {
    loads[body].weight_n = def.bodies[body].mass_kg * def.gravity_m_per_s2;
    loads[body].cable_force_n = sums[body].force;
    loads[body].cable_torque_n_m = sums[body].torque;
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

std::vector<std::vector<ShapeCount>> CollidingShapes(const ModelDef& def) {
  std::vector<std::vector<ShapeCount>> counts(def.bodies.size());
  const auto count = [&](const ShapeName& name, const auto& shapes) {
    for (auto& of_body : counts) of_body.push_back({name, 0});
    for (const auto& shape : shapes) {
      counts[static_cast<std::size_t>(shape.body)].back().count += shape.collides;
    }
  };
  EachShapeList(count, def);
  return counts;
}

}  // namespace taut
