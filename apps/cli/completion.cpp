// Shell completion scripts for bash, zsh and fish (`taut help`).
#include <fmt/format.h>

#include <functional>

#include "manual.h"

namespace taut::cli {
namespace {

std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != text.npos; at += to.size()) {
    text.replace(at, from.size(), to);
  }
  return text;
}

/// Quotes a text for bash and zsh, in single quotes; `Fish` quotes for fish.
std::string Sh(const std::string& text) { return "'" + Replaced(text, "'", "'\\''") + "'"; }
std::string Fish(const std::string& text) {
  return "'" + Replaced(Replaced(text, "\\", "\\\\"), "'", "\\'") + "'";
}

std::string Spaced(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, " "));
}

/// Calls `act` for a command and all its subcommands, recursively.
void ForEach(const CommandText& command, const std::function<void(const CommandText&)>& act) {
  act(command);
  for (const CommandText& one : command.commands) ForEach(one, act);
}

// bash: tables of flag values, of flags, and of the words that may follow a command.

std::string BashValue(const WordText& word) {
  if (!word.Choices().empty()) return "_taut_words " + Sh(Spaced(word.Choices()));
  if (word.value == "FILE") return "_taut_paths -f";
  return word.value == "FOLDER" ? "_taut_paths -d" : ":";
}

std::string BashPlace(const CommandText& command) {
  if (!command.commands.empty()) return "_taut_words " + Sh(Spaced(command.CommandWords()));
  if (command.arguments.empty()) return ":";
  const WordText& first = command.arguments.front();
  return first.Choices().empty() ? "_taut_paths -f" : BashValue(first);
}

std::string Bash(const CommandText& taut) {
  std::string commands, values, flags, places;
  ForEach(taut, [&](const CommandText& command) {
    if (command.name != taut.name) commands += (commands.empty() ? "" : "|") + Sh(command.name);
    std::vector<std::string> names;
    for (const WordText& flag : command.flags) {
      names.push_back(flag.name);
      if (flag.value.empty()) continue;
      values += fmt::format("    {}) {}; return ;;\n", Sh(command.name + " " + flag.name),
                            BashValue(flag));
    }
    flags += fmt::format("      {}) _taut_words {} ;;\n", Sh(command.name), Sh(Spaced(names)));
    places += fmt::format("    {}) {} ;;\n", Sh(command.name), BashPlace(command));
  });
  return "# Completion of taut for bash, made by `taut help --completion bash`.\n"
         "_taut_words() { mapfile -t COMPREPLY < <(compgen -W \"$1\" -- \"$cur\"); }\n"
         "_taut_paths() {\n"
         "  compopt -o filenames 2>/dev/null\n"
         "  mapfile -t COMPREPLY < <(compgen \"$1\" -- \"$cur\")\n"
         "}\n"
         "_taut() {\n"
         "  local cur=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} command=taut "
         "i\n"
         "  COMPREPLY=()\n"
         "  for ((i = 1; i < COMP_CWORD; ++i)); do\n"
         "    case \"$command ${COMP_WORDS[i]}\" in\n"
         "      " +
         commands +
         ") command+=\" ${COMP_WORDS[i]}\" ;;\n"
         "    esac\n"
         "  done\n"
         "  case \"$command $before\" in\n" +
         values +
         "  esac\n"
         "  if [[ $cur == -* ]]; then\n"
         "    case \"$command\" in\n" +
         flags +
         "    esac\n"
         "    return\n"
         "  fi\n"
         "  case \"$command\" in\n" +
         places +
         "  esac\n"
         "}\n"
         "complete -F _taut taut\n";
}

// zsh: one function per command, which calls the functions of its subcommands.

std::string ZshFunction(const CommandText& command) {
  return "_" + Replaced(command.name, " ", "_");
}

/// Escapes a text for use in brackets and between colons.
std::string ZshText(const std::string& text) {
  std::string out = Replaced(text, "\\", "\\\\");
  for (const char* special : {"[", "]", ":"}) {
    out = Replaced(out, special, std::string("\\") + special);
  }
  return out;
}

std::string ZshValue(const WordText& word, bool place) {
  if (!word.Choices().empty()) return "(" + Spaced(word.Choices()) + ")";
  if (word.value == "FILE" || (place && word.value.empty())) return "_files";
  return word.value == "FOLDER" ? "_files -/" : " ";
}

std::string Zsh(const CommandText& taut) {
  std::string functions;
  ForEach(taut, [&](const CommandText& command) {
    std::vector<std::string> specs;
    for (const WordText& flag : command.flags) {
      const std::string value =
          flag.value.empty() ? "" : ":" + ZshText(flag.value) + ":" + ZshValue(flag, false);
      const std::string what = "[" + ZshText(flag.help) + "]" + value;
      specs.push_back(Sh((flag.repeats ? "*" : "") + flag.name + what));
      if (!flag.letter.empty()) specs.push_back(Sh(flag.letter + what));
    }
    std::string cases;
    if (command.commands.empty()) {
      for (const WordText& one : command.arguments) {
        specs.push_back(Sh((one.repeats ? "*" : "") + std::string(":") + ZshText(one.name) + ":" +
                           ZshValue(one, true)));
      }
    } else {
      std::string names;
      for (const CommandText& one : command.commands) {
        names += " " + one.Word() + "\\:" + "\"" + ZshText(one.what) + "\"";
        cases += "    " + one.Word() + ") " + ZshFunction(one) + " ;;\n";
      }
      specs.push_back(Sh("1:command:((" + names + "))"));
      specs.push_back(Sh("*::argument:->argument"));
    }
    functions += ZshFunction(command) +
                 "() {\n  local context state line\n  typeset -A opt_args\n  _arguments -C";
    for (const std::string& spec : specs) functions += " \\\n    " + spec;
    functions += "\n";
    if (!cases.empty()) {
      functions += "  [[ $state == argument ]] && case $words[1] in\n" + cases + "  esac\n";
    }
    functions += "}\n";
  });
  return "#compdef taut\n# Completion of taut for zsh, made by `taut help --completion zsh`.\n" +
         functions + "_taut \"$@\"\n";
}

// fish: one line per word, with the condition under which the shell offers it.

/// Returns the condition that all words of the command's name are present.
std::string FishCondition(const CommandText& command) {
  std::string condition, words = command.name;
  for (std::size_t at; (at = words.find(' ')) != words.npos;) {
    words = words.substr(at + 1);
    condition += (condition.empty() ? "" : "; and ") + std::string("__fish_seen_subcommand_from ") +
                 words.substr(0, words.find(' '));
  }
  if (command.commands.empty()) return condition;
  return condition + (condition.empty() ? "" : "; and ") + "not __fish_seen_subcommand_from " +
         Spaced(command.CommandWords());
}

std::string FishValue(const WordText& word) {
  if (word.value.empty()) return "";
  if (!word.Choices().empty()) return " -x -a " + Fish(Spaced(word.Choices()));
  if (word.value == "FILE") return " -r -F";
  return word.value == "FOLDER" ? " -x -a '(__fish_complete_directories)'" : " -x";
}

std::string Fish(const CommandText& taut) {
  std::string out = "# Completion of taut for fish, made by `taut help --completion fish`.\n";
  ForEach(taut, [&](const CommandText& command) {
    const std::string begin = "complete -c taut -n " + Fish(FishCondition(command));
    for (const CommandText& one : command.commands) {
      out += begin + " -f -a " + one.Word() + " -d " + Fish(one.what) + "\n";
    }
    for (const WordText& flag : command.flags) {
      const std::string letter = flag.letter.empty() ? "" : " -s " + flag.letter.substr(1);
      out += begin + letter + " -l " + flag.name.substr(2) + FishValue(flag) + " -d " +
             Fish(flag.help) + "\n";
    }
    if (!command.arguments.empty() && !command.arguments.front().Choices().empty()) {
      out += begin + " -f -a " + Fish(Spaced(command.arguments.front().Choices())) + "\n";
    }
  });
  return out;
}

}  // namespace

const std::vector<std::string>& Shells() {
  static const std::vector<std::string> shells{"bash", "zsh", "fish"};
  return shells;
}

std::optional<std::string> Completion(const CommandText& taut, const std::string& shell) {
  if (shell == "bash") return Bash(taut);
  if (shell == "zsh") return Zsh(taut);
  if (shell == "fish") return Fish(taut);
  return std::nullopt;
}

}  // namespace taut::cli
