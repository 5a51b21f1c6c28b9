/// Files that come with taut: robots, experiments, gaits, studies, fits.
#pragma once

#include <CLI/CLI.hpp>

#include <optional>
#include <string>
#include <vector>

#include "taut/input_names.h"
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

/// Kinds of files that a command accepts, preferred ones first (`ResolveInput`).
using Kinds = std::vector<std::string>;

/// Adds an option for an input file of one of `kinds`, given by path, folder or name.
CLI::Option* AddInput(CLI::App& command, const std::string& name, const Kinds& kinds,
                      std::string& path, const std::string& meaning);

/// Replaces `path` by the path of the file that it refers to. Returns an error message; empty if
/// there is none.
std::string FindFile(const Kinds& kinds, std::string& path);

/// Returns the files of a kind, sorted by name.
std::vector<ShippedFile> ShippedFiles(const std::string& kind, Diagnostics& out);

}  // namespace taut::cli
