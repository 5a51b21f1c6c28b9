#include "trace/channel_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

namespace taut::trace {
namespace {

/// Longer suffixes stand before those that they end with.
constexpr std::pair<std::string_view, std::string_view> kUnits[] = {
    {"_m_per_s2", "m/s^2"},
    {"_m_per_s", "m/s"},
    {"_rad_per_s", "rad/s"},
    {"_n_per_m", "N/m"},
    {"_n_s_per_m", "N s/m"},
    {"_n_m", "N m"},
    {"_rad", "rad"},
    {"_kg", "kg"},
    {"_hz", "Hz"},
    {"_m", "m"},
    {"_n", "N"},
    {"_j", "J"},
    {"_s", "s"},
};

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

std::string UnitOfName(std::string_view name) {
  for (const auto& [suffix, unit] : kUnits) {
    if (name.ends_with(suffix)) return std::string(unit);
  }
  return "1";
}

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
