/// Scalar coordinates of a structure (lengths, constraint rows of joints, gaps, work of loads).
/// First and second derivatives are with respect to the motions of the bodies involved.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "taut/types.h"

namespace taut::analysis {

/// Poses of the moving bodies, in the order of `Structure::bodies`.
struct Placement {
  std::vector<Vec3> center_m;  ///< Centers of mass, in W.
  std::vector<Quat> turn;      ///< Rotation from the described orientation, in W.
};

/// Returns the placement after each body's motion: three translations [m] and a rotation vector
/// theta [rad], all in W; the rotation is exp(theta).
Placement Moved(const Placement& from, const Eigen::VectorXd& motions);

/// Point of a body or of the static world.
struct Anchor {
  int body = -1;  ///< Index among the moving bodies, or -1.
  Vec3 at_m;      ///< Vector from the center of mass, in the described pose; of a static point:
                  ///< position in W.
};
/// Vector from the center of mass to the point, in W; of a static point: its position in W.
Vec3 ArmOf(const Anchor& anchor, const Placement& at);
Vec3 PlaceOf(const Anchor& anchor, const Placement& at);

/// Scalar function of the motions of some bodies, with derivatives. Rotation vectors theta are a
/// chart of rotations (exp(theta)), so second derivatives are symmetric (eq. 4).
struct Coordinate {
  double value = 0;
  std::vector<int> bodies;   ///< Indices among the moving bodies; six motions each.
  Eigen::VectorXd gradient;  ///< Six components per body of `bodies`.
  Eigen::MatrixXd hessian;   ///< Second derivatives; empty if not requested.
};

/// Returns the matrix of the cross product a x.
Eigen::Matrix3d CrossMatrix(const Vec3& a);
inline Eigen::Vector3d Of(const Vec3& a) { return {a.x, a.y, a.z}; }
inline Vec3 To(const Eigen::Vector3d& a) { return {a[0], a[1], a[2]}; }

/// Returns the second derivative of the scalar product `along` . p with respect to rotations of the
/// body. Point p is at the arm `arm` (eq. 5).
Eigen::Matrix3d TurnCurvature(const Vec3& along, const Vec3& arm);

/// Returns direction . position - offset: the gap of a point above a plane, or the work of a force.
Coordinate PointAlong(const Anchor& point, const Vec3& direction, double offset,
                      const Placement& at);

/// Adds the derivatives of f(c) to a gradient and a Hessian over all motions; `first` and `second`
/// are f' and f''. `hessian` may be null.
void Add(const Coordinate& c, double first, double second, Eigen::VectorXd& gradient,
         Eigen::MatrixXd* hessian);

}  // namespace taut::analysis
