/// What shapes need not be tested with, for engines other than taut's.
#pragma once

#include <vector>

#include "taut/model_def.h"

namespace taut::mechanics {

/// What is tested for nothing costs engines time and adds contacts in the place of others: a rod
/// whose ends carry spheres meets a plane with these alone, and a sphere no thicker than the rod
/// that ends in it meets other bodies as part of the rod. taut leaves the same out. Hills come
/// between the ends of rods, so a height field is met as a body is.
struct ContactRole {
  bool meets_planes = true, meets_bodies = true;
};
struct ContactRoles {
  std::vector<ContactRole> spheres, capsules;  ///< Per shape of the model, if it collides.
};
ContactRoles ContactRolesOf(const ModelDef& def);

}  // namespace taut::mechanics
