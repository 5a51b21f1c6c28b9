/// The files that come with taut: robots, experiments, gaits, studies, fits.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "taut/spec.h"

namespace taut::cli {

struct ShippedFile {
  std::string kind;  ///< A word of `ShippedKinds`.
  std::string path;
  FileHead head;
};

/// "models", "experiments", "gaits", "studies", "fits": the folders.
const std::vector<std::string>& ShippedKinds();

/// A folder of them beside the installed command (share/taut) or of the tree that the command was
/// built from. Nothing if there is none.
std::optional<std::string> ShippedFolder(const std::string& name);

/// The files of a kind, by name.
std::vector<ShippedFile> ShippedFiles(const std::string& kind, Diagnostics& out);

}  // namespace taut::cli
