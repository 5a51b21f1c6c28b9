#include "taut/shipped.h"

#include <filesystem>

namespace taut {

namespace fs = std::filesystem;

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

std::optional<std::string> ShippedFolder() {
  std::error_code failed;
  const fs::path program = fs::read_symlink("/proc/self/exe", failed);
  return failed ? std::nullopt : ShippedFolder(program.string());
}

std::string FindInput(const std::string& path, const std::optional<std::string>& shipped) {
  std::error_code failed;
  if (!shipped || path.empty() || fs::path(path).is_absolute() || fs::exists(path, failed)) {
    return path;
  }
  if (*fs::path(path).lexically_normal().begin() == "..") return path;
  // In a build, share/taut has links into the source tree: users are to see the files themselves.
  const fs::path found = fs::canonical(fs::path(*shipped) / path, failed);
  if (failed || !fs::is_regular_file(found, failed)) return path;
  const fs::path in_tree = fs::path("share") / path;
  return fs::equivalent(in_tree, found, failed) ? in_tree.string() : found.string();
}

}  // namespace taut
