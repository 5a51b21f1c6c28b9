/// Range of heights of a height field.
#pragma once

#include <algorithm>

#include "taut/model_def.h"

namespace taut::mechanics {

struct HeightRange {
  double least_m = 0, most_m = 0;  ///< Heights without the origin of the field.
};
inline HeightRange HeightsOf(const HeightFieldDef& field) {
  const auto [least, most] = std::minmax_element(field.height_m.begin(), field.height_m.end());
  return {*least, *most};
}

}  // namespace taut::mechanics
