// The `taut` command: its subcommands, help, and exceptions that none of them handles.
#include "command_main.h"

#include <cxxabi.h>
#include <fmt/format.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <string>
#include <string_view>
#include <system_error>
#include <typeinfo>
#include <vector>

#include "command_text.h"
#include "commands.h"
#include "features.h"
#include "standard_streams.h"
#include "taut/version.h"
#include "usage.h"

namespace taut::cli {
namespace {

const std::string kVersionText = std::string("taut ") + kVersion;

struct CommandGroup {
  const char* title;
  std::vector<void (*)(CLI::App& app, int& exit_code)> commands;
};

/// Commands in the order of the help texts; the first group contains a beginner's first steps.
const std::vector<CommandGroup> kGroups{
    {"First steps", {AddNew, AddCheck, AddView, AddRun, AddReport}},
    {"Analysis and optimization", {AddCompare, AddPlot, AddFit, AddAnalyze, AddLearn, AddSize}},
    {"Files and other programs", {AddList, AddGait, AddExport, AddImport, AddTrace, AddSchema}},
    {"Hardware and help", {AddRobot, AddHelp}}};

std::vector<CLI::App*> AllSubcommands(CLI::App& app) {
  return app.get_subcommands([](CLI::App*) { return true; });
}

void AddCommands(CLI::App& app, int& exit_code) {
  for (const CommandGroup& group : kGroups) {
    for (const auto add : group.commands) {
      add(app, exit_code);
      AllSubcommands(app).back()->group(group.title);
    }
  }
}

/// Sets options of all commands and subcommands: `--version` everywhere (listed in the help text of
/// `taut` only), and no value for flags that take none (CLI11 reads `--csv=3` as yes).
void SetUpCommands(CLI::App& app) {
  for (CLI::App* command : AllSubcommands(app)) {
    if (app.get_parent() != nullptr) command->group("Commands");
    command->set_version_flag("-V,--version", kVersionText)->group("");
    for (CLI::Option* option : command->get_options()) {
      if (option->get_expected_max() == 0) option->disable_flag_override();
    }
    SetUpCommands(*command);
  }
}

/// Terminates the program when memory runs out where exceptions are not allowed, as in destructors
/// and threads. Its output files are then as after a kill: complete, or marked as unfinished.
[[noreturn]] void EndAtOnce() {
  const std::type_info* const thrown = abi::__cxa_current_exception_type();
  if (thrown == nullptr || *thrown != typeid(std::bad_alloc)) std::abort();
  constexpr std::string_view kSaid = "error: not enough memory\n";
  [[maybe_unused]] const auto ignored = write(STDERR_FILENO, kSaid.data(), kSaid.size());
  _exit(kFailed);
}

int Run(int argc, char** argv) {
  CLI::App app{
      "taut simulates tensegrity robots: check, view and run models; compare, fit, analyze and "
      "learn.",
      "taut"};
  app.set_help_flag("-h,--help", "Print this help and exit");
  app.set_version_flag("-V,--version", kVersionText, "Print the version and exit");
  const CLI::Option* const features = app.add_flag_callback(
      "--features", [] { throw CLI::CallForVersion(); },
      "Print the version and the features of this build, and exit");
  app.footer(
      "Examples:\n"
      "  taut new model my_robot\n"
      "  taut check my_robot.yaml\n"
      "  taut view my_robot.yaml\n"
      "  taut run experiments/push_20n.yaml\n"
      "  taut report runs/push_20n\n"
      "Help on a command: `taut help COMMAND`\n"
      "Exit status: 0 success, 1 failure, 2 bad usage, 3 bad input, 130 interrupted.");
  int exit_code = kOk;
  AddCommands(app, exit_code);
  SetUpCommands(app);
  if (argc <= 1) {
    fmt::print("{}", OverviewText(Describe(app)));
    return kOk;
  }
  app.require_subcommand(1);
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    fmt::print("{}", HelpText(Describe(NamedCommand(app))));
  } catch (const CLI::CallForVersion&) {
    fmt::print("{}\n{}", kVersionText, features->count() > 0 ? FeaturesText() : "");
  } catch (const CLI::ParseError& error) {
    return ExplainUsage(app, error);
  }
  return exit_code;
}

}  // namespace

int Main(int argc, char** argv) {
  GuardStreams();
  std::set_terminate(EndAtOnce);
  // Exceeding the file size limit becomes a write error instead of the end of the program.
  std::signal(SIGXFSZ, SIG_IGN);
  try {
    return FinishOutput(Run(argc, argv));
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "error: not enough memory\n");
  } catch (const std::system_error& error) {  // no thread can be started
    fmt::print(stderr, "error: {}\n", error.what());
  }
  return kFailed;
}

}  // namespace taut::cli
