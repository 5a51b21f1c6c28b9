/// Loading of files that refer to a robot defined in another file: fault scripts and calibrations.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "description/yaml/file_parameters.h"
#include "description/yaml/keys.h"
#include "description/yaml/merged_file.h"

namespace taut::description {

/// Returns the index of an actuated cable; -1 after an error.
inline int FindActuatedCable(const Placed& name, const std::vector<std::string>& cables,
                             const Scope& scope) {
  const auto found = std::find(cables.begin(), cables.end(), name.text);
  if (found != cables.end()) return static_cast<int>(found - cables.begin());
  scope.out.Error("cable.not_actuated", name.at, "there is no actuated cable \"" + name.text + "\"",
                  NameHint(name.text, cables));
  return -1;
}

/// Loads a file of kind `kind` with `read(root, scope)` and stores the paths of its files. Returns
/// nothing after an error.
template <class Read>
auto LoadRobotFile(const std::string& path, const char* kind, Diagnostics& out, Read&& read)
    -> std::optional<decltype(read(std::declval<const Value&>(), std::declval<const Scope&>()))> {
  const std::size_t errors_before = out.items().size();
  MergedFile file = ReadMergedFile(path, kind, out);
  if (!file.root) return std::nullopt;
  const NameTable names = ResolveParameters(file.parameters, out);
  NameSet used;
  auto made = read(*file.root, Scope{names, out, &used});
  if (out.items().size() != errors_before) return std::nullopt;
  WarnOfUnused(file.parameters, std::move(used), file.files, out);
  made.files = std::move(file.files);
  return made;
}

}  // namespace taut::description
