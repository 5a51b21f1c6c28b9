#include "web_files.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

namespace taut::viewer {

namespace fs = std::filesystem;

std::optional<std::string> FindWebFolder(std::string& error, const std::string& otherwise) {
  std::vector<fs::path> folders;
  std::error_code failed;
  if (const char* named = std::getenv("TAUT_WEB"); named != nullptr && *named != '\0') {
    folders.push_back(named);
  } else {
    const fs::path command = fs::read_symlink("/proc/self/exe", failed);
    folders = {command.parent_path() / "web",
               command.parent_path().parent_path() / "share/taut/web", otherwise};
  }
  for (const fs::path& folder : folders) {
    if (fs::exists(folder / "index.html", failed)) return folder.string();
  }
  error =
      "the viewer's pages are missing; they are built with taut where node and npm are "
      "(apt-get install nodejs npm, then script/build)";
  return std::nullopt;
}

WebFiles ReadWebFiles(const std::string& folder) {
  WebFiles files;
  std::error_code failed;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder, failed)) {
    if (!entry.is_regular_file(failed)) continue;
    const std::string name = "/" + fs::relative(entry.path(), folder, failed).generic_string();
    if (name == "/report.html") continue;  // the template of reports is no page
    std::ifstream file(entry.path(), std::ios::binary);
    files[name] = std::string(std::istreambuf_iterator<char>(file), {});
  }
  return files;
}

}  // namespace taut::viewer
