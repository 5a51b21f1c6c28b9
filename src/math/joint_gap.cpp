// How far apart the points of a joint are described.
#include <cmath>

#include "math/vec.h"
#include "taut/joint_def.h"

namespace taut {

double HeldGap(const JointDef& j) noexcept {
  const HeldMotions held = HeldBy(j.kind);
  const Vec3 d = j.to_m - j.from_m;
  const double along = Dot(j.axis, d), across2 = std::fmax(Dot(d, d) - along * along, 0.0);
  if (held.along && held.across) return std::sqrt(Dot(d, d));
  if (held.across) return std::sqrt(across2);
  return held.along ? std::fabs(along) : 0;
}

}  // namespace taut
