/// MJCF import and export: reads tensegrity robots from MuJoCo models, and writes models for MuJoCo
/// 2.2.2 and 3. docs/from_mujoco.md lists which elements are read, omitted and refused.
///
/// SI units, frames as in taut/model_def.h. No function throws or prints. Threads: any number may
/// call these functions at once, each with separate diagnostics.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "taut/spec.h"

namespace taut {

/// Conversion of a MuJoCo spring tendon, by its force below its springlength.
enum class MjcfSlack {
  kTensionOnly,  ///< A cable, without force.
  kAsMujoco,     ///< A bar that pushes: a joint of kind distance with a spring.
};

struct MjcfImport {
  /// Length [m] and mass [kg] of one unit of the file; 1 if not given, with a warning where that is
  /// unlikely.
  std::optional<double> length_unit_m = {}, mass_unit_kg = {};
  MjcfSlack slack = MjcfSlack::kTensionOnly;
  /// Omits the dry friction of tendons that become cables, with a warning; otherwise it is an
  /// error.
  bool without_frictionloss = false;
  /// Keyframe of the file, by name or by number from 0, for the initial pose and controls. Empty:
  /// the bodies as described, with controls 0.
  std::string keyframe = {};
  std::string name = {};  ///< Of the robot; empty: the file's `model`, else the file's name.
};

struct ImportedMjcf {
  RobotSpec robot;    ///< With planes and boxes of the world as `def.planes`, `def.terrain_boxes`.
  double step_s = 0;  ///< The file's timestep.
  std::vector<std::string> notes;  ///< Omissions and conversions, one line each.
};

/// Reads a file and the files that it includes. Returns nothing, with diagnostics, if there was any
/// error. Deviations from MuJoCo's behavior are warnings.
std::optional<ImportedMjcf> ImportMjcf(const std::string& path, const MjcfImport& options,
                                       Diagnostics& out);

/// Returns the text of an experiment file for the model in `model_file`, with the terrain and the
/// step of the import.
std::string MjcfExperimentYaml(const ImportedMjcf& imported, const std::string& model_file);

/// Representation of a cable in MJCF.
enum class MjcfCables {
  kActuator,  ///< An actuator on a tendon that can only pull; its control moves the rest length.
  kSpring,  ///< The spring of a tendon, with a dead band from 0 to the rest length: MuJoCo 3 only.
};

struct MjcfExport {
  MjcfCables cables = MjcfCables::kActuator;
  /// With actuators. True: controls are rest lengths [m], and a keyframe `start` has them and the
  /// bodies' velocities. False: controls are changes of rest lengths [m], so that 0 leaves them
  /// unchanged.
  bool keyframe = false;
};

/// Returns the model as MJCF. Returns nothing, with an error that names the element, if MJCF cannot
/// represent it. Omissions are warnings.
std::optional<std::string> ExportMjcf(const ModelDef& def, const MjcfExport& options,
                                      Diagnostics& out);

}  // namespace taut
