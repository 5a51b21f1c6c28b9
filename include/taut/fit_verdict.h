/// Verdict on a fit: identifiability of parameters, standard errors, jackknife, cross-validation,
/// profile likelihood and goodness of fit. Equations: docs/theory/identification.md. Units and
/// threads as in `taut/fit.h`.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "taut/fit.h"

namespace taut {

/// Returns P(X >= chi2) of a chi-square distribution with `freedom` > 0 degrees of freedom, not
/// necessarily whole.
double ChiSquareTail(double chi2, double freedom);
/// Returns the chi-square that is exceeded with probability `tail`, 0 < tail < 1.
double ChiSquareQuantile(double tail, double freedom);

// Identifiability from the Jacobian.

/// Identifiability of a parameter.
enum class Determined {
  kEstimated,  ///< Standard error at most half of the prior sd, or without a prior, of the scale.
  kPrior,      ///< Held by its prior: the data add little.
  kAtBound,    ///< At a bound; the optimum is beyond it.
  kDead,       ///< No residual depends on it, to first order.
  kWeak,       ///< No prior, and a standard error above half of its scale.
  kTraded,     ///< Identifiable alone, but other parameters can compensate it.
  kScattered,  ///< Estimated by J^T J, but not by the jackknife over groups.
};

struct ParameterVerdict {
  Determined kind = Determined::kEstimated;
  double value = 0;
  double se = 0;  ///< Standard error by J^T J and the priors; infinite in a null direction.
  /// Standard error by leaving out one group at a time (jackknife, eq. F.14). Absent with fewer
  /// than three groups, or if only one group determines the parameter, such as an offset of that
  /// group.
  std::optional<double> se_jackknife;
  /// `se_jackknife` exceeds twice `se`, and by more than chance explains once in a thousand times
  /// with this number of groups: residuals within groups are correlated.
  bool groups_apart = false;
  double se_alone = 0;  ///< Standard error by J^T J if all others were known.
  double sd_ratio = 0;  ///< se / prior sd; without a prior, se / scale.
  double pull = 0;      ///< (value - prior mean) / prior sd; 0 without a prior.
  bool kink = false;    ///< The derivative is unreliable; see FitColumn.
  /// If traded: the compensating change as (parameter, change in its unit), this parameter first.
  /// It changes all residuals together only by `trade_residual` (eq. F.13).
  std::vector<std::pair<std::size_t, double>> trade;
  double trade_residual = 0;
  std::string sentence;
  /// Returns the larger of both errors.
  double error() const { return se_jackknife && *se_jackknife > se ? *se_jackknife : se; }
};

/// Right singular vector of the data's Jacobian, in the parameters' scales.
struct FitDirection {
  double singular = 0;            ///< Change of residuals per unit step.
  bool null = false;              ///< Zero within the error of the derivatives (eq. F.12).
  bool fixed = false;             ///< singular >= sqrt(3) and not null: halves a prior sd.
  std::vector<double> direction;  ///< Unit vector, one component per parameter, in scales.
};

struct Identifiability {
  std::vector<ParameterVerdict> parameters;
  /// Strongest first; one per parameter that is not at a bound.
  std::vector<FitDirection> directions;
  double condition = 0;  ///< Largest / smallest singular value; infinite with a null direction.
  int fixed = 0;         ///< Number of directions that the data fix.
  int endless = 0;       ///< Number of null directions without a prior.
  /// Effective number of parameters that the data determine: trace of H = C J^T J.
  double effective = 0;
  double effective_square = 0;      ///< Trace of H^2.
  std::vector<double> correlation;  ///< n x n, row-major; 0 for parameters without a finite error.
  /// n x n in the parameters' units, row-major; infinite variance without a finite error.
  std::vector<double> covariance;
};

/// Analyzes identifiability at `values` from the derivatives there. Computes no further points; the
/// jackknife is in `JackknifeGroups`.
Identifiability Identify(const FitProblem& problem, const std::vector<double>& values,
                         const FitDerivatives& derivatives);

// Jackknife and cross-validation over groups.

enum class Jackknife {
  kOff,
  kStep,   ///< One Gauss-Newton step from the fit per group: no new points.
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
  bool refit = false;  ///< By full searches; false: by one step.
  std::string why;     ///< Reason, if there is no result.
};

/// Computes standard errors by leaving out one group at a time (eq. F.14).
JackknifeResult JackknifeGroups(const FitProblem& problem, const std::vector<double>& values,
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
  FitErrors errors;            ///< Errors of that fit on the left-out groups.
};

struct CrossValidation {
  std::vector<FoldResult> folds;
  FitErrors all;    ///< All folds together.
  std::string why;  ///< Reason, if there is no result, such as fewer than two groups.
};

/// Cross-validates over groups (k-fold): the i-th group in use is in fold i mod `folds`; 0: one
/// fold per group.
CrossValidation CrossValidate(const FitProblem& problem, const std::vector<double>& values,
                              int folds, const FitOptions& options = {});

/// Computes the errors of a fit on held-out data, a problem with the same parameters. `untuned`
/// refers to the parameters' starts.
FitErrors HoldOut(const FitProblem& test, const std::vector<double>& values);

// Profile likelihood.

struct ProfilePoint {
  double value = 0;
  double rise = 0;             ///< Chi-square (twice the cost) minus the fit's.
  std::vector<double> values;  ///< All parameters.
  std::string failed;          ///< Reason if the point could not be computed.
};

struct FitProfile {
  std::size_t parameter = 0;
  std::vector<ProfilePoint> points;  ///< In ascending order of `value`.
  double level = 0;                  ///< Rise at the interval's ends: 3.84 for 95 %.
  /// Interval in which the rise is below `level`; an end without a crossing is open: the bound, or
  /// infinite.
  double low = 0, high = 0;
  bool low_open = false, high_open = false;
  /// Values of a point below the fit, which then was not the minimum: a better start.
  std::optional<std::vector<double>> better;
  std::string sentence;
  std::string why;  ///< Reason, if there is no profile.
};

struct ProfileOptions {
  int points = 6;            ///< Per side, and per extension of a side.
  double confidence = 0.95;  ///< 0 < confidence < 1.
  double reach = 3;          ///< First extent, in standard errors; without a finite one, in scales.
  FitOptions fit;            ///< For the search over the other parameters at each point.
};

/// Computes the profile likelihood of one parameter: the minimum over all others at fixed values of
/// it, from the fit outwards, then again from each neighbor's result; the lower one is kept. Unlike
/// the ellipse of standard errors, it includes nonlinearity (docs/theory/identification.md, section
/// 5). `se`: standard error of the parameter, for the spacing of points.
FitProfile ProfileParameter(const FitProblem& problem, const std::vector<double>& values,
                            std::size_t parameter, double se, const ProfileOptions& options = {});

// Consistency of data.

/// Data point of two quantities that should be equal, such as an applied load and the load carried
/// by the measured forces.
struct ProportionPoint {
  double expected = 0, measured = 0;
  double sd = 1;  ///< Standard deviation of measured - expected, > 0, in their unit.
  int group = 0;
};

struct ProportionCheck {
  std::size_t count = 0;
  double slope = 0;         ///< Measured / expected, by weighted least squares through 0.
  double se = 0;            ///< Largest of the errors by sds, by scatter and by leaving out groups.
  double chi2 = 0, p = 0;   ///< Scatter of the points about that line.
  double z = 0;             ///< (slope - 1) / se.
  bool consistent = false;  ///< |z| <= 3 and p >= 0.001.
  std::string sentence;
  std::string why;  ///< Reason, if there is no result.
};

/// Tests whether measured = expected within errors. `what`: subject of the sentence, such as "the
/// measured forces carry".
ProportionCheck CheckProportion(std::span<const ProportionPoint> points, const std::string& what);

// Overall verdict.

enum class FitJudgement {
  kGood,
  kRejected,        ///< By chi-square: the model, the priors or the sds are wrong.
  kUnidentifiable,  ///< A parameter other than a nuisance is not estimated.
  kWorse,           ///< Worse than untuned on held-out data.
  kNone,            ///< There is no fit.
};

struct ChiSquare {
  double value = 0;
  double freedom = 0;  ///< Expected value for a linear model.
  double p = 1;        ///< Probability of this value or more; 1 if undefined.
};

struct VerdictOptions {
  double least_p = 0.001;  ///< Smaller p reject the fit.
  Jackknife jackknife = Jackknife::kStep;
  std::optional<int> folds;  ///< As in CrossValidate; absent: no cross-validation.
  FitOptions fit;            ///< For refits and folds.
};

struct FitVerdict {
  FitJudgement judgement = FitJudgement::kNone;                  ///< The worst that applies.
  bool rejected = false, unidentifiable = false, worse = false;  ///< All that apply.
  std::vector<double> values;
  FitDerivatives derivatives;
  Identifiability identifiability;
  JackknifeResult jackknife;
  CrossValidation cross_validation;
  std::optional<FitErrors> hold_out;
  FitErrors train;                     ///< On the fitted data.
  ChiSquare data, prior;               ///< Parts of the total; losses replace squares.
  ChiSquare total;                     ///< Exact for a linear model with normal errors.
  std::vector<std::string> sentences;  ///< Report: the judgment first, then the reasons.
};

/// Evaluates a fit: identifiability, errors, goodness of fit and validation. `test`: held-out data
/// with the same parameters; may be null.
FitVerdict JudgeFit(const FitProblem& problem, const FitResult& fit, const VerdictOptions& options,
                    const FitProblem* test = nullptr);

}  // namespace taut
