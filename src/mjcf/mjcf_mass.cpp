// Masses of MJCF bodies: sums over geoms, and the lower bounds in MuJoCo's compiler settings.
#include "mjcf/mjcf_mass.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "math/principal_axes.h"
#include "math/vec.h"

namespace taut::mjcf {
namespace {

MassProperties SolidOf(const Shape& s) {
  switch (s.kind) {
    case Shape::Kind::kSphere:
      return SolidSphere(s.pose.p, s.radius, s.mass);
    case Shape::Kind::kCapsule:
      return SolidCapsule(s.from, s.to, s.radius, s.mass);
    case Shape::Kind::kCylinder:
      return SolidCylinder(s.from, s.to, s.radius, s.mass);
    default:
      return SolidBox(s.pose.p, s.pose.q, s.half, s.mass);
  }
}

}  // namespace

double VolumeOf(const Shape& shape) {
  const double r = shape.radius, l = std::sqrt(Dot(shape.to - shape.from, shape.to - shape.from));
  switch (shape.kind) {
    case Shape::Kind::kSphere:
      return 4.0 / 3.0 * std::numbers::pi * r * r * r;
    case Shape::Kind::kCapsule:
      return std::numbers::pi * r * r * l + 4.0 / 3.0 * std::numbers::pi * r * r * r;
    case Shape::Kind::kCylinder:
      return std::numbers::pi * r * r * l;
    case Shape::Kind::kBox:
      return 8 * shape.half.x * shape.half.y * shape.half.z;
    case Shape::Kind::kPlane:
      break;
  }
  return 0;
}

void SumMassOfShapes(Scene& scene, int body, std::size_t first) {
  std::vector<MassProperties> parts;
  Body& its = scene.bodies[Scene::Index(body)];
  for (std::size_t i = first; i < scene.shapes.size(); ++i) {
    const Shape& s = scene.shapes[i];
    if (s.body != body || s.mass == 0) continue;
    its.own_masses = its.own_masses && s.kind != Shape::Kind::kCapsule;
    parts.push_back(SolidOf(s));
  }
  its.mass = Combine(parts);
}

void BoundMass(Scene& scene, int body) {
  Body& its = scene.bodies[Scene::Index(body)];
  if (!scene.Moves(body)) return;
  if (its.mass.mass_kg < scene.settings.boundmass) {
    its.mass.mass_kg = scene.settings.boundmass;
    its.own_masses = false;
  }
  double r[9], moments[3];
  PrincipalAxes(its.mass.inertia_kg_m2, r, moments);
  const double bound = scene.settings.boundinertia;
  if (std::min({moments[0], moments[1], moments[2]}) >= bound) return;
  its.own_masses = false;
  Inertia& j = its.mass.inertia_kg_m2;
  double m[3][3] = {};
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t x = 0; x < 3; ++x) {
      for (std::size_t y = 0; y < 3; ++y) {
        m[x][y] += r[3 * x + a] * std::max(moments[a], bound) * r[3 * y + a];
      }
    }
  }
  j = {m[0][0], m[1][1], m[2][2], m[0][1], m[0][2], m[1][2]};
}

}  // namespace taut::mjcf
