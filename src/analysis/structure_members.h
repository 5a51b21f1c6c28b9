/// Members of a structure in the described pose with their coordinates, and the rank and null
/// spaces of the equilibrium matrix.
#pragma once

#include <vector>

#include "analysis/tangent.h"

namespace taut::analysis {

struct MemberTerm {
  StaticMember member;
  Coordinate at;  ///< Length of the member, or violation of the constraint.
};

/// Returns cables, bars, joint rows and contacts of points within `near_m` of planes, in this
/// order. The coordinate of a contact is minus its gap, so that a positive force pushes.
std::vector<MemberTerm> MembersOf(const ModelDef& def, const Structure& structure, double near_m);

/// Returns the Jacobian of a point's position (3 rows, one column per motion).
Eigen::MatrixXd MovesOf(const Structure& structure, const Anchor& point);

/// Returns the distinct points of moving bodies at which members, joints or loads act.
std::vector<Anchor> PlacesOf(const ModelDef& def, const Structure& structure);

/// Rank of a matrix and its two null spaces. Singular values up to 1e-9 of the largest count as 0.
struct Split {
  RankGap rank;
  Eigen::MatrixXd null;  ///< Right null space, orthonormal.
  Eigen::MatrixXd left;  ///< Left null space, orthonormal.
};
Split SplitOf(const Eigen::MatrixXd& matrix);

/// Splits `space` (orthonormal columns) into directions within the span of `part` and directions
/// orthogonal to it.
struct Parts {
  Eigen::MatrixXd in, across;
};
Parts PartsOf(const Eigen::MatrixXd& space, const Eigen::MatrixXd& part);

/// Counts of the pin-jointed structure. Nothing if a body is neither a point nor a rod, a cable
/// passes over wheels, or joints constrain rotations. Rows of the null space: `members` in their
/// order, then rods.
struct Classical {
  ClassicalCount count;
  Eigen::MatrixXd null;
  std::vector<double> rod_length_m;
};
std::optional<Classical> ClassicalOf(const ModelDef& def, const Structure& structure,
                                     const std::vector<MemberTerm>& members);

/// Converts a motion of all bodies to a mode shape, with the scale defined at `Mode`.
Mode ShapeOf(const ModelDef& def, const Structure& structure, Eigen::VectorXd motions);

}  // namespace taut::analysis
