// How far apart the points of a joint are described.
#include <cmath>

#include "math/vec.h"
#include "taut/joint_def.h"

namespace taut {

double HeldGap(const JointDef& j) noexcept {
  using K = JointKind;
  const Vec3 d = j.to_m - j.from_m;
  const double along = Dot(j.axis, d), all2 = Dot(d, d);
  const double across = std::sqrt(std::fmax(all2 - along * along, 0.0));
  switch (j.kind) {
    case K::kDistance:
      return 0;
    case K::kPrismatic:
    case K::kCylindrical:
    case K::kLine:
      return across;
    case K::kPlanar:
    case K::kPlane:
      return std::fabs(along);
    default:
      return std::sqrt(all2);
  }
}

}  // namespace taut
