// Result of a fit as a self-contained HTML page.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "compare/plot.h"
#include "identify/labels.h"
#include "identify/outcome_figures.h"
#include "taut/version.h"

namespace taut {
namespace {

using namespace identify;  // NOLINT(google-build-using-namespace): only in this file
using compare::Escaped;
using compare::Plot;
using compare::Svg;

std::string ParameterSection(const Identification& fit, const FitOutcome& outcome) {
  std::vector<std::vector<std::string>> rows{
      {"parameter", "start", "fitted", "se", "jackknife", "prior sd", "pull", "verdict"}};
  std::string sentences;
  const auto& parameters = fit.train().parameters;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const FitParameter& p = parameters[i];
    const ParameterVerdict& v = outcome.verdict.identifiability.parameters[i];
    rows.push_back({WithUnit(p.name, p.unit), FiveDigits(p.start), FiveDigits(v.value),
                    ErrorText(v.se), v.se_jackknife ? ErrorText(*v.se_jackknife) : "-",
                    FiveDigits(p.prior_sd), std::isfinite(p.prior_sd) ? FiveDigits(v.pull) : "-",
                    std::string(VerdictName(v.kind)) + (v.kink ? ", kink" : "")});
    sentences += "<li>" + Escaped(v.sentence) + "</li>\n";
  }
  return "<h2>Parameters</h2>\n" + ParameterBars(fit, outcome) + compare::HtmlTable(rows) +
         "<ul>\n" + sentences + "</ul>\n";
}

std::string Errors(const char* title, const std::vector<FitPoint>& points,
                   const BeforeAfter& residuals) {
  if (points.empty()) return {};
  std::vector<std::vector<std::string>> rows{
      {title, "data", "untuned rms", "fitted rms", "fitted bias"}};
  for (const ChannelErrors& e : ErrorsByChannel(points, residuals)) {
    rows.push_back({WithUnit(e.channel, e.unit), std::to_string(e.count), FiveDigits(e.untuned),
                    FiveDigits(e.fitted), FiveDigits(e.fitted_bias)});
  }
  return compare::HtmlTable(rows);
}

std::string ErrorsOfExperiments(const char* title, const FitSpec& spec,
                                const std::vector<FitPoint>& points, const BeforeAfter& residuals) {
  if (points.empty()) return {};
  std::vector<std::vector<std::string>> rows{
      {title, "data", "untuned rms [sd]", "fitted rms [sd]"}};
  for (const ExperimentErrors& e : ErrorsByExperiment(spec, points, residuals)) {
    rows.push_back(
        {e.experiment, std::to_string(e.count), FiveDigits(e.untuned), FiveDigits(e.fitted)});
  }
  return compare::HtmlTable(rows);
}

/// Returns the table of sensor errors that the fit does not estimate.
std::string Aliases(const FitVerdict& verdict) {
  if (verdict.aliases.empty()) return {};
  std::vector<std::vector<std::string>> rows{{"sensor error", "value", "se", "chi2 decrease", "p"}};
  for (const AliasTest& test : verdict.aliases) {
    const bool there = !test.confounded;
    rows.push_back({WithUnit(test.name, test.unit), there ? FiveDigits(test.value) : "confounded",
                    there ? FiveDigits(test.se) : "-", there ? FiveDigits(test.fall) : "-",
                    there ? FiveDigits(test.p) : "-"});
  }
  return "<h2>Sensor errors that are not estimated</h2>\n<p class=\"note\">Score tests: estimate "
         "of "
         "each error alone with all parameters, to first order.</p>\n" +
         compare::HtmlTable(rows);
}

/// Returns a list of links to the viewer, which show the experiments before and after the fit.
std::string Looks(const Identification& fit, const std::vector<std::string>& looks) {
  std::string list;
  for (std::size_t e = 0; e < looks.size(); ++e) {
    if (looks[e].empty()) continue;
    const FitExperiment& one = fit.spec().experiments[e];
    list += "<li><a href=\"" + Escaped(looks[e]) + "\">" + Escaped(one.name) + "</a>" +
            (one.train ? "" : ", held out") + "</li>\n";
  }
  if (list.empty()) return {};
  return "<h2>Before and after</h2>\n<p class=\"note\">The fitted robot, with the untuned one as a "
         "ghost; the links lead to files in the folder of this page.</p>\n<ul>\n" +
         list + "</ul>\n";
}

/// Returns the section that compares measured forces with the applied loads.
std::string Carried(const Identification& fit, const FitOutcome& outcome) {
  if (outcome.carried.empty()) return {};
  std::string out =
      "<h2>Consistency of measured forces</h2>\n<p class=\"note\">Load carried by the measured "
      "forces, as a share of the applied load: 1 if the measured members carry all of it.</p>\n";
  for (const CarriedLoad& carried : outcome.carried) {
    Plot plot{carried.name + " of " + fit.spec().experiments[carried.experiment].name,
              "applied [N]",
              "carried share",
              {{carried.check.consistent ? "fitted" : "held", {}}},
              {1},
              {}};
    for (const CarriedLoad::Row& row : carried.rows) {
      if (row.applied_n == 0) continue;
      plot.series[0].points.emplace_back(row.applied_n, row.carried_n / row.applied_n);
    }
    if (!plot.series[0].points.empty()) out += Svg(plot);
    out += "<p>" + Escaped(CarriedText(fit, carried)) + "</p>\n";
  }
  return out;
}

/// Returns plots of computed minus measured values, one plot per channel and unit.
std::string ResidualPlots(const Identification& fit, const FitOutcome& outcome) {
  std::vector<std::string> order;
  std::map<std::string, Plot> plots;
  const auto add = [&](const std::vector<FitPoint>& points, const BeforeAfter& residuals,
                       bool held) {
    for (std::size_t i = 0; i < points.size() && i < residuals.fitted.size(); ++i) {
      const FitPoint& p = points[i];
      auto [at, fresh] = plots.try_emplace(p.channel);
      Plot& plot = at->second;
      if (fresh) {
        order.push_back(p.channel);
        const bool cases = fit.spec().experiments[p.experiment].forward == FitForward::kLoadCases;
        plot = {WithUnit(p.channel, p.unit),
                cases ? "load case" : "time [s]",
                "computed minus measured",
                {{"untuned", {}}, {"fitted", {}}, {"held", {}}},
                {0},
                {}};
      }
      if (i < residuals.untuned.size()) {
        plot.series[0].points.emplace_back(p.time_s, residuals.untuned[i] * p.sd);
      }
      plot.series[held ? 2 : 1].points.emplace_back(p.time_s, residuals.fitted[i] * p.sd);
    }
  };
  add(fit.train_points(), outcome.train, false);
  add(fit.test_points(), outcome.test, true);
  std::string out =
      "<h2>Residuals</h2>\n<p class=\"key\"><span><i class=\"dot untuned\"></i>"
      "untuned</span><span><i class=\"dot fitted\"></i>fitted data"
      "</span><span><i class=\"dot held\"></i>held-out "
      "data</span></p>\n";
  // A channel with few data is in the figure of measured and computed values instead.
  std::erase_if(order, [&](const std::string& channel) {
    const std::vector<compare::Series>& series = plots[channel].series;
    return series[1].points.size() + series[2].points.size() < kFewestOfPlot;
  });
  if (order.empty()) return {};
  constexpr std::size_t kMost = 24;
  for (std::size_t i = 0; i < std::min(order.size(), kMost); ++i) out += Svg(plots[order[i]]);
  if (order.size() > kMost) {
    out += fmt::format("<p class=\"note\">... and {} more channels in summary.json</p>\n",
                       order.size() - kMost);
  }
  return out;
}

std::string ProfileSection(const Identification& fit, const FitOutcome& outcome) {
  if (outcome.profiles.empty()) return {};
  std::string out =
      "<h2>Profiles</h2>\n<p class=\"note\">Rise of chi-square with one parameter fixed and all "
      "others refitted; the line marks the ends of the 95 % interval.</p>\n";
  for (const FitProfile& profile : outcome.profiles) {
    const FitParameter& p = fit.train().parameters[profile.parameter];
    Plot plot{p.name,
              WithUnit(p.name, p.unit),
              "rise of chi-square",
              {{"fitted", {}, true}},
              {profile.level},
              {outcome.fit.values[profile.parameter]}};
    for (const ProfilePoint& point : profile.points) {
      if (point.failed.empty()) plot.series[0].points.emplace_back(point.value, point.rise);
    }
    out += Svg(plot) + "<p>" + Escaped(profile.why.empty() ? profile.sentence : profile.why) +
           "</p>\n";
  }
  return out;
}

std::string Correlations(const Identification& fit, const FitOutcome& outcome) {
  const auto& parameters = fit.train().parameters;
  const Identifiability& id = outcome.verdict.identifiability;
  const std::size_t n = parameters.size();
  if (n < 2 || id.correlation.size() != n * n) return {};
  std::string out = "<h2>Correlations</h2>\n<div class=\"wide\"><table>\n<tr><th></th>";
  for (std::size_t i = 0; i < n; ++i) out += fmt::format("<th>{}</th>", i + 1);
  out += "</tr>\n";
  for (std::size_t i = 0; i < n; ++i) {
    out += fmt::format("<tr><td>{} {}</td>", i + 1, Escaped(parameters[i].name));
    for (std::size_t j = 0; j < n; ++j) {
      const double c = id.correlation[i * n + j];
      const char* colour = c < 0 ? "213,94,0" : "0,114,178";
      out += fmt::format("<td style=\"background:rgba({},{:.2f})\">{:.2f}</td>", colour,
                         i == j ? 0.0 : 0.6 * std::min(1.0, std::fabs(c)), c);
    }
    out += "</tr>\n";
  }
  out +=
      "</table></div>\n<p class=\"note\">Combinations of parameters, each in units of its scale: a "
      "singular value above 1.7 halves the uncertainty.</p>\n";
  std::vector<std::vector<std::string>> rows{
      {"singular value", "fixed by the data", "combination"}};
  for (const FitDirection& d : id.directions) {
    std::vector<std::size_t> by_size(n);
    for (std::size_t i = 0; i < n; ++i) by_size[i] = i;
    std::sort(by_size.begin(), by_size.end(), [&](std::size_t a, std::size_t b) {
      return std::fabs(d.direction[a]) > std::fabs(d.direction[b]);
    });
    std::string text;
    for (std::size_t k = 0; k < std::min<std::size_t>(n, 4); ++k) {
      const double x = d.direction[by_size[k]];
      if (k > 0 && std::fabs(x) < 0.15) break;
      text += fmt::format("{}{:.2f} {}",
                          k == 0  ? ""
                          : x < 0 ? " "
                                  : " + ",
                          x, parameters[by_size[k]].name);
    }
    rows.push_back({d.null ? "none" : FiveDigits(d.singular), d.fixed ? "yes" : "no", text});
  }
  return out + compare::HtmlTable(rows);
}

std::string Jackknifed(const Identification& fit, const FitOutcome& outcome) {
  const JackknifeResult& j = outcome.verdict.jackknife;
  if (j.groups.empty()) return {};
  constexpr std::size_t kMost = 40;
  std::vector<std::vector<std::string>> rows{{"without"}};
  for (const FitParameter& p : fit.train().parameters) rows[0].push_back(p.name);
  for (std::size_t i = 0; i < std::min(j.groups.size(), kMost); ++i) {
    auto& row = rows.emplace_back();
    row.push_back(fit.train().group_names[static_cast<std::size_t>(j.groups[i].group)]);
    for (const double x : j.groups[i].values) row.push_back(FiveDigits(x));
  }
  return "<h2>Estimates without one group</h2>\n" + compare::HtmlTable(rows);
}

std::string Design(const FitOutcome& outcome, std::size_t parameters) {
  if (!outcome.design || !outcome.design->wrong.empty()) return {};
  const DesignRanking& design = *outcome.design;
  std::vector<std::vector<std::string>> rows{{"measurements", "bits more", "combinations fixed"}};
  const auto add = [&](const std::string& name, const DesignWorth& worth) {
    rows.push_back({name, FiveDigits((worth.information - design.now.information) / std::log(2.0)),
                    fmt::format("{} of {}", worth.fixed, parameters)});
  };
  add("present data", design.now);
  for (const DesignWorth& worth : design.alone) add("with " + worth.name, worth);
  for (const DesignWorth& worth : design.greedy) add("and " + worth.name, worth);
  return "<h2>Value of further measurements</h2>\n" + compare::HtmlTable(rows);
}

}  // namespace

std::string OutcomePage(const Identification& fit, const FitOutcome& outcome,
                        const std::vector<std::string>& looks) {
  const FitVerdict& v = outcome.verdict;
  const FitProblem& problem = fit.train();
  std::string out = compare::PageHead(fit.spec().name, "fit") + "<p>" +
                    Escaped(fit.spec().description) + "</p>\n" + Headline(fit, outcome);
  out += fmt::format(
      "<p class=\"note\">{} parameters from {} data points in {} groups, {} data points held out; "
      "taut {}</p>\n",
      problem.parameters.size(), problem.rows.size(), problem.group_names.size(),
      fit.test_points().size(), kVersion);
  out += std::string("<div class=\"verdict ") +
         (v.judgement == FitJudgement::kGood ? "good" : "bad") + "\">";
  for (const std::string& sentence : v.sentences) {
    const auto& parameters = v.identifiability.parameters;  // their sentences follow below
    const bool below = std::any_of(parameters.begin(), parameters.end(),
                                   [&](const auto& p) { return p.sentence == sentence; });
    if (!below) out += Escaped(sentence) + "<br>\n";
  }
  out += "</div>\n";
  out += ParameterSection(fit, outcome) + MeasuredPlots(fit, outcome);
  out += "<h2>Errors</h2>\n" + Errors("fitted data", fit.train_points(), outcome.train) +
         Errors("held-out data", fit.test_points(), outcome.test) +
         ErrorsOfExperiments("experiment", fit.spec(), fit.train_points(), outcome.train) +
         ErrorsOfExperiments("held-out experiment", fit.spec(), fit.test_points(), outcome.test) +
         Aliases(v);
  out += Looks(fit, looks) + Carried(fit, outcome);
  out += ResidualPlots(fit, outcome) + ProfileSection(fit, outcome) + Correlations(fit, outcome) +
         Jackknifed(fit, outcome) + Design(outcome, problem.parameters.size());
  return out + "</main></body></html>\n";
}

}  // namespace taut
