/// The balance of forces of a model as described, with the forces that hold it as unknowns
/// (docs/theory/inverse_statics.md, section 1).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "analysis/structure.h"
#include "taut/inverse_statics.h"

namespace taut::analysis {

/// What a column of the balance is.
struct HoldingUnknown {
  enum class Kind { kCable, kRow, kTouch };
  Kind kind = Kind::kCable;
  std::size_t index = 0;  ///< Of cables, of the structure's rows, of touches.
  int part = 0;           ///< Of a touch: along the normal, and two directions across it.
  double scale = 1;       ///< The force or torque of one unit of the unknown [N, N m].
};

/// columns * x = load: rows are forces on the bodies that move, torques by their reach, all in N.
class ForceBalance {
 public:
  /// `known_tensions`: cables and bars pull as they are described; else they are unknowns.
  ForceBalance(const ModelDef& def, const LoadCaseSpec& loads, const std::vector<TouchDef>& touches,
               bool known_tensions);

  Eigen::Index size() const { return columns.cols(); }
  /// The first column of a touch; without friction it is the only one.
  Eigen::Index TouchColumn(std::size_t touch) const { return touch_columns_[touch]; }
  /// Of a column that is a row of a joint.
  std::size_t JointOf(Eigen::Index column) const {
    return structure_.rows[unknowns[static_cast<std::size_t>(column)].index].joint;
  }
  Vec3 TouchForce(std::size_t touch, const Eigen::VectorXd& x) const;
  /// Per joint; springs included.
  std::vector<JointLoad> JointLoads(const Eigen::VectorXd& x) const;
  /// Per joint: a bar's force, 0 of others.
  std::vector<double> BarForces(const Eigen::VectorXd& x) const;
  /// What x leaves at each body, the most first.
  std::vector<Unbalanced> Left(const Eigen::VectorXd& x) const;
  /// A list of it in words.
  std::string Words(const std::vector<Unbalanced>& left) const;
  /// The largest of all loads; 1 N if there are none.
  double LargestLoad() const;

  /// All x that balance: `particular` + `free` y, if it can be done at all.
  struct Solutions {
    Eigen::VectorXd particular;  ///< The shortest; in least squares, if nothing balances.
    Eigen::MatrixXd free;        ///< Orthonormal columns.
    double left_n = 0;           ///< The largest component that no x can balance.
  };
  Solutions Solve() const;

  Eigen::MatrixXd columns;
  Eigen::VectorXd load;
  std::vector<HoldingUnknown> unknowns;
  std::vector<double> cable_length_m;
  std::vector<double> known_cable_n;  ///< Tensions that are no unknowns, else 0.

 private:
  const ModelDef& def_;
  ModelDef freed_;  ///< Without the forces that are unknowns.
  std::vector<TouchDef> touches_;
  Structure structure_;
  std::vector<double> known_bar_n_;
  std::vector<Eigen::Index> touch_columns_;
  std::vector<double> reach_m_;  ///< Per moving body, touches included.
};

/// Two directions across a normal.
struct Across {
  Vec3 s, t;
};
Across AcrossOf(const Vec3& normal);

/// Rows at_least <= A x that a force law asks for.
struct ForceLimits {
  Eigen::MatrixXd rows;
  Eigen::VectorXd at_least;
  void Add(const Eigen::VectorXd& row, double bound);
};

/// Bounds of the cables that are unknowns; empty bounds: that none pushes.
void LimitCables(const ForceBalance& balance, const std::vector<CableBounds>& bounds,
                 ForceLimits& limits);

/// Friction cones by planes, at the angles across each normal that are given. Outer planes touch
/// the cone there; the inner ones join its lines there, so that all within is possible for sure.
enum class ConeSide { kOuter, kInner };
void LimitTouches(const ForceBalance& balance, const std::vector<TouchDef>& touches,
                  const std::vector<std::vector<double>>& angles_rad, ConeSide side,
                  ForceLimits& limits);
/// Angles that are even round the circle.
std::vector<std::vector<double>> EvenAngles(std::size_t touches, int count);

/// The x within the limits that leaves least, in least squares.
Eigen::VectorXd Nearest(const ForceBalance& balance, const ForceLimits& limits);

/// Complaints about touches, bounds and load cases.
void CheckHolding(const ModelDef& def, const LoadCaseSpec& loads,
                  const std::vector<TouchDef>& touches, const std::vector<CableBounds>& bounds,
                  Diagnostics& out);

}  // namespace taut::analysis
