/// What there is to say of a command: read once from its table of flags, written as a help text, a
/// page of the manual and completions of shells. None of these has a text of its own.
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace taut::cli {

/// A flag, or an argument that has its place.
struct WordText {
  std::string name;    ///< "--step_s", "FILE".
  std::string letter;  ///< "-h"; empty: none.
  /// What stands behind a flag: "S", "FILE", "FOLDER", "index|none|segments". Of an argument the
  /// words it may be, if there are only some. Empty: nothing.
  std::string value;
  std::string help;
  bool needed = false, repeats = false;

  /// The words that the value may be; empty: any.
  std::vector<std::string> Choices() const;
};

struct CommandText {
  std::string name;  ///< "taut gait export".
  std::string what;  ///< A sentence.
  std::string more;  ///< Examples, and what else is good to know.
  std::vector<WordText> arguments, flags;
  std::vector<CommandText> commands;

  /// The last word of its name.
  std::string Word() const;

  /// The last words of its commands, in their order.
  std::vector<std::string> CommandWords() const;
};

/// What is hidden (an empty group) is left out.
CommandText Describe(const CLI::App& command);

/// "taut run [FLAGS] EXPERIMENT".
std::string UsageLine(const CommandText& command);

/// What `--help` prints.
std::string HelpText(const CommandText& command);

/// What `taut` alone prints: what it is, its commands, some examples.
std::string OverviewText(const CommandText& taut);

/// `text` in lines of at most `width` characters, all but the first begun by `indent` spaces.
std::string Wrapped(const std::string& text, std::size_t indent, std::size_t width);

}  // namespace taut::cli
