#include "shipped.h"

#include <algorithm>
#include <filesystem>

namespace taut::cli {

namespace fs = std::filesystem;

const std::vector<std::string>& ShippedKinds() {
  static const std::vector<std::string> kinds{"models", "experiments", "gaits", "studies", "fits"};
  return kinds;
}

std::optional<std::string> ShippedFolder(const std::string& name) {
  std::error_code failed;
  const fs::path command = fs::read_symlink("/proc/self/exe", failed).parent_path();
  for (const fs::path& share : {command.parent_path() / "share/taut", command / "share/taut"}) {
    // In a build these are links into the source tree; users are to see where they lead.
    const fs::path folder = fs::canonical(share / name, failed);
    if (!failed && fs::is_directory(folder, failed)) return folder.string();
  }
  return std::nullopt;
}

std::vector<ShippedFile> ShippedFiles(const std::string& kind, Diagnostics& out) {
  std::vector<ShippedFile> files;
  const std::optional<std::string> folder = ShippedFolder(kind);
  if (!folder) return files;
  std::error_code failed;
  for (const fs::directory_entry& entry : fs::directory_iterator(*folder, failed)) {
    if (entry.path().extension() != ".yaml") continue;
    auto head = ReadFileHead(entry.path().string(), out);
    if (head) files.push_back({kind, entry.path().string(), std::move(*head)});
  }
  std::sort(files.begin(), files.end(),
            [](const ShippedFile& a, const ShippedFile& b) { return a.path < b.path; });
  return files;
}

}  // namespace taut::cli
