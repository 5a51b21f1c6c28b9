// The command line for new users: overview, help, errors for misspelled words, shipped files to
// start from
#include <nlohmann/json.hpp>

#include <map>
#include <sstream>

#include "system/taut_command.h"
#include "taut/version.h"

namespace taut {
namespace {

const char* const kHangOnTheLine = TAUT_SOURCE_DIR "/share/experiments/hang.yaml";

class CliCommand : public test::CommandTest {
 protected:
  std::vector<std::vector<std::string>> Commands() const {
    return {{"new"},
            {"check"},
            {"view"},
            {"run"},
            {"report"},
            {"compare"},
            {"plot"},
            {"fit"},
            {"analyze"},
            {"learn"},
            {"size"},
            {"list"},
            {"gait"},
            {"gait", "export"},
            {"gait", "import"},
            {"gait", "create"},
            {"gait", "values"},
            {"export"},
            {"export", "mjcf"},
            {"export", "shape"},
            {"export", "structure"},
            {"import"},
            {"import", "mjcf"},
            {"import", "ntrt"},
            {"trace"},
            {"trace", "convert"},
            {"schema"},
            {"robot"},
            {"robot", "scan"},
            {"robot", "status"},
            {"robot", "run"},
            {"robot", "log"},
            {"robot", "calibrate"},
            {"robot", "calibrate", "load_cell"},
            {"robot", "calibrate", "encoder"},
            {"robot", "reference"},
            {"robot", "hold"},
            {"robot", "release"},
            {"robot", "set"},
            {"robot", "flash"},
            {"robot", "selftest"},
            {"robot", "estop"},
            {"help"}};
  }
};

TEST_F(CliCommand, AloneItSaysWhatThereIs) {
  const test::CommandResult alone = Taut({});
  EXPECT_EQ(alone.status, 0);
  EXPECT_EQ(alone.errors, "");
  EXPECT_EQ(alone.output.rfind("taut simulates tensegrity robots", 0), 0u) << alone.output;
  std::size_t before = alone.output.find("\n\nFirst steps:\n");
  ASSERT_NE(before, std::string::npos) << alone.output;
  for (const auto& command : Commands()) {
    if (command.size() > 1) continue;
    const std::size_t at = alone.output.find("\n  " + command[0] + " ");
    ASSERT_NE(at, std::string::npos) << command[0];
    EXPECT_GT(at, before) << command[0] << " is too early in\n" << alone.output;
    before = at;
  }
  EXPECT_LE(std::count(alone.output.begin(), alone.output.end(), '\n'), 32);
}

TEST_F(CliCommand, HelpListsTheSameGroups) {
  const std::string help = Taut({"--help"}).output;
  for (const char* const group : {"First steps", "Analysis and optimization",
                                  "Files and other programs", "Hardware and help"}) {
    EXPECT_NE(help.find(std::string("\n\n") + group + ":\n  "), std::string::npos) << help;
  }
  EXPECT_NE(Taut({"gait", "--help"}).output.find("\n\nCommands:\n  export "), std::string::npos);
}

TEST_F(CliCommand, EveryCommandHasAnExample) {
  for (std::vector<std::string> command : Commands()) {
    std::string example = "\nExamples:\n  taut";
    for (const std::string& word : command) example += command[0] == "help" ? "" : " " + word;
    command.push_back("--help");
    const std::string text = Taut(command).output;
    EXPECT_NE(text.find(example), std::string::npos) << example << " is not in\n" << text;
  }
}

TEST_F(CliCommand, WordsOfOtherProgramsNameTheCommand) {
  for (const auto& [word, command] :
       std::vector<std::pair<std::string, std::string>>{{"init", "new"},
                                                        {"simulate", "run"},
                                                        {"validate", "check"},
                                                        {"train", "learn"},
                                                        {"identify", "fit"},
                                                        {"tune", "learn"},
                                                        {"convert", "trace convert"}}) {
    const std::string refusal =
        "error: there is no command \"" + word + "\" (did you mean \"" + command + "\"?)";
    EXPECT_EQ(Refusal({word, "a.yaml", "--out", "b"}), refusal);
    EXPECT_EQ(Refusal({"help", word}), refusal);
  }
  EXPECT_EQ(Refusal({"gait", "train"}).find("learn"), std::string::npos);
}

TEST_F(CliCommand, TheLastLineIsTheNextCommand) {
  Taut({"new", "model", "mine"});
  const auto last_line = [](const std::string& text) {
    return text.substr(text.rfind('\n', text.size() - 2) + 1);
  };
  EXPECT_EQ(last_line(Taut({"new", "experiment", "trial", "--model", "mine.yaml"}).output),
            "next: taut view trial.yaml\n");
  EXPECT_EQ(last_line(Taut({"new", "study", "search"}).output), "next: taut learn search.yaml\n");
  EXPECT_EQ(last_line(Taut({"check", "mine.yaml", "--settled"}).output),
            "next: taut view mine.yaml --settled\n");
  EXPECT_EQ(last_line(Taut({"check", "trial.yaml", "--set", "radius_m=0.12"}).output),
            "next: taut run trial.yaml --set radius_m=0.12\n");
  EXPECT_EQ(last_line(Taut({"run", "trial.yaml", "--duration_s", "0.1", "--out", "my run"}).output),
            "next: taut view 'my run'\n");
  for (const char* const command : {"check", "run"}) {
    EXPECT_EQ(Taut({command, "trial.yaml", "--quiet"}).output, "");
    EXPECT_EQ(Taut({command, "trial.yaml", "--json"}).output.find("next:"), std::string::npos);
  }
}

TEST_F(CliCommand, HelpOfACommandIsItsHelpFlag) {
  for (std::vector<std::string> command : Commands()) {
    std::vector<std::string> help = command;
    help.insert(help.begin(), "help");
    command.push_back("--help");
    const test::CommandResult by_command = Taut(help), by_flag = Taut(command);
    EXPECT_EQ(by_command.status, 0) << by_command.errors;
    EXPECT_NE(by_flag.output, "");
    EXPECT_EQ(by_command.output, by_flag.output);
  }
  EXPECT_EQ(Taut({"help"}).output, Taut({"-h"}).output);
  EXPECT_EQ(Refusal({"help", "chek"}),
            "error: there is no command \"chek\" (did you mean \"check\"?)");
}

TEST_F(CliCommand, HelpShowsNothingOfTheParser) {
  for (std::vector<std::string> command : Commands()) {
    command.push_back("--help");
    const std::string text = Taut(command).output;
    for (const char* const inside : {"ENUM", "TEXT", "FLOAT", "INT", "->", "REQUIRED", " VALUE ",
                                     "Excludes", "Needs", "POSITIONAL"}) {
      EXPECT_EQ(text.find(inside), std::string::npos) << inside << " in\n" << text;
    }
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100u) << line;
  }
}

TEST_F(CliCommand, TheVersionIsToldEverywhere) {
  const std::string version = std::string("taut ") + kVersion + "\n";
  for (std::vector<std::string> command : Commands()) {
    command.push_back("--version");
    EXPECT_EQ(Taut(command).output, version);
  }
  for (const char* const flag : {"-V", "--version"}) EXPECT_EQ(Taut({flag}).output, version);
  EXPECT_EQ(Taut({"gait", "export", "-V"}).output, version);
}

TEST_F(CliCommand, TheFeaturesOfTheBuildFollowTheVersion) {
  std::map<std::string, std::string> found;
  const std::string text = Taut({"--version", "--features"}).output;
  EXPECT_EQ(Taut({"--features"}).output, text);
  std::istringstream lines(text);
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, std::string("taut ") + kVersion);
  while (std::getline(lines, line)) {
    const std::size_t colon = line.find(": ");
    ASSERT_NE(colon, std::string::npos) << line;
    const std::string value = line.substr(colon + 2);
    EXPECT_TRUE(value.starts_with("yes") || value.starts_with("no (")) << line;
    found[line.substr(0, colon)] = value;
  }
  EXPECT_EQ(found.size(), 10u) << text;
  // From CMake, independent of the compile definitions of the command
  EXPECT_EQ(found["MPI"] == "yes", TAUT_MPI_FOUND != 0) << text;
  const std::string sets = TAUT_SETS;
  for (const char* const set : {"scalar", "sse2", "avx2", "avx512", "neon"}) {
    const bool built = ("," + sets + ",").find("," + std::string(set) + ",") != std::string::npos;
    EXPECT_EQ(found["instruction set " + std::string(set)].starts_with("yes"), built) << text;
  }
  EXPECT_EQ(found["instruction set scalar"], "yes") << "every processor has it";
#ifdef TAUT_ASSERTS
  EXPECT_EQ(found["assertions"], "yes");
#else
  EXPECT_TRUE(found["assertions"].starts_with("no")) << text;
#endif
}

TEST_F(CliCommand, TheFeaturesContainThePagesOnlyIfTheyAreThere) {
  const std::string empty = Path("no_pages");
  std::filesystem::create_directory(empty);
  setenv("TAUT_WEB", empty.c_str(), 1);
  const std::string without = Taut({"--features"}).output;
  std::ofstream(empty + "/index.html") << "<html></html>";
  const std::string with = Taut({"--features"}).output;
  unsetenv("TAUT_WEB");
  EXPECT_NE(without.find("\nviewer's pages: no (install nodejs and npm"), std::string::npos)
      << without;
  EXPECT_NE(with.find("\nviewer's pages: yes\n"), std::string::npos) << with;
}

TEST_F(CliCommand, AMisspeltWordIsAnsweredByTheRightOne) {
  EXPECT_EQ(Refusal({"chek", "a.yaml"}),
            "error: there is no command \"chek\" (did you mean \"check\"?)");
  EXPECT_EQ(Refusal({"gait", "exprot"}),
            "error: there is no command \"gait exprot\" (did you mean \"export\"?)");
  EXPECT_EQ(Refusal({"gait"}),
            "error: taut gait needs a command: export, import, create or values");
  EXPECT_EQ(Refusal({"run", kHangOnTheLine, "--duration", "1"}),
            "error: taut run has no flag \"--duration\" (did you mean \"--duration_s\"?)");
  EXPECT_EQ(Refusal({"run", "--duration=1", kHangOnTheLine}),
            "error: taut run has no flag \"--duration\" (did you mean \"--duration_s\"?)");
  EXPECT_EQ(Refusal({"run", "--sep_s", "0.1", kHangOnTheLine}),
            "error: taut run has no flag \"--sep_s\" (did you mean \"--step_s\"?)");
  EXPECT_EQ(Refusal({"run", kHangOnTheLine, "--re"}),
            "error: taut run has no flag \"--re\" (did you mean \"--replay\" or \"--report\"?)");
  EXPECT_EQ(Refusal({"run", kHangOnTheLine, "-q"}),
            "error: taut run has no flag \"-q\" (did you mean \"--quiet\"?)");
  EXPECT_EQ(Refusal({"check", "--quite"}),
            "error: taut check has no flag \"--quite\" (did you mean \"--quiet\"?)");
  EXPECT_EQ(Refusal({"compare", "a.h5", "b.h5", "--max-rmse", "1"}),
            "error: taut compare has no flag \"--max-rmse\" (did you mean \"--max_rmse\"?)");
  EXPECT_EQ(Refusal({"run", kHangOnTheLine, "--xyzzy"}), "error: taut run has no flag \"--xyzzy\"");
  EXPECT_EQ(Refusal({"schema", "modl"}),
            "error: format: \"modl\" is unknown (did you mean \"model\"?)");
  EXPECT_EQ(Refusal({"gait", "create", "a.yaml", "--symmetry", "segment"}),
            "error: --symmetry: \"segment\" is unknown (did you mean \"segments\"?)");
}

// Names of files may contain commands to a terminal, and a shell turns patterns into arguments.
TEST_F(CliCommand, ControlCharactersOfArgumentsArePrintedAsNumbers) {
  EXPECT_EQ(Refusal({"a\x1b[2J.yaml"}).rfind("error: there is no command \"a\\x1b[2J.yaml\"", 0),
            0u);
  EXPECT_EQ(Refusal({"run", kHangOnTheLine, "--\x1b[2J"}),
            "error: taut run has no flag \"--\\x1b[2J\"");
  EXPECT_EQ(Refusal({"check", "a.yaml", "b\x1b.yaml"}),
            "error: unexpected argument \"b\\x1b.yaml\"; usage: taut check [FLAGS] FILE");
  EXPECT_EQ(Refusal({"new", "model", "a\x1b"}),
            "error: NAME: \"a\\x1b\" is not a valid name (expected letters, digits, _ or -)");
  EXPECT_EQ(Taut({"run", kHangOnTheLine, "--set", "\x1b"}).errors,
            "error: --set \\x1b: expected name=value, such as --set push_n=15\n");
}

TEST_F(CliCommand, WhatIsMissingOrTooMuchIsNamed) {
  EXPECT_EQ(Refusal({"check"}),
            "error: FILE is missing (Model, experiment, gait, study or fit file (YAML)); usage: "
            "taut check "
            "[FLAGS] FILE");
  EXPECT_EQ(
      Refusal({"compare", "a.h5"}),
      "error: B is missing (Reference: trace or folder of a run); usage: taut compare [FLAGS] A B");
  EXPECT_EQ(Refusal({"check", "a.yaml", "b.yaml"}),
            "error: unexpected argument \"b.yaml\"; usage: taut check [FLAGS] FILE");
  EXPECT_EQ(Refusal({"view", "a.h5", "b.h5"}),
            "error: unexpected argument \"b.h5\"; usage: taut view [FLAGS] [FILE] (to compare: "
            "--compare b.h5)");
  EXPECT_EQ(Refusal({"run", kHangOnTheLine, "--out"}), "error: --out needs a value: --out FOLDER");
  EXPECT_EQ(Refusal({"run", kHangOnTheLine, "--csv=3"}), "error: --csv takes no value");
  EXPECT_EQ(Refusal({"run", kHangOnTheLine, "--out", "a", "--out", "b"}),
            "error: --out was given more than once");
  EXPECT_EQ(Refusal({"run", kHangOnTheLine, "--seed", "-1"}),
            "error: --seed: \"-1\" is not a whole number from 0 to 18446744073709551615");
}

TEST_F(CliCommand, ListNamesWhatComesAlong) {
  EXPECT_NE(Taut({"list", "models"}).output.find("\n  tetraspine3 "), std::string::npos);
  const test::CommandResult all = Taut({"list"});
  EXPECT_NE(all.output.find("\nnext: taut view models/"), std::string::npos) << all.output;
  EXPECT_EQ(all.status, 0) << all.errors;
  for (const char* const part :
       {"models, in " TAUT_SOURCE_DIR "/share/models\n", "\n  tetraspine3 ", "\n  push_20n ",
        "A mass on a cable is tapped", "studies, in " TAUT_SOURCE_DIR "/share/studies\n",
        "fits, in " TAUT_SOURCE_DIR "/share/fits\n"}) {
    EXPECT_NE(all.output.find(part), std::string::npos) << part << " is not in\n" << all.output;
  }
  std::size_t count = 0;
  for (const char* const kind : {"models", "experiments", "gaits", "studies", "fits"}) {
    const auto json = nlohmann::json::parse(Taut({"list", kind, "--json"}).output);
    for (const auto& file : json) {
      EXPECT_EQ(file["kind"].get<std::string>()[0], kind[0]);
      EXPECT_NE(file["description"], "") << file;  // every shipped file has a description
      EXPECT_TRUE(std::filesystem::exists(file["path"].get<std::string>())) << file;
    }
    EXPECT_GE(json.size(), kind == std::string("fits") ? 1u : 2u);
    count += json.size();
  }
  EXPECT_EQ(nlohmann::json::parse(Taut({"list", "--json"}).output).size(), count);
}

TEST_F(CliCommand, RunPrintsItsSummaryAsJson) {
  const test::CommandResult run = Taut({"run", kHangOnTheLine, "--json", "--report_never"});
  EXPECT_EQ(run.status, 2);
  const test::CommandResult good = Taut({"run", kHangOnTheLine, "--json", "--out", "here"});
  EXPECT_EQ(good.status, 0) << good.errors;
  EXPECT_EQ(good.output, Read(Path("here/summary.json")));
  EXPECT_EQ(nlohmann::json::parse(good.output)["experiment"], "hang");
}

/// Bash's completions of the last of these words
class Completion : public CliCommand {
 protected:
  std::string Offered(const std::string& words) {
    Write("taut.bash", Taut({"help", "--completion", "bash"}).output +
                           "COMP_WORDS=(\"$@\") COMP_CWORD=$(($# - 1))\n_taut\n"
                           "echo \"${COMPREPLY[*]}\"\n");
    const std::string command =
        "cd '" + folder_.string() + "' && bash taut.bash " + words + " >offered 2>&1";
    EXPECT_EQ(std::system(command.c_str()), 0);
    return Read(Path("offered"));
  }
};

TEST_F(Completion, BashKnowsCommandsFlagsChoicesAndFiles) {
  Write("robot.yaml", "");
  std::filesystem::create_directory(Path("robots"));
  EXPECT_EQ(Offered("taut re"), "report\n");
  EXPECT_EQ(Offered("taut gait ''"), "export import create values\n");
  EXPECT_EQ(Offered("taut run --st"), "--step_s --strict\n");
  EXPECT_EQ(Offered("taut gait create a.yaml --symmetry s"), "segments\n");
  EXPECT_EQ(Offered("taut schema m"), "model\n");
  EXPECT_EQ(Offered("taut check robot."), "robot.yaml\n");
  EXPECT_EQ(Offered("taut run a.yaml --out rob"), "robots\n");
  EXPECT_EQ(Offered("taut run a.yaml --step_s ''"), "\n");  // no suggestions for numbers
}

TEST_F(Completion, EveryShellAndTheManualKnowEveryFlag) {
  std::vector<std::string> texts{Taut({"help", "--man"}).output};
  for (const char* const shell : {"bash", "zsh", "fish"}) {
    texts.push_back(Taut({"help", "--completion", shell}).output);
  }
  for (std::vector<std::string> command : Commands()) {
    command.push_back("--help");
    std::istringstream lines(Taut(command).output);
    for (std::string line; std::getline(lines, line);) {
      if (line.rfind("  --", 0) != 0) continue;
      const std::string flag = line.substr(4, line.find(' ', 4) - 4);
      for (const std::string& text : texts) {
        EXPECT_NE(text.find(flag), std::string::npos) << flag << " is not in\n" << text;
      }
    }
  }
  EXPECT_EQ(texts[0].rfind(".\\\" Made by `taut help --man`.\n.TH TAUT 1 ", 0), 0u);
}

}  // namespace
}  // namespace taut
