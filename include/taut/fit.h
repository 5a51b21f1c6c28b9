/// Fitting: parameters that make residuals small, by Levenberg's and Marquardt's method with
/// bounds, priors and several starts, over an abstract function that computes many points at once.
/// What the result is worth says `taut/fit_verdict.h`, what to measure next `taut/fit_design.h`.
/// Equations: docs/theory/identification.md.
///
/// Values, bounds, priors and steps are in each parameter's own unit; a residual is in units of its
/// datum's standard deviation, so that it has none. The same problem, options and state give the
/// same bits.
///
/// Threads: any number may call these functions at once, each with a problem whose `forward` it may
/// call; they keep nothing. Whoever sets `stop` may be any thread.
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
  /// What was known before: a normal distribution, a residual of its own. Infinite: nothing.
  double prior_sd = std::numeric_limits<double>::infinity();
  std::optional<double> prior_mean;  ///< Without: the start.
  /// A change that matters, in which directions are compared and above half of which a standard
  /// error is too large to speak of an estimate. 0: the prior's sd; without a prior a quarter of
  /// the bounds' distance; without bounds a tenth of the start; of a start at 0: 1.
  double scale = 0;
  double step = 0.1;      ///< Of differences, in scales, > 0.
  bool nuisance = false;  ///< Need not be determined by the data: an offset of a sensor, a delay.
};

/// `parameter.scale`, or what stands for 0. > 0.
double FitScale(const FitParameter& parameter);

enum class FitLoss {
  kSquare,  ///< r^2
  kHuber,   ///< Linear beyond a width: 2 w |r| - w^2.
  kCauchy,  ///< w^2 log(1 + r^2 / w^2)
};

/// One residual.
struct FitRow {
  int group = 0;  ///< What hangs together, as a test does: left out together, resampled together.
  FitLoss loss = FitLoss::kSquare;
  double loss_width = 1.345;  ///< In standard deviations, > 0.
};

/// One point's.
struct Residuals {
  std::vector<double> value;  ///< (model - datum) / sd, one a row of the problem.
  std::string failed;         ///< Why this point could not be computed; else empty.
};

/// Computes points, each of as many values as there are parameters, and answers as many, in their
/// order. All points of a call are independent: they may run side by side. An answer that is not
/// finite or has not one value a row counts as failed. Fewer answers than points: it was stopped.
/// All points lie within the bounds.
using Forward = std::function<std::vector<Residuals>(std::span<const std::vector<double>> points)>;

struct FitProblem {
  std::vector<FitParameter> parameters;
  std::vector<FitRow> rows;
  std::vector<std::string> group_names;  ///< For sentences; those that are missing are numbered.
  Forward forward;
};

/// What is wrong with a problem, one sentence each: a sd that is not positive, a start out of its
/// bounds, no row. Those below answer kRefused to a problem with any.
std::vector<std::string> CheckFitProblem(const FitProblem& problem);

enum class FitEnd {
  kRunning,      ///< Not there yet; a state that can go on.
  kConverged,    ///< The projected gradient, the step or the change of the cost vanished.
  kStuck,        ///< No step lowers the cost: as far as the differences carry.
  kIterations,   ///< As many as were allowed.
  kInterrupted,  ///< Stopped; it can go on from its state.
  kFailed,       ///< The start could not be computed.
  kRefused,      ///< The problem is none; see `why`.
};

/// One search: from a start, with some parameters held and some rows left out. All searches of a
/// call run in lockstep, so that the points of all are computed side by side.
struct FitJob {
  std::vector<double> start;   ///< Clipped to the bounds.
  std::vector<bool> held;      ///< Parameters that keep their start; empty: none.
  std::vector<bool> left_out;  ///< Groups that do not count, by number; empty: none.
};

/// Where a search is. Plain numbers, enough to go on.
struct FitTrack {
  FitEnd end = FitEnd::kRunning;
  std::string why;             ///< A sentence about its end.
  std::vector<double> start;   ///< Where it began.
  std::vector<double> values;  ///< The best point so far.
  double cost = 0;             ///< Half of the sum of losses and squared priors at `values`.
  double damping = 0;          ///< Marquardt's lambda.
  std::vector<double> weight;  ///< His D, one a parameter.
  int iterations = 0;
  int rejected = 0;                ///< Iterations since it last moved.
  std::vector<double> step_share;  ///< Shares of the difference steps, one a parameter.
  bool check = true;               ///< Whether difference steps are (to be) checked at `values`.
  std::int64_t failed = 0;         ///< Trial points that could not be computed,
  std::map<std::string, std::int64_t> reasons;  ///< and why, with how many of each.
};

struct FitState {
  std::vector<FitTrack> tracks;  ///< One a job, in their order. Empty: not begun.
  std::int64_t points = 0;       ///< Computed so far.
};

struct FitOptions {
  int starts = 1;  ///< The first is the parameters' starts; others are drawn.
  std::uint64_t seed = 0;
  int most_iterations = 100;  ///< A start.
  int dampings = 3;           ///< Trial points at once an iteration, each with its own.
  double first_damping = 1e-3;
  double gradient_tolerance = 1e-8;  ///< Of the cosine of residuals and columns.
  double step_tolerance = 1e-8;      ///< In scales.
  double cost_tolerance = 1e-12;     ///< Of the cost.
  const std::atomic<bool>* stop = nullptr;
  /// Called after each iteration of all searches; the state can be kept. False stops.
  std::function<bool(const FitState&)> progress;
};

struct FitResult {
  FitEnd end = FitEnd::kRefused;  ///< Of the best search, or of all.
  std::string why;
  FitState state;
  std::optional<std::size_t> best;  ///< Of the tracks: the lowest cost, of equal ones the first.
  std::vector<double> values;       ///< Its values.
  double cost = 0;
};

/// Fits from `options.starts` starts: the given one, others drawn from the priors, cut off at the
/// bounds, or without a prior evenly between the bounds, or within four scales about the start. A
/// drawn start that cannot be computed is drawn again, up to eight times. `from`: a state to go on
/// from, of the same problem and options.
FitResult Fit(const FitProblem& problem, const FitOptions& options, const FitState& from = {});

/// The searches themselves: leaves out and holds as told. `options.starts` and `seed` do not count.
FitState RunFitJobs(const FitProblem& problem, std::span<const FitJob> jobs,
                    const FitOptions& options, const FitState& from = {});

/// The drawn start of a number; 0 is the given one.
std::vector<double> DrawFitStart(const FitProblem& problem, std::uint64_t seed,
                                 std::uint64_t number);

/// Derivatives at a point by differences of two sizes, h and h / 2, with their own check.
struct FitColumn {
  /// d residual / d parameter, one a row, in residuals a unit of the parameter: central,
  /// extrapolated from both sizes; one-sided of second order next to a bound.
  std::vector<double> slope;
  double error = 0;  ///< The norm by which both sizes differ, in residuals a scale.
  /// The sizes disagree, by more than a twentieth of the slope and 0.05 residuals a scale: the
  /// function has a kink or a jump here, as where another contact slips. Not to be trusted.
  bool kink = false;
  double kink_share = 0;  ///< By how much, as a share of the slope.
  double step = 0;        ///< The longer size, in the parameter's unit.
  /// Share of the problem's step: below 1 if that step was too long (its two sizes disagreed, and
  /// shorter ones agree). Standard errors longer than `step` are unreliable: the function curves.
  double step_share = 1;
  /// The second derivative's part over a step, in residuals a scale: an effect that begins with its
  /// square shows here and not in the slope.
  double curved = 0;
  std::string failed;  ///< Points of this column could not be computed, and why.
};

struct FitDerivatives {
  bool done = false;  ///< False if the point itself failed or the computation was stopped.
  std::string why;
  std::vector<double> residual;    ///< At the point.
  std::vector<FitColumn> columns;  ///< One a parameter.
};

FitDerivatives Differentiate(const FitProblem& problem, const std::vector<double>& values);

}  // namespace taut
