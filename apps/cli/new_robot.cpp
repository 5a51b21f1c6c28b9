#include "new_robot.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>

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

/// Folder that appears under its name only when all of its files are written, so that an
/// interrupted command can be repeated. Removed by the destructor if it was not published.
class NewFolder {
 public:
  explicit NewFolder(fs::path path) : path_(std::move(path)) {
    made_at_ = path_.string() + "." + std::to_string(getpid()) + ".part";
  }
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;
  ~NewFolder() {
    std::error_code ignored;
    if (created_) fs::remove_all(made_at_, ignored);
  }

  bool Create(std::error_code& failed) {
    created_ = fs::create_directory(made_at_, failed);
    if (!created_ && !failed) failed = std::make_error_code(std::errc::file_exists);
    return created_;
  }
  const fs::path& made_at() const { return made_at_; }

  /// Replaces at most an empty folder; fails if the name was taken meanwhile.
  bool Publish(std::error_code& failed) {
    fs::rename(made_at_, path_, failed);
    created_ = created_ && failed;
    return !failed;
  }

 private:
  fs::path path_, made_at_;
  bool created_ = false;
};

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
  OutputIsNews();
  NewFolder made(folder);
  bool created = made.Create(failed);
  for (auto it = files.begin(); created && it != files.end(); ++it) {
    const auto& [file, text] = *it;
    const std::string filled = Replaced(Replaced(text, kName, name), kSchemas, *schemas + "/");
    const int written = WriteNamed((made.made_at() / file).string(), filled);
    if (written != kOk) return written;
  }
  created = created && made.Publish(failed);
  if (!created) {
    fmt::print(stderr, "{}: error: cannot create the folder: {}\n", name, failed.message());
    return kFailed;
  }
  fmt::print("{}: a robot like {}\n", name, like);
  for (const auto& [file, text] : files) fmt::print("  {}\n", (folder / file).string());
  SayNext({"view", name});
  return kOk;
}

}  // namespace taut::cli
