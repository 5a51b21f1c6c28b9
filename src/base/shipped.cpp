#include "taut/shipped.h"

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "taut/diagnostics.h"

namespace taut {

namespace fs = std::filesystem;

namespace {

std::string given_program;

}  // namespace

void SetRunningProgram(const std::string& path) { given_program = path; }

std::string RunningProgram() {
  if (!given_program.empty()) return given_program;
  std::error_code failed;
  return fs::read_symlink("/proc/self/exe", failed).string();
}

std::optional<std::string> FindBesideProgram(const std::string& path) {
  const fs::path folder = fs::path(RunningProgram()).parent_path();
  if (folder.empty()) return std::nullopt;
  std::error_code failed;
  for (const char* const from : {"", "../share/taut", "share/taut"}) {
    const fs::path found = folder / from / path;
    if (fs::exists(found, failed)) return found.lexically_normal().string();
  }
  return std::nullopt;
}

std::optional<std::string> ShippedFolder(const std::string& program) {
  std::error_code failed;
  fs::path folder = fs::canonical(program, failed);
  while (!failed && folder.has_relative_path()) {
    folder = folder.parent_path();
    const fs::path share = folder / "share/taut";
    if (fs::is_directory(share / "models", failed)) return share.string();
    failed.clear();
  }
  return std::nullopt;
}

const std::vector<std::string>& ShippedKinds() {
  static const std::vector<std::string> kinds{"models", "experiments", "gaits", "studies", "fits"};
  return kinds;
}

std::string FindInput(const std::string& path, const std::string& program) {
  std::error_code failed;
  const fs::path given(path);
  if (path.empty() || given.is_absolute() || fs::exists(given, failed)) return path;
  // A path that begins with ".." would leave the folder.
  if (*given.lexically_normal().begin() == "..") return path;
  const auto shipped = ShippedFolder(program);
  if (!shipped) return path;
  // In a build, share/taut links to the source tree; return the path of the target.
  const fs::path found = fs::canonical(*shipped / given, failed);
  if (failed || !fs::is_regular_file(found, failed)) return path;
  const fs::path in_tree = "share" / given;
  return fs::equivalent(in_tree, found, failed) ? in_tree.string() : found.string();
}

std::string SimilarInput(const std::string& path, const std::string& program) {
  constexpr std::size_t kMostFiles = 2000;  // maximum number of files read per folder
  const fs::path given(path), parent = given.parent_path();
  std::vector<std::string> names, paths;
  if (!given.has_stem()) return {};
  const auto add = [&](const fs::path& folder, const fs::path& shown) {
    std::error_code failed;
    std::size_t count = 0;
    for (fs::directory_iterator it(folder, failed), end; !failed && it != end;
         it.increment(failed)) {
      if (++count > kMostFiles) break;
      std::error_code unknown;
      const fs::path name = it->path().filename();
      if (given.has_extension() && name.extension() != given.extension()) continue;
      if (!it->is_regular_file(unknown)) continue;
      names.push_back(name.stem().string());
      paths.push_back((shown / name).string());
    }
  };
  add(parent.empty() ? fs::path(".") : parent, parent);
  if (const auto shipped = given.is_relative() ? ShippedFolder(program) : std::nullopt) {
    const fs::path folder(*shipped);
    if (!parent.empty()) {
      add(folder / parent, parent);
    } else {
      for (const std::string& kind : ShippedKinds()) add(folder / kind, kind);
    }
  }
  const auto best =
      std::find(names.begin(), names.end(), ClosestMatch(given.stem().string(), names));
  if (best == names.end()) return {};
  return "did you mean \"" + paths[static_cast<std::size_t>(best - names.begin())] + "\"?";
}

}  // namespace taut
