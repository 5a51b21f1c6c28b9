/// Models in MuJoCo's language, MJCF: read for what they say of a tensegrity robot, and written so
/// that MuJoCo 2.2.2 and 3 take them. docs/from_mujoco.md has what is read, left out and refused.
///
/// SI units, frames as in taut/model_def.h. Nothing here throws or prints. Threads: any number may
/// call these functions at once, each with diagnostics of its own.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "taut/spec.h"

namespace taut {

/// What a spring of MuJoCo does that is shorter than its springlength.
enum class MjcfSlack {
  kTensionOnly,  ///< It is a cable: nothing.
  kAsMujoco,     ///< It pushes: a bar, a joint of kind distance with a spring.
};

struct MjcfImport {
  /// What 1 in the file is; 1 if not given, with a warning where that is unlikely.
  std::optional<double> length_unit_m = {}, mass_unit_kg = {};
  MjcfSlack slack = MjcfSlack::kTensionOnly;
  /// Leaves out dry friction of tendons that become cables, with a warning; else it is an error.
  bool without_frictionloss = false;
  /// A key of the file by its name, or by its number from 0: where the robot is at the start, and
  /// its controls. Empty: as the bodies are described, controls 0.
  std::string keyframe = {};
  std::string name = {};  ///< Of the robot; empty: the file's `model`, else the file's name.
};

struct ImportedMjcf {
  RobotSpec robot;    ///< With planes and boxes of the world as `def.planes`, `def.terrain_boxes`.
  double step_s = 0;  ///< The file's timestep.
  std::vector<std::string> notes;  ///< What was left out or read in its own way, a line each.
};

/// Reads a file, with those that it includes. Nothing if there was any error; what has been taken
/// otherwise than MuJoCo does is a warning.
std::optional<ImportedMjcf> ImportMjcf(const std::string& path, const MjcfImport& options,
                                       Diagnostics& out);

/// An experiment file for the model in `model_file`: the terrain of the import, its step.
std::string MjcfExperimentYaml(const ImportedMjcf& imported, const std::string& model_file);

/// How a cable is written.
enum class MjcfCables {
  kActuator,  ///< An actuator on a tendon that can only pull; its control moves the rest length.
  kSpring,    ///< A tendon's own spring with a dead band from 0 to the rest length: MuJoCo 3 only.
};

struct MjcfExport {
  MjcfCables cables = MjcfCables::kActuator;
  /// With actuators: controls are rest lengths [m], and a keyframe `start` has them and the bodies'
  /// velocities. Else controls are changes of rest lengths [m], so that 0 leaves them as they are.
  bool keyframe = false;
};

/// The model as MJCF. What MJCF cannot say is an error by name, and then there is nothing; what is
/// left out is a warning.
std::optional<std::string> ExportMjcf(const ModelDef& def, const MjcfExport& options,
                                      Diagnostics& out);

}  // namespace taut
