// Entry point of the `taut` command.
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

#include "command_text.h"
#include "commands.h"
#include "streams.h"
#include "taut/version.h"
#include "usage.h"

namespace taut::cli {
namespace {

const std::string kVersionText = std::string("taut ") + kVersion;

/// Sets options of all commands and subcommands: `--version` everywhere (listed in the help text of
/// `taut` only), and no value for flags that take none (CLI11 reads `--csv=3` as yes).
void SetUpCommands(CLI::App& app) {
  for (CLI::App* command : app.get_subcommands([](CLI::App*) { return true; })) {
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
      "taut simulates tensegrity robots: describe, simulate, control, learn, compare with "
      "measurements.",
      "taut"};
  app.set_help_flag("-h,--help", "Print this and end");
  app.set_version_flag("-V,--version", kVersionText, "Print the version and end");
  app.footer(
      "Examples:\n"
      "  taut check models/tetraspine3.yaml\n"
      "  taut run experiments/push_20n.yaml --csv\n"
      "  taut compare simulated.h5 measured.csv\n"
      "  taut view experiments/push_20n.yaml\n"
      "`taut help COMMAND` tells more.\n"
      "Exit status: 0 good, 1 failed, 2 bad usage, 3 bad input, 130 interrupted.");
  int exit_code = kOk;
  AddAnalyze(app, exit_code);
  AddCheck(app, exit_code);
  AddRun(app, exit_code);
  AddCompare(app, exit_code);
  AddExport(app, exit_code);
  AddFit(app, exit_code);
  AddGait(app, exit_code);
  AddImport(app, exit_code);
  AddLearn(app, exit_code);
  AddList(app, exit_code);
  AddNew(app, exit_code);
  AddReport(app, exit_code);
  AddRobot(app, exit_code);
  AddSchema(app, exit_code);
  AddSize(app, exit_code);
  AddTrace(app, exit_code);
  AddView(app, exit_code);
  AddHelp(app, exit_code);
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
    fmt::print("{}\n", kVersionText);
  } catch (const CLI::ParseError& error) {
    return ExplainUsage(app, error);
  }
  return exit_code;
}

/// Runs the command and reports exceptions that no command handles.
int RunGuarded(int argc, char** argv) {
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

}  // namespace
}  // namespace taut::cli

int main(int argc, char** argv) { return taut::cli::RunGuarded(argc, argv); }
