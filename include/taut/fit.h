/// Nonlinear least squares (Levenberg-Marquardt) with bounds, priors, robust losses and several
/// starts, over an abstract function that computes many points at once. `taut/fit_verdict.h`
/// evaluates the result, `taut/fit_design.h` ranks further measurements. Equations:
/// docs/theory/identification.md.
///
/// Units: values, bounds, priors and steps are in the parameter's unit; residuals are in standard
/// deviations of their data, so dimensionless. The same problem, options and state give the same
/// bits.
///
/// Threads: any number may call these functions concurrently, each with a problem whose `forward`
/// it may call; there is no shared state. Any thread may set `stop`.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace taut {

struct FitParameter {
  std::string name;
  std::string unit;
  double start = 0;
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  /// Standard deviation of the prior, a normal distribution that adds a residual. Infinite: no
  /// prior.
  double prior_sd = std::numeric_limits<double>::infinity();
  std::optional<double> prior_mean;  ///< Absent: the start.
  /// Relevant change of the parameter: the unit of directions and steps. A standard error above
  /// half of it is too large for an estimate (without a prior). 0: the prior's sd; without a prior
  /// a quarter of the distance between the bounds; without bounds a tenth of the start; 1 for a
  /// start of 0.
  double scale = 0;
  double step = 0.1;      ///< Step of the difference quotients, in scales, > 0.
  bool nuisance = false;  ///< The data need not determine it: a sensor offset, a delay.
};

/// Returns `parameter.scale`, or the default if that is 0; > 0.
double FitScale(const FitParameter& parameter);

enum class FitLoss {
  kSquare,  ///< r^2
  kHuber,   ///< Linear beyond the width w: 2 w |r| - w^2.
  kCauchy,  ///< w^2 log(1 + r^2 / w^2)
};

/// Grouping and loss of one residual (eq. F.2).
struct FitRow {
  /// Number of the group of correlated residuals, such as one test; groups are left out as a whole.
  int group = 0;
  FitLoss loss = FitLoss::kSquare;
  double loss_width = 1.345;  ///< In standard deviations, > 0.
};

/// Residuals at one point.
struct Residuals {
  std::vector<double> value;  ///< (model - datum) / sd, one per row of the problem.
  std::string failed;         ///< Reason if the point could not be computed; else empty.
};

/// Computes the residuals at points (one value per parameter), in the order of the points. The
/// points of a call are independent and may run in parallel; all lie within the bounds. An answer
/// that is not finite, or does not have one value per row, counts as failed. Fewer answers than
/// points mean that the computation was stopped.
using Forward = std::function<std::vector<Residuals>(std::span<const std::vector<double>> points)>;

struct FitProblem {
  std::vector<FitParameter> parameters;
  std::vector<FitRow> rows;
  std::vector<std::string> group_names;  ///< For messages; missing names are replaced by numbers.
  Forward forward;
};

/// Returns the errors of a problem, one sentence each: a sd that is not positive, a start outside
/// its bounds, no rows. The functions below return kRefused for a problem with errors.
std::vector<std::string> CheckFitProblem(const FitProblem& problem);

enum class FitEnd {
  kRunning,      ///< Not finished; the state can be resumed.
  kConverged,    ///< The projected gradient, the step or the change of the cost vanished.
  kStuck,        ///< No step lowers the cost, although the derivatives predict it.
  kIterations,   ///< Limit of iterations.
  kInterrupted,  ///< Stopped; the state can be resumed.
  kFailed,       ///< The start could not be computed.
  kRefused,      ///< The problem is invalid; see `why`.
};

/// One search: start, held parameters, left-out groups. All searches of a call run in lockstep, so
/// that their points are computed together.
struct FitJob {
  std::vector<double> start;   ///< Clipped to the bounds.
  std::vector<bool> held;      ///< Parameters fixed at their start; empty: none.
  std::vector<bool> left_out;  ///< Excluded groups, by number; empty: none.
};

/// State of a search: plain numbers, sufficient to resume it.
struct FitTrack {
  FitEnd end = FitEnd::kRunning;
  std::string why;             ///< Reason for its end, in a sentence.
  std::vector<double> start;   ///< Start point.
  std::vector<double> values;  ///< The best point so far.
  double cost = 0;             ///< Half of the sum of losses and squared priors at `values`.
  double damping = 0;          ///< Marquardt's lambda.
  std::vector<double> weight;  ///< Marquardt's D (eq. F.4), one per parameter.
  int iterations = 0;
  int rejected = 0;                ///< Iterations since the last accepted step.
  std::vector<double> step_share;  ///< `FitColumn::step_share`, one per parameter.
  bool check = true;               ///< Whether difference steps are (to be) checked at `values`.
  std::int64_t failed = 0;         ///< Number of trial points that could not be computed.
  std::map<std::string, std::int64_t> reasons;  ///< Number of failed points per reason.
};

struct FitState {
  std::vector<FitTrack> tracks;  ///< One per job, in their order. Empty: not started.
  std::int64_t points = 0;       ///< Points computed so far.
};

struct FitOptions {
  int starts = 1;  ///< Number of starts: first the parameters' starts, others are drawn.
  std::uint64_t seed = 0;
  int most_iterations = 100;  ///< Limit per start.
  int dampings = 3;           ///< Trial points per iteration, each with another damping.
  double first_damping = 1e-3;
  double gradient_tolerance = 1e-8;  ///< For the cosine between residuals and columns.
  double step_tolerance = 1e-8;      ///< For the step, in scales.
  double cost_tolerance = 1e-12;     ///< For the change of the cost, relative to the cost.
  const std::atomic<bool>* stop = nullptr;
  /// Called after each iteration of all searches; the state may be stored. Returning false stops.
  std::function<bool(const FitState&)> progress;
};

struct FitResult {
  FitEnd end = FitEnd::kRefused;  ///< End of the best search, or of all.
  std::string why;
  FitState state;
  std::optional<std::size_t> best;  ///< Track with the lowest cost; the first of equal ones.
  std::vector<double> values;       ///< Values of the best track.
  double cost = 0;
};

/// Fits from `options.starts` starts. The first is given, the others are drawn from the priors,
/// truncated at the bounds; without a prior, uniformly between the bounds; without bounds, within
/// four scales of the start. A drawn start that cannot be computed is drawn again, up to eight
/// times. `from`: state of the same problem and options to resume.
FitResult Fit(const FitProblem& problem, const FitOptions& options, const FitState& from = {});

/// Runs searches with the held parameters and left-out groups of each job. Ignores `options.starts`
/// and `seed`.
FitState RunFitJobs(const FitProblem& problem, std::span<const FitJob> jobs,
                    const FitOptions& options, const FitState& from = {});

/// Returns drawn start `number`; 0 is the given start.
std::vector<double> DrawFitStart(const FitProblem& problem, std::uint64_t seed,
                                 std::uint64_t number);

/// Derivatives by one parameter at a point, from differences of two sizes, h and h / 2, with a
/// check of their accuracy (eq. F.6 to F.9).
struct FitColumn {
  /// d residual / d parameter, one per row, in residuals per unit of the parameter: central
  /// differences, extrapolated from both sizes; one-sided of second order next to a bound.
  std::vector<double> slope;
  double error = 0;  ///< Norm of the difference between both sizes, in residuals per scale.
  /// The sizes disagree by more than a twentieth of the slope and by more than 0.05 residuals per
  /// scale: the function has a kink or a jump here, for example where another contact slips. The
  /// slope is unreliable.
  bool kink = false;
  double kink_share = 0;  ///< Size of the disagreement, relative to the slope.
  double step = 0;        ///< The longer size h, in the parameter's unit.
  /// Share of the problem's step: below 1 if that step was too long (its two sizes disagreed, and
  /// shorter ones agree). Standard errors longer than `step` are unreliable: the function curves.
  double step_share = 1;
  /// Second-order part over a step, in residuals per scale: shows a purely quadratic effect, which
  /// has no slope.
  double curved = 0;
  std::string failed;  ///< Reason if points of this column could not be computed.
};

struct FitDerivatives {
  bool done = false;  ///< False if the point itself failed or the computation was stopped.
  std::string why;
  std::vector<double> residual;    ///< At the point.
  std::vector<FitColumn> columns;  ///< One per parameter.
};

/// Computes residuals and derivatives at `values`.
FitDerivatives Differentiate(const FitProblem& problem, const std::vector<double>& values);

}  // namespace taut
