#include "compare/column_meaning.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <utility>

#include "base/foreign_units.h"
#include "trace/csv_lines.h"

namespace taut {
namespace {

/// Spellings of units in headers, in lower case.
constexpr std::pair<std::string_view, std::string_view> kSpellings[] = {
    {"sec", "s"},        {"secs", "s"},          {"second", "s"},        {"seconds", "s"},
    {"sekunden", "s"},   {"sekunde", "s"},       {"msec", "ms"},         {"millisec", "ms"},
    {"millis", "ms"},    {"milliseconds", "ms"}, {"usec", "us"},         {"\xC2\xB5s", "us"},
    {"\xCE\xBCs", "us"}, {"micros", "us"},       {"microseconds", "us"}, {"nsec", "ns"},
    {"nanosec", "ns"},   {"nanoseconds", "ns"},  {"newton", "N"},        {"newtons", "N"},
    {"kn", "kN"},        {"lbs", "lbf"},         {"meter", "m"},         {"meters", "m"},
    {"metre", "m"},      {"metres", "m"},        {"millimeters", "mm"},  {"millimeter", "mm"},
    {"inch", "in"},      {"inches", "in"},       {"\xC2\xB0", "deg"},    {"degree", "deg"},
    {"degrees", "deg"},  {"grad", "deg"},        {"radian", "rad"},      {"radians", "rad"},
    {"\xC2\xB5m", "um"}, {"nm", "N m"},          {"n*m", "N m"},         {"n.m", "N m"},
};

std::string Lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

using Words = std::vector<std::string_view>;

/// Words of other quantities than the measured tension, length, position or angle of a member.
const Words kOtherQuantities{
    "setpoint", "target",       "soll",      "command",  "cmd",        "commanded", "error",
    "desired",  "ref",          "reference", "demand",   "nominal",    "set",       "noise",
    "std",      "stdev",        "sd",        "var",      "variance",   "min",       "max",
    "minimum",  "maximum",      "delta",     "diff",     "elongation", "strain",    "displacement",
    "diameter", "radius",       "friction",  "velocity", "vel",        "speed",     "acc",
    "accel",    "acceleration", "euler",     "rpm",      "current",    "voltage",   "duty",
    "pwm",      "temperature",  "temp",      "twist",    "wrench",     "torque",    "moment",
    "angular",  "linear",       "gyro",      "status",   "flag",       "marker"};

/// Words that contribute nothing to the name of a member.
const Words kExplained{
    "force",    "forces",    "kraft",     "zugkraft",    "tension",     "tensions", "load",
    "cell",     "loadcell",  "lc",        "cable",       "cables",      "seil",     "rope",
    "tendon",   "wire",      "string",    "length",      "laenge",      "rest",     "l0",
    "position", "positions", "pos",       "translation", "orientation", "rotation", "quaternion",
    "quat",     "pose",      "transform", "transforms",  "tf",          "angle",    "joint",
    "joints",   "rigid",     "body",      "node",        "state",       "states",   "effort",
    "data",     "field",     "value",     "measured",    "sensor",      "x",        "y",
    "z",        "w",         "qx",        "qy",          "qz",          "qw"};

/// Words before a number that make it the number of a cable.
const Words kCableWords{"cable", "seil", "rope", "tendon", "wire", "string"};

bool IsNumber(const std::string& token) {
  return !token.empty() && std::all_of(token.begin(), token.end(), [](char c) {
    return std::isdigit(static_cast<unsigned char>(c)) != 0;
  });
}

struct Match {
  std::string kind, name;
  std::size_t length = 0, from = 0, to = 0;  ///< Of the match: characters, range of tokens.
  bool several = false;
};

void Consider(const std::vector<std::string>& column, const std::string& kind,
              const std::vector<std::string>& names, Match& best) {
  for (const std::string& name : names) {
    const std::vector<std::string> words = Tokens(name);
    const bool number = words.size() == 1 && IsNumber(words[0]);
    std::size_t length = 0;
    for (const std::string& word : words) length += word.size();
    for (auto from = column.begin(); !words.empty(); ++from) {
      from = std::search(from, column.end(), words.begin(), words.end());
      if (from == column.end()) break;
      if (number && (from == column.begin() || !HasWord({*(from - 1)}, kCableWords))) continue;
      if (length == best.length) {
        best.several = best.several || (best.kind == kind && best.name != name);
      } else if (length > best.length) {
        const auto place = static_cast<std::size_t>(from - column.begin());
        best = {kind, name, length, place, place + words.size(), false};
      }
    }
  }
}

/// Names the members of the kinds that can have the quantity, the more probable kind first.
std::vector<std::pair<std::string, const std::vector<std::string>*>> Kinds(
    const std::string& si, char axis, const RobotNames& robot) {
  if (axis != 0) return {{"body", &robot.bodies}, {"node", &robot.nodes}};
  if (si == "rad") return {{"joint", &robot.joints}};
  if (si == "N" || si == "m" || si.empty()) {
    return {{"cable", &robot.cables}, {"joint", &robot.joints}};
  }
  return {};
}

/// Returns the axis that a column's name ends with: "pos X", "rod_x", "qw", "x (mm)".
char AxisOf(const std::vector<std::string>& tokens) {
  for (auto token = tokens.rbegin(); token != tokens.rend(); ++token) {
    if (token->size() > 2 || token->empty()) continue;
    const char last = token->back();
    if (last != 'x' && last != 'y' && last != 'z' && last != 'w') continue;
    if (token->size() == 1 || token->front() == 'q' || token->front() == 't') return last;
  }
  return 0;
}

std::string ChannelOf(const ColumnMeaning& found, const std::string& si,
                      const std::vector<std::string>& tokens) {
  const std::string head = found.kind + "/" + found.member + "/";
  if (found.kind == "cable") {
    if (si.empty() && HasWord(tokens, {"position", "pos", "length", "angle"})) return {};
    if (si == "N" || si.empty()) return head + "tension_n";
    if (si == "m") return head + (HasWord(tokens, {"rest", "l0"}) ? "rest_length_m" : "length_m");
    return {};
  }
  if (found.kind == "joint") {
    return si == "rad" ? head + "angle_rad" : si == "m" ? head + "position_m" : std::string();
  }
  const bool turns = found.axis == 'w' || HasWord(tokens, {"rotation", "orientation", "quat",
                                                           "quaternion", "qx", "qy", "qz", "qw"});
  if (found.kind == "body" && turns) {
    return si.empty() ? head + "orientation_{axis}" : std::string();  // a unit marks angles,
                                                                      // not a quaternion
  }
  if (si.empty() && HasWord(tokens, {"force", "kraft"})) return {};
  return (si == "m" || si.empty()) && !turns ? head + "position_{axis}_m" : std::string();
}

/// Unit in a name, and the name without it.
struct SplitName {
  std::string bare, unit, unknown_unit;
};

/// Looks for a unit in brackets, from the last to the first ones, then for one at the end.
SplitName SplitUnit(const std::string& name) {
  SplitName split{name, "", ""};
  std::size_t end = name.size();
  while (true) {
    const std::size_t from = name.find_last_of("[(<", end == 0 ? 0 : end - 1);
    if (from == name.npos || end == 0) break;
    const std::size_t to = name.find_first_of("])>", from);
    end = from;
    if (to == name.npos) continue;
    const std::string text(trace::Trim(std::string_view(name).substr(from + 1, to - from - 1)));
    const std::string unit = KnownUnit(text);
    if (unit.empty()) {
      if (split.unknown_unit.empty()) split.unknown_unit = text;
      continue;
    }
    split.unit = unit;
    split.unknown_unit.clear();
    split.bare = name.substr(0, from) + " " + name.substr(to + 1);
    return split;
  }
  // A last word or two, such as "force_N", "a0 X mm" or "torque N mm".
  for (const std::size_t words : {2u, 1u}) {
    std::size_t mark = name.size();
    for (std::size_t i = 0; i < words && mark != name.npos; ++i) {
      mark = mark == 0 ? name.npos : name.find_last_of(" _,", mark - 1);
    }
    if (mark == name.npos) continue;
    const std::string word = name.substr(mark + 1);
    // Words such as "in" or letters are parts of names more often than units.
    const bool letter = word.size() == 1 && word != "N" && word != "s" && word != "m";
    if (letter || word == "in" || (name[mark] == ' ' && word == "m")) continue;
    split.unit = KnownUnit(word);
    if (split.unit.empty()) continue;
    split.bare = name.substr(0, mark);
    break;
  }
  return split;
}

}  // namespace

bool HasWord(const std::vector<std::string>& tokens, const std::vector<std::string_view>& words) {
  return std::any_of(tokens.begin(), tokens.end(), [&](const std::string& token) {
    return std::find(words.begin(), words.end(), token) != words.end();
  });
}

std::vector<std::string> Tokens(const std::string& name) {
  std::vector<std::string> tokens;
  enum { kNone, kLetter, kDigit } before = kNone;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    const auto now = std::isdigit(byte)                 ? kDigit
                     : std::isalpha(byte) || byte > 127 ? kLetter
                                                        : kNone;
    if (now != kNone) {
      if (now != before) tokens.emplace_back();
      tokens.back() += static_cast<char>(std::tolower(byte));
    }
    before = now;
  }
  for (std::string& token : tokens) {
    while (token.size() > 1 && token.front() == '0' &&
           std::isdigit(static_cast<unsigned char>(token[1])))
      token.erase(0, 1);
  }
  return tokens;
}

std::string KnownUnit(const std::string& unit) {
  if (base::FindUnit(unit)) return unit;
  const std::string lower = Lower(unit);
  for (const auto& [spelling, name] : kSpellings) {
    if (lower == spelling) return std::string(name);
  }
  return {};
}

std::string UnitInName(const std::string& name) { return SplitUnit(name).unit; }

ColumnMeaning MeaningOf(const std::string& name, const std::string& unit,
                        const std::string& length_unit, const RobotNames& robot) {
  ColumnMeaning found;
  SplitName split = SplitUnit(name);
  std::vector<std::string> tokens = Tokens(split.bare);
  found.axis = AxisOf(tokens);
  // Without an axis, "_m" may also mean "measured"; no quantity of a member is a time.
  const bool in_brackets = name.find_first_of("[(<") != name.npos;
  const bool vague = split.unit == "m" && found.axis == 0 && !HasWord(tokens, {"length", "laenge"});
  if (!in_brackets && (split.unit == "s" || vague)) {
    split.unit.clear();
    tokens = Tokens(name);
  }
  found.unknown_unit = split.unknown_unit;
  found.unit = KnownUnit(unit);
  if (found.unit.empty() && !unit.empty()) found.unknown_unit = unit;
  if (found.unit.empty()) found.unit = split.unit;
  const auto known = found.unit.empty() ? std::nullopt : base::FindUnit(found.unit);
  std::string si = known ? known->si : std::string();
  Match best;
  const auto consider = [&] {
    for (const auto& [kind, names] : Kinds(si, found.axis, robot)) {
      Consider(tokens, kind, *names, best);
    }
  };
  consider();
  if (best.length == 0 && found.axis != 0) {  // "x" may belong to the name of a cable
    found.axis = 0;
    consider();
  }
  found.kind = best.kind;
  found.member = best.name;
  found.several = best.several;
  if (found.kind.empty()) return found;
  // The text in brackets may be the member's name.
  if (!found.unknown_unit.empty() && Tokens(found.unknown_unit) == Tokens(found.member)) {
    found.unknown_unit.clear();
  }
  for (std::size_t i = 0; i < tokens.size(); ++i) {
    if (i >= best.from && i < best.to) continue;
    if (HasWord({tokens[i]}, kOtherQuantities)) found.refused = tokens[i];
    if (HasWord({tokens[i]}, kExplained)) continue;
    found.left_over += (found.left_over.empty() ? "" : " ") + tokens[i];
  }
  if (name.starts_with('-')) found.refused = "-";
  if (!found.refused.empty() || !found.unknown_unit.empty()) return found;
  if (si.empty() && found.axis != 0 && !length_unit.empty() &&
      !HasWord(tokens, {"rotation", "orientation"})) {
    found.unit = length_unit;
    si = "m";
  }
  found.channel = ChannelOf(found, si, tokens);
  return found;
}

}  // namespace taut
