/// Files that say `base: other.yaml` and then only what differs.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "description/yaml/parameters.h"
#include "description/yaml/yaml_tree.h"

namespace taut::description {

/// The top of a file with its `base` files merged in: every top-level key of the file replaces
/// the base's, except that `parameters` and `set` are merged by name.
struct MergedFile {
  ValuePtr root;
  std::vector<ParameterText> parameters;
  std::vector<std::string> files;  ///< The file itself first.
};

/// `kind` is what the file and its bases must be: "model" or "experiment". Null root after
/// complaints.
MergedFile ReadMergedFile(const std::string& path, std::string_view kind, Diagnostics& out);

}  // namespace taut::description
