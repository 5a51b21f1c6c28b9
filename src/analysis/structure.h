/// Structure for statics: moving bodies, members with energies, constraint rows of joints, points
/// that may touch planes, and loads (docs/theory/statics.md, section 1).
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

/// Reactions: multipliers y of constraint rows as in eq. 2, and contact forces z >= 0 of touching
/// points [N].
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
  /// Center of a sphere that may touch a plane.
  struct Touch {
    Anchor point;
    int plane;
    Vec3 normal;
    double offset_m;  ///< Offset in the gap normal . p - offset.
    double radius_m;
  };
  struct Load {
    Anchor point;
    Vec3 force_n;
  };

  /// `contact`: whether to add contacts with planes.
  Structure(const ModelDef& def, const LoadCaseSpec& loads, bool contact);

  int motions() const { return 6 * static_cast<int>(bodies.size()); }
  /// Returns the index of a model's body among the moving bodies, or -1.
  int Moving(int body) const { return body < 0 ? -1 : moving_[static_cast<std::size_t>(body)]; }
  Anchor AnchorAt(int body, const Vec3& place_m) const;

  double Tension(const Cable& cable, double length_m) const;
  /// Returns the potential energy of members and loads [J]. `gradient`: its first derivatives
  /// (minus the forces). `hessian`: its second derivatives; may be null.
  double Energy(const Placement& at, Eigen::VectorXd& gradient, Eigen::MatrixXd* hessian) const;
  Coordinate RowAt(std::size_t row, const Placement& at) const;
  Coordinate GapAt(std::size_t touch, const Placement& at) const;
  /// Adds the reactions to the derivatives of the energy.
  void AddReactions(const Placement& at, const Reactions& holding, Eigen::VectorXd& gradient,
                    Eigen::MatrixXd* hessian) const;

  /// Returns the rotations of body `b` that nothing resists, as columns in W. Examples: rotation of
  /// a rod about its axis, and of a body whose forces all act at its center of mass.
  Eigen::MatrixXd FreeTurns(std::size_t b, const Placement& at) const;
  /// Returns a basis of all other motions, orthonormal if not `scaled`. If `scaled`, rotations are
  /// multiplied by the reach of the body, so that all coordinates are lengths [m].
  Eigen::MatrixXd Effective(const Placement& at, bool scaled) const;

  std::vector<int> bodies;  ///< Indices of the moving bodies in the model.
  Placement start;
  std::vector<Cable> cables;
  std::vector<PlacedJoint> joints;
  std::vector<Row> rows;
  std::vector<Touch> touches;
  std::vector<Load> loads;
  std::vector<Vec3> weight_n;    ///< Weight of each moving body.
  std::vector<double> reach_m;   ///< Largest distance from the center of mass at which a force
                                 ///< acts, per moving body.
  double size_m = 0;             ///< Diagonal of the structure's bounding box.
  double stiffness_n_per_m = 0;  ///< Largest stiffness of any member.
  bool held_by_world = false;    ///< Whether a member or a joint ends at a static point.
  std::vector<std::string> left_out;

 private:
  void AddBodies();
  void AddCables(const LoadCaseSpec& load_case);
  void AddJoints(const LoadCaseSpec& load_case);
  void AddLoads(const LoadCaseSpec& load_case);
  void AddTouches();
  void Measure();
  /// Records that a force acts on a body at this point.
  void Acts(const Anchor& anchor);
  /// Records that rotations of a direction fixed in the body are resisted. A zero direction means
  /// all rotations.
  void ResistsTurns(const Anchor& anchor, const Vec3& direction);

  const ModelDef& def_;
  std::vector<int> moving_;
  std::vector<Eigen::Matrix3d> arms_;      ///< Per moving body: sum of |a|^2 - a a^T over the arms
                                           ///< a.
  std::vector<Eigen::Matrix3d> resisted_;  ///< The same sum over directions.
  std::vector<Eigen::MatrixXd> free_;      ///< Free rotations in the described pose.
};

/// Returns the parts of a model that statics ignores, one line per kind of part.
std::vector<std::string> WhatIsLeftOut(const ModelDef& def);

}  // namespace taut::analysis
