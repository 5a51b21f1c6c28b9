/// Small models for the forces that hold a pose
#pragma once

#include <string>
#include <vector>

#include "taut/model_def.h"

namespace taut::test {

inline BodyDef Body(const std::string& name, double mass_kg, const Vec3& com_m) {
  BodyDef body;
  body.name = name, body.mass_kg = mass_kg, body.com_m = com_m;
  body.inertia_kg_m2 = {0.01, 0.01, 0.01, 0, 0, 0};
  return body;
}

/// Returns a cable from `from` of the world to a point of body 0.
inline CableDef CableTo(const std::string& name, const Vec3& from, const Vec3& to,
                        double stiffness_n_per_m = 1000) {
  CableDef cable;
  cable.name = name;
  cable.attachments = {{kWorld, from}, {0, to}};
  cable.stiffness_n_per_m = stiffness_n_per_m, cable.rest_length_m = 1;
  return cable;
}

inline PlaneDef Plane(const std::string& name, const Vec3& normal, double friction) {
  PlaneDef plane;
  plane.name = name, plane.normal = normal;
  plane.material.static_friction = plane.material.kinetic_friction = friction;
  return plane;
}

}  // namespace taut::test
