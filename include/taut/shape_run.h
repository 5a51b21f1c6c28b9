/// Animations of structural analysis for `taut view` and `taut report`: vibration modes and
/// mechanisms as oscillating runs, states of self-stress as tensions.
///
/// Threads: any number may call these functions concurrently, each with a different folder.
#pragma once

#include <string>
#include <vector>

#include "taut/analysis.h"
#include "taut/diagnostics.h"
#include "taut/spec.h"

namespace taut {

/// Displacement shape, or tensions without displacements.
struct Shape {
  std::string name, description;  ///< Name and description of the run.
  /// Per body of the model: translation [m] and rotation vector [rad] at full amplitude, as in
  /// `Mode`. May be empty.
  std::vector<Vec3> translation_m, turn_rad;
  /// Per cable; empty: tensions of the model's cables in each pose.
  std::vector<double> tension_n;
  /// Index (from 1) among the shapes of this kind, and their number; 0: unknown.
  int number = 0, count = 0;
  double frequency_hz = 0;  ///< Natural frequency of a mode; otherwise 0.
};

struct ShapeLook {
  double size = 0.08;     ///< Largest displacement relative to the size of the robot, > 0.
  double period_s = 2.0;  ///< Displayed period of the oscillation, > 0.
  int periods = 2;        ///< Number of displayed periods, >= 1.
  double rate_hz = 30.0;  ///< Rows per second, > 0.
};

/// Returns the size of a robot: diagonal of the bounding box of its nodes, centers of mass and
/// cable ends [m].
double SizeOf(const ModelDef& def);

/// Returns the described pose displaced by `share` (-1..1) * `amplitude` * shape. Rotations are
/// exact, not linearized.
Pose SwungBy(const ModelDef& def, const Shape& shape, double amplitude, double share);

/// Writes a run folder in which the robot of the experiment oscillates about its described pose. On
/// failure, returns false and adds an error.
bool WriteShapeRun(const std::string& folder, const ExperimentSpec& experiment, const Shape& shape,
                   const ShapeLook& look, Diagnostics& out);

/// Writes a run folder as `WriteShapeRun` does, below `folder`, for each mode ("mode_1", ...; at
/// most `most_modes`), mechanism ("mechanism_1", ...) and state of self-stress ("self_stress_1",
/// ...). Rigid motions are omitted. Trace metadata contain index and count; for motions also the
/// relative amplitude, for modes frequency and slowdown. Tensions of a self-stress are in percent
/// of the largest. Returns the written folders.
std::vector<std::string> WriteShapeRuns(const std::string& folder, const ExperimentSpec& experiment,
                                        const Modes& modes, const ForceAnalysis& forces,
                                        int most_modes, const ShapeLook& look, Diagnostics& out);

}  // namespace taut
