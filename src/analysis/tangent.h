/// Stiffness and mass matrices of a structure in the described pose, as Eigen matrices
/// (docs/theory/statics.md, section 3).
#pragma once

#include "analysis/structure.h"
#include "taut/analysis.h"

namespace taut::analysis {

/// Returns the reactions with the least imbalance in the described pose: of joint rows, and of
/// contact points within `near_m` of planes. Contact forces are >= 0.
Reactions ReactionsAsDescribed(const Structure& structure, double near_m);

/// Tangent stiffness in the described pose, including the geometric stiffness of the reactions.
struct HeldStiffness {
  Reactions holding;
  Eigen::MatrixXd stiffness;
};
HeldStiffness StiffnessAsDescribed(const Structure& structure);

/// Returns the mass matrix in the described pose. Includes the consistent mass of members that have
/// a mass.
Eigen::MatrixXd MassMatrix(const ModelDef& def, const Structure& structure);

/// Returns the directions that joint rows and loaded contact points block, as orthonormal columns
/// over all motions.
Eigen::MatrixXd HeldDirections(const Structure& structure, const Reactions& holding);

/// Returns the geometric stiffness: the contribution of member forces, loads and reactions.
Eigen::MatrixXd GeometricStiffness(const Structure& structure, const Reactions& holding);

/// Largest gap of a point in contact, as a share of the structure's size.
inline constexpr double kNearPlane = 1e-7;

/// Returns an orthonormal basis of the span of the columns. Singular values up to 1e-9 of the
/// largest count as 0.
Eigen::MatrixXd SpanOf(const Eigen::MatrixXd& columns);
Matrix PlainOf(const Eigen::MatrixXd& m);
Eigen::MatrixXd EigenOf(const Matrix& m);

}  // namespace taut::analysis
