/// System identification: builds the least-squares problem of a fit file and its data, runs the fit
/// (`taut/fit.h`) and writes its results (docs/fit.md). The forward model runs the experiments with
/// trial values of the estimates and compares them with the measurements.
///
/// Threads: an `Identification` may be used by one thread at a time; it has an internal thread
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

/// One compared value: its residual is (computed - measured) / sd.
struct FitPoint {
  std::size_t experiment = 0;  ///< Index in the fit.
  std::string channel, unit;
  std::string where;  ///< "set point 3", "late", "at 2.5 s".
  /// On the experiment's clock; the middle of a window. For a load case: its number, from 1.
  double time_s = 0;
  double measured = 0, sd = 1;
};

/// Options of an `Identification`. It caches computed points, so that each is computed once; with
/// `memory_file` once across all runs.
struct IdentifyOptions {
  int threads = 0;          ///< 0: one per core.
  std::string memory_file;  ///< SQLite file, created if missing. Empty: none.
  const std::atomic<bool>* stop = nullptr;
};

/// Computes independent pieces of a fit, as `Cluster::Work` spreads them over processes. Returns
/// the result of each piece, in their order; fewer results than pieces if it was stopped.
using FitWork = std::function<std::vector<std::string>(std::span<const std::string> pieces)>;

struct IdentifyCounts {
  std::int64_t computed = 0;    ///< Experiments that were run, or brought to rest.
  std::int64_t remembered = 0;  ///< Points read from the memory file.
  std::int64_t damaged = 0;     ///< Damaged points of the file, which were recomputed.
};

/// Result of the consistency check of measured forces for one experiment (`FitCarried`): applied
/// and carried force along its direction. Directions of members come from the rests of the unfitted
/// experiment.
struct CarriedLoad {
  struct Row {
    std::string where;     ///< As in `FitPoint`.
    double applied_n = 0;  ///< Loads and weight of the bodies, along the check's direction.
    double carried_n = 0;  ///< Measured forces of the members.
    double sd_n = 0;       ///< Standard deviation of `carried_n`, by the sds of the data.
  };
  std::string name;  ///< Name of the check.
  std::size_t experiment = 0;
  std::vector<Row> rows;
  ProportionCheck check;  ///< `why` is also set if the rests could not be computed.
};

/// Problem of a fit: data, forward model and cache.
class Identification {
 public:
  /// Reads the data and the memory file. Returns null and adds diagnostics on errors: a window
  /// without data, channels missing on one side, different units, fewer data than unknowns, the
  /// memory file of another fit.
  static std::unique_ptr<Identification> Make(const FitSpec& spec, const IdentifyOptions& options,
                                              Diagnostics& out);
  virtual ~Identification() = default;

  virtual const FitSpec& spec() const = 0;
  /// Returns the indices in `spec().estimates` of the problem's parameters, in its order: estimates
  /// that affect training data. Others keep their start values.
  virtual const std::vector<std::size_t>& estimates() const = 0;

  virtual const FitProblem& train() const = 0;
  virtual const FitProblem* test() const = 0;  ///< Null: no held-out data.
  /// Returns one problem per entry of `design` of the fit; with sds of 1 and measured values of 0.
  virtual const std::vector<FitProblem>& design() const = 0;
  virtual const std::vector<std::vector<FitPoint>>& design_points() const = 0;
  virtual const std::vector<FitPoint>& train_points() const = 0;  ///< One per row of the problem.
  virtual const std::vector<FitPoint>& test_points() const = 0;

  /// Returns the times at which a static experiment is brought to rest [s], increasing.
  virtual const std::vector<double>& moments_s(std::size_t experiment) const = 0;
  /// Runs the checks in `carried` of the fit for each of their experiments, which it brings to
  /// rest.
  virtual std::vector<CarriedLoad> Carried() const = 0;

  /// Computes pieces of a fit in this process, for this object or for the same fit in another
  /// process.
  virtual std::vector<std::string> Do(std::span<const std::string> pieces) = 0;
  /// Computes all further pieces by `spread`, over `processes` processes. Results keep their bits.
  virtual void SpreadBy(FitWork spread, int processes) = 0;
  /// Returns a text for `Cluster::Agree`, which must be equal on all processes: fit, data and
  /// experiments.
  virtual std::string Agreed() const = 0;

  virtual IdentifyCounts counts() const = 0;
  /// Returns the reason if the memory file can no longer be written; else empty.
  virtual std::string memory_error() const = 0;
  /// Returns the file of the fit that can no longer be read, and the reason; empty if all can be.
  /// Such a file ends a search, and the trials so far are kept.
  virtual std::string input_error() const = 0;
};

/// Progress of a fit.
struct IdentifyProgress {
  const char* what = "";  ///< "searching", "judging", "profile".
  int iterations = 0;     ///< Sum over all searches of this part.
  double chi2 = 0;        ///< Lowest chi-square so far, twice the cost.
  std::int64_t computed = 0;
};

struct OutcomeOptions {
  std::vector<std::string> profiles;  ///< Parameter names to profile; "*": all.
  bool design = false;
  const std::atomic<bool>* stop = nullptr;
  std::function<void(const IdentifyProgress&)> progress;
};

/// Residuals of a problem's rows, in standard deviations: at the start of the search, and fitted.
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

/// Checks that at least one residual depends on each estimate, at the problem's start. Returns
/// false and adds an error for each estimate without influence, or if the start cannot be computed.
bool CheckDependence(const Identification& fit, Diagnostics& out);

/// Runs the search, the verdict, and the requested profiles and design ranking.
FitOutcome RunFit(const Identification& fit, const OutcomeOptions& options);

/// Formats the outcome for a terminal, as one JSON object, or as one self-contained HTML page.
/// `looks`: per experiment, the path of its page with runs before and after the fit, relative to
/// the page's folder; empty strings, or an empty list, for experiments without one.
std::string OutcomeText(const Identification& fit, const FitOutcome& outcome);
/// Returns the short summary for a terminal, without line ends: the verdict, checks and errors, one
/// line per profile and per parameter.
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
/// Computes errors by channel, in the order of the points.
std::vector<ChannelErrors> ErrorsByChannel(const std::vector<FitPoint>& points,
                                           const BeforeAfter& residuals);

/// Returns an experiment file that extends experiment `experiment` of the fit by `base:`,
/// `parameters:` and `set:` with these values of the problem's parameters. `folder`: folder of the
/// new file.
std::string FittedExperimentYaml(const Identification& fit, std::size_t experiment,
                                 const std::vector<double>& values, const std::string& folder);

/// Writes a run folder, for viewers, with the rests of experiment `experiment` of the fit, computed
/// with the experiment `with`. The trace has one row per rest; load case i is at i s. Returns false
/// and adds an error if a rest is not found or the folder cannot be written.
bool WriteRests(const Identification& fit, std::size_t experiment, const ExperimentSpec& with,
                const std::string& folder, Diagnostics& out);

}  // namespace taut
