/// Loader of model files, with the overrides of an experiment.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "description/model/model_text.h"
#include "description/yaml/file_parameters.h"
#include "taut/spec.h"

namespace taut::description {

/// Result of loading a model file, possibly with errors.
struct LoadedModel {
  /// Set if all nodes and cables of the file could be read. Then the experiment is checked against
  /// the robot, even if some numbers are invalid.
  std::optional<RobotSpec> robot;
  bool good = false;                         ///< No errors.
  std::vector<std::string> parameter_names;  ///< Known if the file is valid YAML.
};

/// Loads a model like `LoadRobot`, but does not report overrides of unknown parameters: call
/// `OverrideSet::ReportUnused`. If the file is unreadable, marks all overrides as used. `options`,
/// if set, replace the laws of the file.
LoadedModel LoadModel(const std::string& path, OverrideSet& overrides, Diagnostics& out,
                      const Overlay<ModelOptions>& options = {});

/// Returns the robot of a model given as text, without base files and parameters. Returns nothing
/// after any error.
std::optional<RobotSpec> ModelOfText(const std::string& text, Diagnostics& out);

}  // namespace taut::description
