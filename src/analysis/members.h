/// Members of a structure as described, each with what it measures.
#pragma once

#include <vector>

#include "analysis/tangent.h"

namespace taut::analysis {

struct MemberTerm {
  StaticMember member;
  Coordinate at;  ///< Its length, or how far it is from what it holds.
};

/// Cables and bars, then what joints hold and planes bear, `near_m` from them. A contact's force
/// counts along its gap's opposite, so that it pushes if it is positive.
std::vector<MemberTerm> MembersOf(const ModelDef& def, const Structure& structure, double near_m);

/// 3 x motions: how a point moves.
Eigen::MatrixXd MovesOf(const Structure& structure, const Anchor& point);

/// Places at which something acts, each once.
std::vector<Anchor> PlacesOf(const ModelDef& def, const Structure& structure);

/// Rank of a matrix, cut at 1e-9 of its largest singular value, and the forces that it makes
/// nothing of.
struct Split {
  RankGap rank;
  Eigen::MatrixXd null;  ///< Of the columns: orthonormal.
  Eigen::MatrixXd left;  ///< Of the rows.
};
Split SplitOf(const Eigen::MatrixXd& matrix);

/// Of `space`, orthonormal columns: those that lie in the span of `part`, and what is across them.
struct Parts {
  Eigen::MatrixXd in, across;
};
Parts PartsOf(const Eigen::MatrixXd& space, const Eigen::MatrixXd& part);

/// Nothing if a body is neither a point nor a rod, or if a cable goes round wheels, or joints hold
/// turns. The null space is of its members: those of `members` in their order, then rods.
struct Classical {
  ClassicalCount count;
  Eigen::MatrixXd null;
  std::vector<double> rod_length_m;
};
std::optional<Classical> ClassicalOf(const ModelDef& def, const Structure& structure,
                                     const std::vector<MemberTerm>& members);

/// The shape of a motion of all bodies, scaled as `Mode` says.
Mode ShapeOf(const ModelDef& def, const Structure& structure, Eigen::VectorXd motions);

}  // namespace taut::analysis
