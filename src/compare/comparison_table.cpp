// Comparison as a table for a terminal. Channels whose names differ only in the middle share a
// heading, so that the rows fit into 100 characters:
//
//   cable/*/elastic_n [N]
//                     rmse      bias  max error     at s   lag s   corr     max a     max b   err %
//   inner_top_1     0.0821   -0.0132     -0.412    31.05   0.012  0.998    32.321    32.327   -0.02
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "compare/channel_groups.h"
#include "taut/compare.h"

namespace taut {
namespace {

using compare::Abridged;
using compare::Group;
using compare::GroupsOf;
using compare::GroupTitle;
using compare::HeadingAndRow;
using compare::Shown;

/// Formats a number with its significant digits, in a cell of `width` characters.
std::string Cell(double value, int width) {
  if (!std::isfinite(value)) return fmt::format("{:>{}}", "-", width);
  const double size = std::abs(value);
  if (size != 0.0 && (size >= 1e5 || size < 1e-4)) return fmt::format("{:>{}.2e}", value, width);
  const int decimals = size >= 1000.0 ? 1 : size >= 100.0 ? 2 : size >= 1.0 ? 3 : 4;
  return fmt::format("{:>{}.{}f}", value + 0.0, width, size == 0.0 ? 0 : decimals);  // no "-0"
}

std::string Fixed(double value, int width, int decimals) {
  if (!std::isfinite(value)) return fmt::format("{:>{}}", "-", width);
  return fmt::format("{:>{}.{}f}", Shown(value, decimals), width, decimals);
}

/// Formats the lag. Returns ">0.5" if it is at the limit of the search, since the delay may be
/// longer.
std::string LagCell(const ChannelComparison& channel, int width) {
  if (!channel.lag_at_limit) return Fixed(channel.lag_s, width, 3);
  const char* beyond = channel.lag_s < 0.0 ? "<" : ">";
  return fmt::format("{:>{}}", fmt::format("{}{:.3g}", beyond, channel.lag_s), width);
}

void AppendGroup(const Group& group, std::string& out) {
  out += fmt::format("\n{}\n{:<{}}{:>10}{:>10}{:>11}{:>9}{:>8}{:>7}{:>10}{:>10}{:>8}\n",
                     GroupTitle(group), "", group.name_width, "rmse", "bias", "max error", "at [s]",
                     "lag [s]", "corr", "max a", "max b", "err [%]");
  for (const auto& [name, channel] : group.rows) {
    out += fmt::format("{:<{}}", name, group.name_width);
    out += Cell(channel->rmse, 10) + Cell(channel->bias, 10) + Cell(channel->error.value, 11);
    out += Fixed(channel->error.time_s, 9, 2) + LagCell(*channel, 8);
    out += Fixed(channel->correlation, 7, 3);
    out += Cell(channel->max_a.value, 10) + Cell(channel->max_b.value, 10);
    out += Fixed(channel->max_error_percent, 8, 2) + "\n";
  }
}

/// Appends mean, minimum and maximum of both traces in one phase, and their differences.
void AppendPhase(const Group& group, const TimeWindow& phase, std::size_t index, std::string& out) {
  out += fmt::format("\n{}, {}: {:g} .. {:g} s\n", GroupTitle(group), phase.name, phase.from_s,
                     phase.to_s);
  out += fmt::format("{:<{}}{:>9}{:>9}{:>10}", "", group.name_width, "mean a", "mean b", "diff");
  out += fmt::format("{:>9}{:>9}{:>10}{:>9}{:>9}{:>10}\n", "min a", "min b", "diff", "max a",
                     "max b", "diff");
  for (const auto& [name, channel] : group.rows) {
    const auto& [a, b] = channel->phases[index];
    out += fmt::format("{:<{}}", name, group.name_width);
    for (const auto& [of_a, of_b] :
         {std::pair(a.mean, b.mean), std::pair(a.min, b.min), std::pair(a.max, b.max)}) {
      out += Cell(of_a, 9) + Cell(of_b, 9) + Cell(of_a - of_b, 10);
    }
    out += "\n";
  }
}

std::string SpanText(const TraceSpan& span) {
  if (span.rows == 0) return "no rows";
  return fmt::format("{} rows, {:g} .. {:g} s, every {:.4g} s", span.rows, span.first_s,
                     span.last_s, span.step_s);
}

/// Appends the time spans in which only one of the traces has rows.
void AppendAlone(const TraceSpan& one, const TraceSpan& other, const char* which,
                 std::string& out) {
  if (one.rows == 0 || other.rows == 0) return;
  const double half_s = 0.5 * one.step_s;
  std::string parts;
  if (one.first_s < other.first_s - half_s) {
    parts = fmt::format("{:g} .. {:g} s", one.first_s, std::min(one.last_s, other.first_s));
  }
  if (one.last_s > other.last_s + half_s) {
    parts += fmt::format("{}{:g} .. {:g} s", parts.empty() ? "" : " and ",
                         std::max(one.first_s, other.last_s), one.last_s);
  }
  if (!parts.empty()) out += fmt::format("only {} covers {}\n", which, parts);
}

/// Appends gaps between rows, the longest first if there are many.
void AppendGaps(const TraceSpan& span, const char* which, std::string& out) {
  if (span.gaps_s.empty()) return;
  auto gaps = span.gaps_s;
  constexpr std::size_t kMost = 5;
  if (gaps.size() > kMost) {
    std::stable_sort(gaps.begin(), gaps.end(), [](const auto& x, const auto& y) {
      return x.second - x.first > y.second - y.first;
    });
  }
  std::string spans;
  for (std::size_t i = 0; i < std::min(gaps.size(), kMost); ++i) {
    spans += fmt::format("{}{:g} .. {:g} s", i == 0 ? "" : ", ", gaps[i].first, gaps[i].second);
  }
  const std::string more =
      gaps.size() > kMost ? fmt::format(" and {} shorter gaps", gaps.size() - kMost) : "";
  out += fmt::format("gaps of {}, not compared: {}{}\n", which, spans, more);
}

/// Appends channels whose missing time exceeds the gaps of both traces.
void AppendMissing(const Comparison& comparison, std::string& out) {
  double known_s = 0;
  for (const TraceSpan* span : {&comparison.a, &comparison.b}) {
    for (const auto& [from_s, to_s] : span->gaps_s) {
      known_s +=
          std::max(0.0, std::min(to_s, comparison.to_s) - std::max(from_s, comparison.from_s));
    }
  }
  const double step_s = std::max(comparison.a.step_s, comparison.b.step_s);
  const double least_s = known_s > 0 ? known_s + 4 * step_s : 0.0;
  std::vector<std::pair<std::string, double>> missing;
  for (const ChannelComparison& c : comparison.channels) {
    if (c.missing_s > least_s) missing.emplace_back(c.name, c.missing_s);
  }
  if (missing.empty()) return;
  std::stable_sort(missing.begin(), missing.end(),
                   [](const auto& x, const auto& y) { return x.second > y.second; });
  out += fmt::format("channels with missing values ({}), seconds missing of {:g} s:\n",
                     missing.size(), comparison.to_s - comparison.from_s);
  constexpr std::size_t kMost = 8;
  for (std::size_t i = 0; i < std::min(missing.size(), kMost); ++i) {
    out += fmt::format("  {}: {:.4g} s\n", missing[i].first, missing[i].second);
  }
  if (missing.size() > kMost) out += fmt::format("  and {} more\n", missing.size() - kMost);
}

void AppendList(const std::string& title, const std::vector<std::string>& names, std::string& out) {
  if (names.empty()) return;
  std::string line = fmt::format("{} ({}):", title, names.size());
  const std::vector<std::string> items = Abridged(names);
  constexpr std::size_t kMost = 24;
  for (std::size_t i = 0; i < std::min(items.size(), kMost); ++i) {
    if (line.size() + items[i].size() > 98) {
      out += line + "\n";
      line = " ";
    }
    line += " " + items[i];
  }
  out += line + (items.size() > kMost ? " ...\n" : "\n");
}

}  // namespace

std::string ComparisonTable(const Comparison& comparison, const std::string& name_a,
                            const std::string& name_b) {
  std::string out = fmt::format("a: {} ({})\nb: {} ({}), the reference\n", name_a,
                                SpanText(comparison.a), name_b, SpanText(comparison.b));
  if (comparison.rows > 0) {
    out += fmt::format("compared: {:g} .. {:g} s, {} rows{}; differences are a - b\n",
                       comparison.from_s, comparison.to_s, comparison.rows,
                       comparison.resampled ? ", the finer trace interpolated" : "");
  }
  const std::vector<Group> groups = GroupsOf(comparison.channels);
  for (const Group& group : groups) AppendGroup(group, out);
  for (std::size_t i = 0; i < comparison.phases.size(); ++i) {
    for (const Group& group : groups) AppendPhase(group, comparison.phases[i], i, out);
  }
  if (!comparison.system.empty()) out += "\n";
  for (const SystemMaximum& system : comparison.system) {
    out += fmt::format("largest {}: error {:+.2f} %\n", system.pattern,
                       Shown(system.error_percent, 2));
    for (const auto& [which, extreme, channel] :
         {std::tuple("a", system.a, system.channel_a), {"b", system.b, system.channel_b}}) {
      out += fmt::format("  {} {:.4f} {} in {} at {:.2f} s\n", which, Shown(extreme.value, 4),
                         system.unit, HeadingAndRow(channel).second, extreme.time_s);
    }
  }
  out += "\n";
  AppendAlone(comparison.a, comparison.b, "a", out);
  AppendAlone(comparison.b, comparison.a, "b", out);
  AppendGaps(comparison.a, "a", out);
  AppendGaps(comparison.b, "b", out);
  AppendMissing(comparison, out);
  AppendList("signs not aligned (a component of the quaternion is missing)",
             comparison.unknown_signs, out);
  for (const compare::WrapWarning& warning : compare::WrapWarnings(comparison.wrapped_angles)) {
    AppendList(warning.title, warning.channels, out);
    out += "  " + warning.remedy + "\n";
  }
  AppendList("only in a", comparison.only_a, out);
  AppendList("only in b", comparison.only_b, out);
  if (!comparison.unit_conflicts.empty()) out += "units differ, not compared:\n";
  for (const std::string& conflict : comparison.unit_conflicts) out += "  " + conflict + "\n";
  while (out.ends_with("\n\n")) out.pop_back();
  return out;
}

}  // namespace taut
