/// Output of `taut check` about a robot and its experiment.
#pragma once

#include <string>
#include <vector>

#include "taut/cable_scheme.h"
#include "taut/spec.h"
#include "taut/start.h"

namespace taut::cli {

/// Formats the verdict on a valid file and a summary of at most ten lines. `experiment` and
/// `settled` (the result of settling) may be null.
std::string CheckSummary(const std::string& path, const RobotSpec& robot,
                         const ExperimentSpec* experiment, const StartChange* settled);

/// Formats the numbers of cables per integration scheme as one line without a line end; empty
/// without cables.
std::string SchemesLine(const ExperimentSpec& experiment);

/// Formats the environment of an experiment as one line without a line end; empty without one.
std::string EnvironmentLine(const ExperimentSpec& experiment);

/// Formats aligned tables: bodies, cables, loads at the start, possible collisions.
std::string RobotTables(const RobotSpec& robot);

/// Integration of an experiment's cables at its longest step.
struct CableIntegration {
  std::vector<CableScheme> schemes;  ///< Integration scheme of each cable.
  int substeps = 1;                  ///< Number of substeps of a step.
};
CableIntegration IntegrationOf(const ExperimentSpec& experiment);

/// Formats the experiment: number of cables per integration scheme, controllers, events and phases.
std::string ExperimentTables(const ExperimentSpec& experiment);

/// Returns the same facts and the warnings as JSON. `experiment` and `settled` (the result of
/// settling) may be null.
std::string CheckJson(const RobotSpec& robot, const ExperimentSpec* experiment,
                      const Diagnostics& found, const StartChange* settled);

/// Returns the errors and warnings of a file as JSON.
std::string ErrorsJson(const std::string& path, const Diagnostics& found);

}  // namespace taut::cli
