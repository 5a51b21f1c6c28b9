#include "command_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <sstream>

namespace taut::cli {
namespace {

constexpr std::size_t kWidth = 100, kColumn = 28;

std::string Upper(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

std::string FullName(const CLI::App& command) {
  const CLI::App* const parent = command.get_parent();
  return parent == nullptr ? command.get_name() : FullName(*parent) + " " + command.get_name();
}

WordText DescribeWord(const CLI::Option& option) {
  WordText word;
  word.help = option.get_description();
  word.needed = option.get_required();
  word.repeats = option.get_expected_max() > 1;
  word.value = option.get_option_text();
  if (option.get_positional()) {
    word.name = Upper(option.get_name(true, false));
    return word;
  }
  word.name = "--" + option.get_lnames().front();
  if (!option.get_snames().empty()) word.letter = "-" + option.get_snames().front();
  if (word.value.empty() && option.get_expected_min() > 0) word.value = "VALUE";
  if (!option.get_default_str().empty()) {
    word.help += fmt::format(" (default: {})", option.get_default_str());
  }
  if (word.repeats) word.help += " (may be repeated)";
  return word;
}

/// Formats a row of two columns; a left text that is too long gets a separate line.
std::string Row(const std::string& left, const std::string& right) {
  const std::string begin = "  " + left;
  const std::string text = Wrapped(right, kColumn, kWidth - kColumn) + "\n";
  if (begin.size() + 2 > kColumn) return begin + "\n" + std::string(kColumn, ' ') + text;
  return begin + std::string(kColumn - begin.size(), ' ') + text;
}

/// Lists the subcommands below the headings of their groups.
std::string CommandRows(const CommandText& command) {
  std::string rows, group;
  for (const CommandText& one : command.commands) {
    if (one.group != group) rows += "\n" + one.group + ":\n";
    group = one.group;
    rows += Row(one.Word(), one.what);
  }
  return rows;
}

}  // namespace

std::vector<std::string> WordText::Choices() const {
  std::vector<std::string> words;
  if (value.find('|') == value.npos) return words;
  std::istringstream text(value);
  for (std::string word; std::getline(text, word, '|');) words.push_back(word);
  return words;
}

std::string CommandText::Word() const { return name.substr(name.rfind(' ') + 1); }

CommandText Describe(const CLI::App& command) {
  CommandText text;
  text.name = FullName(command);
  text.group = command.get_group();
  text.what = command.get_description();
  text.more = command.get_footer();
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_group().empty()) continue;
    (option->get_positional() ? text.arguments : text.flags).push_back(DescribeWord(*option));
  }
  for (const CLI::App* one : command.get_subcommands([](const CLI::App*) { return true; })) {
    if (!one->get_group().empty()) text.commands.push_back(Describe(*one));
  }
  return text;
}

std::vector<std::string> CommandText::CommandWords() const {
  std::vector<std::string> words;
  for (const CommandText& one : commands) words.push_back(one.Word());
  return words;
}

std::string UsageLine(const CommandText& command) {
  std::string line = command.name + " [FLAGS]";
  if (!command.commands.empty()) line += " COMMAND";
  for (const WordText& argument : command.arguments) {
    const std::string name = argument.name + (argument.repeats ? "..." : "");
    line += argument.needed ? " " + name : " [" + name + "]";
  }
  return line;
}

std::string HelpText(const CommandText& command) {
  std::string out = Wrapped(command.what, 0, kWidth) + "\n\nUsage: " + UsageLine(command) + "\n";
  if (!command.arguments.empty()) out += "\nArguments:\n";
  for (const WordText& argument : command.arguments) out += Row(argument.name, argument.help);
  out += CommandRows(command);
  if (!command.flags.empty()) out += "\nFlags:\n";
  for (const WordText& flag : command.flags) {
    const std::string letter = flag.letter.empty() ? "" : flag.letter + ", ";
    const std::string value = flag.value.empty() ? "" : " " + flag.value;
    out += Row(letter + flag.name + value, flag.help);
  }
  if (!command.more.empty()) out += "\n" + command.more + "\n";
  return out;
}

std::string OverviewText(const CommandText& taut) {
  return Wrapped(taut.what, 0, kWidth) + "\n" + CommandRows(taut) +
         "\nExample: `taut run experiments/push_20n.yaml`. Help on a command: `taut help "
         "COMMAND`\n";
}

std::string Wrapped(const std::string& text, std::size_t indent, std::size_t width) {
  std::istringstream words(text);
  std::string out;
  std::size_t length = 0;
  for (std::string word; words >> word;) {
    if (length > 0 && length + 1 + word.size() > width) {
      out += "\n" + std::string(indent, ' ');
      length = 0;
    } else if (length > 0) {
      out += " ";
      ++length;
    }
    out += word;
    length += word.size();
  }
  return out;
}

}  // namespace taut::cli
