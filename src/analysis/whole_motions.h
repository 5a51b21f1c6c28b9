/// Rigid-body motions of a structure that its supports leave (docs/theory/statics.md, section 2).
#pragma once

#include <vector>

#include "analysis/structure.h"

namespace taut::analysis {

/// Moving bodies that members and joints connect, and the places in the world where these end.
struct Component {
  std::vector<std::size_t> bodies;  ///< Among those that move.
  Vec3 middle_m;                    ///< Mean of their centers of mass.
  std::vector<Vec3> held_points_m;  ///< Ends of cables, bars and distances in the world.
  std::vector<Vec3> held_axes;      ///< Of wheels in the world.
  std::vector<Vec3> joints_m;       ///< Points of other joints with the world.

  bool IsHeld() const { return !held_points_m.empty() || !joints_m.empty(); }
  bool Has(int moving) const;  ///< A body among those that move, or -1.
};

/// By the first of their bodies.
std::vector<Component> ComponentsOf(const ModelDef& def, const Structure& structure);

/// Rigid motions of a component that move no held point and no held axis, and that its joints with
/// the world allow; 6 x k, orthonormal: translation of `middle_m`, then the turn about it times the
/// structure's size [m].
Eigen::MatrixXd TwistsOf(const Structure& structure, const Component& component);

/// A row a direction in which held points and axes do not move, over all six twists.
Eigen::MatrixXd AnchorRows(const Structure& structure, const Component& component);

/// Rows of the joints between a component and the world.
std::vector<Coordinate> RowsWithWorld(const Structure& structure, const Component& component);

/// First derivatives of coordinates along twists, a row a coordinate.
Eigen::MatrixXd SlopesAlong(const std::vector<Coordinate>& coordinates, const Structure& structure,
                            const Component& component, const Eigen::MatrixXd& twists);

/// The second derivative of a coordinate along exp(t xi) for twists xi: bilinear, symmetric.
Eigen::MatrixXd SecondAlong(const Coordinate& coordinate, const Structure& structure,
                            const Component& component, const Eigen::MatrixXd& twists);

/// Motions of all bodies, a column a twist; other components stand still.
Eigen::MatrixXd MotionsOf(const Structure& structure, const Component& component,
                          const Eigen::MatrixXd& twists);

/// The motions of `TwistsOf` of every component, side by side.
Eigen::MatrixXd WholeMotions(const ModelDef& def, const Structure& structure);

/// Returns the part of motions that counts (`Structure::Effective`).
Eigen::MatrixXd EffectivePart(const Eigen::MatrixXd& effective, const Eigen::MatrixXd& motions);

/// An orthonormal basis of the null space of `rows`: singular values up to `limit` count as zero.
Eigen::MatrixXd Nothing(const Eigen::MatrixXd& rows, double limit);

/// Motions that nothing holds.
struct FreeMotions {
  Eigen::MatrixXd basis;   ///< Those as a whole that nothing resists first, then all others.
  Eigen::Index rigid = 0;  ///< How many of them are motions as a whole.
};

/// Splits motions that leave `held` (columns) at rest. `stiffness` decides what is resisted; the
/// two parts are orthogonal by `weight`: the mass, or a metric.
FreeMotions FreeMotionsOf(const ModelDef& def, const Structure& structure,
                          const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& weight,
                          const Eigen::MatrixXd& held);

}  // namespace taut::analysis
