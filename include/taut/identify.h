/// System identification: builds a least-squares problem from a fit file and its data, runs the fit
/// (`taut/fit.h`) and writes the results (docs/fit.md). The forward model runs the experiments with
/// trial values and compares the results with the measurements.
///
/// Threads: only one thread at a time may use an `Identification`, which has an internal thread
/// pool.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "taut/diagnostics.h"
#include "taut/fit.h"
#include "taut/fit_design.h"
#include "taut/fit_spec.h"
#include "taut/fit_verdict.h"

namespace taut {

/// Compared value. The residual of the point is (computed - measured) / sd.
struct FitPoint {
  std::size_t experiment = 0;  ///< Index of the experiment in the fit.
  std::string channel, unit;
  std::string where;  ///< For example "set point 3", "late", "at 2.5 s".
  /// Time on the clock of the experiment; for a window, its middle; for a load case, its number,
  /// from 1.
  double time_s = 0;
  double measured = 0, sd = 1;
};

/// Options of an `Identification`. An identification caches computed points within a run, and
/// across runs if `memory_file` is set.
struct IdentifyOptions {
  int threads = 0;          ///< Number of threads; 0: one per core.
  std::string memory_file;  ///< SQLite file; created if missing. Empty: no file.
  const std::atomic<bool>* stop = nullptr;
};

/// Function that processes independent pieces of a fit, like `Cluster::Work`. The function returns
/// one result per piece, in order, or fewer results if it was stopped.
using FitWork = std::function<std::vector<std::string>(std::span<const std::string> pieces)>;

struct IdentifyCounts {
  std::int64_t computed = 0;    ///< Number of simulated experiments and computed equilibria.
  std::int64_t remembered = 0;  ///< Number of points read from the memory file.
  std::int64_t damaged = 0;     ///< Number of damaged points in the file; they were computed again.
};

/// Result of a `FitCarried` check for one experiment: applied load and measured member forces,
/// along the direction of the check. Member directions come from the equilibria of the experiment
/// before the fit.
struct CarriedLoad {
  struct Row {
    std::string where;     ///< See `FitPoint::where`.
    double applied_n = 0;  ///< Loads and weight of the bodies, along the direction of the check.
    double carried_n = 0;  ///< Sum of the measured member forces along this direction.
    double sd_n = 0;       ///< Standard deviation of `carried_n` from the sds of the data.
  };
  std::string name;  ///< Name of the check.
  std::size_t experiment = 0;
  std::vector<Row> rows;
  ProportionCheck check;  ///< `why` is also set if the equilibria could not be computed.
};

/// Fit problem: data, forward model and cache.
class Identification {
 public:
  /// Reads the data and the memory file. On an error, returns null and adds diagnostics. Errors: a
  /// window without data, channels missing on one side, different units, fewer data than unknowns,
  /// a memory file of another fit.
  static std::unique_ptr<Identification> Make(const FitSpec& spec, const IdentifyOptions& options,
                                              Diagnostics& out);
  virtual ~Identification() = default;

  virtual const FitSpec& spec() const = 0;
  /// Returns the index in `spec().estimates` of each parameter of the problem, in order. Only
  /// estimates that affect training data are parameters; others keep their start values.
  virtual const std::vector<std::size_t>& estimates() const = 0;

  virtual const FitProblem& train() const = 0;
  virtual const FitProblem* test() const = 0;  ///< Null without held-out data.
  /// Returns one problem per entry of `design` in the fit file, with sds of 1 and measured values
  /// of 0.
  virtual const std::vector<FitProblem>& design() const = 0;
  virtual const std::vector<std::vector<FitPoint>>& design_points() const = 0;
  virtual const std::vector<FitPoint>& train_points() const = 0;  ///< One per row of the problem.
  virtual const std::vector<FitPoint>& test_points() const = 0;

  /// Returns the increasing times [s] at which a static experiment has its equilibria.
  virtual const std::vector<double>& moments_s(std::size_t experiment) const = 0;
  /// Runs the `carried` checks of the fit for all their experiments, including the computation of
  /// the equilibria.
  virtual std::vector<CarriedLoad> Carried() const = 0;

  /// Processes pieces of a fit in this process. The pieces come from this object or from another
  /// process with the same fit.
  virtual std::vector<std::string> Do(std::span<const std::string> pieces) = 0;
  /// Makes `spread` process all further pieces, on `processes` processes. The results stay
  /// bit-identical.
  virtual void SpreadBy(FitWork spread, int processes) = 0;
  /// Returns a text that must be equal on all processes, for `Cluster::Agree`: fit, data and
  /// experiments.
  virtual std::string Agreed() const = 0;

  virtual IdentifyCounts counts() const = 0;
  /// Returns the reason if the memory file is no longer writable; otherwise empty.
  virtual std::string memory_error() const = 0;
  /// Returns the first input file of the fit that is no longer readable, with the reason; otherwise
  /// empty. Such a file ends the search; finished trials are kept.
  virtual std::string input_error() const = 0;
};

/// Progress of a fit.
struct IdentifyProgress {
  const char* what = "";  ///< "searching", "judging" or "profile".
  int iterations = 0;     ///< Sum over all searches in progress.
  double chi2 = 0;        ///< Lowest chi-square so far: twice the cost.
  std::int64_t computed = 0;
  int most_iterations = 0;     ///< Limit of `iterations` for this part; 0: unknown.
  std::vector<double> values;  ///< Best values so far, in the order of the parameters.
};

struct OutcomeOptions {
  std::vector<std::string> profiles;  ///< Parameter names to profile; "*": all.
  bool design = false;
  const std::atomic<bool>* stop = nullptr;
  std::function<void(const IdentifyProgress&)> progress;
};

/// Residuals at the start and after the fit, in standard deviations, per row of the problem.
struct BeforeAfter {
  std::vector<double> untuned, fitted;
};

/// Complete result of a fit.
struct FitOutcome {
  bool interrupted = false;
  std::string why;  ///< Reason, if there is no fit.
  FitResult fit;
  FitVerdict verdict;
  BeforeAfter train, test;
  std::vector<FitProfile> profiles;
  std::optional<DesignRanking> design;
  std::vector<CarriedLoad> carried;
};

/// Checks at the problem's start that at least one residual depends on each estimate. Returns false
/// and adds an error for each estimate without influence, or if the start cannot be computed.
bool CheckDependence(const Identification& fit, Diagnostics& out);

/// Runs the search, the evaluation, and the requested profiles and design ranking.
FitOutcome RunFit(const Identification& fit, const OutcomeOptions& options);

/// Return the outcome as terminal text, as a JSON object, or as a self-contained HTML page.
/// `looks`: per experiment, the path of a page with runs before and after the fit, relative to the
/// folder of the HTML page; empty strings, or an empty list, for experiments without such a page.
std::string OutcomeText(const Identification& fit, const FitOutcome& outcome);
/// Returns a short summary for a terminal, one text per line without line ends: the verdict, checks
/// and errors, one line per profile, and one line per parameter.
std::vector<std::string> OutcomeLines(const Identification& fit, const FitOutcome& outcome);
std::string OutcomeJson(const Identification& fit, const FitOutcome& outcome);
std::string OutcomePage(const Identification& fit, const FitOutcome& outcome,
                        const std::vector<std::string>& looks = {});

/// Root mean square of computed - measured of one channel, in its unit.
struct ChannelErrors {
  std::string channel, unit;
  std::size_t count = 0;
  double untuned = 0, fitted = 0, fitted_bias = 0;
};
/// Computes the errors of each channel, in order of the points.
std::vector<ChannelErrors> ErrorsByChannel(const std::vector<FitPoint>& points,
                                           const BeforeAfter& residuals);

/// Root mean square of the residuals of one experiment, in standard deviations.
struct ExperimentErrors {
  std::string experiment;
  std::size_t count = 0;
  double untuned = 0, fitted = 0;
};
/// Computes the errors of each experiment, in order of the points.
std::vector<ExperimentErrors> ErrorsByExperiment(const FitSpec& spec,
                                                 const std::vector<FitPoint>& points,
                                                 const BeforeAfter& residuals);

/// Returns the text of an experiment file with these values of the problem's parameters. The new
/// file extends experiment `experiment` of the fit by `base:`, `parameters:` and `set:`. `folder`:
/// folder of the new file.
std::string FittedExperimentYaml(const Identification& fit, std::size_t experiment,
                                 const std::vector<double>& values, const std::string& folder);

/// Writes a run folder, for viewers, with the equilibria of experiment `experiment` of the fit,
/// computed from the experiment `with`. The trace has one row per equilibrium; load case i is at i
/// s. Returns false and adds an error if an equilibrium is not found or the folder cannot be
/// written.
bool WriteRests(const Identification& fit, std::size_t experiment, const ExperimentSpec& with,
                const std::string& folder, Diagnostics& out);

}  // namespace taut
