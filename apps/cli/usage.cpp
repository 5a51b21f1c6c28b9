// Error messages for wrong command lines, with suggestions.
#include "usage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "command_text.h"
#include "commands.h"
#include "taut/diagnostics.h"

namespace taut::cli {
namespace {

std::string Joined(const std::vector<std::string>& words, const char* last) {
  std::string out;
  for (std::size_t i = 0; i < words.size(); ++i) {
    out += (i == 0 ? "" : i + 1 == words.size() ? last : ", ") + words[i];
  }
  return out;
}

/// Returns the flags that begin with the word, else the most similar one; empty if there is none.
std::string MeantFlags(const CommandText& command, std::string word) {
  std::vector<std::string> all, longer;
  for (const WordText& flag : command.flags) all.push_back(flag.name);
  if (word.rfind("--", 0) != 0) word = "-" + word;  // "-o" becomes "--o", the beginning of "--out"
  std::replace(word.begin() + 2, word.end(), '-', '_');
  for (const std::string& flag : all) {
    if (word.size() > 2 && flag.rfind(word, 0) == 0) longer.push_back("\"" + flag + "\"");
  }
  if (!longer.empty() && longer.size() <= 3) return Joined(longer, " or ");
  const std::string_view closest = ClosestMatch(word, all);
  return closest.empty() ? "" : "\"" + std::string(closest) + "\"";
}

bool IsFlag(const std::string& word) {
  double number = 0;
  return word.size() > 1 && word[0] == '-' && word != "--" &&
         !CLI::detail::lexical_cast(word, number);
}

/// Returns the command of taut for a name that other programs use; empty if there is none.
std::string CommandMeant(const std::string& word) {
  static const std::map<std::string, std::string> kSynonyms{{"convert", "trace convert"},
                                                            {"create", "new"},
                                                            {"diff", "compare"},
                                                            {"draw", "plot"},
                                                            {"identify", "fit"},
                                                            {"init", "new"},
                                                            {"optimize", "learn"},
                                                            {"show", "view"},
                                                            {"simulate", "run"},
                                                            {"train", "learn"},
                                                            {"tune", "learn"},
                                                            {"validate", "check"}};
  const auto found = kSynonyms.find(word);
  return found == kSynonyms.end() ? "" : found->second;
}

/// Explains an unknown flag, an unknown command or an extra argument. Returns false if the command
/// line has none of these errors.
bool ExplainUnknown(const CLI::App& app, const CommandText& command) {
  const std::vector<std::string> unknown = app.remaining();
  const auto flag = std::find_if(unknown.begin(), unknown.end(), IsFlag);
  const bool of_command = command.commands.empty() || flag == unknown.begin();
  if (flag != unknown.end() && of_command) {
    const std::string word = flag->substr(0, flag->find('='));
    const std::string meant = MeantFlags(command, word);
    fmt::print(stderr, "error: {} has no flag \"{}\"{}\n", command.name, Printable(word),
               meant.empty() ? "" : fmt::format(" (did you mean {}?)", meant));
    return true;
  }
  if (unknown.empty()) return false;
  if (!command.commands.empty()) {
    NoSuchCommand(app, unknown.front());
  } else {
    const bool compares = std::any_of(command.flags.begin(), command.flags.end(),
                                      [](const WordText& f) { return f.name == "--compare"; });
    const std::string word = Printable(unknown.front());
    fmt::print(stderr, "error: unexpected argument \"{}\"; usage: {}{}\n", word, UsageLine(command),
               compares ? fmt::format(" (to compare: --compare {})", word) : "");
  }
  return true;
}

/// Explains a missing argument. Returns false if no argument is missing.
bool ExplainMissing(const CLI::App& app, const CommandText& command) {
  if (!command.commands.empty()) {
    fmt::print(stderr, "error: {} needs a command: {}\n", command.name,
               Joined(command.CommandWords(), " or "));
    return true;
  }
  for (const CLI::Option* option : app.get_options()) {
    if (!option->get_required() || option->count() > 0) continue;
    const std::vector<WordText>& words =
        option->get_positional() ? command.arguments : command.flags;
    const auto word = std::find_if(words.begin(), words.end(), [&](const WordText& one) {
      return one.help.rfind(option->get_description(), 0) == 0;
    });
    if (word == words.end()) return false;
    fmt::print(stderr, "error: {} is missing ({}); usage: {}\n", word->name, word->help,
               UsageLine(command));
    return true;
  }
  return false;
}

/// Explains a flag without its value, with an extra value, or given twice. `said`: CLI11's message,
/// which begins with the flag, sometimes without its hyphens.
std::string Mismatch(const CommandText& command, const std::string& said) {
  const std::string name = said.substr(0, said.find_first_of(": ="));
  for (const WordText& flag : command.flags) {
    if (flag.name != name && flag.letter != name && flag.name != "--" + name) continue;
    if (flag.value.empty()) return flag.name + " takes no value";
    if (said.find("At Most") != said.npos) return flag.name + " was given more than once";
    return fmt::format("{0} needs a value: {0} {1}", flag.name, flag.value);
  }
  return said;
}

}  // namespace

const CLI::App& NamedCommand(const CLI::App& app) {
  const CLI::App* command = &app;
  while (!command->get_subcommands().empty()) command = command->get_subcommands().back();
  return *command;
}

int NoSuchCommand(const CLI::App& command, const std::string& word) {
  const CommandText text = Describe(command);
  const bool top = command.get_parent() == nullptr;
  const std::string before = top ? "" : text.name.substr(5) + " ";
  const std::string meant = top ? CommandMeant(word) : "";
  fmt::print(stderr, "error: there is no command \"{}{}\" ({})\n", before, Printable(word),
             meant.empty() ? DidYouMean(word, text.CommandWords())
                           : fmt::format("did you mean \"{}\"?", meant));
  return kUsage;
}

int ExplainUsage(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App& named = NamedCommand(app);
  const CommandText command = Describe(named);
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr) {
    fmt::print(stderr, "error: {}\n", Printable(Mismatch(command, error.what())));
  } else if (!ExplainUnknown(named, command) &&
             (dynamic_cast<const CLI::RequiredError*>(&error) == nullptr ||
              !ExplainMissing(named, command))) {
    fmt::print(stderr, "error: {}\n", Printable(error.what()));
  }
  fmt::print(stderr, "see `{} --help`\n", command.name);
  return kUsage;
}

}  // namespace taut::cli
