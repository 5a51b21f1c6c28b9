/// Stiffness and mass matrices of a structure in the described pose, as Eigen matrices
/// (docs/theory/statics.md, section 3).
#pragma once

#include "analysis/structure.h"
#include "taut/analysis.h"

namespace taut::analysis {

/// Returns the reactions that minimize the imbalance in the described pose: of joint rows, and of
/// points within `near_m` of planes, none of which pulls.
Reactions ReactionsAsDescribed(const Structure& structure, double near_m);

/// Tangent stiffness in the described pose, including the geometric part of the reactions.
struct HeldStiffness {
  Reactions holding;
  Eigen::MatrixXd stiffness;
};
HeldStiffness StiffnessAsDescribed(const Structure& structure);

/// Returns the mass matrix in the described pose, with consistent mass of members that have one.
Eigen::MatrixXd MassMatrix(const ModelDef& def, const Structure& structure);

/// Returns the directions that joint rows and bearing points hold, as orthonormal columns over all
/// motions.
Eigen::MatrixXd HeldDirections(const Structure& structure, const Reactions& holding);

/// Returns the geometric stiffness: the part that depends on member forces, loads and reactions.
Eigen::MatrixXd GeometricStiffness(const Structure& structure, const Reactions& holding);

/// Largest gap of a touching point, as a share of the structure's size.
inline constexpr double kNearPlane = 1e-7;

/// Returns an orthonormal basis of the span of the columns; singular values above 1e-9 of the
/// largest count.
Eigen::MatrixXd SpanOf(const Eigen::MatrixXd& columns);
Matrix PlainOf(const Eigen::MatrixXd& m);
Eigen::MatrixXd EigenOf(const Matrix& m);

}  // namespace taut::analysis
