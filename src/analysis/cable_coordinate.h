/// The length of a cable along its path, with its derivatives.
#pragma once

#include <vector>

#include "analysis/coordinate.h"
#include "math/cable_wheel.h"
#include "taut/model_def.h"

namespace taut::analysis {

class CableCoordinate {
 public:
  /// `anchors`: of its attachments.
  CableCoordinate(const CableDef& cable, std::vector<Anchor> anchors);

  /// Of a cable with wheels second derivatives are differences of the exact first ones.
  Coordinate At(const Placement& at, bool with_hessian) const;
  bool has_wheels() const { return !wheels_.empty(); }
  /// Lengths of its spans: from one attachment to the next, round no wheel [m].
  std::vector<double> SpansAt(const Placement& at) const;

 private:
  /// A wheel of the path; its axis as described.
  struct WheelAt {
    std::size_t attachment;
    Vec3 axis;
    double radius, angle;
  };
  struct Path {
    std::vector<PathPoint<Vec3>> points;
    std::vector<std::size_t> attachment;
    double length = 0;
  };
  Path Lay(const Placement& at) const;
  Eigen::VectorXd Gradient(const Path& path) const;
  Eigen::MatrixXd ExactHessian(const Path& path) const;
  Eigen::MatrixXd DifferenceHessian(const Placement& at) const;
  int Local(std::size_t attachment) const { return local_[attachment]; }

  std::vector<Anchor> anchors_;
  std::vector<WheelAt> wheels_;
  std::vector<int> bodies_;  ///< That it hangs on and that move.
  std::vector<int> local_;   ///< Which of `bodies_`, per attachment, or -1.
};

}  // namespace taut::analysis
