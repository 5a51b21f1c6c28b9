#include "taut/input_names.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>

#include "description/yaml/kinds.h"
#include "taut/run_folder.h"
#include "taut/spec.h"

namespace taut {

namespace fs = std::filesystem;

namespace {

struct KindOfInput {
  const char* kind;
  const char* folder;     ///< Folder of shipped files.
  const char* extension;  ///< Extension of these files; names may omit it.
};

constexpr KindOfInput kKinds[] = {
    {"model", "models", ".yaml"},  {"experiment", "experiments", ".yaml"},
    {"gait", "gaits", ".yaml"},    {"study", "studies", ".yaml"},
    {"fit", "fits", ".yaml"},      {"mapping", "mappings", ".json"},
    {"faults", "faults", ".yaml"}, {"calibration", "calibrations", ".yaml"},
};
constexpr const char* kTrace = "trace";

/// Returns null for "trace".
const KindOfInput* FindKind(const std::string& kind) {
  const auto found = std::find_if(std::begin(kKinds), std::end(kKinds),
                                  [&](const KindOfInput& one) { return kind == one.kind; });
  return found == std::end(kKinds) ? nullptr : found;
}

bool IsFile(const fs::path& path) {
  std::error_code failed;
  return fs::is_regular_file(path, failed);
}

bool Accepts(const std::vector<std::string>& kinds, const char* kind) {
  return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
}

/// Returns the YAML files of a folder with their kinds, sorted by name. The inputs of a run are an
/// experiment.
std::vector<std::pair<fs::path, std::string>> YamlFiles(const fs::path& folder) {
  constexpr std::size_t kMostFiles = 200;  // the folder of a robot contains a few
  std::vector<std::pair<fs::path, std::string>> files;
  std::error_code failed;
  std::size_t count = 0;
  for (fs::directory_iterator it(folder, failed), end; !failed && it != end; it.increment(failed)) {
    if (it->path().extension() != ".yaml" || !IsFile(it->path())) continue;
    if (++count > kMostFiles) break;
    Diagnostics ignored;
    const auto head = ReadFileHead(it->path().string(), ignored);
    std::string kind = head ? head->kind : std::string();
    if (kind == description::kResolvedKind) kind = "experiment";
    files.emplace_back(it->path(), std::move(kind));
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// Returns the file that a folder represents; the folder itself if there is no such file or after
/// an error.
std::string FileOfFolder(const std::string& given, const std::vector<std::string>& kinds,
                         Diagnostics& out) {
  const fs::path folder = (fs::path(given) / "").parent_path();  // without the slash at the end
  if (Accepts(kinds, kTrace) && IsFile(TraceOfRun(given))) return given;
  std::optional<std::vector<std::pair<fs::path, std::string>>> files;
  for (const std::string& kind : kinds) {
    // A file that is named after its kind is selected even if it has errors, so that these are
    // reported.
    const KindOfInput* const known = FindKind(kind);
    if (known == nullptr) continue;
    const fs::path named = folder / (kind + known->extension);
    if (IsFile(named)) return named.string();
    if (!files) files = YamlFiles(folder);
    std::vector<fs::path> found;
    for (const auto& [path, of_file] : *files) {
      // The inputs of a run whose trace is missing must not start a new run in place of a replay.
      const bool inputs = path.filename().string().starts_with("inputs");
      if (of_file == kind && !(inputs && Accepts(kinds, kTrace))) found.push_back(path);
    }
    if (found.size() == 1) return found.front().string();
    if (found.empty()) continue;
    std::string names;
    for (const fs::path& path : found) {
      names += (names.empty() ? "" : ", ") + path.filename().string();
    }
    out.Error("input.several_files", {given, 0, 0},
              "the folder contains several files of the kind " + kind + ": " + names,
              "name one of them, such as " + found.front().string());
    return given;
  }
  return given;
}

}  // namespace

std::string ResolveInput(const std::string& given, const std::vector<std::string>& kinds,
                         Diagnostics& out, const std::string& program) {
  std::error_code failed;
  if (given.empty()) return given;
  if (fs::is_directory(given, failed)) return FileOfFolder(given, kinds, out);
  if (fs::exists(given, failed)) return given;
  for (const std::string& kind : kinds) {
    const KindOfInput* const known = FindKind(kind);
    if (known != nullptr && IsFile(given + known->extension)) return given + known->extension;
  }
  const auto shipped = [&](const std::string& path) {
    std::string found = FindInput(path, program);
    return found == path ? std::string() : found;
  };
  if (std::string found = shipped(given); !found.empty()) return found;
  const bool bare = fs::path(given).parent_path().empty();
  for (const std::string& kind : kinds) {
    const KindOfInput* const known = FindKind(kind);
    if (known == nullptr) continue;
    const std::string below = bare ? std::string(known->folder) + "/" + given : given;
    const bool whole = fs::path(given).extension() == known->extension;
    if (std::string found = shipped(whole ? below : below + known->extension); !found.empty()) {
      return found;
    }
  }
  return given;
}

}  // namespace taut
