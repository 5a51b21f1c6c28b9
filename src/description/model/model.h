/// Reading a model file on behalf of an experiment, which shares its overrides.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "description/model/model_text.h"
#include "description/yaml/parameters.h"
#include "taut/spec.h"

namespace taut::description {

/// A model file as far as it could be read.
struct LoadedModel {
  /// There if every node and cable that the file describes is: then an experiment can be checked
  /// against it even though some of its numbers are wrong.
  std::optional<RobotSpec> robot;
  bool good = false;                         ///< Nothing was wrong.
  std::vector<std::string> parameter_names;  ///< Known as soon as the file is YAML.
};

/// As `LoadRobot`, but overrides that the model does not know are left for the caller to report
/// (`OverrideSet::ReportUnused`). If the file cannot be read at all, the overrides are silenced.
/// `options`, if given, replace what the file says.
LoadedModel LoadModel(const std::string& path, OverrideSet& overrides, Diagnostics& out,
                      const Overlay<ModelOptions>& options = {});

/// The robot of a model file that is a text, without bases and parameters. Nothing if there was any
/// error.
std::optional<RobotSpec> ModelOfText(const std::string& text, Diagnostics& out);

}  // namespace taut::description
