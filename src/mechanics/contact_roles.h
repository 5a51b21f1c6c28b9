/// Redundant shapes of contact detection, for other engines than taut.
#pragma once

#include <vector>

#include "taut/model_def.h"

namespace taut::mechanics {

/// Redundant tests cost engines time and add contacts in place of others: planes need only the
/// spheres at a rod's ends, not the rod, and other bodies need the rod, not a sphere at its end
/// that is no thicker than the rod. taut omits the same tests. Hills fit between the ends of rods,
/// so height fields count as bodies.
struct ContactRole {
  bool meets_planes = true, meets_bodies = true;
};
struct ContactRoles {
  std::vector<ContactRole> spheres, capsules;  ///< Per shape of the model, if it collides.
};
ContactRoles ContactRolesOf(const ModelDef& def);

}  // namespace taut::mechanics
