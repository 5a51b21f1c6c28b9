/// Stiffness and mass of a structure where it is, in Eigen's matrices (docs/theory/statics.md,
/// section 3), for what is made of them.
#pragma once

#include "analysis/structure.h"
#include "taut/analysis.h"

namespace taut::analysis {

/// The forces of what holds that leave the least unbalanced as described: rows, and points within
/// `near_m` of planes, none of which pulls.
Reactions ReactionsAsDescribed(const Structure& structure, double near_m);

/// Tangent stiffness in the described pose, including the geometric part of the reactions.
struct HeldStiffness {
  Reactions holding;
  Eigen::MatrixXd stiffness;
};
HeldStiffness StiffnessAsDescribed(const Structure& structure);

/// As described, with the consistent mass of members that have one.
Eigen::MatrixXd MassMatrix(const ModelDef& def, const Structure& structure);

/// Directions that rows and bearing points hold, orthonormal, a column each: of all motions.
Eigen::MatrixXd HeldDirections(const Structure& structure, const Reactions& holding);

/// What forces make of the stiffness.
Eigen::MatrixXd GeometricStiffness(const Structure& structure, const Reactions& holding);

/// How near a plane a point touches it, as a share of the size.
inline constexpr double kNearPlane = 1e-7;

/// An orthonormal basis of the columns' span, and how sharp it is cut: singular values above 1e-9
/// of the largest count.
Eigen::MatrixXd SpanOf(const Eigen::MatrixXd& columns);
Matrix PlainOf(const Eigen::MatrixXd& m);
Eigen::MatrixXd EigenOf(const Matrix& m);

}  // namespace taut::analysis
