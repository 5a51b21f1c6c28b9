/// Form finding: equilibrium shapes of nets from force densities, and of robots from force
/// densities or tensions of their cables (docs/theory/inverse_statics.md, section 5).
///
/// SI units, W frame. Invalid inputs are reported as errors. Threads: all functions are pure; any
/// number may run concurrently.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "taut/analysis.h"
#include "taut/diagnostics.h"
#include "taut/spec.h"

namespace taut {

/// Pin-jointed net: nodes, and straight members that pull or push along their line.
struct FormNet {
  std::vector<Vec3> nodes_m;                ///< Start of the search; fixed nodes: their places.
  std::vector<bool> fixed;                  ///< Per node; empty: none fixed.
  std::vector<std::array<int, 2>> members;  ///< Two nodes each.
};

/// Returns the node places [m] at which the net is in equilibrium with these force densities (force
/// / length, per member, tension > 0) under loads per node [N] (empty: none), by the force density
/// method (eq. 7). Requires fixed nodes; without them use `FindFreeForm`. Returns nothing and adds
/// errors on failure.
std::optional<std::vector<Vec3>> FindNetForm(const FormNet& net,
                                             const std::vector<double>& force_density_n_per_m,
                                             const std::vector<Vec3>& loads_n, Diagnostics& out);

struct FreeForm {
  bool found = false;
  std::string why;                                  ///< Reason, if not found.
  std::vector<double> group_force_density_n_per_m;  ///< Per group; the first is 1 or -1.
  std::vector<Vec3> nodes_m;
  double residual = 0;  ///< Largest residual at a node, relative to the largest member force.
  /// Super-stability: prestress stabilizes the form at any stiffness. The force density matrix has
  /// no negative eigenvalue and exactly four zero ones.
  bool super_stable = false;
};

/// Finds the form of a net without fixed nodes, and the force density of each group of members,
/// close to the given nodes. All forms with these densities are affine images of each other; the
/// result is the nearest to the start in least squares. `group`: group of each member, from 0 on.
FreeForm FindFreeForm(const FormNet& net, const std::vector<int>& group, Diagnostics& out);

struct FormOptions {
  /// Per cable, > 0; set one of the two. Bodies keep their shapes.
  std::vector<double> force_density_n_per_m, tension_n;
  bool weight = false;   ///< Whether gravity acts.
  bool contact = false;  ///< Whether planes support bodies.
};

struct Form {
  bool found = false;
  std::string why;  ///< Reason, if not found.
  /// The robot with the form as its described pose and the required rest lengths of its cables.
  RobotSpec robot;
  Equilibrium equilibrium;  ///< Equilibrium of `robot`.
};

/// Finds the stable form of a robot with these force densities or tensions of its cables, from the
/// described pose (`FindEquilibrium`). All cables are in tension in the result, so the prestress is
/// feasible.
Form FindForm(const RobotSpec& robot, const FormOptions& options, Diagnostics& out);

}  // namespace taut
