// Result of a fit as text for a terminal.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "identify/labels.h"

namespace taut {
namespace identify {

const char* WordOf(Determined kind) {
  switch (kind) {
    case Determined::kEstimated:
      return "estimated";
    case Determined::kPrior:
      return "held by its prior";
    case Determined::kAtBound:
      return "at its bound";
    case Determined::kDead:
      return "dead";
    case Determined::kWeak:
      return "weakly determined";
    case Determined::kScattered:
      return "scattered";
    case Determined::kTraded:
      break;
  }
  return "traded";
}

const char* WordOf(FitJudgement judgement) {
  switch (judgement) {
    case FitJudgement::kGood:
      return "good";
    case FitJudgement::kRejected:
      return "rejected";
    case FitJudgement::kUnidentifiable:
      return "not identifiable";
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

std::string ErrorText(double se) { return std::isfinite(se) ? fmt::format("{:.3g}", se) : "any"; }

std::string CarriedText(const Identification& fit, const CarriedLoad& carried) {
  if (carried.check.why.empty()) return carried.check.sentence;
  return carried.name + " of " + fit.spec().experiments[carried.experiment].name +
         ": the carried load cannot be determined: " + carried.check.why;
}

}  // namespace identify

namespace {

using namespace identify;  // NOLINT(google-build-using-namespace): its parts, of this file

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
                       WordOf(v.kind), v.kink ? ", kink" : "");
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
  for (const FitProfile& profile : outcome.profiles) {
    lines.push_back("profile of " + problem.parameters[profile.parameter].name + ": " +
                    (profile.why.empty() ? profile.sentence : profile.why));
  }
  const auto& parameters = verdict.identifiability.parameters;
  for (std::size_t i = 0; i < std::min(problem.parameters.size(), parameters.size()); ++i) {
    const FitParameter& p = problem.parameters[i];
    const ParameterVerdict& v = parameters[i];
    lines.push_back(fmt::format("{}: {:.6g} -> {:.6g} +- {}, {}", WithUnit(p.name, p.unit), p.start,
                                v.value, ErrorText(v.error()), WordOf(v.kind)));
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
