#include <fmt/format.h>

#include "commands.h"
#include "taut/version.h"

int main(int argc, char** argv) {
  using namespace taut::cli;
  CLI::App app{"Tensegrity robots: describe, simulate, control, compare with measurements.",
               "taut"};
  app.set_version_flag("--version", std::string("taut ") + taut::kVersion);
  app.require_subcommand(1);
  app.footer(
      "Examples:\n"
      "  taut check models/tetraspine3.yaml\n"
      "  taut run experiments/push_20n.yaml --csv\n"
      "  taut compare simulated.h5 measured.csv\n"
      "`taut COMMAND --help` tells more.\n"
      "Exit status: 0 good, 1 failed, 2 bad usage, 3 bad input, 130 interrupted.");
  int exit_code = kOk;
  AddCheck(app, exit_code);
  AddRun(app, exit_code);
  AddCompare(app, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::RequiredError& error) {
    // CLI11 does not say which word it did not know.
    if (argc > 1 && argv[1][0] != '-' && app.get_subcommands().empty()) {
      fmt::print(stderr, "error: there is no command \"{}\"; one of: check, run, compare\n",
                 argv[1]);
      return kUsage;
    }
    return app.exit(error) == 0 ? kOk : kUsage;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kOk : kUsage;
  }
  return exit_code;
}
