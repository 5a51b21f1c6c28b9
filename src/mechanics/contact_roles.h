/// Redundant shapes in contact detection, for exports to other engines.
#pragma once

#include <vector>

#include "taut/model_def.h"

namespace taut::mechanics {

/// Kinds of geometry that a shape must be tested against. Redundant tests cost time, and redundant
/// contacts displace needed ones. Planes need only the spheres at the ends of a rod, not the rod.
/// Other bodies need the rod, but not an end sphere of at most its radius. Height fields count as
/// bodies, because hills may fit between the ends of a rod. taut itself omits the same tests.
struct ContactRole {
  bool meets_planes = true, meets_bodies = true;
};
struct ContactRoles {
  std::vector<ContactRole> spheres, capsules;  ///< One per colliding shape of the model.
};
ContactRoles ContactRolesOf(const ModelDef& def);

}  // namespace taut::mechanics
