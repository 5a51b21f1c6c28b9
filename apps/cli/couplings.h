/// The network of a gait's oscillators, for people, programs and pages.
#pragma once

#include <string>

#include "taut/gait.h"
#include "taut/spec.h"

namespace taut::cli {

/// Counts, who is coupled to how many, the groups, and for small networks the whole matrix.
std::string CouplingTables(const RobotSpec& robot, const CouplingGraph& graph);

/// The same facts for programs: every coupling with its cables and its group.
std::string CouplingJson(const RobotSpec& robot, const CouplingGraph& graph);

/// A drawing: a ring of oscillators a joint, a line a coupled pair.
std::string CouplingSvg(const RobotSpec& robot, const CouplingGraph& graph);

}  // namespace taut::cli
