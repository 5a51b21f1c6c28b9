#include <nlohmann/json.hpp>

#include "taut/compare.h"

namespace taut {
namespace {

using Json = nlohmann::ordered_json;  // keeps the order of keys; writes NaN as null

Json ToJson(const Extreme& extreme) {
  return {{"value", extreme.value}, {"time_s", extreme.time_s}};
}

Json ToJson(const WindowStatistics& window) {
  return {{"rows", window.rows}, {"mean", window.mean}, {"min", window.min}, {"max", window.max}};
}

Json ToJson(const TraceSpan& span, const std::string& name, const std::vector<std::string>& only) {
  Json gaps = Json::array();
  for (const auto& [from_s, to_s] : span.gaps_s) gaps.push_back({from_s, to_s});
  return {{"name", name},          {"rows", span.rows},     {"first_s", span.first_s},
          {"last_s", span.last_s}, {"step_s", span.step_s}, {"gaps_s", gaps},
          {"only_here", only}};
}

Json ToJson(const ChannelComparison& channel, const std::vector<TimeWindow>& windows) {
  Json phases = Json::object();
  for (std::size_t i = 0; i < channel.phases.size(); ++i) {
    const auto& [a, b] = channel.phases[i];
    phases[windows[i].name] = {
        {"a", ToJson(a)},
        {"b", ToJson(b)},
        {"difference",
         {{"mean", a.mean - b.mean}, {"min", a.min - b.min}, {"max", a.max - b.max}}}};
  }
  return {{"name", channel.name},
          {"unit", channel.unit},
          {"rows", channel.rows},
          {"missing_s", channel.missing_s},
          {"rmse", channel.rmse},
          {"bias", channel.bias},
          {"max_error", ToJson(channel.error)},
          {"lag_s", channel.lag_s},
          {"lag_at_limit", channel.lag_at_limit},
          {"correlation", channel.correlation},
          {"max_a", ToJson(channel.max_a)},
          {"max_b", ToJson(channel.max_b)},
          {"max_error_percent", channel.max_error_percent},
          {"phases", phases}};
}

Json ToJson(const SystemMaximum& system) {
  Json a = ToJson(system.a), b = ToJson(system.b);
  a["channel"] = system.channel_a;
  b["channel"] = system.channel_b;
  return {{"pattern", system.pattern},
          {"unit", system.unit},
          {"a", a},
          {"b", b},
          {"error_percent", system.error_percent}};
}

}  // namespace

std::string ComparisonJson(const Comparison& comparison, const std::string& name_a,
                           const std::string& name_b) {
  Json json;
  json["format_version"] = 1;
  json["a"] = ToJson(comparison.a, name_a, comparison.only_a);
  json["b"] = ToJson(comparison.b, name_b, comparison.only_b);
  json["from_s"] = comparison.from_s;
  json["to_s"] = comparison.to_s;
  json["rows"] = comparison.rows;
  json["resampled"] = comparison.resampled;
  json["unknown_signs"] = comparison.unknown_signs;
  json["wrapped_angles"] = Json::array();
  for (const WrappedAngle& angle : comparison.wrapped_angles) {
    json["wrapped_angles"].push_back(
        {{"name", angle.channel}, {"trace", angle.in_b ? "b" : "a"}, {"time_s", angle.time_s}});
  }
  json["unit_conflicts"] = comparison.unit_conflicts;
  json["phases"] = Json::array();
  for (const TimeWindow& phase : comparison.phases) {
    json["phases"].push_back(
        {{"name", phase.name}, {"from_s", phase.from_s}, {"to_s", phase.to_s}});
  }
  json["system"] = Json::array();
  for (const SystemMaximum& system : comparison.system) json["system"].push_back(ToJson(system));
  json["channels"] = Json::array();
  for (const ChannelComparison& channel : comparison.channels) {
    json["channels"].push_back(ToJson(channel, comparison.phases));
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace taut
