#include "shipped_inputs.h"

#include <algorithm>
#include <filesystem>

#include "taut/shipped.h"

namespace taut::cli {

namespace fs = std::filesystem;

std::optional<std::string> ShippedFolderOf(const std::string& kind) {
  const auto shipped = ShippedFolder();
  if (!shipped) return std::nullopt;
  // In a build, share/taut is a link into the source tree: messages show the folder itself.
  std::error_code failed;
  const fs::path folder = fs::canonical(fs::path(*shipped) / kind, failed);
  return failed ? std::nullopt : std::optional(folder.string());
}

std::string FindFile(const Kinds& kinds, std::string& path) {
  Diagnostics found;
  path = ResolveInput(path, kinds, found);
  if (found.ok()) return {};
  const Diagnostic& error = found.items().front();
  return error.at.file + ": " + error.what + " (" + error.hint + ")";
}

CLI::Option* AddInput(CLI::App& command, const std::string& name, const Kinds& kinds,
                      std::string& path, const std::string& meaning) {
  const auto find = [kinds](std::string& given) { return FindFile(kinds, given); };
  return command.add_option(name, path, meaning)->transform(CLI::Validator(find, "", "input"));
}

std::vector<ShippedFile> ShippedFiles(const std::string& kind, Diagnostics& out) {
  std::vector<ShippedFile> files;
  const std::optional<std::string> folder = ShippedFolderOf(kind);
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
