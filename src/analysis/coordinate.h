/// What a member, a joint, a load or a touching point sees of a structure: one number with its
/// derivatives with respect to the motions of the bodies that it hangs on.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "taut/types.h"

namespace taut::analysis {

/// Where the moving bodies are, in their order.
struct Placement {
  std::vector<Vec3> center_m;  ///< Of mass, in W.
  std::vector<Quat> turn;      ///< From how they are described, in W.
};

/// Moves by three translations and three turns in W a body, the turns by exp(theta).
Placement Moved(const Placement& from, const Eigen::VectorXd& motions);

/// A point of a body, or of what does not move.
struct Anchor {
  int body = -1;  ///< Among those that move, or -1.
  Vec3 at_m;      ///< From the centre of mass as described; of what does not move, in W.
};
/// From the centre of mass, in W; of what does not move the place itself.
Vec3 ArmOf(const Anchor& anchor, const Placement& at);
Vec3 PlaceOf(const Anchor& anchor, const Placement& at);

/// A number, and its derivatives with respect to the motions of some bodies. With turns as
/// exp(theta) they are those of a chart, so that the second ones are symmetric (eq. 4).
struct Coordinate {
  double value = 0;
  std::vector<int> bodies;   ///< Among those that move; six motions each.
  Eigen::VectorXd gradient;  ///< 6 a body of `bodies`.
  Eigen::MatrixXd hessian;   ///< May be empty, if nobody asked for it.
};

/// The matrix of a x.
Eigen::Matrix3d CrossMatrix(const Vec3& a);
inline Eigen::Vector3d Of(const Vec3& a) { return {a.x, a.y, a.z}; }
inline Vec3 To(const Eigen::Vector3d& a) { return {a[0], a[1], a[2]}; }

/// The second derivative that a point with the arm `arm` has by its body's turns alone, times
/// `along` (eq. 5).
Eigen::Matrix3d TurnCurvature(const Vec3& along, const Vec3& arm);

/// direction . place - offset: how high a point is, what a force has done.
Coordinate PointAlong(const Anchor& point, const Vec3& direction, double offset,
                      const Placement& at);

/// Adds `c`, scaled, to a gradient and a second derivative of all motions: of f(c), with its first
/// and second derivative. `hessian` may be null.
void Add(const Coordinate& c, double first, double second, Eigen::VectorXd& gradient,
         Eigen::MatrixXd* hessian);

}  // namespace taut::analysis
