/// Where the pages are that web/ is built into.
#pragma once

#include <optional>
#include <string>

#include "server.h"

namespace taut::viewer {

/// The folder of the pages: $TAUT_WEB, or web beside the program, or share/taut/web of an installed
/// one, or `otherwise`. Nothing if none of them has an index.html; `error` says what to do.
std::optional<std::string> FindWebFolder(std::string& error, const std::string& otherwise = "");

/// Every file of the folder, by the path that a browser asks for.
WebFiles ReadWebFiles(const std::string& folder);

}  // namespace taut::viewer
