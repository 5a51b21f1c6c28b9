#include "compare/wrapped_angle.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace taut::compare {
namespace {

/// Smallest jump that counts as a wrap [turns]. The rest of a turn is motion between two rows.
constexpr double kLeastJump = 0.75;
/// Largest range of a wrapped angle [turns]. Text files may round -180 and 180 degrees outward.
constexpr double kMostRange = 1.01;

/// Returns a full turn in the unit of a channel; 0 if the channel is not an angle.
double TurnIn(const ChannelInfo& channel) {
  if (channel.unit == "rad") return 2.0 * std::numbers::pi;
  return channel.unit == "deg" || channel.name.ends_with("_deg") ? 360.0 : 0.0;
}

}  // namespace

double NearestTurn(double value, double to, double period) {
  const double turns = std::round((to - value) / period);
  return std::isfinite(turns) && turns != 0.0 ? value + turns * period : value;
}

void Unwrap(std::vector<double>& values, double period) {
  std::optional<double> last;
  for (double& value : values) {
    if (!std::isfinite(value)) continue;
    if (last) value = NearestTurn(value, *last, period);
    last = value;
  }
}

void AlignTurns(const std::vector<double>& to, double period, std::vector<double>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = NearestTurn(values[i], to[i], period);
}

void Unwrap(Trace& trace) {
  for (std::size_t c = 0; c < trace.channels.size(); ++c) {
    if (trace.channels[c].period > 0) Unwrap(trace.values[c], trace.channels[c].period);
  }
}

std::optional<std::size_t> FindWrap(const ChannelInfo& channel, const std::vector<double>& values) {
  const double turn = TurnIn(channel);
  if (turn == 0.0 || channel.period > 0.0) return std::nullopt;
  std::optional<std::size_t> last, jump;
  double least = INFINITY, most = -INFINITY;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) continue;
    least = std::min(least, values[i]), most = std::max(most, values[i]);
    if (last && !jump && std::abs(values[i] - values[*last]) >= kLeastJump * turn) jump = last;
    last = i;
  }
  return most - least <= kMostRange * turn ? jump : std::nullopt;
}

}  // namespace taut::compare
