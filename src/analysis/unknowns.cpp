// Effective motions of a structure: all motions of its bodies except rotations without any effect
// on members or joints, such as the spin of a rod about its axis. Also the parts of a model that
// statics ignores.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "analysis/structure.h"
#include "math/vec.h"

namespace taut::analysis {

// A rotation w moves a point with arm a by w x a. The sum of squares over all points is w^T (sum of
// |a|^2 - a a^T) w, so unresisted rotations are the null space of this matrix.
Eigen::MatrixXd Structure::FreeTurns(std::size_t b, const Placement& at) const {
  constexpr double kOnAxis = 1e-7;  ///< Share of the structure's size. Its square is close to
                                    ///< rounding.
  const Eigen::Matrix3d all = arms_[b] + size_m * size_m * resisted_[b];
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(all);
  Eigen::MatrixXd turns(3, 0);
  for (int i = 0; i < 3; ++i) {
    const double square = std::max(size_m * size_m, arms_[b].trace());
    if (solver.eigenvalues()[i] > kOnAxis * kOnAxis * square) continue;
    turns.conservativeResize(3, turns.cols() + 1);
    turns.col(turns.cols() - 1) = Of(Rotate(at.turn[b], To(solver.eigenvectors().col(i))));
  }
  return turns;
}

Eigen::MatrixXd Structure::Effective(const Placement& at, bool scaled) const {
  Eigen::MatrixXd basis = Eigen::MatrixXd::Zero(motions(), motions());
  Eigen::Index columns = 0;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Eigen::Index row = 6 * static_cast<Eigen::Index>(b);
    basis.block<3, 3>(row, columns) = Eigen::Matrix3d::Identity();
    columns += 3;
    const Eigen::MatrixXd free = FreeTurns(b, at);
    const Eigen::Matrix3d kept = Eigen::Matrix3d::Identity() - free * free.transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(kept);  // eigenvalues are 0 or 1
    const double reach = reach_m[b] > 1e-8 * size_m ? reach_m[b] : size_m;
    for (Eigen::Index i = free.cols(); i < 3; ++i) {
      Eigen::Vector3d turn = solver.eigenvectors().col(i);
      if (free.cols() == 0) turn = Eigen::Vector3d::Unit(i);
      basis.block<3, 1>(row + 3, columns++) = (scaled ? 1 / reach : 1.0) * turn;
    }
  }
  return basis.leftCols(columns);
}

std::vector<std::string> WhatIsLeftOut(const ModelDef& def) {
  std::vector<std::string> out;
  const auto names = [&](const auto& list, const auto& has, const char* kind, const char* what) {
    std::string text;
    int count = 0;
    for (const auto& item : list) {
      if (!has(item)) continue;
      if (++count <= 3) text += (count > 1 ? ", " : "") + item.name;
    }
    if (count > 3) text += " and " + std::to_string(count - 3) + " more";
    if (count > 0) out.push_back(std::string(what) + " of " + kind + " " + text);
  };
  const auto slips = [](const CableDef& c) {
    return std::any_of(c.attachments.begin(), c.attachments.end(),
                       [](const AttachmentDef& at) { return at.friction > 0; });
  };
  names(def.cables, slips, "cable", "friction along the path");
  names(
      def.cables, [](const CableDef& c) { return c.touches != CableTouches::kNone; }, "cable",
      "obstacles along the path");
  names(
      def.joints, [](const JointDef& j) { return j.least || j.most; }, "joint", "the limits");
  names(
      def.joints, [](const JointDef& j) { return j.friction > 0; }, "joint", "friction");
  return out;
}

}  // namespace taut::analysis
