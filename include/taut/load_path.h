/// Load-displacement path of a structure by arc-length continuation, through limit points (snap
/// through) and slackening (docs/theory/statics.md, section 8).
///
/// Threads: any number may call these functions concurrently.
#pragma once

#include <string>
#include <vector>

#include "taut/analysis.h"

namespace taut {

struct LoadPathOptions {
  double to_factor = 1;  ///< The path ends at this load factor, or at its negative.
  int most_steps = 500;
  /// The path ends when a node has moved by this share of the structure's size.
  double most_displacement = 1;
};

/// Equilibrium at a load factor, stable or not.
struct LoadedPoint {
  double load_factor = 0;
  /// Displacement in the direction of the loads: work of the forces of the load case at factor 1,
  /// divided by the sum of their magnitudes [m]; 0 without forces.
  double displacement_m = 0;
  Pose pose;
  std::vector<double> cable_tension_n, bar_force_n;  ///< As in `Equilibrium`.
  bool stable = true;  ///< No motion that the joints allow has a negative stiffness.
  /// The load factor has a maximum or a minimum along the path here.
  bool limit = false;
  std::vector<int> went_slack, went_taut;  ///< Cables that change here.
};

struct LoadPath {
  std::string why;  ///< Reason for an end before `to_factor`; empty if the path reached it.
  std::vector<LoadedPoint> points;  ///< In the order of the path; the first one has factor 0.
  std::vector<std::string> left_out;
};

/// Follows the equilibrium from load factor 0. The factor multiplies forces, settlements and
/// changes of length of the load case; weight acts throughout with its own factor. Contact is
/// ignored.
LoadPath FollowLoads(const ModelDef& def, const LoadCaseSpec& loads,
                     const LoadPathOptions& options = {});

}  // namespace taut
