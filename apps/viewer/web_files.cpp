#include "web_files.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "taut/shipped.h"

namespace taut::viewer {

namespace fs = std::filesystem;

std::optional<std::string> FindWebFolder(std::string& error, const std::string& otherwise) {
  fs::path folder = otherwise;
  if (const char* named = std::getenv("TAUT_WEB"); named != nullptr && *named != '\0') {
    folder = named;
  } else if (const auto page = FindBesideProgram("web/index.html")) {
    folder = fs::path(*page).parent_path();
  }
  std::error_code failed;
  if (fs::exists(folder / "index.html", failed)) return folder.string();
  error =
      "the viewer's pages are missing (to build them: apt-get install nodejs npm, then "
      "script/build)";
  return std::nullopt;
}

WebFiles ReadWebFiles(const std::string& folder) {
  WebFiles files;
  std::error_code failed;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder, failed)) {
    if (!entry.is_regular_file(failed)) continue;
    const std::string name = "/" + fs::relative(entry.path(), folder, failed).generic_string();
    if (name == "/report.html") continue;  // template of reports, not served
    std::ifstream file(entry.path(), std::ios::binary);
    files[name] = std::string(std::istreambuf_iterator<char>(file), {});
  }
  return files;
}

}  // namespace taut::viewer
