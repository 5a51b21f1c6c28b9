/// Load case: static loads on a robot or structure, for `taut/analysis.h` (docs/theory/loads.md).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "taut/types.h"

namespace taut {

/// Load case of an experiment. Indices are positions in the robot's `ModelDef`.
struct LoadCaseSpec {
  struct NodeForce {
    int node = 0;
    Vec3 force_n;  ///< Force, in W.
  };
  struct Settlement {
    int joint = 0;  ///< Support whose point in the world moves.
    Vec3 by_m;      ///< Displacement, in W.
  };
  struct Lengthening {
    int index = 0;  ///< Index of a cable or, in `bars`, of a joint that is a bar.
    double by_m = 0.0;
  };
  std::string name;
  bool weight = true;          ///< Whether gravity acts.
  double weight_factor = 1.0;  ///< Partial factor on gravity, if it acts.
  std::vector<NodeForce> forces;
  std::vector<Settlement> settlements;
  /// Increase of rest lengths, including thermal expansion.
  std::vector<Lengthening> cables, bars;
  /// Limit of the displacement of any node from its described place; absent: none.
  std::optional<double> max_displacement_m;

  /// Factor on gravity; 0 without weight.
  double GravityFactor() const { return weight ? weight_factor : 0.0; }
};

}  // namespace taut
