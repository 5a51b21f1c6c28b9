/// What the checks of a model definition have in common.
#pragma once

#include <cmath>
#include <string>

#include "taut/diagnostics.h"
#include "taut/model_def.h"

namespace taut::sim {

/// Checks numbers and names what is wrong; there are no file positions at this level.
class Checker {
 public:
  explicit Checker(Diagnostics& out) : out_(out) {}
  void Require(bool good, const std::string& what) {
    if (!good) out_.Error({}, what);
  }
  void Positive(double x, const std::string& what) {
    Require(x > 0 && std::isfinite(x), what + " must be a positive number");
  }
  void NonNegative(double x, const std::string& what) {
    Require(x >= 0 && std::isfinite(x), what + " must be zero or a positive number");
  }
  void Finite(const Vec3& p, const std::string& what) {
    Require(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z),
            what + " must be finite");
  }
  void Body(int body, const ModelDef& def, const std::string& what) {
    Require(body >= kWorld && body < static_cast<int>(def.bodies.size()),
            what + " refers to a body that is not there");
  }
  void Surface(const Material& m, const std::string& what) {
    NonNegative(m.kinetic_friction, what + ": kinetic friction");
    NonNegative(m.static_friction, what + ": static friction");
    Require(!(m.static_friction < m.kinetic_friction),
            what + ": static friction must not be below kinetic friction");
    Require(m.restitution >= 0 && m.restitution <= 1, what + ": restitution must be 0..1");
  }

 private:
  Diagnostics& out_;
};

/// Height fields and meshes (surface_check.cpp).
void CheckGround(const ModelDef& def, Checker& check);

/// Joints, and bodies that are kept apart (joint_check.cpp).
void CheckJoints(const ModelDef& def, Checker& check);

}  // namespace taut::sim
