#include "description/yaml/merged_file.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "description/yaml/reader.h"

namespace taut::description {
namespace {

/// Returns the canonical path, so that different paths to one file compare equal.
std::string Canonical(const std::string& path) {
  std::error_code failed;
  const std::filesystem::path canonical = std::filesystem::weakly_canonical(path, failed);
  return failed ? path : canonical.string();
}

/// Merges `top` over `base`, key by key.
ValuePtr Merge(const Value& top, const Value& base) {
  auto merged = std::make_shared<Value>(top);
  for (const Entry& entry : base.entries) {
    const auto own = std::find_if(merged->entries.begin(), merged->entries.end(),
                                  [&](const Entry& e) { return e.key == entry.key; });
    if (own == merged->entries.end()) {
      merged->entries.push_back(entry);
    } else if (entry.key == "set" && own->value->kind == Value::Kind::kMap &&
               entry.value->kind == Value::Kind::kMap) {
      own->value = Merge(*own->value, *entry.value);
    }
  }
  return merged;
}

}  // namespace

MergedFile ReadMergedFile(const std::string& path, std::string_view kind, Diagnostics& out) {
  ValuePtr root = ReadYaml(path, out);
  return root ? MergeBases(path, std::move(root), kind, out) : MergedFile();
}

MergedFile MergeBases(const std::string& path, ValuePtr root, std::string_view kind,
                      Diagnostics& out) {
  MergedFile file;
  std::vector<std::vector<ParameterText>> parameters;
  std::vector<std::string> seen;
  for (std::string next = path;; root = ReadYaml(next, out)) {
    if (!root || !CheckHeader(*root, kind, out)) return {};
    file.files.push_back(next);
    seen.push_back(Canonical(next));
    parameters.push_back(ReadParameters(root->Find("parameters"), out));

    const Value* base = root->Find("base");
    file.root = file.root ? Merge(*file.root, *root) : root;
    if (!base) break;
    if (base->kind != Value::Kind::kScalar || base->text.empty()) {
      out.Error("base.bad_name", base->at,
                "base must be the name of a file of kind " + std::string(kind));
      return {};
    }
    next = PathBeside(next, base->text);
    if (std::find(seen.begin(), seen.end(), Canonical(next)) != seen.end()) {
      out.Error("base.circle", base->at, "base files refer to each other in a circle: " + next);
      return {};
    }
    std::error_code ignored;
    if (!std::filesystem::exists(next, ignored)) {
      out.Unreadable("base.missing", base->at, "base: there is no file " + next,
                     "paths are relative to the folder of this file");
      return {};
    }
  }
  for (auto block = parameters.rbegin(); block != parameters.rend(); ++block) {
    MergeParameters(file.parameters, *block);
  }
  return file;
}

}  // namespace taut::description
