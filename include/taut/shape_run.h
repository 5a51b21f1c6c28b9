/// Shapes of a structure as runs to look at: modes and mechanisms that swing, states of self-stress
/// as tensions (`taut view`, `taut report`).
///
/// Threads: any number may write at once, each a folder of its own.
#pragma once

#include <string>
#include <vector>

#include "taut/analysis.h"
#include "taut/diagnostics.h"
#include "taut/spec.h"

namespace taut {

/// A motion, or nothing but tensions.
struct Shape {
  std::string name, description;  ///< Of the run.
  /// Per body of the model, or empty: as `Mode` has them. Of a swing's amplitude.
  std::vector<Vec3> translation_m, turn_rad;
  /// Per cable, or empty: those of the model's springs where they are.
  std::vector<double> tension_n;
};

struct ShapeLook {
  double size = 0.08;     ///< Largest way of a swing, as a share of the robot's size. > 0
  double period_s = 2.0;  ///< Of a swing as it is shown. > 0
  int periods = 2;        ///< >= 1
  double rate_hz = 30.0;  ///< Rows a second. > 0
};

/// How far a robot reaches: the diagonal of the box that its nodes, centres of mass and ends of
/// cables fill [m].
double SizeOf(const ModelDef& def);

/// The robot as described, swung by `share` (-1..1) of a shape's amplitude, which is the shape
/// times `amplitude`. Turns are turns, however large.
Pose SwungBy(const ModelDef& def, const Shape& shape, double amplitude, double share);

/// Writes a folder as a run does: `experiment`'s robot as it is described, swinging. False and a
/// complaint if that fails.
bool WriteShapeRun(const std::string& folder, const ExperimentSpec& experiment, const Shape& shape,
                   const ShapeLook& look, Diagnostics& out);

/// The same for each of some modes ("mode_1", ...), mechanisms ("mechanism_1", ...) and states of
/// self-stress ("self_stress_1", ...), in folders of these names below `folder`, which are
/// returned. Rigid motions are left out. Tensions of a self-stress are per cent of the largest.
std::vector<std::string> WriteShapeRuns(const std::string& folder, const ExperimentSpec& experiment,
                                        const Modes& modes, const ForceAnalysis& forces,
                                        int most_modes, const ShapeLook& look, Diagnostics& out);

}  // namespace taut
