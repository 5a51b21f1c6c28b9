#include "identify/sensor_errors.h"

#include <algorithm>
#include <map>

#include "base/pattern.h"
#include "compare/channel_groups.h"

namespace taut::identify {
namespace {

/// Returns the pattern of all channels with the kind and the quantity of a channel, such as
/// "cable/*/tension_n".
std::string KindOf(const std::string& channel) {
  const bool has_member = channel.find('/') != channel.rfind('/');
  return has_member ? compare::HeadingAndRow(channel).first : channel;
}

bool IsEstimated(const FitSpec& spec, FitEstimate::Kind kind, const std::string& channel) {
  return std::any_of(spec.estimates.begin(), spec.estimates.end(), [&](const FitEstimate& e) {
    return e.kind == kind && base::Fits(e.channels, channel);
  });
}

}  // namespace

std::vector<FitAlias> SensorErrors(const FitSpec& spec, const std::vector<FitPoint>& points,
                                   const std::vector<double>& residual) {
  std::map<std::string, FitAlias> errors;
  std::map<std::string, bool> estimated;
  const auto add = [&](FitEstimate::Kind kind, const std::string& pattern, std::size_t i) {
    const FitPoint& p = points[i];
    const bool gain = kind == FitEstimate::Kind::kGain;
    const std::string name = (gain ? "gain " : "offset ") + pattern;
    estimated[name] = estimated[name] || IsEstimated(spec, kind, p.channel);
    FitAlias& alias = errors[name];
    alias.name = name, alias.unit = gain ? "" : p.unit, alias.neutral = gain ? 1 : 0;
    alias.slope.resize(points.size());
    // Slopes of residual = (gain * computed + offset - measured) / sd at gain 1 and offset 0
    alias.slope[i] = gain ? p.measured / p.sd + residual[i] : 1 / p.sd;
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::string kind = KindOf(points[i].channel);
    if (points[i].unit == "N") add(FitEstimate::Kind::kGain, "*_n", i);
    if (points[i].unit == "N" || points[i].unit == "m" || points[i].unit == "rad") {
      add(FitEstimate::Kind::kOffset, kind, i);
    }
  }
  std::vector<FitAlias> out;
  for (auto& [name, alias] : errors) {
    if (!estimated[name]) out.push_back(std::move(alias));
  }
  return out;
}

}  // namespace taut::identify
