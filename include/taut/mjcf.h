/// MJCF import and export: reads tensegrity robots from MuJoCo models, and writes models for MuJoCo
/// 2.2.2 and 3. docs/from_mujoco.md lists the supported, omitted and rejected elements.
///
/// SI units, frames as in taut/model_def.h. No function throws or prints. Threads: any number may
/// call these functions concurrently, with separate diagnostics.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "taut/spec.h"

namespace taut {

/// Conversion of a MuJoCo spring tendon, by its behavior while shorter than its springlength.
enum class MjcfSlack {
  kTensionOnly,  ///< A cable, which has no force in that state.
  kAsMujoco,     ///< A bar that pushes: a joint of kind distance with a spring.
};

struct MjcfImport {
  /// Length [m] and mass [kg] of one file unit. Default: 1, with a warning if that is unlikely.
  std::optional<double> length_unit_m = {}, mass_unit_kg = {};
  MjcfSlack slack = MjcfSlack::kTensionOnly;
  /// Omits the dry friction of tendons that become cables, with a warning. False: dry friction is
  /// an error.
  bool without_frictionloss = false;
  /// Keyframe of the file, as a name or a number from 0, for the initial pose and controls. Empty:
  /// the described bodies and controls of 0.
  std::string keyframe = {};
  std::string name = {};  ///< Name of the robot; empty: `model` of the file, or else the file name.
};

struct ImportedMjcf {
  RobotSpec robot;  ///< Planes and boxes of the world are in `def.planes` and `def.terrain_boxes`.
  double step_s = 0;               ///< Timestep of the file.
  std::vector<std::string> notes;  ///< Descriptions of omissions and conversions, one line each.
};

/// Reads a file and the files that it includes. Deviations from MuJoCo's behavior are warnings. On
/// an error, returns nothing and adds diagnostics.
std::optional<ImportedMjcf> ImportMjcf(const std::string& path, const MjcfImport& options,
                                       Diagnostics& out);

/// Returns the text of an experiment file for the model `model_file`, with terrain and step of the
/// import.
std::string MjcfExperimentYaml(const ImportedMjcf& imported, const std::string& model_file);

/// Representation of a cable in MJCF.
enum class MjcfCables {
  kActuator,  ///< A pull-only actuator on a tendon; its control changes the rest length.
  /// The spring of a tendon, without force from length 0 to the rest length. MuJoCo 3 only.
  kSpring,
};

struct MjcfExport {
  MjcfCables cables = MjcfCables::kActuator;
  /// For kActuator. True: controls are rest lengths [m], and the keyframe `start` contains them and
  /// the velocities of the bodies. False: controls are changes of rest lengths [m], so a control of
  /// 0 has no effect.
  bool keyframe = false;
};

/// Returns the model as MJCF. If MJCF cannot represent it, returns nothing and adds an error that
/// names the element. Omissions are warnings.
std::optional<std::string> ExportMjcf(const ModelDef& def, const MjcfExport& options,
                                      Diagnostics& out);

}  // namespace taut
