/// Start of an experiment: check for overlaps, settling to static equilibrium, comparison with the
/// described pose; poses as models.
///
/// Threads: as in taut/run.h.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "taut/spec.h"
#include "taut/world_batch.h"

namespace taut {

/// Checks a start before it is prepared: the model must compile, and no body may penetrate the
/// terrain or another body by more than half its thickness (`Overlap`) in the described pose.
/// Smaller penetrations give a warning, unless the robot settles first: they are pushed out without
/// velocity, and a settled robot has none. Returns false after an error.
bool CheckStart(const RobotSpec& robot, StartKind start, Diagnostics& out);

/// Brings a world to static equilibrium by kinetic damping: with fixed rest lengths, sets all
/// velocities to 0 at each peak of the kinetic energy, until no node gains more than 1e-9 m/s in a
/// step. Time does not advance. Returns false after `max_steps`, or if `go_on`, which is called
/// before every step, returns false.
bool Settle(WorldBatch& batch, int world, double step_s, const std::function<bool()>& go_on = {},
            int max_steps = 200000);

/// Pose of a robot, without velocities.
struct Pose {
  std::vector<BodyState> bodies;       ///< Velocities are ignored.
  std::vector<double> rest_lengths_m;  ///< Per cable.
};

/// Returns the robot at rest in a pose, as if it had been described there.
RobotSpec RobotAt(const RobotSpec& robot, const Pose& pose);

/// Effect of settling on a robot.
struct StartChange {
  int taut_cables = 0;                    ///< Number of taut cables in the described pose.
  std::vector<std::string> slack_cables;  ///< Names of cables that were taut and are slack now.
  double max_tension_n = 0, described_max_tension_n = 0;  ///< Largest k (l - L) of any cable.
  /// Largest distance of a node from its described position, after removal of the best common rigid
  /// motion (least squares).
  double largest_displacement_m = 0;
  std::string displaced_node;
  /// Twice the largest distance of a node from the center of all nodes, in the described pose.
  double size_m = 0;
  /// Names of bodies that press on each other now, but did not touch in the described pose.
  std::vector<std::pair<std::string, std::string>> new_contacts;
};

/// Warns of a probably unintended start: cables that went slack, or a robot far from its described
/// shape (docs/formats/checks.md).
void WarnOfStart(const StartChange& change, Diagnostics& out);

struct SettledStart {
  Pose pose;
  StartChange change;
};

/// Returns the pose at which a robot settles whose experiment starts `settled` or
/// `settled_floating`, without the start's noise. Returns nothing, with diagnostics as from
/// `RunExperiment`, if there is none, or if `go_on`, which is polled repeatedly, returns false
/// before it is found. Warns as `WarnOfStart` does.
std::optional<SettledStart> FindSettledStart(const ExperimentSpec& experiment, Diagnostics& out,
                                             const std::function<bool()>& go_on = {});

}  // namespace taut
