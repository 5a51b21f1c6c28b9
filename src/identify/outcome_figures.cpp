#include "identify/outcome_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "compare/plot.h"
#include "identify/labels.h"

namespace taut::identify {
namespace {

using compare::Axis;
using compare::Escaped;
using compare::Plot;

constexpr double kNormal95 = 1.96;  // half of a 95 % interval, in standard deviations

/// Returns the reason of a verdict in a few words.
const char* ReasonOf(FitJudgement judgement, bool held_out) {
  switch (judgement) {
    case FitJudgement::kGood:
      return held_out ? "agrees with held-out data" : "agrees with the data";
    case FitJudgement::kRejected:
      return "residuals exceed the measurement errors";
    case FitJudgement::kContradiction:
      return "experiments fitted alone disagree";
    case FitJudgement::kUnidentifiable:
      return "data do not determine all parameters";
    case FitJudgement::kUnreliable:
      return "results contradict a standard error";
    case FitJudgement::kWorse:
      return "untuned values agree better";
    case FitJudgement::kNone:
      break;
  }
  return "the search did not end";
}

std::string Capitalized(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] -= 'a' - 'A';
  return text;
}

compare::Card ErrorCard(const char* label, const FitErrors& errors) {
  return {label, FiveDigits(errors.fitted), "rms [sd], untuned " + FiveDigits(errors.untuned), ""};
}

struct Interval {
  double low, high;
};

struct Bar {
  std::string name, text;
  double start, value;
  Interval estimate, prior;  ///< Not finite: unknown or unlimited.
};

Bar BarOf(const FitParameter& p, const ParameterVerdict& v) {
  const double error = kNormal95 * v.error(), spread = kNormal95 * p.prior_sd;
  const double mean = p.prior_mean.value_or(p.start);
  const std::string error_text =
      std::isfinite(v.error()) ? " ± " + ErrorText(v.error()) : ", not determined";
  return {WithUnit(p.name, p.unit),           FiveDigits(v.value) + error_text, p.start, v.value,
          {v.value - error, v.value + error}, {mean - spread, mean + spread}};
}

constexpr double kNames = 230, kScale = 420, kText = 170, kRow = 34;

std::string Rectangle(const char* style, double from, double to, double y, double height) {
  return fmt::format(
      R"(<rect class="{}" x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{}" rx="2"/>)", style, from,
      y - 0.5 * height, std::max(1.0, to - from), height);
}

std::string BarRow(const Bar& bar, double y) {
  Axis scale;
  scale.Take(bar.start), scale.Take(bar.value);
  for (const Interval& one : {bar.estimate, bar.prior}) {
    if (std::isfinite(one.low)) scale.Take(one.low), scale.Take(one.high);
  }
  scale.Widen(0.06);
  scale.from = kNames, scale.to = kNames + kScale;
  std::string out =
      fmt::format(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="end">{}</text>)"
                  R"(<line class="axis" x1="{:.1f}" y1="{:.1f}" x2="{:.1f}" y2="{:.1f}"/>)",
                  scale.from - 12, y + 4, Escaped(bar.name), scale.from, y, scale.to, y);
  if (std::isfinite(bar.prior.low)) {
    out += Rectangle("prior", scale.At(bar.prior.low), scale.At(bar.prior.high), y, 18);
  }
  const bool limited = std::isfinite(bar.estimate.low);
  out += Rectangle("interval", limited ? scale.At(bar.estimate.low) : scale.from,
                   limited ? scale.At(bar.estimate.high) : scale.to, y, 6);
  out += fmt::format(R"(<line class="start" x1="{0:.1f}" y1="{1:.1f}" x2="{0:.1f}" y2="{2:.1f}"/>)"
                     R"(<circle class="fitted" cx="{3:.1f}" cy="{4:.1f}" r="5"/>)"
                     R"(<text x="{5:.1f}" y="{6:.1f}">{7}</text>)",
                     scale.At(bar.start), y - 9, y + 9, scale.At(bar.value), y, scale.to + 12,
                     y + 4, Escaped(bar.text));
  return out;
}

/// Data of a channel in one experiment: measured and computed values against time.
struct ChannelPlot {
  Plot plot;
  std::vector<const FitPoint*> points;
  compare::Points measured, untuned, fitted;
};

/// Draws measured and computed values of a few data with the same unit on one scale.
std::string FewData(const std::string& unit, const std::vector<const ChannelPlot*>& channels) {
  constexpr double kNamesHere = 300, kLine = 22;
  Axis scale;
  std::size_t rows = 0;
  for (const ChannelPlot* channel : channels) {
    for (std::size_t i = 0; i < channel->points.size(); ++i, ++rows) {
      const FitPoint& p = *channel->points[i];
      scale.Take(p.measured - kNormal95 * p.sd), scale.Take(p.measured + kNormal95 * p.sd);
      scale.Take(channel->fitted[i].second);
      if (i < channel->untuned.size()) scale.Take(channel->untuned[i].second);
    }
  }
  if (!std::isfinite(scale.low) || !std::isfinite(scale.high)) return {};
  scale.Widen(0.04);
  scale.from = kNamesHere, scale.to = kNamesHere + kScale;
  const double bottom = kLine * static_cast<double>(rows) + 12;
  const double width = scale.to + 30, height = bottom + 34;
  std::string out = fmt::format(
      R"(<svg viewBox="0 0 {0} {1}" width="{0}" height="{1}" role="img" aria-label="measured and computed values">)",
      width, height);
  for (const double t : compare::Ticks(scale.low, scale.high)) {
    out += fmt::format(R"(<line class="grid" x1="{0:.1f}" y1="6" x2="{0:.1f}" y2="{1:.1f}"/>)"
                       R"(<text x="{0:.1f}" y="{2:.1f}" text-anchor="middle">{3:.4g}</text>)",
                       scale.At(t), bottom, bottom + 14, t);
  }
  double y = 6 + 0.5 * kLine;
  for (const ChannelPlot* channel : channels) {
    for (std::size_t i = 0; i < channel->points.size(); ++i, y += kLine) {
      const FitPoint& p = *channel->points[i];
      const std::string where = channel->points.size() > 1 ? ", " + p.where : "";
      out +=
          fmt::format(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="end">{}</text>)"
                      R"(<line class="start" x1="{:.1f}" y1="{y:.1f}" x2="{:.1f}" y2="{y:.1f}"/>)",
                      kNamesHere - 12, y + 4, Escaped(channel->plot.title + where),
                      scale.At(p.measured - kNormal95 * p.sd),
                      scale.At(p.measured + kNormal95 * p.sd), fmt::arg("y", y));
      const auto dot = [&](const char* style, double value, double radius) {
        out += fmt::format(R"(<circle class="{}" cx="{:.1f}" cy="{:.1f}" r="{}"/>)", style,
                           scale.At(value), y, radius);
      };
      if (i < channel->untuned.size()) dot("untuned", channel->untuned[i].second, 4);
      dot("measured", p.measured, 4);
      dot("fitted", channel->fitted[i].second, 4);
    }
  }
  return out +
         fmt::format(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="middle">{}</text></svg>)",
                     kNamesHere + 0.5 * kScale, height - 4, Escaped(unit)) +
         "\n";
}

}  // namespace

std::string Headline(const Identification& fit, const FitOutcome& outcome) {
  const FitVerdict& v = outcome.verdict;
  std::vector<compare::Card> cards;
  cards.push_back({"verdict", Capitalized(WordOf(v.judgement)),
                   ReasonOf(v.judgement, v.hold_out.has_value()),
                   v.judgement == FitJudgement::kGood ? "good" : "bad"});
  if (v.judgement == FitJudgement::kNone) return compare::Cards(cards);
  cards.push_back({"chi-square", FiveDigits(v.total.value),
                   fmt::format("{:.4g} degrees of freedom, p = {:.2g}", v.total.freedom, v.total.p),
                   ""});
  if (v.train.failed.empty()) cards.push_back(ErrorCard("fitted data", v.train));
  if (v.hold_out && v.hold_out->failed.empty()) {
    cards.push_back(ErrorCard("held-out data", *v.hold_out));
  }
  const auto& parameters = v.identifiability.parameters;
  const auto estimated = std::count_if(parameters.begin(), parameters.end(), [](const auto& p) {
    return p.kind == Determined::kEstimated;
  });
  cards.push_back({"estimated parameters", fmt::format("{} of {}", estimated, parameters.size()),
                   fmt::format("{} data points", fit.train_points().size()),
                   estimated == static_cast<std::ptrdiff_t>(parameters.size()) ? "good" : "bad"});
  return compare::Cards(cards);
}

std::string ParameterBars(const Identification& fit, const FitOutcome& outcome) {
  const auto& parameters = fit.train().parameters;
  const auto& verdicts = outcome.verdict.identifiability.parameters;
  if (parameters.empty() || verdicts.size() != parameters.size()) return {};
  const double width = kNames + kScale + kText;
  const double height = kRow * static_cast<double>(parameters.size()) + 12;
  std::string out = fmt::format(
      R"(<svg viewBox="0 0 {0} {1}" width="{0}" height="{1}" role="img" aria-label="start, prior and estimate of each parameter">)",
      width, height);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const Bar bar = BarOf(parameters[i], verdicts[i]);
    if (std::isfinite(bar.value)) out += BarRow(bar, kRow * (static_cast<double>(i) + 0.5) + 6);
  }
  return out +
         "</svg>\n<p class=\"note\">Each row has its own scale. Dot: estimate; blue bar: its 95 % "
         "interval; gray bar: 95 % interval of the prior; line: start.</p>\n";
}

std::string MeasuredPlots(const Identification& fit, const FitOutcome& outcome) {
  std::vector<ChannelPlot> channels;
  std::map<std::pair<std::size_t, std::string>, std::size_t> places;
  const auto add = [&](const std::vector<FitPoint>& points, const BeforeAfter& residuals) {
    for (std::size_t i = 0; i < points.size() && i < residuals.fitted.size(); ++i) {
      const FitPoint& p = points[i];
      const auto [at, fresh] = places.try_emplace({p.experiment, p.channel}, channels.size());
      if (fresh) {
        const FitExperiment& experiment = fit.spec().experiments[p.experiment];
        ChannelPlot& channel = channels.emplace_back();
        channel.plot.title =
            experiment.name + (experiment.train ? ": " : ", held out: ") + p.channel;
        channel.plot.x = experiment.forward == FitForward::kLoadCases ? "load case" : "time [s]";
        channel.plot.y = WithUnit("", p.unit);
      }
      ChannelPlot& channel = channels[at->second];
      channel.points.push_back(&p);
      channel.measured.emplace_back(p.time_s, p.measured);
      channel.fitted.emplace_back(p.time_s, p.measured + residuals.fitted[i] * p.sd);
      if (i < residuals.untuned.size()) {
        channel.untuned.emplace_back(p.time_s, p.measured + residuals.untuned[i] * p.sd);
      }
    }
  };
  add(fit.train_points(), outcome.train);
  add(fit.test_points(), outcome.test);
  if (channels.empty()) return {};
  std::string out =
      "<h2>Measured and computed</h2>\n<p class=\"key\"><span><i class=\"dot "
      "measured\"></i>measured"
      "</span><span><i class=\"dot fitted\"></i>fitted</span><span><i class=\"dot untuned\"></i>"
      "untuned</span></p>\n";
  constexpr std::size_t kMost = 24, kMostPoints = 300;
  std::map<std::string, std::vector<const ChannelPlot*>> few;
  std::size_t plots = 0;
  for (ChannelPlot& channel : channels) {
    if (channel.points.size() < kFewestOfPlot) {
      few[channel.plot.y].push_back(&channel);
      continue;
    }
    if (++plots > kMost) continue;
    channel.plot.series = {{"untuned", compare::Thinned(channel.untuned, kMostPoints), true},
                           {"measured", compare::Thinned(channel.measured, kMostPoints)},
                           {"fitted", compare::Thinned(channel.fitted, kMostPoints), true}};
    out += compare::Svg(channel.plot);
  }
  if (plots > kMost) {
    out += fmt::format("<p class=\"note\">... and {} more in summary.json</p>\n", plots - kMost);
  }
  for (const auto& [unit, some] : few) out += FewData(unit, some);
  if (!few.empty()) {
    out += "<p class=\"note\">Lines: 95 % intervals of the measurements.</p>\n";
  }
  return out;
}

}  // namespace taut::identify
