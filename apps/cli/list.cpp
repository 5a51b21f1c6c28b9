// Command `taut list`: models, experiments and other files that come with taut.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "commands.h"
#include "output.h"
#include "overrides.h"
#include "shipped_inputs.h"

namespace taut::cli {
namespace {

struct ListArguments {
  std::string kind;
  bool json = false;
};

void PrintLines(const std::vector<ShippedFile>& files) {
  std::size_t width = 0;
  for (const ShippedFile& file : files) width = std::max(width, file.head.name.size());
  std::string kind;
  for (const ShippedFile& file : files) {
    if (file.kind != kind) {
      fmt::print("{}{}, in {}\n", kind.empty() ? "" : "\n", file.kind, *ShippedFolderOf(file.kind));
    }
    kind = file.kind;
    fmt::print("  {:<{}}  {}\n", file.head.name, width, file.head.description);
  }
}

/// Returns the usual command for a shipped file.
std::vector<std::string> NextOf(const ShippedFile& file) {
  const std::string name = file.kind + "/" + std::filesystem::path(file.path).filename().string();
  if (file.kind == "models") return {"view", name};
  if (file.kind == "experiments") return {"run", name};
  if (file.kind == "studies") return {"learn", name};
  if (file.kind == "fits") return {"fit", name};
  return {"check", name};
}

int List(const ListArguments& args) {
  Diagnostics found;
  std::vector<ShippedFile> files;
  for (const std::string& kind : ShippedKinds()) {
    if (!args.kind.empty() && kind != args.kind) continue;
    for (ShippedFile& file : ShippedFiles(kind, found)) files.push_back(std::move(file));
  }
  if (!found.ok()) return Fail(found, kBadInput);
  if (files.empty()) {
    fmt::print(stderr,
               "error: the shipped files are missing (cmake --install installs them in share/taut, "
               "next to the folder of the command)\n");
    return kFailed;
  }
  if (!args.json) {
    PrintLines(files);
    SayNext(NextOf(files.front()));
    return kOk;
  }
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const ShippedFile& file : files) {
    list.push_back({{"kind", file.head.kind},
                    {"name", file.head.name},
                    {"description", file.head.description},
                    {"path", file.path}});
  }
  fmt::print("{}\n", list.dump(2));
  return kOk;
}

}  // namespace

void AddList(CLI::App& app, int& exit_code) {
  auto args = std::make_shared<ListArguments>();
  CLI::App* list =
      app.add_subcommand("list", "List the shipped models, experiments, gaits, studies and fits.");
  list->add_option("kind", args->kind, "models, experiments, gaits, studies or fits (default: all)")
      ->option_text(Alternatives(ShippedKinds()))
      ->check(OneOf(ShippedKinds()));
  list->add_flag("--json", args->json, "JSON instead of text");
  list->footer(
      "Examples:\n"
      "  taut list\n"
      "  taut list models\n"
      "  taut list experiments --json\n"
      "`taut new` writes a template for a new file.");
  list->callback([args, &exit_code] { exit_code = List(*args); });
}

}  // namespace taut::cli
