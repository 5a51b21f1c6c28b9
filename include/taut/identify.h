/// From a fit file and its data to a problem that `taut/fit.h` solves: what experiments give for
/// any values of what is estimated, set beside what was measured (docs/fit.md).
///
/// Threads: an `Identification` belongs to one thread at a time; it computes on threads of its own.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "taut/diagnostics.h"
#include "taut/fit.h"
#include "taut/fit_design.h"
#include "taut/fit_spec.h"
#include "taut/fit_verdict.h"

namespace taut {

/// One number that is compared: a residual is (computed - measured) / sd.
struct FitPoint {
  std::size_t experiment = 0;  ///< Of the fit.
  std::string channel, unit;
  std::string where;  ///< "set point 3", "late", "at 2.5 s".
  double time_s = 0;  ///< On the experiment's clock; the middle of a window. Of a load case: its
                      ///< number, from 1.
  double measured = 0, sd = 1;
};

/// What experiments give, remembered: the same point is computed once, and once in all if `file`
/// keeps it.
struct IdentifyOptions {
  int threads = 0;          ///< 0: one a core.
  std::string memory_file;  ///< Empty: none. SQLite; made if it is not there.
  const std::atomic<bool>* stop = nullptr;
};

struct IdentifyCounts {
  std::int64_t computed = 0;    ///< Experiments that were run, or brought to rest.
  std::int64_t remembered = 0;  ///< Points that the file knew.
  std::int64_t damaged = 0;     ///< Of the file's, that were computed again.
};

class Identification {
 public:
  /// Reads the data and the memory. Null and diagnostics if anything is wrong with them: data that
  /// no window meets, channels that one side lacks, units that differ, fewer data than unknowns, a
  /// memory of another fit.
  static std::unique_ptr<Identification> Make(const FitSpec& spec, const IdentifyOptions& options,
                                              Diagnostics& out);
  virtual ~Identification() = default;

  virtual const FitSpec& spec() const = 0;
  /// Of `spec().estimates`, those that act on what is trained on: the problem's parameters, in its
  /// order. Others stay where they start.
  virtual const std::vector<std::size_t>& estimates() const = 0;

  virtual const FitProblem& train() const = 0;
  virtual const FitProblem* test() const = 0;  ///< Null: nothing is held out.
  /// What `design` of the fit would measure, one each; sds are 1, measured are 0.
  virtual const std::vector<FitProblem>& design() const = 0;
  virtual const std::vector<std::vector<FitPoint>>& design_points() const = 0;
  virtual const std::vector<FitPoint>& train_points() const = 0;  ///< A row of the problem each.
  virtual const std::vector<FitPoint>& test_points() const = 0;

  virtual IdentifyCounts counts() const = 0;
  /// Why the memory can no longer be written; empty if it can.
  virtual std::string memory_error() const = 0;
};

/// Where work on a fit stands.
struct IdentifyProgress {
  const char* what = "";  ///< "searching", "judging", "profile".
  int iterations = 0;     ///< Of all searches of this part.
  double chi2 = 0;        ///< The lowest so far; twice the cost.
  std::int64_t computed = 0;
};

struct OutcomeOptions {
  std::vector<std::string> profiles;  ///< Names of parameters; "*": all.
  bool design = false;
  const std::atomic<bool>* stop = nullptr;
  std::function<void(const IdentifyProgress&)> progress;
};

/// Residuals of a problem's rows, in standard deviations: where the search began, and fitted.
struct BeforeAfter {
  std::vector<double> untuned, fitted;
};

/// All that a fit has to say.
struct FitOutcome {
  bool interrupted = false;
  std::string why;  ///< If there is no fit.
  FitResult fit;
  FitVerdict verdict;
  BeforeAfter train, test;
  std::vector<FitProfile> profiles;
  std::optional<DesignRanking> design;
};

/// Of the estimates at the problem's start, those that nothing depends on: a mistake of the fit.
/// False, and a complaint each, if there are any, or if the start cannot be computed.
bool CheckDependence(const Identification& fit, Diagnostics& out);

FitOutcome RunFit(const Identification& fit, const OutcomeOptions& options);

/// The outcome for a terminal; as one JSON object; as one page that needs nothing else.
std::string OutcomeText(const Identification& fit, const FitOutcome& outcome);
std::string OutcomeJson(const Identification& fit, const FitOutcome& outcome);
std::string OutcomePage(const Identification& fit, const FitOutcome& outcome);

/// Of a channel, root mean squares of computed less measured, in its unit.
struct ChannelErrors {
  std::string channel, unit;
  std::size_t count = 0;
  double untuned = 0, fitted = 0, fitted_bias = 0;
};
/// By channel, in the order of the points.
std::vector<ChannelErrors> ErrorsByChannel(const std::vector<FitPoint>& points,
                                           const BeforeAfter& residuals);

/// An experiment file that is `one` with these values, of the problem's parameters, as people go on
/// with: `base:`, `parameters:` and `set:`. `folder`: where it will be.
std::string FittedExperimentYaml(const Identification& fit, std::size_t experiment,
                                 const std::vector<double>& values, const std::string& folder);

}  // namespace taut
