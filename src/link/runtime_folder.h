/// Where programs that use one robot find each other.
#pragma once

#include <string>

#include "taut/diagnostics.h"

namespace taut::link {

/// $XDG_RUNTIME_DIR/taut, or /tmp/taut-UID where there is none; only this user may look into it.
/// Empty and a complaint if it cannot be had.
std::string RuntimeFolder(Diagnostics& out);

}  // namespace taut::link
