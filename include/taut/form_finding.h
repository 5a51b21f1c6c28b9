/// Forms that forces hold: nets from their force densities, and robots from those or the tensions
/// of their cables (docs/theory/inverse_statics.md, section 5).
///
/// SI units, W frame. Wrong inputs are complaints. Threads: all functions are pure; any number may
/// run at once.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "taut/analysis.h"
#include "taut/diagnostics.h"
#include "taut/spec.h"

namespace taut {

/// Points and straight members between them, which pull or push along their line.
struct FormNet {
  std::vector<Vec3> nodes_m;  ///< Where the search begins; of fixed ones, where they are.
  std::vector<bool> fixed;    ///< Per node; empty: none is.
  std::vector<std::array<int, 2>> members;  ///< Its two nodes.
};

/// Where the nodes are if members have these force densities, force over length, tension > 0, under
/// loads per node (empty: none). Fixed nodes are needed: without them see `FindFreeForm`.
std::optional<std::vector<Vec3>> FindNetForm(const FormNet& net,
                                             const std::vector<double>& force_density_n_per_m,
                                             const std::vector<Vec3>& loads_n, Diagnostics& out);

struct FreeForm {
  bool found = false;
  std::string why;                                  ///< If not.
  std::vector<double> group_force_density_n_per_m;  ///< Per group; the first is 1 or -1.
  std::vector<Vec3> nodes_m;
  double residual = 0;  ///< What is left at a node, of the largest force at one.
  /// Whether no stiffness is needed to make it stable, only prestress: the matrix of force
  /// densities has no negative eigenvalue, and no more than four that are zero.
  bool super_stable = false;
};

/// The form of a net without fixed nodes in which members of a group have the same force density,
/// which is found, too, as near as may be to where the nodes are. Of the forms that the force
/// densities allow, all that are affine to each other, it is the nearest to the start in least
/// squares. `group`: per member, from 0 on.
FreeForm FindFreeForm(const FormNet& net, const std::vector<int>& group, Diagnostics& out);

struct FormOptions {
  /// Per cable, one of the two, > 0; bodies keep their forms.
  std::vector<double> force_density_n_per_m, tension_n;
  bool weight = false;   ///< Whether gravity acts.
  bool contact = false;  ///< Whether planes bear what stands on them.
};

struct Form {
  bool found = false;
  std::string why;  ///< If not.
  /// The robot as described there, with the rest lengths that its cables have to have.
  RobotSpec robot;
  Equilibrium equilibrium;  ///< Of `robot`: where it stays.
};

/// The stable form that the robot's cables give its bodies if they have these force densities or
/// tensions, found by relaxation from where it is described. All cables pull, so that it is a
/// prestress that they can have.
Form FindForm(const RobotSpec& robot, const FormOptions& options, Diagnostics& out);

}  // namespace taut
