/// Files that come with taut: robots, experiments, gaits, studies, fits.
#pragma once

#include <CLI/CLI.hpp>

#include <optional>
#include <string>
#include <vector>

#include "taut/shipped.h"
#include "taut/spec.h"

namespace taut::cli {

struct ShippedFile {
  std::string kind;  ///< One of `ShippedKinds`.
  std::string path;
  FileHead head;
};

/// Returns the folder of a kind: of the installed taut, or of the source tree of a build.
std::optional<std::string> ShippedFolderOf(const std::string& kind);

/// Adds an option for the path of an input file, which `FindInput` resolves.
CLI::Option* AddInput(CLI::App& command, const std::string& name, std::string& path,
                      const std::string& meaning);

/// Returns the files of a kind, sorted by name.
std::vector<ShippedFile> ShippedFiles(const std::string& kind, Diagnostics& out);

}  // namespace taut::cli
