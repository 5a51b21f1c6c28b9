// Run of a fit with its verdict, profile likelihoods and design of further measurements.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/pattern.h"
#include "identify/sensor_errors.h"
#include "taut/identify.h"

namespace taut {
namespace {

/// Returns the residuals at one point. Returns an empty list if they could not be computed.
std::vector<double> At(const FitProblem& problem, const std::vector<double>& values) {
  const std::vector<std::vector<double>> points{values};
  const auto answers = problem.forward(points);
  return answers.empty() ? std::vector<double>() : answers[0].value;
}

std::vector<double> Starts(const FitProblem& problem) {
  std::vector<double> out;
  for (const FitParameter& p : problem.parameters) out.push_back(p.start);
  return out;
}

BeforeAfter Both(const FitProblem& problem, const std::vector<double>& values) {
  return {At(problem, Starts(problem)), At(problem, values)};
}

bool AtRest(const FitSpec& spec) {
  return std::all_of(spec.experiments.begin(), spec.experiments.end(),
                     [](const auto& one) { return one.forward != FitForward::kDynamic; });
}

/// Converts the rows of a problem and their standard deviations to a design candidate.
DesignCandidate CandidateOf(const std::string& name, const FitProblem& problem,
                            const std::vector<FitPoint>& points, bool scaled,
                            const std::vector<double>& values) {
  DesignCandidate out;
  out.name = name;
  const FitDerivatives d = Differentiate(problem, values);
  if (!d.done) return out;
  for (std::size_t row = 0; row < points.size(); ++row) {
    // Residuals are in standard deviations, so the slope of the channel is slope times sd.
    out.sd.push_back(scaled ? points[row].sd : 1.0);
    for (const FitColumn& column : d.columns) {
      const double slope = column.failed.empty() ? column.slope[row] : NAN;
      out.jacobian.push_back(scaled ? slope * points[row].sd : slope);
    }
  }
  return out;
}

DesignRanking Rank(const Identification& fit, const std::vector<double>& values) {
  const DesignCandidate base =
      CandidateOf("measured", fit.train(), fit.train_points(), false, values);
  std::vector<DesignCandidate> candidates;
  for (std::size_t i = 0; i < fit.design().size(); ++i) {
    candidates.push_back(CandidateOf(fit.spec().design[i].name, fit.design()[i],
                                     fit.design_points()[i], true, values));
  }
  return RankDesigns(fit.train().parameters, base, candidates);
}

}  // namespace

bool CheckDependence(const Identification& fit, Diagnostics& out) {
  const FitProblem& problem = fit.train();
  const FitDerivatives d = Differentiate(problem, Starts(problem));
  const std::string& file = fit.spec().files[0];
  if (!d.done) {
    out.Error("fit.start_not_computed", {file},
              "the start of the search cannot be computed: " + d.why);
    return false;
  }
  bool good = true;
  for (std::size_t i = 0; i < d.columns.size(); ++i) {
    const FitColumn& column = d.columns[i];
    if (!column.failed.empty() || column.curved != 0) continue;
    if (std::any_of(column.slope.begin(), column.slope.end(), [](double x) { return x != 0; })) {
      continue;
    }
    const FitEstimate& e = fit.spec().estimates[fit.estimates()[i]];
    out.Error("estimate.no_influence", e.at, "estimate: no compared value depends on " + e.name,
              "leave it out, or compare a channel that it affects");
    good = false;
  }
  return good;
}

FitOutcome RunFit(const Identification& fit, const OutcomeOptions& options) {
  const FitSpec& spec = fit.spec();
  const FitProblem& problem = fit.train();
  FitOutcome out;
  IdentifyProgress now;
  now.what = "searching";
  FitOptions search;
  search.starts = spec.search.starts;
  search.seed = spec.search.seed;
  search.most_iterations = spec.search.iterations;
  search.cost_tolerance = spec.search.tolerance;
  search.stop = options.stop;
  search.progress = [&](const FitState& state) {
    now.iterations = 0;
    double best = INFINITY;
    for (const FitTrack& track : state.tracks) {
      now.iterations += track.iterations;
      if (!(track.cost < best)) continue;
      best = track.cost;
      now.values = track.values;
    }
    now.chi2 = 2 * best;
    now.computed = fit.counts().computed;
    if (options.progress) options.progress(now);
    return !options.stop || !*options.stop;
  };
  now.most_iterations = search.starts * search.most_iterations;
  const auto stopped = [&] { return options.stop && *options.stop; };
  out.fit = Fit(problem, search);
  if (stopped() || out.fit.end == FitEnd::kInterrupted) {
    out.interrupted = true;
    return out;
  }
  if (out.fit.end == FitEnd::kFailed || out.fit.end == FitEnd::kRefused || !out.fit.best) {
    out.why = out.fit.why.empty() ? "no start could be computed" : out.fit.why;
    return out;
  }
  now.what = "judging";
  now.most_iterations = 0;
  VerdictOptions judge;
  judge.fit = search;
  judge.jackknife = AtRest(spec) ? Jackknife::kRefit : Jackknife::kStep;
  if (spec.search.folds > 0) judge.folds = spec.search.folds;
  judge.aliases = [&](const std::vector<double>& residual) {
    return identify::SensorErrors(spec, fit.train_points(), residual);
  };
  out.carried = fit.Carried();
  out.verdict = JudgeFit(problem, out.fit, judge, fit.test());
  out.train = Both(problem, out.fit.values);
  if (fit.test()) out.test = Both(*fit.test(), out.fit.values);
  now.what = "profile";
  for (std::size_t i = 0; i < problem.parameters.size() && !stopped(); ++i) {
    if (options.profiles.empty() || !base::FitsAny(options.profiles, problem.parameters[i].name)) {
      continue;
    }
    ProfileOptions profile;
    profile.fit = search;
    const double se = out.verdict.identifiability.parameters[i].error();
    out.profiles.push_back(ProfileParameter(problem, out.fit.values, i, se, profile));
  }
  if (options.design && !stopped()) out.design = Rank(fit, out.fit.values);
  out.interrupted = stopped();
  return out;
}

std::vector<ExperimentErrors> ErrorsByExperiment(const FitSpec& spec,
                                                 const std::vector<FitPoint>& points,
                                                 const BeforeAfter& residuals) {
  std::vector<ExperimentErrors> out;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i >= residuals.fitted.size() || i >= residuals.untuned.size()) continue;
    const std::string& name = spec.experiments[points[i].experiment].name;
    auto at = std::find_if(out.begin(), out.end(),
                           [&](const ExperimentErrors& e) { return e.experiment == name; });
    if (at == out.end()) at = out.insert(at, {name, 0, 0, 0});
    ++at->count;
    at->untuned += residuals.untuned[i] * residuals.untuned[i];
    at->fitted += residuals.fitted[i] * residuals.fitted[i];
  }
  for (ExperimentErrors& e : out) {
    e.untuned = std::sqrt(e.untuned / static_cast<double>(e.count));
    e.fitted = std::sqrt(e.fitted / static_cast<double>(e.count));
  }
  return out;
}

std::vector<ChannelErrors> ErrorsByChannel(const std::vector<FitPoint>& points,
                                           const BeforeAfter& residuals) {
  std::vector<ChannelErrors> out;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const FitPoint& p = points[i];
    auto at = std::find_if(out.begin(), out.end(),
                           [&](const ChannelErrors& e) { return e.channel == p.channel; });
    if (at == out.end()) at = out.insert(at, {p.channel, p.unit});
    const auto error = [&](const std::vector<double>& of) {
      return i < of.size() ? of[i] * p.sd : NAN;
    };
    const double before = error(residuals.untuned), after = error(residuals.fitted);
    ++at->count;
    at->untuned += before * before;
    at->fitted += after * after;
    at->fitted_bias += after;
  }
  for (ChannelErrors& e : out) {
    const auto n = static_cast<double>(e.count);
    e.untuned = std::sqrt(e.untuned / n);
    e.fitted = std::sqrt(e.fitted / n);
    e.fitted_bias /= n;
  }
  return out;
}

}  // namespace taut
