#include "trace/channel_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <set>

#include "base/name_unit.h"

namespace taut::trace {
namespace {

/// Returns the defect of a channel name; empty if there is none. `taken`: all names.
std::string_view Flaw(std::string_view name, const std::set<std::string_view>& taken) {
  if (name == "time_s") return "is reserved for the clock of the trace";
  for (const char c : name) {
    if (static_cast<unsigned char>(c) < ' ' || c == ',' || c == '"') {
      return "contains a comma, a quote or a control character";
    }
  }
  for (std::size_t from = 0; from <= name.size();) {
    const std::size_t to = std::min(name.find('/', from), name.size());
    const std::string_view part = name.substr(from, to - from);
    if (part.empty() || part == ".") return "has an empty part or a single dot between slashes";
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
    out.Error("trace.bad_channel_name", {path},
              fmt::format("channel name \"{}\" {}", channel.name, flaw));
    good = false;
  }
  return good;
}

bool IsTautChannel(const std::string& name) {
  static const std::set<std::string, std::less<>> kinds{
      "cable", "body", "node", "joint", "sensor", "system", "board", "contact", "goal"};
  const std::size_t slash = name.find('/');
  return slash != name.npos && kinds.contains(name.substr(0, slash)) && UnitOfName(name) != "1";
}

std::string TableUnit(const std::string& name) {
  return IsTautChannel(name) ? UnitOfName(name) : "1";
}

}  // namespace taut::trace

namespace taut {

std::string UnitOfName(std::string_view name) {
  name.remove_prefix(name.rfind('/') + 1);  // without a slash, npos + 1 is 0
  const base::NameUnit unit = base::UnitAtEnd(name);
  // Without a known unit before "per", as in turns_per_s, the unit is 1 instead of 1/s.
  return unit.over.empty() ? "1" : unit.Text();
}

}  // namespace taut
