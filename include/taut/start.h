/// How an experiment begins: what a start is refused for, the rest that a robot settles to, how far
/// that is from what is described; and poses as models.
///
/// Threads: as in taut/run.h.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "taut/batch.h"
#include "taut/spec.h"

namespace taut {

/// All that a start can be refused for before it is prepared: that the model compiles, and that
/// nothing is deeper in the terrain or in another body than half its thickness (`Overlap`), as
/// described. What is in each other less gets a warning, if it starts so: it is pushed out without
/// speed, and a robot that settles first has none of it. False if there was an error.
bool CheckStart(const RobotSpec& robot, StartKind start, Diagnostics& out);

/// Brings a world to rest: rest lengths fixed, motion taken out whenever the kinetic energy peaks,
/// until no node gains more than 1e-9 m/s in a step. Time does not pass. False if that takes more
/// than `max_steps`, or once `go_on`, which is asked before every step, says no.
bool Settle(Batch& batch, int world, double step_s, const std::function<bool()>& go_on = {},
            int max_steps = 200000);

/// Where a robot is, without its velocities.
struct Pose {
  std::vector<BodyState> bodies;       ///< Velocities are not looked at.
  std::vector<double> rest_lengths_m;  ///< Per cable.
};

/// The robot in a pose that it has come to, at rest: as if it had been described there.
RobotSpec RobotAt(const RobotSpec& robot, const Pose& pose);

/// What settling has made of a robot.
struct StartChange {
  int taut_cables = 0;                                    ///< How many are taut as described.
  std::vector<std::string> slack_cables;                  ///< Those of them that are slack now.
  double max_tension_n = 0, described_max_tension_n = 0;  ///< Largest k (l - L) of any cable.
  /// The farthest that any node is from where it was described, after the rigid motion of all of
  /// them together (the best in least squares) is taken out.
  double largest_displacement_m = 0;
  std::string displaced_node;
  double size_m = 0;  ///< Twice the largest distance of a node from the centre of all, described.
  /// Names of bodies that press on each other and did not touch as described.
  std::vector<std::pair<std::string, std::string>> new_contacts;
};

/// Warnings of a start that is hardly meant: cables that went slack, a robot that is no longer the
/// one described (docs/formats/checks.md).
void WarnOfStart(const StartChange& change, Diagnostics& out);

struct SettledStart {
  Pose pose;
  StartChange change;
};

/// Where the robot of an experiment settles that begins `settled` or `settled_floating`, without
/// the start's noise. Nothing and diagnostics as from `RunExperiment`, or if `go_on`, which is
/// asked again and again, says no before it is found. Warns as `WarnOfStart`.
std::optional<SettledStart> FindSettledStart(const ExperimentSpec& experiment, Diagnostics& out,
                                             const std::function<bool()>& go_on = {});

}  // namespace taut
