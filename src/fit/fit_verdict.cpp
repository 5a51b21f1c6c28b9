// Verdict on a fit: goodness of fit by chi-square, errors by groups, cross-validation
// (docs/theory/identification.md, section 6).
#include <algorithm>
#include <cmath>

#include "fit/contradictions.h"
#include "fit/format.h"
#include "fit/problem.h"
#include "taut/fit_verdict.h"

namespace taut {
namespace {

using fit::Brief;

/// If a fit is rejected, parameters at least this far from their prior mean are named [prior sd].
constexpr double kStrongPull = 3;
/// Largest difference of chi-square of starts that converged to the same minimum. It is far below
/// the change of 1 at one standard error.
constexpr double kSameMinimum = 0.1;

/// Approximates the distribution of a sum of squares of normal numbers by a multiple of a
/// chi-square with the same mean and variance (Satterthwaite). `trace`, `trace_of_square`: traces
/// of the covariance and of its square. Exact if all eigenvalues are equal or 0.
ChiSquare MakeChiSquare(double value, double trace, double trace_of_square) {
  ChiSquare chi{value, trace, 1};
  if (trace > 1e-6 && trace_of_square > 0) {
    const double factor = trace_of_square / trace;
    chi.p = ChiSquareTail(value / factor, trace / factor);
  }
  return chi;
}

/// Chi-square of the priors. The covariance of the pulls is I - D C D with D = diag(1 / prior sd)
/// (F.15).
ChiSquare PriorsOf(const FitProblem& problem, const Identifiability& found) {
  const std::size_t n = problem.parameters.size();
  double value = 0, trace = 0, square = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const FitParameter& p = problem.parameters[i];
    if (!fit::HasPrior(p)) continue;
    value += found.parameters[i].pull * found.parameters[i].pull;
    for (std::size_t j = 0; j < n; ++j) {
      const FitParameter& other = problem.parameters[j];
      if (!fit::HasPrior(other)) continue;
      const double entry =
          (i == j ? 1.0 : 0.0) - found.covariance[i * n + j] / (p.prior_sd * other.prior_sd);
      if (i == j) trace += entry;
      square += entry * entry;
    }
  }
  return MakeChiSquare(value, trace, square);
}

/// Chi-squares of the data (with robust losses), of the priors, and of their sum. For a linear
/// model with normal errors, the sum has a chi-square distribution.
void ChiSquares(const FitProblem& problem, FitVerdict& verdict) {
  double data = 0;
  for (std::size_t i = 0; i < problem.rows.size(); ++i) {
    data += fit::Loss(problem.rows[i], verdict.derivatives.residual[i]);
  }
  const Identifiability& found = verdict.identifiability;
  const double rows = static_cast<double>(problem.rows.size());
  verdict.data = MakeChiSquare(data, rows - found.effective,
                               rows - 2 * found.effective + found.effective_square);
  verdict.prior = PriorsOf(problem, found);
  double freedom = rows + found.endless;
  for (std::size_t j = 0; j < problem.parameters.size(); ++j) {
    if (fit::HasPrior(problem.parameters[j])) freedom += 1;
    if (found.parameters[j].kind != Determined::kAtBound) freedom -= 1;
  }
  verdict.total = MakeChiSquare(data + verdict.prior.value, freedom, freedom);
}

std::string Of(const ChiSquare& chi) {
  return "chi-square " + Brief(chi.value) + " with " + Brief(chi.freedom) +
         " degrees of freedom (p = " + Brief(chi.p) + ")";
}

std::string Errors(const std::string& what, const FitErrors& errors) {
  return what + ": " + Brief(errors.fitted) + " standard deviations RMS, untuned " +
         Brief(errors.untuned) + " (" + std::to_string(errors.count) + " data)" +
         (errors.worse() ? ": worse than untuned" : "");
}

std::string RejectedSentence(const FitProblem& problem, const FitVerdict& verdict) {
  std::string text = "Rejected: total " + Of(verdict.total) + ", data " + Of(verdict.data) +
                     ", priors " + Of(verdict.prior) + ".";
  for (std::size_t j = 0; j < problem.parameters.size(); ++j) {
    const double pull = verdict.identifiability.parameters[j].pull;
    if (std::fabs(pull) < kStrongPull) continue;
    text += " " + problem.parameters[j].name + " is " + Brief(std::fabs(pull)) +
            " prior standard deviations from its prior mean.";
  }
  return text;
}

/// Returns whether the data determine a parameter, whether or not its error is reliable.
bool IsDetermined(const ParameterVerdict& v) {
  return v.kind == Determined::kEstimated || v.kind == Determined::kUnreliable;
}

std::string UnidentifiableSentence(const FitProblem& problem, const FitVerdict& verdict) {
  std::vector<std::string> names;
  for (std::size_t j = 0; j < problem.parameters.size(); ++j) {
    const ParameterVerdict& v = verdict.identifiability.parameters[j];
    if (!IsDetermined(v) && !problem.parameters[j].nuisance) {
      names.push_back(problem.parameters[j].name + " (" + VerdictName(v.kind) + ")");
    }
  }
  return "Not identifiable: the data do not determine " + fit::List(names) + "; they fix " +
         std::to_string(verdict.identifiability.fixed) + " of " +
         std::to_string(problem.parameters.size()) + " combinations of parameters (condition " +
         Brief(verdict.identifiability.condition) + ").";
}

std::string UnreliableSentence(const FitProblem& problem, const FitVerdict& verdict) {
  std::vector<std::string> names;
  for (std::size_t j = 0; j < problem.parameters.size(); ++j) {
    const bool unreliable = verdict.identifiability.parameters[j].kind == Determined::kUnreliable;
    if (unreliable && !problem.parameters[j].nuisance) names.push_back(problem.parameters[j].name);
  }
  return "Unreliable: other results contradict the standard error of " + fit::List(names) + ".";
}

std::string ContradictionSentence(const FitVerdict& verdict) {
  std::string text = "Contradiction: experiments fitted alone disagree by more than their errors";
  for (const Homogeneity& test : verdict.alone.tested) {
    if (test.apart) text += "; " + test.sentence;
  }
  return text + ".";
}

void Decide(const FitProblem& problem, const VerdictOptions& options, FitVerdict& verdict) {
  verdict.rejected = verdict.total.p < options.least_p || verdict.data.p < options.least_p ||
                     verdict.prior.p < options.least_p;
  for (std::size_t j = 0; j < problem.parameters.size(); ++j) {
    const ParameterVerdict& v = verdict.identifiability.parameters[j];
    if (problem.parameters[j].nuisance) continue;
    verdict.unidentifiable |= !IsDetermined(v);
    verdict.unreliable |= v.kind == Determined::kUnreliable;
  }
  const FitErrors& unseen = verdict.hold_out ? *verdict.hold_out : verdict.cross_validation.all;
  verdict.worse = unseen.worse() || !unseen.failed.empty();
  verdict.judgement = verdict.rejected         ? FitJudgement::kRejected
                      : verdict.contradiction  ? FitJudgement::kContradiction
                      : verdict.unidentifiable ? FitJudgement::kUnidentifiable
                      : verdict.unreliable     ? FitJudgement::kUnreliable
                      : verdict.worse          ? FitJudgement::kWorse
                                               : FitJudgement::kGood;
}

void SayJudgement(const FitProblem& problem, FitVerdict& verdict) {
  auto& say = verdict.sentences;
  if (verdict.rejected) say.push_back(RejectedSentence(problem, verdict));
  if (verdict.contradiction) say.push_back(ContradictionSentence(verdict));
  if (verdict.unidentifiable) say.push_back(UnidentifiableSentence(problem, verdict));
  // All errors of a rejected fit are unreliable.
  if (verdict.unreliable && !verdict.rejected) say.push_back(UnreliableSentence(problem, verdict));
  if (verdict.worse) say.emplace_back("Worse than untuned on held-out data.");
  if (verdict.judgement == FitJudgement::kGood) {
    say.push_back("Good: all parameters are estimated, " + Of(verdict.total) +
                  (verdict.hold_out || verdict.cross_validation.all.count > 0
                       ? ", and better than untuned on held-out data."
                       : "; it was not tested on held-out data."));
  }
  if (verdict.total.p > 1 - 1e-3) {
    say.emplace_back(
        "The residuals are smaller than their standard deviations suggest: these are too large, "
        "or data are correlated.");
  }
}

void SayWhy(const FitProblem& problem, const FitResult& fit, const VerdictOptions& options,
            FitVerdict& verdict) {
  auto& say = verdict.sentences;
  for (std::size_t j = 0; j < problem.parameters.size(); ++j) {
    say.push_back(verdict.identifiability.parameters[j].sentence);
  }
  say.push_back(Errors("on fitted data", verdict.train));
  for (const AliasTest& test : verdict.aliases) {
    if (!test.confounded && test.p < options.least_p) say.push_back(test.sentence);
  }
  if (verdict.hold_out) {
    say.push_back(verdict.hold_out->failed.empty()
                      ? Errors("on held-out data", *verdict.hold_out)
                      : "the held-out data could not be computed: " + verdict.hold_out->failed);
  }
  if (verdict.cross_validation.all.count > 0) {
    say.push_back(Errors("on groups left out in turn", verdict.cross_validation.all));
  }
  if (fit.state.tracks.size() > 1) say.push_back(StartsSentence(fit));
}

}  // namespace

std::string StartsSentence(const FitResult& fit) {
  const auto& tracks = fit.state.tracks;
  std::size_t same = 0, failed = 0;
  std::vector<std::string> values;
  for (const FitTrack& track : tracks) {
    const bool there = track.end != FitEnd::kFailed;
    failed += there ? 0 : 1;
    same += there && 2 * (track.cost - fit.cost) <= kSameMinimum ? 1 : 0;
    if (there) values.push_back(Brief(2 * track.cost));
  }
  return std::to_string(same) + " of " + std::to_string(tracks.size()) +
         " starts converged to this minimum" +
         (failed > 0 ? ", " + std::to_string(failed) + " could not be computed" : "") +
         "; chi-square by start: " + fit::List(values);
}

const char* VerdictName(Determined kind) {
  switch (kind) {
    case Determined::kEstimated:
      return "estimated";
    case Determined::kPrior:
      return "held by its prior";
    case Determined::kAtBound:
      return "at its bound";
    case Determined::kDead:
      return "without influence";
    case Determined::kWeak:
      return "weakly identified";
    case Determined::kConfounded:
      return "confounded";
    case Determined::kUnreliable:
      return "unreliable";
  }
  return "";
}

FitVerdict JudgeFit(const FitProblem& problem, const FitResult& fit, const VerdictOptions& options,
                    const FitProblem* test) {
  FitVerdict verdict;
  if (!fit.best) {
    verdict.sentences.push_back("There is no fit: " + fit.why);
    return verdict;
  }
  verdict.values = fit.values;
  verdict.derivatives = Differentiate(problem, fit.values);
  if (!verdict.derivatives.done) {
    verdict.sentences.push_back("There is no verdict: " + verdict.derivatives.why);
    return verdict;
  }
  Identifiability& found = verdict.identifiability;
  found = Identify(problem, fit.values, verdict.derivatives);
  verdict.jackknife =
      JackknifeGroups(problem, fit.values, verdict.derivatives, options.jackknife, options.fit);
  fit::ContradictByGroups(problem, verdict);
  ChiSquares(problem, verdict);
  fit::ContradictByResiduals(problem, options.least_p, verdict);
  fit::ContradictByStarts(problem, fit, verdict);
  fit::ContradictByCost(problem, verdict);
  verdict.alone =
      FitExperimentsAlone(problem, fit.values, verdict.derivatives, options.jackknife, options.fit);
  fit::ContradictByExperiments(verdict);
  if (options.aliases) {
    verdict.aliases = TestAliases(problem, fit.values, verdict.derivatives,
                                  options.aliases(verdict.derivatives.residual));
  }
  fit::ContradictByAliases(options.least_p, verdict);
  fit::ApplyContradictions(problem, verdict);
  verdict.train = HoldOut(problem, fit.values);
  if (options.folds) {
    verdict.cross_validation = CrossValidate(problem, fit.values, *options.folds, options.fit);
  }
  if (test != nullptr) verdict.hold_out = HoldOut(*test, fit.values);
  Decide(problem, options, verdict);
  SayJudgement(problem, verdict);
  SayWhy(problem, fit, options, verdict);
  return verdict;
}

}  // namespace taut
