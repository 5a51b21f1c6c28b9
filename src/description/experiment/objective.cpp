// Checks of objectives and termination conditions.
#include "description/experiment/objective_keys.h"

namespace taut::description {

void Check(const MapReader& map, FallSpec& fall) {
  if (fall.min_height_m && fall.max_height_m && *fall.min_height_m >= *fall.max_height_m) {
    map.Error("objective.empty_range", "min_height_m",
              map.what() + ": min_height_m " + Shown(*fall.min_height_m) +
                  " is not below max_height_m " + Shown(*fall.max_height_m));
  }
}

void CheckObjective(const MapReader& map, const ObjectiveSpec& objective) {
  if (!map.Has("direction") && objective.measure == Measure::kHeading) {
    map.Error("objective.direction_missing", "measure",
              map.what() + ": heading needs the key \"direction\"", "such as [1, 0, 0]");
  }
}

}  // namespace taut::description
