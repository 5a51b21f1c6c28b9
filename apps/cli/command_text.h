/// Description of a command, read from its CLI11 flags. Help text, manual page and shell
/// completions are all generated from it.
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace taut::cli {

/// Flag or positional argument.
struct WordText {
  std::string name;    ///< Such as "--step_s" or "FILE".
  std::string letter;  ///< Short form, such as "-h"; empty: none.
  /// Placeholder of a flag's value: "S", "FILE", "FOLDER", "index|none|segments". For an argument:
  /// its allowed words, if there is a fixed set. Empty: no value.
  std::string value;
  std::string help;
  bool needed = false, repeats = false;

  /// Returns the allowed words of the value; empty: any.
  std::vector<std::string> Choices() const;
};

struct CommandText {
  std::string name;   ///< Complete name, such as "taut gait export".
  std::string group;  ///< Heading of the command in the help text of its parent.
  std::string what;   ///< Purpose, as one sentence.
  std::string more;   ///< Examples and further information.
  std::vector<WordText> arguments, flags;
  std::vector<CommandText> commands;

  /// Returns the last word of the command's name.
  std::string Word() const;

  /// Returns the last words of its subcommands, in order.
  std::vector<std::string> CommandWords() const;
};

/// Describes a command; hidden flags (with an empty group) are omitted.
CommandText Describe(const CLI::App& command);

/// Returns the usage line: "taut run [FLAGS] EXPERIMENT".
std::string UsageLine(const CommandText& command);

/// Returns the text printed by `--help`.
std::string HelpText(const CommandText& command);

/// Returns the text printed by `taut` without arguments: purpose, commands, examples.
std::string OverviewText(const CommandText& taut);

/// Wraps `text` at `width` characters; all lines but the first are indented by `indent` spaces.
std::string Wrapped(const std::string& text, std::size_t indent, std::size_t width);

}  // namespace taut::cli
