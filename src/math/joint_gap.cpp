// Joint errors in the described pose: distance of the joint points, and angle between the bodies.
#include <cmath>

#include "math/joint_turn.h"
#include "math/vec.h"
#include "taut/joint_def.h"

namespace taut {

double JointError(const JointDef& j) noexcept {
  const HeldMotions held = ConstrainedMotions(j.kind);
  const Vec3 d = j.to_m - j.from_m;
  const double along = Dot(j.axis, d), across2 = std::fmax(Dot(d, d) - along * along, 0.0);
  if (held.along && held.across) return std::sqrt(Dot(d, d));
  if (held.across) return std::sqrt(across2);
  return held.along ? std::fabs(along) : 0;
}

namespace math {

double HeldTurn(const JointDef& j) noexcept {
  using K = JointKind;
  const auto off = [](const Vec3& d) { return std::sqrt(Dot(d, d)); };
  switch (j.kind) {
    case K::kWeld:
    case K::kPrismatic:
      return 2 * off({j.turned.x, j.turned.y, j.turned.z});
    case K::kHinge:
    case K::kCylindrical:
    case K::kPlanar:
      return off(Rotate(j.turned, j.axis) - j.axis);
    default:
      return 0;
  }
}

}  // namespace math

}  // namespace taut
