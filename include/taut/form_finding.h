/// Form finding: equilibrium shapes of nets with given force densities, and of robots with given
/// force densities or tensions of their cables (docs/theory/inverse_statics.md, section 5).
///
/// SI units, world frame W. Errors describe invalid inputs. Threads: all functions are pure and
/// thread safe.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "taut/analysis.h"
#include "taut/diagnostics.h"
#include "taut/spec.h"

namespace taut {

/// Pin-jointed net: nodes, and straight members that transmit only axial forces.
struct FormNet {
  std::vector<Vec3> nodes_m;                ///< Initial guess; for fixed nodes, their positions.
  std::vector<bool> fixed;                  ///< One per node; empty: no node is fixed.
  std::vector<std::array<int, 2>> members;  ///< Two nodes each.
};

/// Returns the equilibrium positions [m] of the nodes by the force density method (eq. 7). Force
/// densities (force / length, tension > 0): one per member. `loads_n`: one per node, or empty.
/// Requires fixed nodes; without them, use `FindFreeForm`. On failure, returns nothing and adds
/// errors.
std::optional<std::vector<Vec3>> FindNetForm(const FormNet& net,
                                             const std::vector<double>& force_density_n_per_m,
                                             const std::vector<Vec3>& loads_n, Diagnostics& out);

struct FreeForm {
  bool found = false;
  std::string why;                                  ///< Reason, if not found.
  std::vector<double> group_force_density_n_per_m;  ///< One per group; the first one is 1 or -1.
  std::vector<Vec3> nodes_m;
  double residual = 0;  ///< Largest residual at a node, relative to the largest member force.
  /// Super-stability: prestress stabilizes the form at any stiffness. The force density matrix has
  /// no negative eigenvalue and exactly four zero eigenvalues.
  bool super_stable = false;
};

/// Finds force densities of member groups, and an equilibrium form of a net without fixed nodes.
/// All forms with these densities are affine images of each other; the result has the least squared
/// distance from the given nodes. `group`: group index of each member, starting at 0.
FreeForm FindFreeForm(const FormNet& net, const std::vector<int>& group, Diagnostics& out);

struct FormOptions {
  /// One per cable, > 0; set only one of the two. Bodies keep their shapes.
  std::vector<double> force_density_n_per_m, tension_n;
  bool weight = false;   ///< Whether gravity acts.
  bool contact = false;  ///< Whether planes support bodies.
};

struct Form {
  bool found = false;
  std::string why;  ///< Reason, if not found.
  /// The robot with the form as its described pose and with the required rest lengths of its
  /// cables.
  RobotSpec robot;
  Equilibrium equilibrium;  ///< Equilibrium of `robot`.
};

/// Finds the stable form of a robot with the given force densities or tensions of its cables. The
/// search starts at the described pose (`FindEquilibrium`). In the result, all cables are in
/// tension, so the prestress is feasible.
Form FindForm(const RobotSpec& robot, const FormOptions& options, Diagnostics& out);

}  // namespace taut
