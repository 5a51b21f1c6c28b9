/// Folder with sockets and files that connect programs using the same robot.
#pragma once

#include <string>

#include "taut/diagnostics.h"

namespace taut::link {

/// Returns $XDG_RUNTIME_DIR/taut, or /tmp/taut-UID if this variable is not set. Only this user can
/// access the folder. Returns an empty text and reports an error if it cannot be created.
std::string RuntimeFolder(Diagnostics& out);

}  // namespace taut::link
