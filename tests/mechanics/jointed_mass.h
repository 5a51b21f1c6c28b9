/// A point mass and a joint at a given place, for scenes of one body on one joint.
#pragma once

#include "taut/model_def.h"

namespace taut::mechanics {

/// Returns a mass of 1 kg at `at`, far smaller than all distances.
inline ModelDef PointMass(const Vec3& at, const Vec3& velocity, double inertia_kg_m2 = 1e-6) {
  ModelDef def;
  BodyDef body;
  body.name = "mass", body.mass_kg = 1, body.com_m = at, body.velocity_m_per_s = velocity;
  body.inertia_kg_m2.xx = body.inertia_kg_m2.yy = body.inertia_kg_m2.zz = inertia_kg_m2;
  def.bodies.push_back(body);
  return def;
}

inline JointDef JointAt(JointKind kind, const Vec3& at, const Vec3& axis) {
  JointDef joint;
  joint.name = "joint", joint.kind = kind, joint.axis = axis, joint.from_m = joint.to_m = at;
  return joint;
}

}  // namespace taut::mechanics
