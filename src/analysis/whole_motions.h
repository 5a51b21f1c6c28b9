/// Rigid motions that supports leave free (docs/theory/statics.md, section 2).
#pragma once

#include <vector>

#include "analysis/structure.h"

namespace taut::analysis {

/// Connected component: moving bodies connected by members and joints, and its connections to the
/// world.
struct Component {
  std::vector<std::size_t> bodies;  ///< Indices among the moving bodies.
  Vec3 middle_m;                    ///< Mean of the bodies' centers of mass.
  std::vector<Vec3> held_points_m;  ///< Ends of cables, bars and distance joints in the world.
  std::vector<Vec3> held_axes;      ///< Axes of wheels in the world.
  std::vector<Vec3> joints_m;       ///< Points of other joints with the world.

  bool IsHeld() const { return !held_points_m.empty() || !joints_m.empty(); }
  bool Has(int moving) const;  ///< `moving`: index among the moving bodies, or -1.
};

/// Returns the connected components in the order of their first bodies.
std::vector<Component> ComponentsOf(const ModelDef& def, const Structure& structure);

/// Returns the rigid motions of a component that its fixed points and axes and its joints with the
/// world permit. Shape 6 x k, orthonormal: translation of `middle_m`, then rotation about it times
/// the structure's size [m].
Eigen::MatrixXd TwistsOf(const Structure& structure, const Component& component);

/// Returns the constraint rows of fixed points and axes, with six columns for the twists.
Eigen::MatrixXd AnchorRows(const Structure& structure, const Component& component);

/// Returns the rows of the joints between a component and the world.
std::vector<Coordinate> RowsWithWorld(const Structure& structure, const Component& component);

/// Returns the first derivatives of coordinates along twists, one row per coordinate.
Eigen::MatrixXd SlopesAlong(const std::vector<Coordinate>& coordinates, const Structure& structure,
                            const Component& component, const Eigen::MatrixXd& twists);

/// Returns the second derivative of a coordinate along exp(t xi) as a symmetric 6 x 6 form of the
/// twist xi.
Eigen::MatrixXd SecondAlong(const Coordinate& coordinate, const Structure& structure,
                            const Component& component, const Eigen::MatrixXd& twists);

/// Converts twists of a component to motions of all bodies (columns). Other components do not move.
Eigen::MatrixXd MotionsOf(const Structure& structure, const Component& component,
                          const Eigen::MatrixXd& twists);

/// Returns the rigid motions (`TwistsOf`) of all components as columns.
Eigen::MatrixXd WholeMotions(const ModelDef& def, const Structure& structure);

/// Projects motions onto the effective ones (`Structure::Effective`).
Eigen::MatrixXd EffectivePart(const Eigen::MatrixXd& effective, const Eigen::MatrixXd& motions);

/// Returns an orthonormal basis of the null space of `rows`; singular values <= `limit` count as 0.
Eigen::MatrixXd Nothing(const Eigen::MatrixXd& rows, double limit);

/// Basis of the motions that constraints leave free.
struct FreeMotions {
  Eigen::MatrixXd basis;   ///< Rigid motions without stiffness first, then all others.
  Eigen::Index rigid = 0;  ///< Number of rigid motions.
};

/// Splits the motions orthogonal to `held` (columns) into rigid motions without stiffness and the
/// rest. The two parts are orthogonal in `weight` (mass matrix or metric).
FreeMotions FreeMotionsOf(const ModelDef& def, const Structure& structure,
                          const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& weight,
                          const Eigen::MatrixXd& held);

}  // namespace taut::analysis
