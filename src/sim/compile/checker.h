/// Shared helpers for checks of a model definition.
#pragma once

#include <cmath>
#include <string>

#include "taut/diagnostics.h"
#include "taut/model_def.h"

namespace taut::sim {

/// Checks values and reports errors with the names of elements; file positions are unknown here.
class Checker {
 public:
  Checker(const ModelDef& def, Diagnostics& out)
      : out_(out), cone_(def.friction_law == FrictionLaw::kCone) {}
  void Require(bool good, const std::string& what) {
    if (!good) out_.Error("model.invalid", {}, what);
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
            what + " refers to a body that does not exist");
  }
  /// Checks surface properties. `has_axis`: the shape itself defines a forward direction.
  void Surface(const Material& m, const std::string& what, bool has_axis = false) {
    NonNegative(m.kinetic_friction, what + ": kinetic friction");
    NonNegative(m.static_friction, what + ": static friction");
    Require(!(m.static_friction < m.kinetic_friction),
            what + ": static friction must not be below kinetic friction");
    Require(m.restitution >= 0 && m.restitution <= 1, what + ": restitution must be within 0..1");
    if (m.stribeck) {
      Positive(m.stribeck->speed_m_per_s, what + ": Stribeck's speed");
      NonNegative(m.stribeck->viscous_friction_s_per_m, what + ": viscous friction");
    }
    if (m.directions) Directions(*m.directions, what, has_axis);
  }
  void Directions(const FrictionDirections& d, const std::string& what, bool has_axis) {
    NonNegative(d.forward, what + ": forward friction factor");
    NonNegative(d.backward, what + ": backward friction factor");
    NonNegative(d.sideways, what + ": sideways friction factor");
    Finite(d.axis, what + ": friction axis");
    Require(has_axis || d.axis.x != 0 || d.axis.y != 0 || d.axis.z != 0,
            what + ": the friction axis must not be zero; only rods have a default axis");
    Require(cone_, what + ": directional friction needs FrictionLaw::kCone");
  }
  void Member(const MemberDef& m, const std::string& what) {
    NonNegative(m.area_m2, what + ": area");
    NonNegative(m.young_pa, what + ": Young's modulus");
    NonNegative(m.second_moment_m4, what + ": second moment of area");
    NonNegative(m.buckling_length_m, what + ": buckling length");
    NonNegative(m.yield_pa, what + ": yield stress");
    NonNegative(m.strength_n, what + ": strength");
    Require(std::isfinite(m.expansion_per_k), what + ": thermal expansion must be finite");
    NonNegative(m.mass_kg, what + ": member mass");
  }

 private:
  Diagnostics& out_;
  bool cone_;
};

/// Checks height fields and meshes (surface_check.cpp).
void CheckGround(const ModelDef& def, Checker& check);

/// Checks joints and pairs of bodies that cannot collide (joint_check.cpp).
void CheckJoints(const ModelDef& def, Checker& check);

/// Checks motions of kinematic bodies (motion_check.cpp).
void CheckMotions(const ModelDef& def, Checker& check);

}  // namespace taut::sim
