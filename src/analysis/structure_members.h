/// Members of a structure in the described pose with their coordinates, and the rank and null
/// spaces of the equilibrium matrix.
#pragma once

#include <vector>

#include "analysis/tangent.h"

namespace taut::analysis {

struct MemberTerm {
  StaticMember member;
  Coordinate at;  ///< Length of the member, or violation of its constraint.
};

/// Returns cables and bars, then joint rows and contacts of points within `near_m` of planes. The
/// coordinate of a contact is minus its gap, so that a positive force pushes.
std::vector<MemberTerm> MembersOf(const ModelDef& def, const Structure& structure, double near_m);

/// Returns the 3 x motions Jacobian of a point's position.
Eigen::MatrixXd MovesOf(const Structure& structure, const Anchor& point);

/// Returns the distinct points of moving bodies at which something acts.
std::vector<Anchor> PlacesOf(const ModelDef& def, const Structure& structure);

/// Rank of a matrix, cut at 1e-9 of its largest singular value, and its two null spaces.
struct Split {
  RankGap rank;
  Eigen::MatrixXd null;  ///< Null space of the columns, orthonormal.
  Eigen::MatrixXd left;  ///< Null space of the rows (left null space), orthonormal.
};
Split SplitOf(const Eigen::MatrixXd& matrix);

/// Division of `space` (orthonormal columns) into directions within the span of `part` and
/// directions orthogonal to it.
struct Parts {
  Eigen::MatrixXd in, across;
};
Parts PartsOf(const Eigen::MatrixXd& space, const Eigen::MatrixXd& part);

/// Pin-jointed count. Nothing if a body is neither a point nor a rod, a cable passes over wheels,
/// or joints constrain rotations. The null space refers to `members` in their order, then rods.
struct Classical {
  ClassicalCount count;
  Eigen::MatrixXd null;
  std::vector<double> rod_length_m;
};
std::optional<Classical> ClassicalOf(const ModelDef& def, const Structure& structure,
                                     const std::vector<MemberTerm>& members);

/// Returns the shape of a motion of all bodies, scaled as described at `Mode`.
Mode ShapeOf(const ModelDef& def, const Structure& structure, Eigen::VectorXd motions);

}  // namespace taut::analysis
