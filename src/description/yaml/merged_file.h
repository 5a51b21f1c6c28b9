/// File inheritance: a file with `base: other.yaml` contains only the differences from its base.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "description/yaml/file_parameters.h"
#include "description/yaml/yaml_tree.h"

namespace taut::description {

/// File after merging its `base` files. Every top-level key of the file replaces the same key of
/// the base. `parameters` and `set` are merged by name.
struct MergedFile {
  ValuePtr root;
  std::vector<ParameterText> parameters;
  std::vector<std::string> files;  ///< First the file, then its bases.
};

/// Reads a file and its bases, which must all be of kind `kind` ("model", "experiment", ...). The
/// root is null after an error.
MergedFile ReadMergedFile(const std::string& path, std::string_view kind, Diagnostics& out);

/// Same as `ReadMergedFile`, for a file already parsed by `ReadYaml`. `root` must not be null.
MergedFile MergeBases(const std::string& path, ValuePtr root, std::string_view kind,
                      Diagnostics& out);

}  // namespace taut::description
