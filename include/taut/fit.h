/// Nonlinear least squares (Levenberg-Marquardt) with bounds, priors, robust losses and several
/// starts. A function of the caller computes residuals at many points per call.
/// `taut/fit_verdict.h` evaluates the result, `taut/fit_design.h` ranks further measurements.
/// Equations: docs/theory/identification.md.
///
/// Units: values, bounds, priors and steps have the unit of the parameter; residuals are in
/// standard deviations of their data, so they are dimensionless. The same problem, options and
/// state give bit-identical results.
///
/// Threads: any number may call these functions concurrently; there is no shared state. `forward`
/// of the problem must be thread safe. Any thread may set `stop`.
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
  /// Standard deviation of the normal prior, which adds a residual. Infinite: no prior.
  double prior_sd = std::numeric_limits<double>::infinity();
  std::optional<double> prior_mean;  ///< Absent: the start value.
  /// Relevant change of the parameter, the unit of directions and steps. Without a prior, an
  /// estimate needs a standard error below half the scale. 0 selects a default: the sd of the
  /// prior; without a prior, a quarter of the distance between the bounds; without bounds, a tenth
  /// of the start value, or 1 if the start value is 0.
  double scale = 0;
  double step = 0.1;  ///< Step of finite differences, in units of the scale, > 0.
  /// The data need not determine the parameter, for example a sensor offset or a delay.
  bool nuisance = false;
};

/// Returns `parameter.scale`, or its default if it is 0; > 0.
double FitScale(const FitParameter& parameter);

enum class FitLoss {
  kSquare,  ///< Least squares: r^2.
  kHuber,   ///< Huber's loss: 2 w |r| - w^2 beyond the width w, otherwise r^2.
  kCauchy,  ///< Cauchy's loss: w^2 log(1 + r^2 / w^2), with the width w.
};

/// Group and loss of one residual (eq. F.2).
struct FitRow {
  /// Number of a group of correlated residuals, such as one test. Cross-validation leaves out whole
  /// groups.
  int group = 0;
  FitLoss loss = FitLoss::kSquare;
  double loss_width = 1.345;  ///< In standard deviations, > 0.
  /// Number of the experiment of the datum, to compare experiments (`FitExperimentsAlone`).
  int experiment = 0;
};

/// Residuals at one point.
struct Residuals {
  std::vector<double> value;  ///< (model - datum) / sd, one per row of the problem.
  std::string failed;         ///< Reason if the point could not be computed; otherwise empty.
};

/// Computes the residuals at points (one value per parameter), in order of the points. All points
/// are within the bounds and may be computed in parallel. A result counts as failed if it is not
/// finite or does not have one value per row. Fewer results than points mean that the computation
/// was stopped.
using Forward = std::function<std::vector<Residuals>(std::span<const std::vector<double>> points)>;

struct FitProblem {
  std::vector<FitParameter> parameters;
  std::vector<FitRow> rows;
  /// Names for messages; numbers replace missing names.
  std::vector<std::string> group_names, experiment_names;
  Forward forward;
};

/// Returns the errors of a problem, one sentence each, such as a sd that is not positive, a start
/// outside its bounds, or no rows. For a problem with errors, the functions below return kRefused.
std::vector<std::string> CheckFitProblem(const FitProblem& problem);

enum class FitEnd {
  kRunning,      ///< Not finished; the state can be resumed.
  kConverged,    ///< The projected gradient, the step or the cost change is below its tolerance.
  kStuck,        ///< No step decreases the cost, although the derivatives predict a decrease.
  kIterations,   ///< Iteration limit reached.
  kInterrupted,  ///< Stopped; the state can be resumed.
  kFailed,       ///< The start could not be computed.
  kRefused,      ///< The problem is invalid; see `why`.
};

/// One search: start, held parameters, left-out groups. All searches of a call run in lockstep, so
/// their points are computed together.
struct FitJob {
  std::vector<double> start;   ///< Start point, clipped to the bounds.
  std::vector<bool> held;      ///< Parameters fixed at their start value; empty: none.
  std::vector<bool> left_out;  ///< Excluded groups, by number; empty: none.
};

/// State of a search, sufficient to resume it.
struct FitTrack {
  FitEnd end = FitEnd::kRunning;
  std::string why;             ///< Reason for the end, one sentence.
  std::vector<double> start;   ///< Start point.
  std::vector<double> values;  ///< The best point so far.
  double cost = 0;             ///< Half the sum of losses and squared prior residuals at `values`.
  double damping = 0;          ///< Marquardt's lambda.
  std::vector<double> weight;  ///< Marquardt's D (eq. F.4), one per parameter.
  int iterations = 0;
  int rejected = 0;                ///< Iterations since the last accepted step.
  std::vector<double> step_share;  ///< `FitColumn::step_share`, one per parameter.
  bool check = true;        ///< Whether the steps of finite differences are checked at `values`.
  std::int64_t failed = 0;  ///< Number of trial points that could not be computed.
  std::map<std::string, std::int64_t> reasons;  ///< Number of failed points for each reason.
};

struct FitState {
  std::vector<FitTrack> tracks;  ///< One per job, in order. Empty: not started.
  std::int64_t points = 0;       ///< Points computed so far.
};

struct FitOptions {
  int starts = 1;  ///< Number of starts: the start values of the parameters, then random ones.
  std::uint64_t seed = 0;
  int most_iterations = 100;  ///< Maximum number of iterations per start.
  int dampings = 3;           ///< Trial points per iteration, with different dampings.
  double first_damping = 1e-3;
  /// Tolerance for the cosine between the residuals and the columns of the Jacobian.
  double gradient_tolerance = 1e-8;
  double step_tolerance = 1e-8;   ///< For the step length, in units of the scale.
  double cost_tolerance = 1e-12;  ///< For the cost change, relative to the cost.
  const std::atomic<bool>* stop = nullptr;
  /// Called after each iteration of all searches, for example to store the state. Return false to
  /// stop.
  std::function<bool(const FitState&)> progress;
};

struct FitResult {
  /// Reason why the best search ended; without a best search, why all searches ended.
  FitEnd end = FitEnd::kRefused;
  std::string why;
  FitState state;
  std::optional<std::size_t> best;  ///< Track with the lowest cost; the first one if equal.
  std::vector<double> values;       ///< Values of the best track.
  double cost = 0;
};

/// Fits from `options.starts` starts. The first has the start values; the others are drawn from the
/// priors within the bounds. Without a prior, they are uniform between the bounds; without bounds,
/// within four scales of the start value. A random start that cannot be computed is drawn again, up
/// to eight times. `from`: state of the same problem and options, to resume.
FitResult Fit(const FitProblem& problem, const FitOptions& options, const FitState& from = {});

/// Runs one search per job. Ignores `options.starts` and `seed`.
FitState RunFitJobs(const FitProblem& problem, std::span<const FitJob> jobs,
                    const FitOptions& options, const FitState& from = {});

/// Returns random start `number`; 0 is the given start.
std::vector<double> DrawFitStart(const FitProblem& problem, std::uint64_t seed,
                                 std::uint64_t number);

/// Derivatives with respect to one parameter at a point, from finite differences of two step sizes,
/// h and h / 2, with an accuracy check (eq. F.6 to F.9).
struct FitColumn {
  /// d residual / d parameter, one per row, in the inverse unit of the parameter. Central
  /// differences, extrapolated from both step sizes; next to a bound one-sided, second order.
  std::vector<double> slope;
  double error = 0;  ///< Norm of the difference between both step sizes, in residuals per scale.
  /// The two step sizes disagree by more than 1/20 of the slope and more than 0.05 residuals per
  /// scale. The function has a kink or a jump here, for example a contact that starts to slip, and
  /// the slope is unreliable.
  bool kink = false;
  double kink_share = 0;  ///< The disagreement relative to the slope.
  double step = 0;        ///< The larger step h, in the unit of the parameter.
  /// Ratio of `step` to the problem's difference step. Below 1 if the slopes for the problem's step
  /// and for half of it disagreed, but the slopes for a shorter step agree. Standard errors above
  /// `step` are unreliable, because the function is nonlinear over them.
  double step_share = 1;
  /// Second-order change over a step, in residuals per scale. Reveals a purely quadratic effect,
  /// which has slope 0.
  double curved = 0;
  std::string failed;  ///< Reason if points of this column could not be computed.
};

struct FitDerivatives {
  bool done = false;  ///< False if the point failed or the computation was stopped.
  std::string why;
  std::vector<double> residual;    ///< Residuals at the point.
  std::vector<FitColumn> columns;  ///< One per parameter.
};

/// Computes residuals and derivatives at `values`.
FitDerivatives Differentiate(const FitProblem& problem, const std::vector<double>& values);

}  // namespace taut
