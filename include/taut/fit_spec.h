/// Fits as files describe them: which numbers of experiments to find from which measurements
/// (docs/fit.md).
///
/// Threads: any number may call these functions at once, each with diagnostics of its own. A spec
/// is plain data.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "taut/diagnostics.h"
#include "taut/spec.h"

namespace taut {

/// What is made of an experiment, to be set beside its data.
enum class FitForward {
  kDynamic,    ///< A run of it.
  kStatic,     ///< The rest that it comes to at each of its set points, one after the other.
  kLoadCases,  ///< The rest under each of its load cases; row i of the data is that of case i.
};

/// One measurement: the experiment that says what was done, and what came of it.
struct FitExperiment {
  std::string name;
  std::string experiment_file;
  std::string data_file;       ///< A trace; empty: only the experiment's references.
  std::string map_file;        ///< Gives the data the names of taut; empty: none.
  std::string setpoints_file;  ///< Times of set points on the data's clock; empty: the
                               ///< experiment's own.
  bool train = true;           ///< Else it is held out, for a verdict.
  FitForward forward = FitForward::kDynamic;
  Overrides set;              ///< As `set:` says, the user's `--set` behind it.
  ExperimentSpec experiment;  ///< With `set`, before anything is fitted.
  SourceRef at, data_at, setpoints_at;
};

/// What is known of a number before the data is looked at.
struct FitRange {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  std::optional<double> mean, sd;  ///< Of the prior; without `sd` there is none.
  double start = 0.0;
  double scale = 0.0;  ///< About how far it moves, > 0: the unit of steps.
};

/// A number that is found.
struct FitEstimate {
  enum class Kind {
    kParameter,  ///< Of the experiments or their models.
    kOffset,     ///< Added to what is computed of some channels, in their unit.
    kGain,       ///< A factor on what is computed of some channels.
    kDelay,      ///< By how many seconds the data's clock says later what happened.
  };
  Kind kind = Kind::kParameter;
  std::string name;       ///< "k12_n_per_m", "offset body/v/position_z_m", "delay t0".
  std::string unit;       ///< Empty: not known.
  std::string parameter;  ///< Of kParameter.
  std::string channels;   ///< Pattern, of kOffset and kGain.
  std::vector<std::size_t> experiments;  ///< That it acts on.
  FitRange range;
  SourceRef at;
};

enum class FitStatistic { kMean, kMax, kMin, kRows };
enum class RobustLoss { kSquares, kHuber, kCauchy };

/// What is compared: channels of the data, or the references of the experiments.
struct FitResidual {
  std::string channels;                                ///< Pattern; empty: references.
  std::optional<ReferenceSpec::Statistic> references;  ///< Which; nothing: all.
  double sd = 1.0;                                     ///< What it is known to, in its unit.
  double relative_sd = 0.0;                            ///< More of it: this share of the value.
  FitStatistic statistic = FitStatistic::kMean;
  std::optional<std::string> phase;                           ///< A window by the timeline's name,
  std::optional<std::pair<double, double>> span_s;            ///< on the experiment's clock,
  std::optional<std::pair<double, double>> after_setpoint_s;  ///< or after each set point.
  std::vector<std::size_t> experiments;
  RobustLoss loss = RobustLoss::kSquares;
  double loss_sd = 0.0;  ///< From where on a residual counts less, in `sd`.
  SourceRef at;
};

enum class FitGroups { kExperiment, kChannel, kWindow };

struct FitSearch {
  int starts = 1;           ///< The first from where the experiments are.
  double step = 0.1;        ///< Of differences, in scales.
  int iterations = 50;      ///< At most, of each start.
  std::uint64_t seed = 0;   ///< Of the other starts.
  int folds = 0;            ///< Of cross-validation over groups; 0: none.
  double tolerance = 1e-6;  ///< Relative fall of the cost that is none.
};

/// What may be measured next, for `--design`.
struct FitCandidate {
  std::string name;
  std::vector<FitResidual> residuals;
};

/// Whether data agree with themselves: bodies to which a load is applied, and which nothing holds
/// but members whose forces are compared. What was measured of these is to carry what is applied.
struct FitCarried {
  std::string name;
  std::vector<std::string> bodies;  ///< Patterns.
  Vec3 direction;                   ///< Of the load, in W; a unit vector.
  std::vector<std::size_t> experiments;
  SourceRef at;
};

struct FitSpec {
  std::string name;
  std::string description;
  std::vector<FitExperiment> experiments;
  std::vector<FitEstimate> estimates;
  std::vector<FitResidual> residuals;
  std::vector<FitCandidate> design;
  std::vector<FitCarried> carried;
  FitGroups groups = FitGroups::kExperiment;
  FitSearch search;
  std::vector<std::string> files;  ///< That were read, the fit first.
};

/// Reads a fit and its experiments, not the data. Returns nothing if there was any error.
std::optional<FitSpec> LoadFit(const std::string& path, const Overrides& overrides,
                               Diagnostics& out);

/// The fit in numbers, a line each fact, without its experiments: two with the same text, the same
/// experiments and the same data find the same.
std::string FitText(const FitSpec& fit);

}  // namespace taut
