/// Length of a cable along its path, through eyelets and round wheels, with first and second
/// derivatives.
#pragma once

#include <vector>

#include "analysis/coordinate.h"
#include "math/cable_wheel.h"
#include "taut/model_def.h"

namespace taut::analysis {

class CableCoordinate {
 public:
  /// `anchors`: one per attachment of the cable.
  CableCoordinate(const CableDef& cable, std::vector<Anchor> anchors);

  /// Returns the path length [m] and its derivatives. For cables with wheels, the second
  /// derivatives are central differences of the exact first derivatives.
  Coordinate At(const Placement& at, bool with_hessian) const;
  bool has_wheels() const { return !wheels_.empty(); }
  /// Returns the straight distances between successive attachments, without arcs on wheels [m].
  std::vector<double> SpansAt(const Placement& at) const;

 private:
  /// Wheel of the path, with its axis in the described pose.
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
  std::vector<int> bodies_;  ///< Moving bodies to which the cable is attached.
  std::vector<int> local_;   ///< Per attachment: index into `bodies_`, or -1.
};

}  // namespace taut::analysis
