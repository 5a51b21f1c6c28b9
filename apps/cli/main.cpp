#include <cxxabi.h>
#include <fmt/format.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>
#include <typeinfo>

#include "commands.h"
#include "streams.h"
#include "taut/version.h"

namespace taut::cli {
namespace {

/// Help that was asked for, or what is wrong with the command line.
int Explain(const CLI::App& app, const CLI::ParseError& error) {
  std::ostringstream output, errors;
  const int exit_code = app.exit(error, output, errors);
  fmt::print("{}", output.str());
  fmt::print(stderr, "{}", errors.str());
  return exit_code == 0 ? kOk : kUsage;
}

/// Of all commands, for a line of text.
std::string NamesOfCommands(CLI::App& app) {
  std::string names;
  for (const CLI::App* command : app.get_subcommands([](CLI::App*) { return true; })) {
    names += (names.empty() ? "" : ", ") + command->get_name();
  }
  return names;
}

/// Where nothing may be thrown, as while an object goes or in a thread, missing memory ends the
/// program at once. What it had written is as after a kill: complete or declared unfinished.
[[noreturn]] void EndAtOnce() {
  const std::type_info* const thrown = abi::__cxa_current_exception_type();
  if (thrown == nullptr || *thrown != typeid(std::bad_alloc)) std::abort();
  constexpr std::string_view kSaid = "error: not enough memory\n";
  [[maybe_unused]] const auto ignored = write(STDERR_FILENO, kSaid.data(), kSaid.size());
  _exit(kFailed);
}

int Run(int argc, char** argv) {
  CLI::App app{"Tensegrity robots: describe, simulate, control, compare with measurements.",
               "taut"};
  app.set_version_flag("--version", std::string("taut ") + taut::kVersion);
  app.require_subcommand(1);
  app.footer(
      "Examples:\n"
      "  taut check models/tetraspine3.yaml\n"
      "  taut run experiments/push_20n.yaml --csv\n"
      "  taut compare simulated.h5 measured.csv\n"
      "  taut view experiments/push_20n.yaml\n"
      "`taut COMMAND --help` tells more.\n"
      "Exit status: 0 good, 1 failed, 2 bad usage, 3 bad input, 130 interrupted.");
  int exit_code = kOk;
  AddCheck(app, exit_code);
  AddRun(app, exit_code);
  AddCompare(app, exit_code);
  AddGait(app, exit_code);
  AddLearn(app, exit_code);
  AddReport(app, exit_code);
  AddSchema(app, exit_code);
  AddView(app, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::RequiredError& error) {
    // CLI11 does not say which word it did not know.
    if (argc > 1 && argv[1][0] != '-' && app.get_subcommands().empty()) {
      fmt::print(stderr, "error: there is no command \"{}\"; one of: {}\n", argv[1],
                 NamesOfCommands(app));
      return kUsage;
    }
    return Explain(app, error);
  } catch (const CLI::ParseError& error) {
    return Explain(app, error);
  }
  return exit_code;
}

/// Runs, and says what went wrong where no command could.
int RunGuarded(int argc, char** argv) {
  GuardStreams();
  std::set_terminate(EndAtOnce);
  // A file that reaches a limit of its size is an error of writing, not the end of the program.
  std::signal(SIGXFSZ, SIG_IGN);
  try {
    return FinishOutput(Run(argc, argv));
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "error: not enough memory\n");
  } catch (const std::system_error& error) {  // threads cannot start
    fmt::print(stderr, "error: {}\n", error.what());
  }
  return kFailed;
}

}  // namespace
}  // namespace taut::cli

int main(int argc, char** argv) { return taut::cli::RunGuarded(argc, argv); }
