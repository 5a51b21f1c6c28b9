/// Location and content of the built pages of web/.
#pragma once

#include <optional>
#include <string>

#include "server.h"

namespace taut::viewer {

/// Returns the folder of the pages: $TAUT_WEB, or web in the program's folder, or share/taut/web of
/// an installation, or `otherwise`. Returns nothing, with advice in `error`, if none of them has an
/// index.html.
std::optional<std::string> FindWebFolder(std::string& error, const std::string& otherwise = "");

/// Returns all files of the folder by request path.
WebFiles ReadWebFiles(const std::string& folder);

}  // namespace taut::viewer
