// Verdict on a comparison of a simulation (a) with a measurement (b): the largest errors, and
// patterns that suggest their cause.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/channel_groups.h"
#include "taut/compare.h"

namespace taut {
namespace {

/// A bias explains an error if it is at least this share of the RMSE, in all channels.
constexpr double kMostlyBias = 0.7;
/// Smallest correlation at which the lag of a channel counts, and largest RMS of the difference at
/// this lag, relative to the RMS without lag.
constexpr double kCorrelated = 0.5, kCloser = 0.9;

double MedianOf(std::vector<double> values) {
  if (values.empty()) return NAN;
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

/// RMSE relative to the largest measured magnitude; 0 if undefined.
double Relative(const ChannelComparison& c) {
  const double size = std::fabs(c.max_b.value);
  return std::isfinite(c.rmse) && size > 0 ? c.rmse / size : 0;
}

/// Returns the group whose median relative RMSE is largest.
const compare::Group& Worst(const std::vector<compare::Group>& groups) {
  const auto of = [](const compare::Group& group) {
    std::vector<double> all;
    for (const auto& [name, c] : group.rows) all.push_back(Relative(*c));
    return MedianOf(all);
  };
  return *std::max_element(groups.begin(), groups.end(),
                           [&](const auto& a, const auto& b) { return of(a) < of(b); });
}

std::string ErrorLine(const compare::Group& group) {
  std::vector<double> rmse, bias, relative;
  const std::pair<std::string, const ChannelComparison*>* worst = &group.rows.front();
  for (const auto& row : group.rows) {
    const ChannelComparison& c = *row.second;
    if (!std::isfinite(c.rmse)) continue;
    rmse.push_back(c.rmse);
    bias.push_back(c.bias);
    if (c.max_b.value != 0) relative.push_back(100 * c.bias / std::fabs(c.max_b.value));
    if (c.rmse > worst->second->rmse || !std::isfinite(worst->second->rmse)) worst = &row;
  }
  if (rmse.empty()) return compare::GroupTitle(group) + ": no values to compare";
  const auto [least, most] = std::minmax_element(rmse.begin(), rmse.end());
  const double share = MedianOf(relative);
  const std::string size =
      std::isfinite(share) ? fmt::format(" ({:+.2g} % of the largest value)", share) : "";
  if (rmse.size() == 1) {
    return fmt::format("{}, {}: bias {}{}, RMSE {}", compare::GroupTitle(group), worst->first,
                       compare::FourDigits(bias[0]), size, compare::FourDigits(rmse[0]));
  }
  return fmt::format("{}: median bias {}{}, RMSE {} to {}, worst {}", compare::GroupTitle(group),
                     compare::FourDigits(MedianOf(bias)), size, compare::FourDigits(*least),
                     compare::FourDigits(*most), worst->first);
}

/// Returns the sign pattern of the biases and a cause that it suggests; empty without a pattern.
std::string BiasLine(const compare::Group& group) {
  std::size_t above = 0, below = 0, constant = 0;
  for (const auto& [name, c] : group.rows) {
    if (!std::isfinite(c->rmse) || c->rmse == 0) continue;
    above += c->bias > 0 ? 1 : 0;
    below += c->bias < 0 ? 1 : 0;
    constant += std::fabs(c->bias) >= kMostlyBias * c->rmse ? 1 : 0;
  }
  const std::size_t all = above + below;
  if (all < 2 || (above > 0 && below > 0) || constant < all) return {};
  const bool forces = group.rows.front().second->unit == "N";
  return fmt::format("a is {} in all {} channels by a nearly constant amount: check {}",
                     above > 0 ? "larger" : "smaller", all,
                     forces ? "the prestress, and the zero and gain of the load cells"
                            : "the placement of the robot and of the camera");
}

/// Returns the common lag; empty if there is none.
std::string LagLine(const compare::Group& group, double step_s) {
  std::vector<double> lags;
  for (const auto& [name, c] : group.rows) {
    const bool closer = c->lag_rms_ratio < kCloser;
    if (std::isfinite(c->lag_s) && c->correlation > kCorrelated && closer && !c->lag_at_limit) {
      lags.push_back(c->lag_s);
    }
  }
  const double lag_s = MedianOf(lags);
  if (2 * lags.size() <= group.rows.size() || !(std::fabs(lag_s) > step_s)) return {};
  return fmt::format("b is {} than a by {:.3g} s (median of {}): check the clock of the log",
                     lag_s > 0 ? "later" : "earlier", std::fabs(lag_s), lags.size());
}

}  // namespace

std::vector<std::string> MeasuredVerdict(const Comparison& comparison, const std::string& name_a,
                                         const std::string& name_b) {
  if (comparison.rows == 0 || comparison.channels.empty()) return {};
  const std::size_t measured = comparison.channels.size() + comparison.only_b.size();
  std::vector<std::string> lines{fmt::format(
      "{} (a) against {} (b): {} of {} measured channels, {:g} .. {:g} s, {:.4g} rows per second",
      name_a, name_b, comparison.channels.size(), measured, comparison.from_s, comparison.to_s,
      comparison.b.step_s > 0 ? 1 / comparison.b.step_s : 0.0)};
  const std::vector<compare::Group> groups = compare::GroupsOf(comparison.channels);
  const compare::Group& worst = Worst(groups);
  lines.push_back(ErrorLine(worst));
  for (const std::string& line :
       {BiasLine(worst), LagLine(worst, std::max(comparison.a.step_s, comparison.b.step_s))}) {
    if (!line.empty()) lines.push_back(line);
  }
  return lines;
}

}  // namespace taut
