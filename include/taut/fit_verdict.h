/// Evaluation of a fit: identifiability, standard errors, jackknife, cross-validation, profile
/// likelihood and goodness of fit. Equations: docs/theory/identification.md. Units and threads: see
/// `taut/fit.h`.
#pragma once

#include <algorithm>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "taut/fit.h"

namespace taut {

/// Returns P(X >= chi2) of a chi-square distribution with `freedom` > 0 degrees of freedom, which
/// may be fractional.
double ChiSquareTail(double chi2, double freedom);
/// Returns the chi-square value exceeded with probability `tail`, 0 < tail < 1.
double ChiSquareQuantile(double tail, double freedom);

// Identifiability from the Jacobian.

/// Identifiability of a parameter.
enum class Determined {
  kEstimated,   ///< Standard error at most half the prior sd; without a prior, half the scale.
  kPrior,       ///< Determined mainly by its prior; the data add little information.
  kAtBound,     ///< At a bound; the optimum is outside.
  kDead,        ///< No residual depends on the parameter to first order.
  kWeak,        ///< Weakly identified: no prior, and a standard error above half the scale.
  kConfounded,  ///< Identifiable alone, but other parameters can compensate for it.
  kUnreliable,  ///< Estimated according to J^T J, but other results contradict its standard error.
};

/// Returns the verdict as text, such as "weakly identified".
const char* VerdictName(Determined kind);

struct ParameterVerdict {
  Determined kind = Determined::kEstimated;
  double value = 0;
  double se = 0;  ///< Standard error from J^T J and the priors; infinite in a null direction.
  /// Jackknife standard error: leaves out one group at a time (eq. F.14). Absent with fewer than
  /// three groups, or if only one group determines the parameter, such as an offset of that group.
  std::optional<double> se_jackknife;
  /// Residuals within groups are correlated: `se_jackknife` exceeds 2 `se`, with a significance of
  /// 0.1 % for this number of groups.
  bool groups_apart = false;
  /// `se` times sqrt(chi-square / degrees of freedom), at most the prior sd: the standard error if
  /// all sds of the data are too small by the same factor. Absent unless chi-square of the data
  /// rejects the fit.
  std::optional<double> se_residuals;
  /// Results that contradict `se`, one clause each; empty: none. With contradictions, a parameter
  /// is kUnreliable instead of kEstimated.
  std::vector<std::string> contradictions;
  double se_alone = 0;  ///< Standard error from J^T J if all other parameters were known.
  double sd_ratio = 0;  ///< se / prior sd; without a prior, se / scale.
  double pull = 0;      ///< (value - prior mean) / prior sd; 0 without a prior.
  bool kink = false;    ///< The derivative is unreliable; see `FitColumn::kink`.
  /// For kConfounded: a compensating change, as pairs of parameter and change in its unit, this
  /// parameter first. This change alters all residuals together only by `confounded_residual` (eq.
  /// F.13).
  std::vector<std::pair<std::size_t, double>> confounded_with;
  double confounded_residual = 0;
  std::string sentence;
  /// Returns the largest of the standard errors.
  double error() const {
    return std::max({se, se_jackknife.value_or(se), se_residuals.value_or(se)});
  }
};

/// Right singular vector of the Jacobian of the data, scaled by the scales of the parameters.
struct FitDirection {
  double singular = 0;  ///< Change of residuals per unit step.
  /// The singular value is zero within the error of the derivatives (eq. F.12).
  bool null = false;
  bool fixed = false;  ///< singular >= sqrt(3) and not null: the data at least halve a prior sd.
  std::vector<double> direction;  ///< Unit vector, one component per parameter, in scales.
};

struct Identifiability {
  std::vector<ParameterVerdict> parameters;
  /// One per parameter that is not at a bound, strongest first.
  std::vector<FitDirection> directions;
  double condition = 0;  ///< Largest / smallest singular value; infinite with a null direction.
  int fixed = 0;         ///< Number of directions with `fixed`.
  int endless = 0;       ///< Number of null directions without a prior.
  /// Effective number of parameters determined by the data: trace of H = C J^T J.
  double effective = 0;
  double effective_square = 0;      ///< Trace of H^2.
  std::vector<double> correlation;  ///< n x n, row-major; 0 for parameters with infinite error.
  /// n x n in the units of the parameters, row-major; infinite variance for infinite errors.
  std::vector<double> covariance;
};

/// Analyzes identifiability at `values` from the derivatives at this point, without new points.
/// `JackknifeGroups` computes the jackknife.
Identifiability Identify(const FitProblem& problem, const std::vector<double>& values,
                         const FitDerivatives& derivatives);

// Agreement of experiments.

/// Fit to the data of one experiment alone.
struct AloneFit {
  int experiment = 0;
  /// Per parameter: value and standard error, at least the error by the residuals of this
  /// experiment. Absent if this experiment alone does not estimate the parameter.
  std::vector<std::optional<double>> value, se;
};

/// Homogeneity test of one parameter over the experiments that estimate it alone.
struct Homogeneity {
  std::size_t parameter = 0;
  double chi2 = 0;  ///< Sum of squared differences from their mean, weighted by errors (eq. F.14a).
  double freedom = 0;
  double p = 1;
  bool apart = false;  ///< The experiments disagree: p < 0.001.
  std::string sentence;
};

struct ExperimentsAlone {
  std::vector<AloneFit> fits;       ///< One per experiment.
  std::vector<Homogeneity> tested;  ///< One per parameter that several experiments estimate.
  std::string why;                  ///< Reason, if there is no result.
};

// Effects that are not estimated.

/// Effect that the fit does not estimate, such as a gain error of the load cells. Includes the
/// derivatives of the residuals with respect to the effect.
struct FitAlias {
  std::string name, unit;
  double neutral = 0;         ///< Value in the fit: 1 for a gain, 0 for an offset.
  std::vector<double> slope;  ///< d residual / d effect, one per row of the problem.
};

/// Score test of an effect: estimates it together with all parameters, to first order (eq. F.15b).
struct AliasTest {
  std::string name, unit;
  double value = 0;  ///< Estimate of the effect.
  double se = 0;     ///< Standard error, at least the error by the residuals.
  double fall = 0;   ///< Decrease of chi-square.
  double p = 1;      ///< Probability of this decrease by chance.
  /// Parameters can compensate for the effect, so the data do not contain it as a separate effect.
  bool confounded = false;
  std::vector<double> change;    ///< Changes of the parameters, in their units.
  std::vector<double> se_ratio;  ///< Standard errors with the effect / without it.
  std::string sentence;
};

/// Tests effects at `values`, from the derivatives at this point, without new points.
std::vector<AliasTest> TestAliases(const FitProblem& problem, const std::vector<double>& values,
                                   const FitDerivatives& derivatives,
                                   std::span<const FitAlias> aliases);

// Jackknife and cross-validation over groups.

enum class Jackknife {
  kOff,
  kStep,   ///< One Gauss-Newton step per group from the fit; no new points.
  kRefit,  ///< A full search per group.
};

/// Effect of leaving out one group.
struct GroupEffect {
  int group = 0;
  std::vector<double> values;  ///< Fit without the group.
};

struct JackknifeResult {
  std::vector<std::optional<double>> se;  ///< One per parameter; see ParameterVerdict.
  std::vector<GroupEffect> groups;
  bool refit = false;  ///< By full searches instead of single steps.
  std::string why;     ///< Reason, if there is no result.
};

/// Computes standard errors by the jackknife: leaves out one group at a time (eq. F.14).
JackknifeResult JackknifeGroups(const FitProblem& problem, const std::vector<double>& values,
                                const FitDerivatives& derivatives, Jackknife how,
                                const FitOptions& options = {});

/// Fits each experiment alone and compares the results. `how`: as for the jackknife, single
/// Gauss-Newton steps from the fit or full searches.
ExperimentsAlone FitExperimentsAlone(const FitProblem& problem, const std::vector<double>& values,
                                     const FitDerivatives& derivatives, Jackknife how,
                                     const FitOptions& options = {});

/// Root mean square of residuals in standard deviations, before and after the fit.
struct FitErrors {
  std::size_t count = 0;  ///< Number of residuals.
  double untuned = 0, fitted = 0;
  std::string failed;  ///< Reason, if there is no result.
  bool worse() const { return failed.empty() && count > 0 && fitted > untuned; }
};

struct FoldResult {
  std::vector<int> groups;     ///< Left-out groups.
  std::vector<double> values;  ///< Fit of the other groups.
  FitErrors errors;            ///< Errors of `values` on the left-out groups.
};

struct CrossValidation {
  std::vector<FoldResult> folds;
  FitErrors all;    ///< All folds combined.
  std::string why;  ///< Reason, if there is no result, such as fewer than two groups.
};

/// Cross-validates over groups (k-fold): group i is in fold i mod `folds`, counted over the used
/// groups. `folds` = 0: one fold per group.
CrossValidation CrossValidate(const FitProblem& problem, const std::vector<double>& values,
                              int folds, const FitOptions& options = {});

/// Computes the errors of a fit on held-out data: a problem with the same parameters. `untuned` is
/// at the start values of the parameters.
FitErrors HoldOut(const FitProblem& test, const std::vector<double>& values);

// Profile likelihood.

struct ProfilePoint {
  double value = 0;
  double rise = 0;             ///< Chi-square (twice the cost) minus its value for the fit.
  std::vector<double> values;  ///< Values of all parameters.
  std::string failed;          ///< Reason if the point could not be computed.
};

struct FitProfile {
  std::size_t parameter = 0;
  std::vector<ProfilePoint> points;  ///< In ascending order of `value`.
  double level = 0;                  ///< Rise at both ends of the interval: 3.84 for 95 %.
  /// Interval in which the rise is below `level`. Without a crossing, the end is the bound or
  /// infinite.
  double low = 0, high = 0;
  bool low_open = false, high_open = false;
  /// Values of a point with lower cost than the fit, if there is one: the fit was not the minimum.
  /// Start a new fit from these values.
  std::optional<std::vector<double>> better;
  std::string sentence;
  std::string why;  ///< Reason, if there is no profile.
};

struct ProfileOptions {
  int points = 6;            ///< Number of points per side, and per extension of a side.
  double confidence = 0.95;  ///< 0 < confidence < 1.
  double reach = 3;  ///< First extent, in standard errors, or in scales if the error is infinite.
  FitOptions fit;    ///< For the searches over the other parameters.
};

/// Computes the profile likelihood of one parameter: the minimum of chi-square over all other
/// parameters at fixed values of this one. The search proceeds from the fit outward, then starts
/// again from each neighbor's result, and keeps the lower minimum. Unlike standard errors, profiles
/// include nonlinearity (docs/theory/identification.md, section 5). `se`: standard error of the
/// parameter, for the spacing of the points.
FitProfile ProfileParameter(const FitProblem& problem, const std::vector<double>& values,
                            std::size_t parameter, double se, const ProfileOptions& options = {});

// Consistency of data.

/// Two quantities that should be equal, such as an applied load and the load carried by the
/// measured forces.
struct ProportionPoint {
  double expected = 0, measured = 0;
  double sd = 1;  ///< Standard deviation of measured - expected, in their unit, > 0.
  int group = 0;
};

struct ProportionCheck {
  std::size_t count = 0;
  double slope = 0;  ///< Measured / expected: slope of the weighted least-squares line through 0.
  /// Largest of three standard errors: from the sds, the scatter, and the jackknife.
  double se = 0;
  double chi2 = 0, p = 0;   ///< Scatter of the points about the line.
  double z = 0;             ///< (slope - 1) / se.
  bool consistent = false;  ///< |z| <= 3 and p >= 0.001.
  std::string sentence;
  std::string why;  ///< Reason, if there is no result.
};

/// Tests whether measured = expected within errors. `what`: subject of the result sentence, such as
/// "the measured forces carry".
ProportionCheck CheckProportion(std::span<const ProportionPoint> points, const std::string& what);

// Overall verdict.

enum class FitJudgement {
  kGood,
  kRejected,        ///< Rejected by chi-square: the model, the priors or the sds are wrong.
  kContradiction,   ///< Experiments fitted alone disagree by more than their errors.
  kUnidentifiable,  ///< The data do not determine a parameter that is no nuisance parameter.
  kUnreliable,      ///< Other results contradict the standard error of such a parameter.
  kWorse,           ///< Worse than the start values on held-out data.
  kNone,            ///< There is no fit.
};

struct ChiSquare {
  double value = 0;
  double freedom = 0;  ///< Degrees of freedom: expected value for a linear model.
  double p = 1;        ///< Probability of this or a larger value; 1 if undefined.
};

struct VerdictOptions {
  double least_p = 0.001;  ///< A smaller p-value rejects the fit.
  Jackknife jackknife = Jackknife::kStep;
  std::optional<int> folds;  ///< Number of folds for `CrossValidate`; absent: no cross-validation.
  FitOptions fit;            ///< For refits and for the fits of folds.
  /// Derives the effects to test from the residuals of the fit. If empty, no effects are tested.
  std::function<std::vector<FitAlias>(const std::vector<double>& residual)> aliases;
};

struct FitVerdict {
  FitJudgement judgement = FitJudgement::kNone;  ///< The worst applicable verdict.
  /// All applicable verdicts.
  bool rejected = false, contradiction = false, unidentifiable = false, unreliable = false,
       worse = false;
  std::vector<double> values;
  FitDerivatives derivatives;
  Identifiability identifiability;
  JackknifeResult jackknife;
  ExperimentsAlone alone;
  std::vector<AliasTest> aliases;  ///< In descending order of `fall`.
  CrossValidation cross_validation;
  std::optional<FitErrors> hold_out;
  FitErrors train;                     ///< Errors on the fitted data.
  ChiSquare data, prior;               ///< Parts of `total`; robust losses replace squares.
  ChiSquare total;                     ///< Exact for a linear model with normal errors.
  std::vector<std::string> sentences;  ///< Report: first the verdict, then its reasons.
};

/// Returns how many starts reached the minimum, and chi-square of each start, as a sentence.
std::string StartsSentence(const FitResult& fit);

/// Evaluates a fit: identifiability, errors, goodness of fit and validation. `test`: held-out data
/// with the same parameters, or null.
FitVerdict JudgeFit(const FitProblem& problem, const FitResult& fit, const VerdictOptions& options,
                    const FitProblem* test = nullptr);

}  // namespace taut
