/// Animations of structural analysis: vibration modes and mechanisms as swinging runs, states of
/// self-stress as tensions (`taut view`, `taut report`).
///
/// Threads: any number may write at once, each to a different folder.
#pragma once

#include <string>
#include <vector>

#include "taut/analysis.h"
#include "taut/diagnostics.h"
#include "taut/spec.h"

namespace taut {

/// A displacement shape, or only tensions.
struct Shape {
  std::string name, description;  ///< Of the run.
  /// Per body of the model: translation [m] and rotation vector [rad] at the amplitude of the
  /// swing, as in `Mode`; or empty.
  std::vector<Vec3> translation_m, turn_rad;
  /// Per cable; empty: tensions of the model's springs in each pose.
  std::vector<double> tension_n;
  /// Index (from 1) among the shapes of this kind, and their count; 0: unknown.
  int number = 0, count = 0;
  double frequency_hz = 0;  ///< Natural frequency of a mode; 0: not a mode.
};

struct ShapeLook {
  double size = 0.08;     ///< Largest displacement relative to the robot's size, > 0.
  double period_s = 2.0;  ///< Displayed period of a swing, > 0.
  int periods = 2;        ///< >= 1
  double rate_hz = 30.0;  ///< Rows per second, > 0.
};

/// Returns the size of a robot: diagonal of the bounding box of its nodes, centers of mass and
/// cable ends [m].
double SizeOf(const ModelDef& def);

/// Returns the described pose displaced by `share` (-1..1) times `amplitude` times the shape.
/// Rotations of any size are exact rotations, not linearized.
Pose SwungBy(const ModelDef& def, const Shape& shape, double amplitude, double share);

/// Writes the folder of a run in which the experiment's robot swings about its described pose.
/// Returns false, with an error, if that fails.
bool WriteShapeRun(const std::string& folder, const ExperimentSpec& experiment, const Shape& shape,
                   const ShapeLook& look, Diagnostics& out);

/// Writes one such folder per mode ("mode_1", ...; at most `most_modes`), mechanism ("mechanism_1",
/// ...) and state of self-stress ("self_stress_1", ...), without rigid motions, below `folder`.
/// The metadata of each trace contain index and count; those of motions also the relative
/// amplitude, those of modes frequency and slowdown. Returns the written folders. Tensions of a
/// self-stress are in percent of the largest.
std::vector<std::string> WriteShapeRuns(const std::string& folder, const ExperimentSpec& experiment,
                                        const Modes& modes, const ForceAnalysis& forces,
                                        int most_modes, const ShapeLook& look, Diagnostics& out);

}  // namespace taut
