// Result of a fit as text for a terminal.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "identify/labels.h"

namespace taut {
namespace identify {

const char* WordOf(FitJudgement judgement) {
  switch (judgement) {
    case FitJudgement::kGood:
      return "good";
    case FitJudgement::kRejected:
      return "rejected";
    case FitJudgement::kUnidentifiable:
      return "not identifiable";
    case FitJudgement::kContradiction:
      return "contradiction";
    case FitJudgement::kUnreliable:
      return "unreliable";
    case FitJudgement::kWorse:
      return "worse than untuned on held-out data";
    case FitJudgement::kNone:
      break;
  }
  return "no fit";
}

std::string WithUnit(const std::string& name, const std::string& unit) {
  return unit.empty() || unit == "1" ? name : name + " [" + unit + "]";
}

std::string FiveDigits(double x) { return std::isfinite(x) ? fmt::format("{:.5g}", x) : "-"; }

std::string ErrorText(double se) { return std::isfinite(se) ? fmt::format("{:.3g}", se) : "any"; }

std::string CarriedText(const Identification& fit, const CarriedLoad& carried) {
  if (carried.check.why.empty()) return carried.check.sentence;
  return carried.name + " of " + fit.spec().experiments[carried.experiment].name +
         ": the carried load cannot be determined: " + carried.check.why;
}

}  // namespace identify

namespace {

using namespace identify;  // NOLINT(google-build-using-namespace): only in this file

std::string ParameterTable(const Identification& fit, const FitOutcome& outcome) {
  const FitProblem& problem = fit.train();
  std::size_t width = 9;
  for (const FitParameter& p : problem.parameters) {
    width = std::max(width, WithUnit(p.name, p.unit).size());
  }
  std::string out = fmt::format("{:<{}} {:>12} {:>12} {:>10} {:>10} {:>10}  {}\n", "parameter",
                                width, "start", "fitted", "se", "jackknife", "prior sd", "verdict");
  for (std::size_t i = 0; i < problem.parameters.size(); ++i) {
    const FitParameter& p = problem.parameters[i];
    const ParameterVerdict& v = outcome.verdict.identifiability.parameters[i];
    out += fmt::format("{:<{}} {:>12.6g} {:>12.6g} {:>10} {:>10} {:>10}  {}{}\n",
                       WithUnit(p.name, p.unit), width, p.start, v.value, ErrorText(v.se),
                       v.se_jackknife ? ErrorText(*v.se_jackknife) : "-",
                       std::isfinite(p.prior_sd) ? fmt::format("{:.3g}", p.prior_sd) : "-",
                       VerdictName(v.kind), v.kink ? ", kink" : "");
  }
  return out;
}

std::string ErrorTable(const char* title, const std::vector<FitPoint>& points,
                       const BeforeAfter& residuals) {
  const auto errors = ErrorsByChannel(points, residuals);
  if (errors.empty()) return {};
  std::size_t width = 20;
  for (const ChannelErrors& e : errors) width = std::max(width, WithUnit(e.channel, e.unit).size());
  std::string out = fmt::format("\n{:<{}} {:>7} {:>12} {:>12} {:>12}\n", title, width, "data",
                                "untuned rms", "fitted rms", "fitted bias");
  constexpr std::size_t kMost = 24;
  for (std::size_t i = 0; i < std::min(errors.size(), kMost); ++i) {
    const ChannelErrors& e = errors[i];
    out += fmt::format("{:<{}} {:>7} {:>12.5g} {:>12.5g} {:>12.4g}\n", WithUnit(e.channel, e.unit),
                       width, e.count, e.untuned, e.fitted, e.fitted_bias);
  }
  if (errors.size() > kMost) out += fmt::format("... and {} more\n", errors.size() - kMost);
  return out;
}

std::string ExperimentTable(const char* title, const FitSpec& spec,
                            const std::vector<FitPoint>& points, const BeforeAfter& residuals) {
  const auto errors = ErrorsByExperiment(spec, points, residuals);
  if (errors.size() < 2) return {};  // the total is in the summary
  std::string out = fmt::format("\n{:<28} {:>7} {:>16} {:>16}\n", title, "data", "untuned rms [sd]",
                                "fitted rms [sd]");
  for (const ExperimentErrors& e : errors) {
    out += fmt::format("{:<28} {:>7} {:>16.4g} {:>16.4g}\n", e.experiment, e.count, e.untuned,
                       e.fitted);
  }
  return out;
}

/// Returns the held-out channels and experiments that the fit predicts less accurately than the
/// untuned model; empty if there are none.
std::string WorseParts(const Identification& fit, const FitOutcome& outcome) {
  std::vector<std::string> parts;
  for (const ChannelErrors& e : ErrorsByChannel(fit.test_points(), outcome.test)) {
    if (e.fitted > e.untuned) {
      parts.push_back(
          fmt::format("{} ({:.3g} -> {:.3g})", WithUnit(e.channel, e.unit), e.untuned, e.fitted));
    }
  }
  const auto experiments = ErrorsByExperiment(fit.spec(), fit.test_points(), outcome.test);
  for (const ExperimentErrors& e : experiments) {
    if (experiments.size() > 1 && e.fitted > e.untuned) {
      parts.push_back(
          fmt::format("experiment {} ({:.3g} -> {:.3g} sd)", e.experiment, e.untuned, e.fitted));
    }
  }
  constexpr std::size_t kMost = 6;
  std::string text;
  for (std::size_t i = 0; i < std::min(parts.size(), kMost); ++i) {
    text += (i == 0 ? "" : ", ") + parts[i];
  }
  if (parts.size() > kMost) text += fmt::format(" and {} more", parts.size() - kMost);
  return text;
}

std::string AliasTable(const FitVerdict& verdict) {
  if (verdict.aliases.empty()) return {};
  std::size_t width = 26;
  for (const AliasTest& test : verdict.aliases) {
    width = std::max(width, WithUnit(test.name, test.unit).size());
  }
  std::string out =
      fmt::format("\n{:<{}} {:>12} {:>10} {:>14} {:>10}\n", "sensor error, not estimated", width,
                  "value", "se", "chi2 decrease", "p");
  for (const AliasTest& test : verdict.aliases) {
    const std::string name = WithUnit(test.name, test.unit);
    out += test.confounded ? fmt::format("{:<{}} confounded with parameters\n", name, width)
                           : fmt::format("{:<{}} {:>12.6g} {:>10.3g} {:>14.4g} {:>10.3g}\n", name,
                                         width, test.value, test.se, test.fall, test.p);
  }
  return out;
}

std::string DesignTable(const DesignRanking& design, std::size_t parameters) {
  std::string out;
  for (const std::string& wrong : design.wrong) out += "design: " + wrong + "\n";
  if (!design.wrong.empty()) return out;
  out += fmt::format("\n{:<28} {:>9} {:>18}\n", "measurements", "bits more", "combinations fixed");
  const double now = design.now.information;
  const auto line = [&](const std::string& name, const DesignWorth& worth) {
    out += fmt::format("{:<28} {:>9.2f} {:>11} of {}\n", name,
                       (worth.information - now) / std::log(2.0), worth.fixed, parameters);
  };
  line("present data", design.now);
  for (const DesignWorth& worth : design.alone) line("with " + worth.name, worth);
  if (design.greedy.size() > 1) out += "in the best order:\n";
  for (const DesignWorth& worth : design.greedy) {
    if (design.greedy.size() > 1) line("and " + worth.name, worth);
  }
  return out;
}

}  // namespace

std::vector<std::string> OutcomeLines(const Identification& fit, const FitOutcome& outcome) {
  const FitVerdict& verdict = outcome.verdict;
  const FitProblem& problem = fit.train();
  std::vector<std::string> lines{fmt::format("{}: {}", fit.spec().name, WordOf(verdict.judgement))};
  if (!verdict.sentences.empty()) lines.front() += ": " + verdict.sentences.front();
  for (const CarriedLoad& carried : outcome.carried) lines.push_back(CarriedText(fit, carried));
  const auto errors = [&](const char* title, const FitErrors& of) {
    if (of.count == 0) return;
    lines.push_back(
        fmt::format("{} ({} residuals): rms {:.4g} untuned, {:.4g} fitted, in "
                    "standard deviations",
                    title, of.count, of.untuned, of.fitted));
  };
  errors("fitted data", verdict.train);
  if (verdict.hold_out) errors("held-out data", *verdict.hold_out);
  const std::string worse = WorseParts(fit, outcome);
  if (!worse.empty()) lines.push_back("worse than untuned on held-out data: " + worse);
  for (const Homogeneity& test : verdict.alone.tested) {
    if (test.apart && verdict.judgement != FitJudgement::kContradiction) {
      lines.push_back("experiments disagree: " + test.sentence);
    }
  }
  for (const AliasTest& test : verdict.aliases) {
    if (!test.confounded && test.p < VerdictOptions{}.least_p) lines.push_back(test.sentence);
  }
  if (outcome.fit.state.tracks.size() > 1) lines.push_back(StartsSentence(outcome.fit));
  for (const FitProfile& profile : outcome.profiles) {
    lines.push_back("profile of " + problem.parameters[profile.parameter].name + ": " +
                    (profile.why.empty() ? profile.sentence : profile.why));
  }
  const auto& parameters = verdict.identifiability.parameters;
  for (std::size_t i = 0; i < std::min(problem.parameters.size(), parameters.size()); ++i) {
    const FitParameter& p = problem.parameters[i];
    const ParameterVerdict& v = parameters[i];
    lines.push_back(fmt::format("{}: {:.6g} -> {:.6g} +- {}, {}", WithUnit(p.name, p.unit), p.start,
                                v.value, ErrorText(v.error()), VerdictName(v.kind)));
  }
  return lines;
}

std::string OutcomeText(const Identification& fit, const FitOutcome& outcome) {
  const FitVerdict& verdict = outcome.verdict;
  const FitProblem& problem = fit.train();
  std::string out =
      fmt::format("{}: {} parameters from {} data points in {} groups", fit.spec().name,
                  problem.parameters.size(), problem.rows.size(), problem.group_names.size());
  if (fit.test()) out += fmt::format(", {} held out", fit.test()->rows.size());
  out += "\n\n" + ParameterTable(fit, outcome);
  for (const FitTrack& track : outcome.fit.state.tracks) {
    for (const auto& [why, count] : track.reasons) {
      out += fmt::format("{} trial points failed: {}\n", count, why);
    }
  }
  out += ErrorTable("fitted data", fit.train_points(), outcome.train);
  out += ErrorTable("held-out data", fit.test_points(), outcome.test);
  out += ExperimentTable("experiment", fit.spec(), fit.train_points(), outcome.train);
  out += ExperimentTable("held-out experiment", fit.spec(), fit.test_points(), outcome.test);
  out += AliasTable(verdict);
  if (!outcome.carried.empty()) out += "\n";
  for (const CarriedLoad& carried : outcome.carried) out += CarriedText(fit, carried) + "\n";
  for (const FitProfile& profile : outcome.profiles) {
    const std::string& name = problem.parameters[profile.parameter].name;
    out += "\nprofile of " + name + ": " + (profile.why.empty() ? profile.sentence : profile.why) +
           "\n";
  }
  if (outcome.design) {
    out += DesignTable(*outcome.design, problem.parameters.size());
  }
  out += "\n";
  for (const std::string& sentence : verdict.sentences) out += sentence + "\n";
  return out;
}

}  // namespace taut
