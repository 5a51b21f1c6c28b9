/// Start of an experiment: check for overlaps, settling to static equilibrium, comparison with the
/// described pose, and models in other poses.
///
/// Threads: see taut/run.h.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "taut/spec.h"
#include "taut/world_batch.h"

namespace taut {

/// Checks a start before its preparation. The model must compile, and in the described pose no body
/// may penetrate the terrain or another body by more than half its thickness (`Overlap`). Smaller
/// penetrations cause a warning, unless the robot settles first: contacts push the bodies apart
/// without velocity. Returns false after an error.
bool CheckStart(const RobotSpec& robot, StartKind start, Diagnostics& out);

/// Brings a world to static equilibrium by kinetic damping with fixed rest lengths. All velocities
/// become 0 at each peak of the kinetic energy, until no node gains more than 1e-9 m/s in a step.
/// Time does not advance. `go_on` is called before every step. Returns false if `go_on` returns
/// false, or after `max_steps`.
bool Settle(WorldBatch& batch, int world, double step_s, const std::function<bool()>& go_on = {},
            int max_steps = 200000);

/// Pose of a robot.
struct Pose {
  std::vector<BodyState> bodies;       ///< States of the bodies; velocities are ignored.
  std::vector<double> rest_lengths_m;  ///< Rest length of each cable.
};

/// Returns the robot with `pose` as its described pose, at rest.
RobotSpec RobotAt(const RobotSpec& robot, const Pose& pose);

/// Effect of settling on a robot.
struct StartChange {
  int taut_cables = 0;                    ///< Number of taut cables in the described pose.
  std::vector<std::string> slack_cables;  ///< Names of cables that settling made slack.
  /// Largest elastic tension k (l - L) of any cable: settled, and in the described pose.
  double max_tension_n = 0, described_max_tension_n = 0;
  /// Largest displacement of a node from its described position, after subtraction of the rigid
  /// motion that fits all nodes best (least squares).
  double largest_displacement_m = 0;
  std::string displaced_node;
  /// Twice the largest distance of a node from the center of all nodes, in the described pose.
  double size_m = 0;
  /// Names of bodies with new contact forces that did not touch in the described pose.
  std::vector<std::pair<std::string, std::string>> new_contacts;
};

/// Adds warnings about a start that is probably not intended: cables that went slack, or a shape
/// far from the described one (docs/formats/checks.md).
void WarnOfStart(const StartChange& change, Diagnostics& out);

struct SettledStart {
  Pose pose;
  StartChange change;
};

/// Returns the settled pose of an experiment that starts `settled` or `settled_floating`, without
/// its start noise. Returns nothing if no equilibrium is found (with diagnostics as from
/// `RunExperiment`), or if `go_on` returns false. `go_on` is called repeatedly. Adds the warnings
/// of `WarnOfStart`.
std::optional<SettledStart> FindSettledStart(const ExperimentSpec& experiment, Diagnostics& out,
                                             const std::function<bool()>& go_on = {});

}  // namespace taut
