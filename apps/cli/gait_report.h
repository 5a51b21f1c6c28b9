/// Gaits and their oscillator networks as tables, JSON and SVG.
#pragma once

#include <string>

#include "taut/gait.h"
#include "taut/spec.h"

namespace taut::cli {

/// Returns every number of a gait with its name: as one line each, and as a JSON list.
std::string GaitTable(GaitSpec& gait);
std::string GaitJson(GaitSpec& gait);

/// Formats the counts, the couplings per oscillator, the groups, and for small networks the whole
/// matrix.
std::string CouplingTables(const RobotSpec& robot, const CouplingGraph& graph);

/// Returns the same facts as JSON: every coupling with its cables and its group.
std::string CouplingJson(const RobotSpec& robot, const CouplingGraph& graph);

/// Draws the network: one ring of oscillators per joint, one line per coupled pair.
std::string CouplingSvg(const RobotSpec& robot, const CouplingGraph& graph);

}  // namespace taut::cli
