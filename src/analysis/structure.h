/// A model as statics sees it: bodies that move, members with energies, directions that are held,
/// points that may touch planes, loads (docs/theory/statics.md, section 1).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "analysis/cable_coordinate.h"
#include "analysis/joint_coordinates.h"
#include "taut/model_def.h"
#include "taut/spec.h"

namespace taut::analysis {

/// What holds: forces of held rows and of touching points. A row's is that of eq. 2; a point's is
/// how hard the plane pushes, >= 0.
struct Reactions {
  Eigen::VectorXd rows, touches;
};

class Structure {
 public:
  struct Cable {
    CableCoordinate path;
    double stiffness, rest_m;
  };
  struct Row {
    std::size_t joint;
    HeldRow row;
  };
  /// A point, with a ball about it, above a plane.
  struct Touch {
    Anchor point;
    int plane;
    Vec3 normal;
    double offset_m;  ///< Of the gap normal . p - offset.
    double radius_m;
  };
  struct Load {
    Anchor point;
    Vec3 force_n;
  };

  /// `contact`: whether points may touch planes.
  Structure(const ModelDef& def, const LoadCaseSpec& loads, bool contact);

  int motions() const { return 6 * static_cast<int>(bodies.size()); }
  /// A model's body among those that move, or -1.
  int Moving(int body) const { return body < 0 ? -1 : moving_[static_cast<std::size_t>(body)]; }
  Anchor AnchorAt(int body, const Vec3& place_m) const;

  double Tension(const Cable& cable, double length_m) const;
  /// The potential energy of members and loads, its gradient, the opposite of their forces, and its
  /// second derivative, if that is not null.
  double Energy(const Placement& at, Eigen::VectorXd& gradient, Eigen::MatrixXd* hessian) const;
  Coordinate RowAt(std::size_t row, const Placement& at) const;
  Coordinate GapAt(std::size_t touch, const Placement& at) const;
  /// Adds those that hold, to the derivatives of the energy.
  void AddReactions(const Placement& at, const Reactions& holding, Eigen::VectorXd& gradient,
                    Eigen::MatrixXd* hessian) const;

  /// Turns of body `b` that nothing resists, as columns in W: of bodies on which all hangs at the
  /// centre of mass, of rods about their axis. By geometry.
  Eigen::MatrixXd FreeTurns(std::size_t b, const Placement& at) const;
  /// All other motions, orthonormal; turns by the reach of their body, so that all are lengths [m].
  Eigen::MatrixXd Effective(const Placement& at, bool scaled) const;

  std::vector<int> bodies;  ///< Of the model, that move.
  Placement start;
  std::vector<Cable> cables;
  std::vector<PlacedJoint> joints;
  std::vector<Row> rows;
  std::vector<Touch> touches;
  std::vector<Load> loads;
  std::vector<Vec3> weight_n;    ///< Per moving body.
  std::vector<double> reach_m;   ///< The farthest that something acts on a moving body.
  double size_m = 0;             ///< Of all of it.
  double stiffness_n_per_m = 0;  ///< The largest of any member.
  bool held_by_world = false;    ///< Whether a member or a joint ends at what does not move.
  std::vector<std::string> left_out;

 private:
  void AddBodies();
  void AddCables(const LoadCaseSpec& load_case);
  void AddJoints(const LoadCaseSpec& load_case);
  void AddLoads(const LoadCaseSpec& load_case);
  void AddTouches();
  void Measure();
  /// Something acts on a body there.
  void Acts(const Anchor& anchor);
  /// A body's turns of a direction are resisted; of all, if it is zero.
  void ResistsTurns(const Anchor& anchor, const Vec3& direction);

  const ModelDef& def_;
  std::vector<int> moving_;
  std::vector<Eigen::Matrix3d> arms_;      ///< Sum of |a|^2 - a a^T, per moving body.
  std::vector<Eigen::Matrix3d> resisted_;  ///< The same of directions.
  std::vector<Eigen::MatrixXd> free_;      ///< Turns, as described.
};

/// Of a left-out list: one line for each kind.
std::vector<std::string> WhatIsLeftOut(const ModelDef& def);

}  // namespace taut::analysis
