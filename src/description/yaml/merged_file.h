/// File inheritance: files with `base: other.yaml` that contain only the differences.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "description/yaml/file_parameters.h"
#include "description/yaml/yaml_tree.h"

namespace taut::description {

/// File with its `base` files merged in: every top-level key of the file replaces the key of the
/// base, except that `parameters` and `set` are merged by name.
struct MergedFile {
  ValuePtr root;
  std::vector<ParameterText> parameters;
  std::vector<std::string> files;  ///< The file first, then its bases.
};

/// Reads a file and its bases, which must all be of kind `kind` ("model", "experiment", ...). The
/// root is null after an error.
MergedFile ReadMergedFile(const std::string& path, std::string_view kind, Diagnostics& out);

/// Same for a file that `ReadYaml` has read already as `root`, which is not null.
MergedFile MergeBases(const std::string& path, ValuePtr root, std::string_view kind,
                      Diagnostics& out);

}  // namespace taut::description
