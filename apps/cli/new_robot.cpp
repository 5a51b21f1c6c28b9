#include "new_robot.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string_view>

#include "commands.h"
#include "output.h"
#include "shipped_inputs.h"
#include "standard_streams.h"

namespace taut::cli {
namespace {

namespace fs = std::filesystem;

/// Texts of a template that depend on the new robot: its name, and the folder of the schemas.
constexpr std::string_view kName = "my_robot", kSchemas = "../../schema/";

std::string Replaced(std::string text, std::string_view from, const std::string& to) {
  for (std::size_t at = text.find(from); at != text.npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

/// Reads the files of a template, by name. Empty if one cannot be read.
std::map<std::string, std::string> ReadTemplate(const fs::path& folder) {
  std::map<std::string, std::string> files;
  std::error_code failed;
  for (fs::directory_iterator it(folder, failed), end; !failed && it != end; it.increment(failed)) {
    std::ifstream file(it->path(), std::ios::binary);
    std::ostringstream text;
    if (!(text << file.rdbuf())) return {};
    files[it->path().filename().string()] = text.str();
  }
  return files;
}

}  // namespace

const std::vector<std::string>& RobotTemplates() {
  static const std::vector<std::string> names{"six_bar",   "prism", "three_bar", "spine",
                                              "quadruped", "tower", "blank"};
  return names;
}

int NewRobot(const std::string& name, const std::string& like) {
  const auto shipped = ShippedFolderOf("robots");
  const auto schemas = ShippedFolderOf("schema");
  std::map<std::string, std::string> files;
  if (shipped) files = ReadTemplate(fs::path(*shipped) / like);
  if (files.empty() || !schemas) {
    fmt::print(
        stderr,
        "error: the template \"{}\" is missing or cannot be read (taut's folder share/robots)\n",
        like);
    return kFailed;
  }
  const fs::path folder(name);
  std::error_code failed;
  if (fs::exists(fs::symlink_status(folder, failed))) {
    fmt::print(stderr, "{}: error: {} exists already, and nothing is overwritten\n", name,
               fs::is_directory(folder, failed) ? "the folder" : "a file of this name");
    for (const auto& [file, text] : files) {
      if (!fs::exists(fs::symlink_status(folder / file, failed))) continue;
      fmt::print(stderr, "{}: error: the file exists already\n", (folder / file).string());
    }
    return kBadInput;
  }
  if (!fs::create_directory(folder, failed)) {
    fmt::print(stderr, "{}: error: cannot create the folder: {}\n", name, failed.message());
    return kFailed;
  }
  OutputIsNews();
  for (const auto& [file, text] : files) {
    const std::string filled = Replaced(Replaced(text, kName, name), kSchemas, *schemas + "/");
    const int written = WriteNamed((folder / file).string(), filled);
    if (written != kOk) return written;
  }
  fmt::print("{}: a robot like {}\n", name, like);
  for (const auto& [file, text] : files) fmt::print("  {}\n", (folder / file).string());
  SayNext({"view", name});
  return kOk;
}

}  // namespace taut::cli
