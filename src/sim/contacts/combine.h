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

inline Coefficients Combined(CombineRule friction, CombineRule restitution, const Material& a,
                             const Material& b) {
  return {Combine(friction, a.static_friction, b.static_friction),
          Combine(friction, a.kinetic_friction, b.kinetic_friction),
          Combine(restitution, a.restitution, b.restitution)};
}
inline Coefficients Combined(const ModelDef& def, const Material& a, const Material& b) {
  return Combined(def.friction_combine, def.restitution_combine, a, b);
}

}  // namespace taut::sim
