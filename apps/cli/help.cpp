// Command `taut help`: help texts, manual page and shell completions.
#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "command_text.h"
#include "commands.h"
#include "manual.h"
#include "overrides.h"
#include "usage.h"

namespace taut::cli {
namespace {

struct HelpArguments {
  std::vector<std::string> words;
  bool man = false;
  std::string shell;
};

int Help(const CLI::App& app, const HelpArguments& args) {
  if (args.man || !args.shell.empty()) {
    const CommandText taut = Describe(app);
    fmt::print("{}", args.man ? ManPage(taut) : *Completion(taut, args.shell));
    return kOk;
  }
  const CLI::App* command = &app;
  for (const std::string& word : args.words) {
    const auto named =
        command->get_subcommands([&](const CLI::App* one) { return one->get_name() == word; });
    if (named.empty()) return NoSuchCommand(*command, word);
    command = named.front();
  }
  fmt::print("{}", HelpText(Describe(*command)));
  return kOk;
}

}  // namespace

void AddHelp(CLI::App& app, int& exit_code) {
  auto args = std::make_shared<HelpArguments>();
  CLI::App* help = app.add_subcommand("help", "Print the help of taut or of a command.");
  std::vector<std::string> commands;
  for (const CommandText& one : Describe(app).commands) commands.push_back(one.Word());
  help->add_option("command", args->words, "Command to describe (default: taut itself)")
      ->option_text(Alternatives(commands));
  auto* man = help->add_flag("--man", args->man, "Complete help as a manual page");
  help->add_option("--completion", args->shell,
                   "Completion script of commands, flags and files for a shell")
      ->option_text(Alternatives(Shells()))
      ->check(OneOf(Shells()))
      ->excludes(man);
  help->footer(
      "Examples:\n"
      "  taut help run\n"
      "  taut help gait export\n"
      "  taut help --man | man -l -\n"
      "  source <(taut help --completion bash)");
  help->callback([&app, args, &exit_code] { exit_code = Help(app, *args); });
}

}  // namespace taut::cli
