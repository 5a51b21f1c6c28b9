/// Force balance of a model in the described pose for inverse statics. The unknowns are member,
/// joint and contact forces (docs/theory/inverse_statics.md, section 1).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "analysis/structure.h"
#include "taut/inverse_statics.h"

namespace taut::analysis {

/// Meaning of a column of `ForceBalance`.
struct HoldingUnknown {
  enum class Kind { kCable, kRow, kTouch };
  Kind kind = Kind::kCable;
  std::size_t index = 0;  ///< Index of the cable, of the row in `Structure::rows`, or of the
                          ///< contact.
  int part = 0;           ///< For a contact: 0 normal, 1 and 2 tangential.
  double scale = 1;       ///< Force or torque of one unit of the unknown [N, N m].
};

/// Linear system columns * x = load of force balance. Rows are forces on the moving bodies and
/// torques divided by the body's reach [N].
class ForceBalance {
 public:
  /// `known_tensions`: cable and bar forces follow from the described lengths; otherwise they are
  /// unknowns.
  ForceBalance(const ModelDef& def, const LoadCaseSpec& loads, const std::vector<TouchDef>& touches,
               bool known_tensions);

  Eigen::Index size() const { return columns.cols(); }
  /// Returns the index of a contact's first column (normal force). Without friction, this is its
  /// only column.
  Eigen::Index TouchColumn(std::size_t touch) const { return touch_columns_[touch]; }
  /// Returns the joint index of a column of kind kRow.
  std::size_t JointOf(Eigen::Index column) const {
    return structure_.rows[unknowns[static_cast<std::size_t>(column)].index].joint;
  }
  Vec3 TouchForce(std::size_t touch, const Eigen::VectorXd& x) const;
  /// Returns the load of each joint, including the force of its spring.
  std::vector<JointLoad> JointLoads(const Eigen::VectorXd& x) const;
  /// Returns the force of each joint that is a bar, 0 for others.
  std::vector<double> BarForces(const Eigen::VectorXd& x) const;
  /// Returns the residual force and torque of each body for x, largest first.
  std::vector<Unbalanced> Left(const Eigen::VectorXd& x) const;
  /// Formats a list of residuals for messages.
  std::string Words(const std::vector<Unbalanced>& left) const;
  /// Returns the largest component of the loads [N]; 1 N if there are none.
  double LargestLoad() const;

  /// General solution of the balance: `particular` + `free` y, with any y.
  struct Solutions {
    Eigen::VectorXd particular;  ///< Least-norm solution; least-squares solution if the loads
                                 ///< cannot be balanced.
    Eigen::MatrixXd free;        ///< Basis of the solutions without loads, orthonormal columns.
    double left_n = 0;           ///< Largest component of the loads that no x can balance.
  };
  Solutions Solve() const;

  Eigen::MatrixXd columns;
  Eigen::VectorXd load;
  std::vector<HoldingUnknown> unknowns;
  std::vector<double> cable_length_m;
  std::vector<double> known_cable_n;  ///< Tension of each cable whose tension is known; otherwise
                                      ///< 0.

 private:
  const ModelDef& def_;
  ModelDef freed_;  ///< Model without the unknown forces.
  std::vector<TouchDef> touches_;
  Structure structure_;
  std::vector<double> known_bar_n_;
  std::vector<Eigen::Index> touch_columns_;
  std::vector<double> reach_m_;  ///< Per moving body, including its contacts.
};

/// Orthonormal directions s and t perpendicular to a normal.
struct Across {
  Vec3 s, t;
};
Across AcrossOf(const Vec3& normal);

/// Limits of the unknown forces x of a ForceBalance, rows * x >= at_least: bounds of cable tensions
/// and friction cones.
struct ForceLimits {
  Eigen::MatrixXd rows;
  Eigen::VectorXd at_least;
  void Add(const Eigen::VectorXd& row, double bound);
};

/// Adds bounds of the unknown cable tensions. Without `bounds`, tensions are >= 0.
void LimitCables(const ForceBalance& balance, const std::vector<CableBounds>& bounds,
                 ForceLimits& limits);

/// Adds friction cones as planes at the given angles around each normal. Outer planes are tangent
/// to the cone at these angles. Each inner plane passes through two adjacent lines of contact with
/// the cone, so that all forces within the inner planes satisfy the friction law.
enum class ConeSide { kOuter, kInner };
void LimitTouches(const ForceBalance& balance, const std::vector<TouchDef>& touches,
                  const std::vector<std::vector<double>>& angles_rad, ConeSide side,
                  ForceLimits& limits);
/// Returns, for each contact, `count` evenly spaced angles around the circle [rad].
std::vector<std::vector<double>> EvenAngles(std::size_t touches, int count);

/// Returns the x within the limits that minimizes the sum of squared residuals.
Eigen::VectorXd Nearest(const ForceBalance& balance, const ForceLimits& limits);

/// Adds errors of contacts, bounds and load cases to `out`.
void CheckHolding(const ModelDef& def, const LoadCaseSpec& loads,
                  const std::vector<TouchDef>& touches, const std::vector<CableBounds>& bounds,
                  Diagnostics& out);

}  // namespace taut::analysis
