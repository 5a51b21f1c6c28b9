#include "trace/channel_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

namespace taut::trace {
namespace {

/// How names write units.
constexpr std::pair<std::string_view, std::string_view> kUnits[] = {
    {"m", "m"}, {"s", "s"},   {"kg", "kg"},   {"n", "N"},
    {"j", "J"}, {"hz", "Hz"}, {"rad", "rad"}, {"pa", "Pa"},
};

/// "s^2" of "s2". Empty if a word is no unit.
std::string UnitOfWord(std::string_view word) {
  std::string power;
  if (word.ends_with('2') || word.ends_with('3')) {
    power = std::string("^") + word.back();
    word.remove_suffix(1);
  }
  for (const auto& [written, unit] : kUnits) {
    if (word == written) return std::string(unit) + power;
  }
  return {};
}

/// What is wrong with a name; empty if nothing is. `taken`: all names.
std::string_view Flaw(std::string_view name, const std::set<std::string_view>& taken) {
  if (name == "time_s") return "is the trace's own clock";
  for (const char c : name) {
    if (static_cast<unsigned char>(c) < ' ' || c == ',' || c == '"') {
      return "holds a comma, a quote or a control character";
    }
  }
  for (std::size_t from = 0; from <= name.size();) {
    const std::size_t to = std::min(name.find('/', from), name.size());
    const std::string_view part = name.substr(from, to - from);
    if (part.empty() || part == ".") return "has an empty part or a lone dot between slashes";
    if (to < name.size() &&
        (taken.contains(name.substr(0, to)) || name.substr(0, to) == "time_s")) {
      return "continues the name of another channel after a slash";
    }
    from = to + 1;
  }
  return {};
}

}  // namespace

bool CheckChannelNames(const std::string& path, const std::vector<ChannelInfo>& channels,
                       Diagnostics& out) {
  bool good = true;
  std::set<std::string_view> taken;
  for (const ChannelInfo& channel : channels) taken.insert(channel.name);
  std::set<std::string_view> before;
  for (const ChannelInfo& channel : channels) {
    const bool twice = !before.insert(channel.name).second;
    const std::string_view flaw = twice ? "occurs twice" : Flaw(channel.name, taken);
    if (flaw.empty()) continue;
    out.Error({path}, fmt::format("channel name \"{}\" {}", channel.name, flaw));
    good = false;
  }
  return good;
}

}  // namespace taut::trace

namespace taut {

std::string UnitOfName(std::string_view name) {
  std::vector<std::string_view> words;
  name.remove_prefix(name.rfind('/') + 1);  // npos + 1 is 0
  for (std::size_t at = 0; (at = name.find('_')) != name.npos; name.remove_prefix(at + 1)) {
    words.push_back(name.substr(0, at));
  }
  words.push_back(name);
  // A unit is all the words at the end that are of one: kg_per_m ends with m and is no m. The first
  // word says what is measured.
  std::size_t from = words.size();
  while (from > 1 && (words[from - 1] == "per" || !trace::UnitOfWord(words[from - 1]).empty())) {
    --from;
  }
  const auto begin = words.begin() + static_cast<std::ptrdiff_t>(from);
  const auto per = std::find(begin, words.end(), "per");
  const auto join = [](auto first, auto last) {
    std::string text;
    for (; first != last; ++first) text += (text.empty() ? "" : " ") + trace::UnitOfWord(*first);
    return text;
  };
  const std::string over = join(begin, per);
  if (per == words.end()) return over.empty() ? "1" : over;
  const std::string under = join(per + 1, words.end());
  // What stands before "per" may be a unit that is not known: turns_per_s.
  if (over.empty() || under.empty() || std::find(per + 1, words.end(), "per") != words.end()) {
    return "1";
  }
  return over + "/" + (words.end() - per > 2 ? "(" + under + ")" : under);
}

}  // namespace taut
