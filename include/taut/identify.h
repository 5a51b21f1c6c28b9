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
#include <span>
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

/// Computes pieces of a fit that know nothing of each other, as `Cluster::Work` spreads them over
/// processes: what came of each, in their order. Fewer answers than pieces: it was stopped.
using FitWork = std::function<std::vector<std::string>(std::span<const std::string> pieces)>;

struct IdentifyCounts {
  std::int64_t computed = 0;    ///< Experiments that were run, or brought to rest.
  std::int64_t remembered = 0;  ///< Points that the file knew.
  std::int64_t damaged = 0;     ///< Of the file's, that were computed again.
};

/// Whether the measured forces of an experiment carry what is applied: see `FitCarried`. Both along
/// its direction, where members stand as the experiment says before anything is fitted.
struct CarriedLoad {
  struct Row {
    std::string where;     ///< As of `FitPoint`.
    double applied_n = 0;  ///< On the bodies: loads and weight.
    double carried_n = 0;  ///< By the members, as measured.
    double sd_n = 0;       ///< Of that, by the sds of what is compared.
  };
  std::string name;  ///< Of the question.
  std::size_t experiment = 0;
  std::vector<Row> rows;
  ProportionCheck check;  ///< Its `why` also if the rests could not be computed.
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

  /// When an experiment is looked at that is brought to rest at its set points [s], rising.
  virtual const std::vector<double>& moments_s(std::size_t experiment) const = 0;
  /// What `carried` of the fit asks, of each of its experiments. Brings these to rest.
  virtual std::vector<CarriedLoad> Carried() const = 0;

  /// Does pieces of a fit's work here: of this one, or of the same one on another process.
  virtual std::vector<std::string> Do(std::span<const std::string> pieces) = 0;
  /// From now on `spread` does all pieces, `processes` of which each do a share. Numbers keep their
  /// bits.
  virtual void SpreadBy(FitWork spread, int processes) = 0;
  /// What processes must agree on before they share work: the fit, its data and its experiments.
  virtual std::string Agreed() const = 0;

  virtual IdentifyCounts counts() const = 0;
  /// Why the memory can no longer be written; empty if it can.
  virtual std::string memory_error() const = 0;
  /// Returns the file of the fit that can no longer be read, and the reason; empty if all can be.
  /// Such a file ends a search, and the trials so far are kept.
  virtual std::string input_error() const = 0;
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
  std::vector<CarriedLoad> carried;
};

/// Of the estimates at the problem's start, those that nothing depends on: a mistake of the fit.
/// False, and a complaint each, if there are any, or if the start cannot be computed.
bool CheckDependence(const Identification& fit, Diagnostics& out);

FitOutcome RunFit(const Identification& fit, const OutcomeOptions& options);

/// The outcome for a terminal; as one JSON object; as one page that needs nothing else. `looks`:
/// where each experiment can be looked at before and after, as paths from the page's folder; empty
/// where it cannot, or all of them.
std::string OutcomeText(const Identification& fit, const FitOutcome& outcome);
std::string OutcomeJson(const Identification& fit, const FitOutcome& outcome);
std::string OutcomePage(const Identification& fit, const FitOutcome& outcome,
                        const std::vector<std::string>& looks = {});

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

/// Writes a folder as a run does, to be looked at: the rests that experiment `experiment` of the
/// fit comes to where it is as `with` says. A row a rest; load case i is at i s. False and a
/// complaint if one is not found or the folder cannot be written.
bool WriteRests(const Identification& fit, std::size_t experiment, const ExperimentSpec& with,
                const std::string& folder, Diagnostics& out);

}  // namespace taut
