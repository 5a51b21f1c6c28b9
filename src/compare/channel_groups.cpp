#include "compare/channel_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace taut::compare {

std::pair<std::string, std::string> HeadingAndRow(const std::string& name) {
  const std::size_t first = name.find('/');
  if (first == name.npos) return {"", name};
  const std::size_t last = name.rfind('/');
  if (first == last) return {name.substr(0, first) + "/*", name.substr(first + 1)};
  return {name.substr(0, first) + "/*" + name.substr(last),
          name.substr(first + 1, last - first - 1)};
}

std::vector<Group> GroupsOf(const std::vector<ChannelComparison>& channels) {
  std::vector<Group> groups;
  for (const ChannelComparison& channel : channels) {
    auto [heading, row] = HeadingAndRow(channel.name);
    auto group = std::find_if(groups.begin(), groups.end(),
                              [&, &name = heading](const Group& g) { return g.heading == name; });
    if (group == groups.end()) {
      groups.push_back({heading, {}});
      group = groups.end() - 1;
    }
    group->name_width = std::max(group->name_width, row.size());
    group->rows.emplace_back(std::move(row), &channel);
  }
  return groups;
}

std::string GroupTitle(const Group& group) {
  const std::string& unit = group.rows.front().second->unit;
  const bool one_unit = std::all_of(group.rows.begin(), group.rows.end(),
                                    [&](const auto& row) { return row.second->unit == unit; });
  return one_unit ? fmt::format("{} [{}]", group.heading, unit) : group.heading;
}

std::vector<std::string> Abridged(const std::vector<std::string>& names) {
  std::vector<std::pair<std::string, int>> counts;
  std::vector<std::string> first;
  for (const std::string& name : names) {
    const std::string heading = HeadingAndRow(name).first;
    const auto known = std::find_if(counts.begin(), counts.end(),
                                    [&](const auto& count) { return count.first == heading; });
    if (known != counts.end() && !heading.empty()) {
      ++known->second;
    } else {
      counts.emplace_back(heading, 1);
      first.push_back(name);
    }
  }
  for (std::size_t i = 0; i < first.size(); ++i) {
    if (counts[i].second > 1) first[i] = fmt::format("{} ({})", counts[i].first, counts[i].second);
  }
  return first;
}

std::vector<WrapWarning> WrapWarnings(const std::vector<WrappedAngle>& angles) {
  std::vector<WrapWarning> warnings;
  for (const bool in_b : {false, true}) {
    std::vector<std::string> names;
    double first_s = INFINITY;
    for (const WrappedAngle& angle : angles) {
      if (angle.in_b != in_b) continue;
      names.push_back(angle.channel);
      first_s = std::min(first_s, angle.time_s);
    }
    if (names.empty()) continue;
    warnings.push_back(
        {fmt::format("warning: angles of {} that jump by a turn, first at {:g} s", in_b ? "b" : "a",
                     first_s),
         fmt::format("if they wrap, set \"wrap\": \"turn\" in their rule of a mapping ({})",
                     in_b ? "--map" : "--map_a"),
         std::move(names)});
  }
  return warnings;
}

std::string FourDigits(double value) {
  return std::isfinite(value) ? fmt::format("{:.4g}", value) : "-";
}

double Shown(double value, int decimals) {
  return std::abs(value) < 0.5 * std::pow(10.0, -decimals) ? 0.0 : value;
}

}  // namespace taut::compare
