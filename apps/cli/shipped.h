/// The files that come with taut: robots, experiments, gaits, studies, fits.
#pragma once

#include <CLI/CLI.hpp>

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
std::optional<std::string> ShippedFolderOf(const std::string& kind);

/// Looks an input file up among the files that come with taut if the current folder has none of
/// its name (`FindInput`).
CLI::Option* LookUpShipped(CLI::Option* input);

/// The files of a kind, by name.
std::vector<ShippedFile> ShippedFiles(const std::string& kind, Diagnostics& out);

}  // namespace taut::cli
