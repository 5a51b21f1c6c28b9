/// Gaits and the networks of their oscillators, for people, programs and pages.
#pragma once

#include <string>

#include "taut/gait.h"
#include "taut/spec.h"

namespace taut::cli {

/// Every number of a gait by name: one line each, and as a JSON list.
std::string GaitTable(GaitSpec& gait);
std::string GaitJson(GaitSpec& gait);

/// Counts, who is coupled to how many, the groups, and for small networks the whole matrix.
std::string CouplingTables(const RobotSpec& robot, const CouplingGraph& graph);

/// The same facts for programs: every coupling with its cables and its group.
std::string CouplingJson(const RobotSpec& robot, const CouplingGraph& graph);

/// A drawing: a ring of oscillators a joint, a line a coupled pair.
std::string CouplingSvg(const RobotSpec& robot, const CouplingGraph& graph);

}  // namespace taut::cli
