/// What a fit is worth: what the data determine and what they do not, standard errors, profiles,
/// errors on data that were left out, and whether the model is to be rejected. Equations:
/// docs/theory/identification.md. Units and threads as in `taut/fit.h`.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "taut/fit.h"

namespace taut {

/// P(X >= chi2) of a chi-square distribution with `freedom` > 0 degrees, not necessarily whole.
double ChiSquareTail(double chi2, double freedom);
/// The chi-square that is exceeded with probability `tail`, 0 < tail < 1.
double ChiSquareQuantile(double tail, double freedom);

// What the Jacobian says.

enum class Determined {
  kEstimated,  ///< The data at least halve its prior sd, or know it to half its scale.
  kPrior,      ///< The prior holds it: the data alone would not.
  kAtBound,    ///< At a bound, and the data would have it beyond.
  kDead,       ///< No residual depends on it, to first order.
  kWeak,       ///< Nothing was known before, and the data do not know it to half its scale.
  kTraded,     ///< Alone it would be determined; others can take its place.
  kScattered,  ///< Estimated by J^T J, but groups left out disagree, and by them it is not.
};

struct ParameterVerdict {
  Determined kind = Determined::kEstimated;
  double value = 0;
  double se = 0;  ///< Standard error by J^T J and the priors; infinite in a null direction.
  /// By leaving out one group at a time. Nothing if there are fewer than three groups, or if
  /// without some group it is not determined at all, as an offset of that group's own.
  std::optional<double> se_jackknife;
  /// The error by groups is more than twice that by J^T J, and by more than chance would have it
  /// once in a thousand times with as many groups: residuals of a group hang together.
  bool groups_apart = false;
  double se_alone = 0;  ///< By J^T J if all others were known.
  double sd_ratio = 0;  ///< se over the prior's sd, or the scale.
  double pull = 0;      ///< (value - prior mean) / prior sd; 0 without a prior.
  bool kink = false;    ///< See FitColumn.
  /// What moves with it and takes its place, if traded: (parameter, change in its unit), the
  /// parameter itself first; all residuals together move by `trade_residual` only.
  std::vector<std::pair<std::size_t, double>> trade;
  double trade_residual = 0;
  std::string sentence;
  /// The larger of both errors.
  double error() const { return se_jackknife && *se_jackknife > se ? *se_jackknife : se; }
};

/// A direction in the parameters' scales, by singular value decomposition of the data's Jacobian.
struct FitDirection {
  double singular = 0;            ///< Residuals a unit step of the direction.
  bool null = false;              ///< Indistinguishable from none by the derivatives' own error.
  bool fixed = false;             ///< singular >= sqrt(3), no null: a prior sd is halved.
  std::vector<double> direction;  ///< Unit vector, one a parameter, in scales.
};

struct Identifiability {
  std::vector<ParameterVerdict> parameters;
  std::vector<FitDirection> directions;  ///< Strongest first, one a parameter
                                         ///< that is not at a bound.
  double condition = 0;             ///< Largest over smallest singular value; infinite if null.
  int fixed = 0;                    ///< Directions that the data fix.
  int endless = 0;                  ///< Null directions that no prior holds either.
  double effective = 0;             ///< Parameters that the data determine, trace of H,
  double effective_square = 0;      ///< and of H^2.
  std::vector<double> correlation;  ///< n x n, row by row; 0 with what has no finite error.
  std::vector<double> covariance;   ///< n x n in the parameters' units; infinite where they are.
};

/// At `values`, from their derivatives. Refit and jackknife are not here: nothing is computed anew.
Identifiability Identify(const FitProblem& problem, const std::vector<double>& values,
                         const FitDerivatives& derivatives);

// Leaving groups out.

enum class Jackknife {
  kOff,
  kStep,   ///< One Gauss-Newton step from the fit a group: no new points.
  kRefit,  ///< A whole search a group.
};

struct GroupEffect {
  int group = 0;
  std::vector<double> values;  ///< The fit without it.
};

struct JackknifeResult {
  std::vector<std::optional<double>> se;  ///< One a parameter; see ParameterVerdict.
  std::vector<GroupEffect> groups;
  bool refit = false;  ///< Else by one step.
  std::string why;     ///< If there is none.
};

JackknifeResult JackknifeGroups(const FitProblem& problem, const std::vector<double>& values,
                                const FitDerivatives& derivatives, Jackknife how,
                                const FitOptions& options = {});

/// Root mean square of residuals, in standard deviations: without the fit, with it.
struct FitErrors {
  std::size_t count = 0;  ///< Of residuals.
  double untuned = 0, fitted = 0;
  std::string failed;  ///< Why there is none.
  bool worse() const { return failed.empty() && count > 0 && fitted > untuned; }
};

struct FoldResult {
  std::vector<int> groups;     ///< That were left out,
  std::vector<double> values;  ///< what the others gave,
  FitErrors errors;            ///< and what that gave for the groups left out.
};

struct CrossValidation {
  std::vector<FoldResult> folds;
  FitErrors all;    ///< Of all folds together.
  std::string why;  ///< If there is none: fewer than two groups.
};

/// Folds of groups: group i of those that occur, in order, is in fold i mod `folds`; 0: one a
/// group.
CrossValidation CrossValidate(const FitProblem& problem, const std::vector<double>& values,
                              int folds, const FitOptions& options = {});

/// On data that the fit never saw: a problem of the same parameters. `untuned`: the parameters'
/// starts.
FitErrors HoldOut(const FitProblem& test, const std::vector<double>& values);

// Profiles.

struct ProfilePoint {
  double value = 0;
  double rise = 0;             ///< Of chi-square (twice the cost) over the fit's.
  std::vector<double> values;  ///< Of all parameters.
  std::string failed;
};

struct FitProfile {
  std::size_t parameter = 0;
  std::vector<ProfilePoint> points;  ///< By value.
  double level = 0;                  ///< Rise at the interval's ends: 3.84 for 95 %.
  /// Where the rise crosses it; the bound, or infinite, where it does not (open).
  double low = 0, high = 0;
  bool low_open = false, high_open = false;
  /// A point lies below the fit: it was not the best. Its values are a better start.
  std::optional<std::vector<double>> better;
  std::string sentence;
  std::string why;  ///< If there is none.
};

struct ProfileOptions {
  int points = 6;            ///< A side; as many more each time that is not far enough.
  double confidence = 0.95;  ///< 0 < confidence < 1.
  double reach = 3;          ///< In standard errors; without a finite one, in scales.
  FitOptions fit;            ///< Of each point's search over the others.
};

/// Minimises over all others at fixed values of one, from the fit outwards, then once more from
/// each neighbour's result, and keeps the lower: not the ellipse's guess.
FitProfile ProfileParameter(const FitProblem& problem, const std::vector<double>& values,
                            std::size_t parameter, double se, const ProfileOptions& options = {});

// Data beside themselves.

/// Two channels that ought to be proportional: an applied load and what measured forces carry of
/// it.
struct ProportionPoint {
  double expected = 0, measured = 0;
  double sd = 1;  ///< Of `measured` minus `expected`, > 0, in their unit.
  int group = 0;
};

struct ProportionCheck {
  std::size_t count = 0;
  double slope = 0;  ///< Measured over expected, by weighted least squares through 0.
  double se = 0;     ///< From the sds, from the scatter or by leaving out groups: the largest.
  double chi2 = 0, p = 0;   ///< Of the points about that line.
  double z = 0;             ///< (slope - 1) / se.
  bool consistent = false;  ///< |z| <= 3 and p >= 0.001.
  std::string sentence;
  std::string why;  ///< If there is none.
};

/// `what`: for the sentence, as "the measured forces carry".
ProportionCheck CheckProportion(std::span<const ProportionPoint> points, const std::string& what);

// All together.

enum class FitJudgement {
  kGood,
  kRejected,        ///< Chi-square: the model, the priors or the sds are wrong.
  kUnidentifiable,  ///< A parameter that is no nuisance is not estimated.
  kWorse,           ///< Worse than untuned on data that it has not seen.
  kNone,            ///< There is no fit.
};

struct ChiSquare {
  double value = 0;
  double freedom = 0;  ///< What a linear model leads to expect of it.
  double p = 1;        ///< The probability of that much and more; 1 where nothing can be said.
};

struct VerdictOptions {
  double least_p = 0.001;  ///< Below it the fit is rejected.
  Jackknife jackknife = Jackknife::kStep;
  std::optional<int> folds;  ///< As CrossValidate's; nothing: no cross-validation.
  FitOptions fit;            ///< Of refits and folds.
};

struct FitVerdict {
  FitJudgement judgement = FitJudgement::kNone;  ///< The worst, in the order of the enumeration.
  bool rejected = false, unidentifiable = false, worse = false;  ///< All that hold.
  std::vector<double> values;
  FitDerivatives derivatives;
  Identifiability identifiability;
  JackknifeResult jackknife;
  CrossValidation cross_validation;
  std::optional<FitErrors> hold_out;
  FitErrors train;                     ///< On the data fitted.
  ChiSquare data, prior;               ///< By parts; losses in place of squares.
  ChiSquare total;                     ///< Exact for a linear model with normal errors.
  std::vector<std::string> sentences;  ///< For a reader: the judgement first, then why.
};

/// `test`: data that were held out, of the same parameters; may be null.
FitVerdict JudgeFit(const FitProblem& problem, const FitResult& fit, const VerdictOptions& options,
                    const FitProblem* test = nullptr);

}  // namespace taut
