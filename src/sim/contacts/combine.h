/// Combination rules for the friction and restitution coefficients of two materials.
#pragma once

#include <algorithm>
#include <cmath>

#include "taut/model_def.h"

namespace taut::sim {

inline double Combine(CombineRule rule, double a, double b) {
  switch (rule) {
    case CombineRule::kProduct:
      return a * b;
    case CombineRule::kGeometricMean:
      return std::sqrt(a * b);
    case CombineRule::kMinimum:
      return std::min(a, b);
    default:
      return std::max(a, b);
  }
}

struct Coefficients {
  double static_friction, kinetic_friction, restitution;
};

inline Coefficients Combined(const ModelDef& def, const Material& a, const Material& b) {
  return {Combine(def.friction_combine, a.static_friction, b.static_friction),
          Combine(def.friction_combine, a.kinetic_friction, b.kinetic_friction),
          Combine(def.restitution_combine, a.restitution, b.restitution)};
}

}  // namespace taut::sim
