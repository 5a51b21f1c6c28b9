#include "taut/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "base/pattern.h"
#include "compare/channel_comparer.h"
#include "compare/common_clock.h"
#include "compare/wrapped_angle.h"

namespace taut {
namespace {

using compare::CommonClock;
using compare::Percent;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::vector<SystemMaximum> SystemMaxima(const std::vector<ChannelComparison>& channels,
                                        const std::vector<std::string>& patterns) {
  std::vector<SystemMaximum> result;
  for (const std::string& pattern : patterns) {
    SystemMaximum system{pattern, "", "", "", {kNan, kNan}, {kNan, kNan}, kNan};
    bool any = false;
    for (const ChannelComparison& channel : channels) {
      if (!base::Fits(pattern, channel.name)) continue;
      any = true;
      system.unit = channel.unit;
      if (channel.max_a.value > system.a.value || std::isnan(system.a.value)) {
        system.a = channel.max_a;
        system.channel_a = channel.name;
      }
      if (channel.max_b.value > system.b.value || std::isnan(system.b.value)) {
        system.b = channel.max_b;
        system.channel_b = channel.name;
      }
    }
    system.error_percent = Percent(system.a.value, system.b.value);
    if (any) result.push_back(std::move(system));
  }
  return result;
}

std::unordered_map<std::string, std::size_t> IndexOf(const Trace& trace) {
  std::unordered_map<std::string, std::size_t> index;
  for (std::size_t i = 0; i < trace.channels.size(); ++i) index.emplace(trace.channels[i].name, i);
  return index;
}

/// Returns whether one of the traces lacks a component of the channel's quaternion.
bool SignUnknown(const std::string& channel, const std::unordered_map<std::string, std::size_t>& a,
                 const std::unordered_map<std::string, std::size_t>& b) {
  const std::vector<std::string> names = compare::QuaternionNames(channel);
  return std::any_of(names.begin(), names.end(), [&](const std::string& name) {
    return !a.contains(name) || !b.contains(name);
  });
}

void AddWraps(const Trace& trace, std::size_t channel, bool in_b, Comparison& result) {
  const auto row = compare::FindWrap(trace.channels[channel], trace.values[channel]);
  if (!row) return;
  result.wrapped_angles.push_back({trace.channels[channel].name, in_b, trace.time_s[*row]});
}

}  // namespace

Comparison Compare(const Trace& a, const Trace& b, const CompareOptions& options) {
  const CommonClock clock = compare::MakeCommonClock(a.time_s, b.time_s, options);
  Comparison result;
  result.a = compare::SpanOf(a.time_s);
  result.b = compare::SpanOf(b.time_s);
  result.from_s = clock.from_s;
  result.to_s = clock.to_s;
  result.rows = clock.time_s.size();
  result.resampled = clock.resample_a || clock.resample_b;
  result.phases = options.phases;

  const auto index_a = IndexOf(a), index_b = IndexOf(b);
  for (const ChannelInfo& channel : b.channels) {
    if (!index_a.contains(channel.name) && base::FitsAny(options.channels, channel.name)) {
      result.only_b.push_back(channel.name);
    }
  }
  std::optional<compare::ChannelComparer> comparer;
  if (result.rows > 0) comparer.emplace(a, b, options, clock);
  for (std::size_t i = 0; i < a.channels.size(); ++i) {
    const ChannelInfo& channel = a.channels[i];
    if (!base::FitsAny(options.channels, channel.name)) continue;
    const auto in_b = index_b.find(channel.name);
    if (in_b == index_b.end()) {
      result.only_a.push_back(channel.name);
    } else if (const std::string& unit = b.channels[in_b->second].unit; unit != channel.unit) {
      result.unit_conflicts.push_back(
          fmt::format("{}: {} against {}", channel.name, channel.unit, unit));
    } else if (comparer) {
      if (SignUnknown(channel.name, index_a, index_b)) result.unknown_signs.push_back(channel.name);
      result.channels.push_back(comparer->Compare(i, in_b->second));
      AddWraps(a, i, false, result);
      AddWraps(b, in_b->second, true, result);
    }
  }
  result.system = SystemMaxima(result.channels, options.system);
  return result;
}

}  // namespace taut
