#include "mechanics/contact_roles.h"

#include "math/vec.h"

namespace taut::mechanics {

ContactRoles ContactRolesOf(const ModelDef& def) {
  constexpr double kTogether_m2 = 1e-18;
  ContactRoles roles{std::vector<ContactRole>(def.spheres.size()),
                     std::vector<ContactRole>(def.capsules.size())};
  for (std::size_t c = 0; c < def.capsules.size(); ++c) {
    const CapsuleDef& rod = def.capsules[c];
    if (!rod.collides) continue;
    bool covered[2] = {false, false};
    for (std::size_t s = 0; s < def.spheres.size(); ++s) {
      const SphereDef& sphere = def.spheres[s];
      if (!sphere.collides || sphere.body != rod.body) continue;
      for (int end = 0; end < 2; ++end) {
        const Vec3 apart = sphere.center_m - (end == 0 ? rod.from_m : rod.to_m);
        if (Dot(apart, apart) > kTogether_m2) continue;
        if (sphere.radius_m >= rod.radius_m) covered[end] = true;
        if (sphere.radius_m <= rod.radius_m) roles.spheres[s].meets_bodies = false;
      }
    }
    roles.capsules[c].meets_planes = !(covered[0] && covered[1]);
  }
  return roles;
}

}  // namespace taut::mechanics
