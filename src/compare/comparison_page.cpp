// Comparison of two runs, or of a simulation with a measurement, as a self-contained HTML page.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/channel_groups.h"
#include "compare/common_clock.h"
#include "compare/gaps.h"
#include "compare/plot.h"
#include "taut/compare.h"
#include "taut/version.h"

namespace taut {
namespace {

constexpr std::size_t kMostPlots = 24, kMostPoints = 400;

/// Returns at most kMostPoints rows of a channel in the common time.
compare::Points Rows(const Trace& trace, std::size_t channel, const Comparison& comparison) {
  compare::Points all;
  for (std::size_t i = 0; i < trace.time_s.size(); ++i) {
    const double t = trace.time_s[i];
    if (t < comparison.from_s || t > comparison.to_s) continue;
    all.emplace_back(t, trace.values[channel][i]);
  }
  return compare::Thinned(all, kMostPoints);
}

/// Returns one bar per channel for its bias (filled) and its RMSE (outline).
std::string Bars(const compare::Group& group) {
  double most = 0;
  for (const auto& [name, c] : group.rows) {
    if (std::isfinite(c->rmse)) most = std::max({most, c->rmse, std::fabs(c->bias)});
  }
  if (!(most > 0)) return {};
  constexpr double kRow = 18, kNames = 160, kHalf = 150;
  const double height = kRow * static_cast<double>(group.rows.size()) + 30, zero = kNames + kHalf;
  std::string out = fmt::format(
      R"(<svg viewBox="0 0 480 {0}" width="480" height="{0}" role="img" aria-label="bias and RMSE">)"
      R"(<text class="title" x="8" y="16">bias (filled) and RMSE (outline)</text>)",
      height);
  double y = 26;
  for (const auto& [name, c] : group.rows) {
    if (!std::isfinite(c->rmse)) continue;
    const double bias = kHalf * c->bias / most, rmse = kHalf * c->rmse / most;
    out +=
        fmt::format(R"(<text class="tick" x="{:.1f}" y="{:.1f}" text-anchor="end">{}</text>)"
                    R"(<rect x="{:.1f}" y="{:.1f}" width="{:.1f}" height="12" class="outline"/>)"
                    R"(<rect x="{:.1f}" y="{:.1f}" width="{:.1f}" height="12" class="interval"/>)",
                    kNames - 6, y + 10, compare::Escaped(name), zero - rmse, y, 2 * rmse,
                    std::min(zero, zero + bias), y, std::fabs(bias));
    y += kRow;
  }
  return out +
         fmt::format(R"(<line class="level" x1="{0}" y1="22" x2="{0}" y2="{1:.1f}"/></svg>)", zero,
                     y) +
         "\n";
}

std::string GroupTable(const compare::Group& group) {
  std::vector<std::vector<std::string>> rows{{"channel", "RMSE", "bias", "max error", "at [s]",
                                              "lag [s]", "correlation", "max a", "max b"}};
  for (const auto& [name, c] : group.rows) {
    rows.push_back({name, compare::FourDigits(c->rmse), compare::FourDigits(c->bias),
                    compare::FourDigits(c->error.value), compare::FourDigits(c->error.time_s),
                    (c->lag_at_limit ? ">" : "") + compare::FourDigits(c->lag_s),
                    compare::FourDigits(c->correlation), compare::FourDigits(c->max_a.value),
                    compare::FourDigits(c->max_b.value)});
  }
  return compare::HtmlTable(rows);
}

/// Returns the values of b over the values of a, with the line of equality.
std::string Scatter(const compare::Group& group, const Trace& a, const Trace& b,
                    const Comparison& comparison, bool measured) {
  compare::Plot plot{compare::GroupTitle(group),
                     measured ? "a (simulated)" : "a",
                     measured ? "b (measured)" : "b",
                     {{"fitted", {}, true}, {"held", {}}},
                     {},
                     {}};
  const std::vector<bool> gaps = compare::FindGaps(a.time_s);
  double low = INFINITY, high = -INFINITY;
  for (const auto& [name, c] : group.rows) {
    const auto in_a = a.Find(c->name), in_b = b.Find(c->name);
    if (!in_a || !in_b) continue;
    std::vector<double> times_s;
    const auto of_b = Rows(b, *in_b, comparison);
    for (const auto& point : of_b) times_s.push_back(point.first);
    const auto of_a = compare::Interpolate(a.time_s, a.values[*in_a], gaps, times_s);
    for (std::size_t i = 0; i < of_b.size(); ++i) {
      const double x = of_a[i], y = of_b[i].second;
      if (!std::isfinite(x) || !std::isfinite(y)) continue;
      plot.series[1].points.emplace_back(x, y);
      low = std::min(low, x), high = std::max(high, x);
    }
  }
  compare::Points& points = plot.series[1].points;
  if (points.empty()) return {};
  points = compare::Thinned(points, 4 * kMostPoints);
  plot.series[0].points = {{low, low}, {high, high}};
  return compare::Svg(plot);
}

std::string Curves(const compare::Group& group, const Trace& a, const Trace& b,
                   const Comparison& comparison, std::size_t& plots) {
  std::string out;
  for (const auto& [name, c] : group.rows) {
    const auto in_a = a.Find(c->name), in_b = b.Find(c->name);
    if (!in_a || !in_b || ++plots > kMostPlots) continue;
    const std::string unit = c->unit.empty() || c->unit == "1" ? "" : " [" + c->unit + "]";
    out += compare::Svg(
        {c->name + unit,
         "time [s]",
         "",
         {{"fitted", Rows(a, *in_a, comparison), true}, {"held", Rows(b, *in_b, comparison)}},
         {},
         {}});
  }
  return out;
}

}  // namespace

std::string ComparisonPage(const Comparison& comparison, const Trace& a, const Trace& b,
                           const std::string& name_a, const std::string& name_b, bool measured) {
  const std::string title = measured ? "Simulation and measurement" : "Two runs";
  std::string out = compare::PageHead(title, "comparison") +
                    "<p class=\"note\">a: " + compare::Escaped(name_a) +
                    ", b: " + compare::Escaped(name_b) + "; differences are a - b; taut " +
                    kVersion + "</p>\n<div class=\"verdict\">";
  for (const std::string& line : measured ? MeasuredVerdict(comparison, name_a, name_b)
                                          : ComparisonLines(comparison, name_a, name_b)) {
    out += compare::Escaped(line) + "<br>\n";
  }
  out += fmt::format(
      "</div>\n<p class=\"key\"><span><i class=\"dot fitted\"></i>a{}</span>"
      "<span><i class=\"dot held\"></i>b{}</span></p>\n",
      measured ? ", simulated" : "", measured ? ", measured" : "");
  std::size_t plots = 0;
  for (const compare::Group& group : compare::GroupsOf(comparison.channels)) {
    out += "<h2>" + compare::Escaped(compare::GroupTitle(group)) + "</h2>\n";
    out += GroupTable(group) + Bars(group) + Scatter(group, a, b, comparison, measured) + "<br>\n" +
           Curves(group, a, b, comparison, plots);
  }
  if (plots > kMostPlots) {
    out +=
        fmt::format("<p class=\"note\">{} more channels without curves</p>\n", plots - kMostPlots);
  }
  return out + "</main></body></html>\n";
}

}  // namespace taut
