#include "compare/column_meaning.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <initializer_list>
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

std::string Joined(const std::vector<std::string>& tokens) {
  std::string whole;
  for (const std::string& token : tokens) whole += token;
  return whole;
}

/// Returns whether a run of a column's tokens, written together, is the member's name.
bool Contains(const std::vector<std::string>& column, const std::string& member) {
  for (std::size_t from = 0; from < column.size(); ++from) {
    std::string run;
    for (std::size_t to = from; to < column.size() && run.size() < member.size(); ++to) {
      run += column[to];
      if (run == member) return true;
    }
  }
  return false;
}

struct Match {
  std::string kind, name;
  std::size_t length = 0;
  bool several = false;
};

void Consider(const std::vector<std::string>& column, const std::string& kind,
              const std::vector<std::string>& names, Match& best) {
  for (const std::string& name : names) {
    const std::string joined = Joined(Tokens(name));
    if (joined.empty() || joined.size() < best.length || !Contains(column, joined)) continue;
    const bool again = joined.size() == best.length && best.kind == kind && best.name != name;
    if (joined.size() > best.length) best = {kind, name, joined.size(), false};
    best.several = best.several || again;
  }
}

/// Names the members of the kinds that can have the quantity, the more probable kind first.
std::vector<std::pair<std::string, const std::vector<std::string>*>> Kinds(
    const std::string& si, char axis, const RobotNames& robot) {
  if (axis != 0) return {{"body", &robot.bodies}, {"node", &robot.nodes}};
  if (si == "rad") return {{"joint", &robot.joints}};
  if (si == "N m") return {};
  return {{"cable", &robot.cables}, {"joint", &robot.joints}};
}

bool Has(const std::vector<std::string>& tokens, std::initializer_list<std::string_view> words) {
  return std::any_of(tokens.begin(), tokens.end(), [&](const std::string& token) {
    return std::find(words.begin(), words.end(), token) != words.end();
  });
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
    if (si == "N" || si.empty()) return head + "tension_n";
    if (si == "m") return head + (Has(tokens, {"rest", "l0"}) ? "rest_length_m" : "length_m");
    return {};
  }
  if (found.kind == "joint") {
    return si == "rad" ? head + "angle_rad" : si == "m" ? head + "position_m" : std::string();
  }
  const bool turns = found.axis == 'w' ||
                     Has(tokens, {"rotation", "orientation", "quat", "quaternion"}) ||
                     Has(tokens, {"qx", "qy", "qz", "qw"});
  if (found.kind == "body" && turns) {
    return si.empty() ? head + "orientation_{axis}" : std::string();  // angles are no quaternion
  }
  return (si == "m" || si.empty()) && !turns ? head + "position_{axis}_m" : std::string();
}

}  // namespace

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

std::string KnownUnit(std::string unit) {
  if (base::FindUnit(unit)) return unit;
  const std::string lower = Lower(unit);
  for (const auto& [spelling, name] : kSpellings) {
    if (lower == spelling) return std::string(name);
  }
  return {};
}

std::string UnitInName(const std::string& name) {
  for (const auto& [open, close] : {std::pair('[', ']'), std::pair('(', ')')}) {
    const std::size_t from = name.rfind(open);
    const std::size_t to = from == name.npos ? from : name.find(close, from);
    if (to == name.npos) continue;
    const std::string unit =
        KnownUnit(std::string(trace::Trim(std::string_view(name).substr(from + 1, to - from - 1))));
    if (!unit.empty()) return unit;
  }
  // A last word, such as "force_N", "a0 X mm" or "time, ms". Other single letters after a blank are
  // names: "rotation W", "rod A".
  const std::size_t mark = name.find_last_of(" _,/");
  if (mark == name.npos) return {};
  const std::string word = name.substr(mark + 1);
  const bool is_name =
      name[mark] == ' ' && word.size() == 1 && word != "N" && word != "m" && word != "s";
  return is_name ? std::string() : KnownUnit(word);
}

ColumnMeaning MeaningOf(const std::string& name, const std::string& unit,
                        const std::string& length_unit, const RobotNames& robot) {
  ColumnMeaning found;
  found.unit = KnownUnit(unit);
  if (found.unit.empty()) found.unit = UnitInName(name);
  std::string bare = name.substr(0, name.find_first_of("[("));
  if (bare.empty()) bare = name;
  const std::vector<std::string> tokens = Tokens(bare);
  // "x [mm]" and "rotation x" have an axis; a cable may be named "x".
  found.axis = AxisOf(tokens);
  const auto known = found.unit.empty() ? std::nullopt : base::FindUnit(found.unit);
  std::string si = known ? known->si : std::string();
  Match best;
  for (const auto& [kind, names] : Kinds(si, found.axis, robot)) {
    Consider(tokens, kind, *names, best);
  }
  if (best.length == 0 && found.axis != 0) {
    found.axis = 0;
    for (const auto& [kind, names] : Kinds(si, 0, robot)) Consider(tokens, kind, *names, best);
  }
  found.kind = best.kind;
  found.member = best.name;
  found.several = best.several;
  if (found.kind.empty() || Has(tokens, {"setpoint", "target", "soll", "command", "cmd", "error"}))
    return found;
  if (si.empty() && found.axis != 0 && !length_unit.empty() &&
      !Has(tokens, {"rotation", "orientation"})) {
    found.unit = length_unit;
    si = "m";
  }
  found.channel = ChannelOf(found, si, tokens);
  return found;
}

}  // namespace taut
