// Comparison as a short text: the verdict, then one line per group of channels.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/channel_groups.h"
#include "taut/compare.h"

namespace taut {
namespace {

bool IsEqual(const ChannelComparison& channel) {
  return channel.rmse == 0 && channel.error.value == 0 && channel.missing_s == 0;
}

std::string Verdict(const Comparison& comparison, const std::string& name_a,
                    const std::string& name_b) {
  const std::string both = name_a + " and " + name_b;
  if (comparison.rows == 0) return both + " have no time in common";
  if (comparison.channels.empty()) return both + " have no channel in common";
  const auto equal = std::count_if(comparison.channels.begin(), comparison.channels.end(), IsEqual);
  const std::size_t all = comparison.channels.size();
  if (static_cast<std::size_t>(equal) == all) {
    return fmt::format("{} are equal: {} channels, {} rows", both, all, comparison.rows);
  }
  return fmt::format("{} differ in {} of {} channels", both, all - static_cast<std::size_t>(equal),
                     all);
}

/// Returns the channel with the largest `size`. Undefined sizes count as 0.
template <class Measure>
const std::pair<std::string, const ChannelComparison*>& Largest(const compare::Group& group,
                                                                const Measure& size) {
  const auto of = [&](const auto& row) {
    const double x = size(*row.second);
    return std::isfinite(x) ? x : 0.0;
  };
  return *std::max_element(group.rows.begin(), group.rows.end(),
                           [&](const auto& a, const auto& b) { return of(a) < of(b); });
}

std::string GroupLine(const compare::Group& group) {
  const auto& [rmse_name, rmse] = Largest(group, [](const ChannelComparison& c) { return c.rmse; });
  const auto& [error_name, error] =
      Largest(group, [](const ChannelComparison& c) { return std::abs(c.error.value); });
  if (group.rows.size() == 1) {
    return fmt::format("{}, {}: RMSE {}, bias {}, largest difference {} at {:.2f} s",
                       compare::GroupTitle(group), rmse_name, compare::FourDigits(rmse->rmse),
                       compare::FourDigits(rmse->bias), compare::FourDigits(error->error.value),
                       error->error.time_s);
  }
  return fmt::format("{}: {} channels, RMSE at most {} ({}), largest difference {} ({}, {:.2f} s)",
                     compare::GroupTitle(group), group.rows.size(), compare::FourDigits(rmse->rmse),
                     rmse_name, compare::FourDigits(error->error.value), error_name,
                     error->error.time_s);
}

/// Returns a line with the largest difference of the means in a phase.
std::string PhaseLine(const compare::Group& group, const TimeWindow& phase, std::size_t index) {
  const auto difference = [&](const ChannelComparison& c) {
    return c.phases[index].a.mean - c.phases[index].b.mean;
  };
  const auto& [name, channel] =
      Largest(group, [&](const ChannelComparison& c) { return std::abs(difference(c)); });
  return fmt::format("{}, {}: mean a {}, b {}, difference {} ({})", compare::GroupTitle(group),
                     phase.name, compare::FourDigits(channel->phases[index].a.mean),
                     compare::FourDigits(channel->phases[index].b.mean),
                     compare::FourDigits(difference(*channel)), name);
}

std::string ListLine(const std::string& title, const std::vector<std::string>& names) {
  std::string line = fmt::format("{} ({}):", title, names.size());
  constexpr std::size_t kLongest = 90;
  for (const std::string& item : compare::Abridged(names)) {
    if (line.size() + item.size() > kLongest) return line + " ...";
    line += " " + item;
  }
  return line;
}

}  // namespace

std::vector<std::string> ComparisonLines(const Comparison& comparison, const std::string& name_a,
                                         const std::string& name_b) {
  std::vector<std::string> lines{Verdict(comparison, name_a, name_b)};
  if (comparison.rows == 0) return lines;
  for (const compare::WrapWarning& warning : compare::WrapWarnings(comparison.wrapped_angles)) {
    lines.push_back(ListLine(warning.title, warning.channels));
    lines.push_back(warning.remedy);
  }
  for (const SystemMaximum& system : comparison.system) {
    lines.push_back(fmt::format(
        "largest {}: error {:+.2f} %; a {:.4f} {} in {}, b {:.4f} {} in {}", system.pattern,
        compare::Shown(system.error_percent, 2), compare::Shown(system.a.value, 4), system.unit,
        compare::HeadingAndRow(system.channel_a).second, compare::Shown(system.b.value, 4),
        system.unit, compare::HeadingAndRow(system.channel_b).second));
  }
  lines.push_back(fmt::format("compared: {:g} .. {:g} s, {} rows{}; differences are a - b",
                              comparison.from_s, comparison.to_s, comparison.rows,
                              comparison.resampled ? ", the finer trace interpolated" : ""));
  const auto list = [&](const char* title, const std::vector<std::string>& names) {
    if (!names.empty()) lines.push_back(ListLine(title, names));
  };
  list("only in a", comparison.only_a);
  list("only in b", comparison.only_b);
  list("units differ, not compared", comparison.unit_conflicts);
  list("quaternion signs not aligned", comparison.unknown_signs);
  const std::size_t gaps = comparison.a.gaps_s.size() + comparison.b.gaps_s.size();
  if (gaps > 0) lines.push_back(fmt::format("gaps, not compared: {}", gaps));
  const auto missing = std::count_if(comparison.channels.begin(), comparison.channels.end(),
                                     [](const ChannelComparison& c) { return c.missing_s > 0; });
  if (missing > 0) lines.push_back(fmt::format("channels with missing values: {}", missing));
  const std::vector<compare::Group> groups = compare::GroupsOf(comparison.channels);
  for (std::size_t i = 0; i < comparison.phases.size(); ++i) {
    for (const compare::Group& group : groups) {
      lines.push_back(PhaseLine(group, comparison.phases[i], i));
    }
  }
  for (const compare::Group& group : groups) lines.push_back(GroupLine(group));
  return lines;
}

}  // namespace taut
