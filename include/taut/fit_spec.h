/// Fit files (system identification): measurements, estimated parameters, priors, residuals and
/// search settings (docs/fit.md).
///
/// Threads: any number may call these functions concurrently, each with separate diagnostics. A
/// spec is plain data.
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

/// Forward model: computation of the values that are compared with the data.
enum class FitForward {
  kDynamic,    ///< Simulation of the experiment.
  kStatic,     ///< Equilibrium at each set point, each from the previous one.
  kLoadCases,  ///< Equilibrium under each load case; row i of the data belongs to case i.
};

/// Measurement: the experiment file that describes the test, and the data file with its results.
struct FitExperiment {
  std::string name;
  std::string experiment_file;
  std::string data_file;  ///< Trace; empty: only the experiment's reference values.
  std::string map_file;   ///< Mapping of the data to taut's names and units; empty: none.
  /// Times of set points on the data's clock; empty: the experiment's set points.
  std::string setpoints_file;
  bool train = true;  ///< False: held out for validation.
  FitForward forward = FitForward::kDynamic;
  Overrides set;              ///< Overrides by `set:`, followed by the user's `--set`.
  ExperimentSpec experiment;  ///< With `set` applied, before the fit.
  SourceRef at, data_at, setpoints_at;
};

/// Bounds, prior, start and scale of an estimate.
struct FitRange {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  std::optional<double> mean, sd;  ///< Prior; absent without `sd`.
  double start = 0.0;
  double scale = 0.0;  ///< Typical change, > 0: the unit of steps.
};

/// Estimated number.
struct FitEstimate {
  enum class Kind {
    kParameter,  ///< Parameter of the experiments or their models.
    kOffset,     ///< Offset added to computed channels, in their unit.
    kGain,       ///< Factor on computed channels, before the offset.
    kDelay,      ///< Delay of the data's clock against the run [s].
  };
  Kind kind = Kind::kParameter;
  std::string name;       ///< "k12_n_per_m", "offset body/v/position_z_m", "delay t0".
  std::string unit;       ///< Empty: unknown.
  std::string parameter;  ///< Name, for kParameter.
  std::string channels;   ///< Pattern, for kOffset and kGain.
  std::vector<std::size_t> experiments;  ///< Indices of the experiments it applies to.
  FitRange range;
  SourceRef at;
};

enum class FitStatistic { kMean, kMax, kMin, kRows };
enum class RobustLoss { kSquares, kHuber, kCauchy };

/// Compared values: channels of the data, or reference values of the experiments.
struct FitResidual {
  std::string channels;                                ///< Pattern; empty: references.
  std::optional<ReferenceSpec::Statistic> references;  ///< Absent: all.
  double sd = 1.0;           ///< Standard deviation, in the channel's unit.
  double relative_sd = 0.0;  ///< Relative to the measured value; the larger of both counts.
  FitStatistic statistic = FitStatistic::kMean;
  std::optional<std::string> phase;                           ///< Window: a phase of the timeline,
  std::optional<std::pair<double, double>> span_s;            ///< a span on the experiment's clock,
  std::optional<std::pair<double, double>> after_setpoint_s;  ///< or a span after each set point.
  std::vector<std::size_t> experiments;
  RobustLoss loss = RobustLoss::kSquares;
  double loss_sd = 0.0;  ///< Width of the loss, in `sd`; larger residuals count less.
  SourceRef at;
};

/// Grouping of residuals with correlated errors.
enum class FitGroups { kExperiment, kChannel, kWindow };

struct FitSearch {
  int starts = 1;           ///< Number of starts; the first has the experiments' values.
  double step = 0.1;        ///< Step of the difference quotients, in scales.
  int iterations = 50;      ///< Limit per start.
  std::uint64_t seed = 0;   ///< Seed of the other starts.
  int folds = 0;            ///< Folds of cross-validation over groups; 0: none.
  double tolerance = 1e-6;  ///< Relative change of the cost at which the search ends.
};

/// Candidate measurement for `--design`.
struct FitCandidate {
  std::string name;
  std::vector<FitResidual> residuals;
};

/// Consistency check of measured forces: on loaded bodies that only members with measured forces
/// support, the measured forces must balance the applied load (docs/theory/identification.md, eq.
/// F.15a).
struct FitCarried {
  std::string name;
  std::vector<std::string> bodies;  ///< Name patterns.
  Vec3 direction;                   ///< Direction of the load, in W; unit vector.
  std::vector<std::size_t> experiments;
  SourceRef at;
};

/// Contents of a fit file.
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
  std::vector<std::string> files;  ///< All files read, the fit first.
};

/// Reads a fit file and its experiments, not the data. Returns nothing, and adds diagnostics, on
/// any error.
std::optional<FitSpec> LoadFit(const std::string& path, const Overrides& overrides,
                               Diagnostics& out);

/// Returns the settings of a fit as text, one per line, without the contents of its experiments:
/// fits with the same text, the same experiments and the same data have the same result.
std::string FitText(const FitSpec& fit);

}  // namespace taut
