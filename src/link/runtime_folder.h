/// Folder of sockets and files by which programs that use the same robot find each other.
#pragma once

#include <string>

#include "taut/diagnostics.h"

namespace taut::link {

/// Returns $XDG_RUNTIME_DIR/taut, or /tmp/taut-UID without that variable; accessible to this user
/// only. Returns an empty string and reports an error if it cannot be created.
std::string RuntimeFolder(Diagnostics& out);

}  // namespace taut::link
