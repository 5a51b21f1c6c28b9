// Manual page taut(1) in roff.
#include <fmt/format.h>

#include <sstream>

#include "manual.h"
#include "taut/version.h"

namespace taut::cli {
namespace {

/// Escapes a text for roff: hyphens can be copied, and no line is taken as a request.
std::string Roff(const std::string& text) {
  std::string out;
  if (!text.empty() && (text[0] == '.' || text[0] == '\'')) out = "\\&";
  for (const char c : text) {
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else {
      out += c;
    }
  }
  return out;
}

/// Formats lines; indented lines are examples and keep their layout.
std::string Lines(const std::string& text) {
  std::string out;
  bool example = false;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const bool indented = line.rfind("  ", 0) == 0;
    if (indented != example) out += indented ? ".PP\n.nf\n" : ".fi\n.PP\n";
    example = indented;
    out += Roff(line) + "\n";
    if (!indented && line.back() == ':') out += ".br\n";
  }
  return out + (example ? ".fi\n" : "");
}

std::string Word(const WordText& word) {
  std::string name = "\\fB" + Roff(word.name) + "\\fR";
  if (!word.letter.empty()) name = "\\fB" + Roff(word.letter) + "\\fR, " + name;
  if (!word.value.empty() && word.name[0] == '-') name += " \\fI" + Roff(word.value) + "\\fR";
  return ".TP\n" + name + "\n" + Roff(word.help) + "\n";
}

std::string Section(const CommandText& command) {
  std::string out = ".SS " + Roff(UsageLine(command)) + "\n" + Roff(command.what) + "\n";
  for (const WordText& argument : command.arguments) out += Word(argument);
  for (const WordText& flag : command.flags) {
    if (flag.name != "--help") out += Word(flag);  // documented once, for `taut`
  }
  if (!command.more.empty()) out += ".PP\n" + Lines(command.more);
  for (const CommandText& one : command.commands) out += Section(one);
  return out;
}

}  // namespace

std::string ManPage(const CommandText& taut) {
  std::string out = fmt::format(
      ".\\\" Made by `taut help --man`.\n.TH TAUT 1 \"\" \"taut {}\" \"User Commands\"\n"
      ".SH NAME\ntaut \\- {}\n.SH SYNOPSIS\n\\fBtaut\\fR [FLAGS] COMMAND\n.SH DESCRIPTION\n{}\n",
      kVersion, Roff(taut.what.substr(taut.what.find(' ') + 1)), Roff(taut.what));
  out += ".PP\n" + Lines(taut.more) + ".SH FLAGS\n";
  for (const WordText& flag : taut.flags) out += Word(flag);
  out += ".SH COMMANDS\n";
  for (const CommandText& command : taut.commands) out += Section(command);
  return out;
}

}  // namespace taut::cli
