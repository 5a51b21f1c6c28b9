/// Description of a world's status as text.
#pragma once

#include <string>

#include "taut/world_batch.h"

namespace taut::plant {

/// Describes a status, with the names of body, cable and terrain. Empty if there is no problem.
std::string StatusText(const ModelDef& def, const WorldStatus& status);

}  // namespace taut::plant
