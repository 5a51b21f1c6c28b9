#include <fmt/format.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <new>
#include <system_error>

#include "commands.h"
#include "taut/version.h"

namespace taut::cli {
namespace {

/// What a command has printed must have arrived: a full disk is no success.
int Printed(int exit_code) {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return exit_code;
  fmt::print(stderr, "error: standard output cannot be written: {}\n", std::strerror(errno));
  return exit_code == kOk ? kFailed : exit_code;
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
  AddView(app, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::RequiredError& error) {
    // CLI11 does not say which word it did not know.
    if (argc > 1 && argv[1][0] != '-' && app.get_subcommands().empty()) {
      fmt::print(stderr,
                 "error: there is no command \"{}\"; one of: check, run, compare, gait, learn, "
                 "report, view\n",
                 argv[1]);
      return kUsage;
    }
    return app.exit(error) == 0 ? kOk : kUsage;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kOk : kUsage;
  }
  return exit_code;
}

}  // namespace
}  // namespace taut::cli

int main(int argc, char** argv) {
  using namespace taut::cli;
  // A file that reaches a limit of its size is an error of writing, not the end of the program.
  std::signal(SIGXFSZ, SIG_IGN);
  try {
    return Printed(Run(argc, argv));
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "error: not enough memory\n");
  } catch (const std::system_error& error) {  // fmt cannot print, threads cannot start
    fmt::print(stderr, "error: {}\n", error.what());
  }
  return kFailed;
}
