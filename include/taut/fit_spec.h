/// Fit files (system identification): measurements, estimated parameters, priors, residuals and
/// search settings (docs/fit.md).
///
/// Threads: any number may call these functions concurrently, with separate diagnostics. A spec is
/// plain data.
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

/// Forward model, which computes the values to compare with the data.
enum class FitForward {
  kDynamic,    ///< Simulation of the experiment.
  kStatic,     ///< Equilibrium at each set point, searched from the previous one.
  kLoadCases,  ///< Equilibrium under each load case; row i of the data belongs to case i.
};

/// Measurement: an experiment file for the test, and a data file with its results.
struct FitExperiment {
  std::string name;
  std::string experiment_file;
  std::string data_file;  ///< Trace. Empty: only the reference values in the experiment.
  std::string map_file;   ///< Mapping from the data to taut's names and units; empty: none.
  /// File with set point times on the clock of the data; empty: set points of the experiment.
  std::string setpoints_file;
  bool train = true;  ///< False: held out for validation.
  FitForward forward = FitForward::kDynamic;
  Overrides set;              ///< Overrides from `set:`, then from `--set` of the user.
  ExperimentSpec experiment;  ///< Experiment with `set` applied, before the fit.
  SourceRef at, data_at, setpoints_at;
};

/// Bounds, prior, start value and scale of an estimate.
struct FitRange {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  std::optional<double> mean, sd;  ///< Normal prior; no prior without `sd`.
  double start = 0.0;
  double scale = 0.0;  ///< Relevant change, > 0; the unit of steps.
};

/// Quantity to estimate.
struct FitEstimate {
  enum class Kind {
    kParameter,  ///< Parameter of the experiments or of their models.
    kOffset,     ///< Offset added to computed channels, in their unit.
    kGain,       ///< Factor on computed channels, before the offset.
    kDelay,      ///< Delay of the data clock relative to the simulation clock [s].
  };
  Kind kind = Kind::kParameter;
  std::string name;       ///< For example "k12_n_per_m", "offset body/v/position_z_m", "delay t0".
  std::string unit;       ///< Unit of the estimate; empty if unknown.
  std::string parameter;  ///< Parameter name, for kParameter.
  std::string channels;   ///< Channel pattern, for kOffset and kGain.
  std::vector<std::size_t> experiments;  ///< Indices of the affected experiments.
  FitRange range;
  SourceRef at;
};

enum class FitStatistic { kMean, kMax, kMin, kRows };
enum class RobustLoss { kSquares, kHuber, kCauchy };

/// Compared values: channels of the data, or reference values of the experiments.
struct FitResidual {
  std::string channels;  ///< Channel pattern; empty: reference values.
  std::optional<ReferenceSpec::Statistic> references;  ///< Absent: all.
  double sd = 1.0;  ///< Standard deviation, in the unit of the channel.
  /// Standard deviation relative to the measured value. The larger of `sd` and this product
  /// applies.
  double relative_sd = 0.0;
  FitStatistic statistic = FitStatistic::kMean;
  std::optional<std::string> phase;  ///< Time window: a phase of the timeline.
  /// Time window: a span on the clock of the experiment.
  std::optional<std::pair<double, double>> span_s;
  /// Time window: a span after each set point.
  std::optional<std::pair<double, double>> after_setpoint_s;
  std::vector<std::size_t> experiments;
  RobustLoss loss = RobustLoss::kSquares;
  /// Width of the robust loss, in `sd`; it reduces the influence of larger residuals.
  double loss_sd = 0.0;
  SourceRef at;
};

/// Grouping of residuals with correlated errors.
enum class FitGroups { kExperiment, kChannel, kWindow };

struct FitSearch {
  int starts = 1;           ///< Number of starts; the first has the values of the experiments.
  double step = 0.1;        ///< Step of finite differences, in units of the scale.
  int iterations = 50;      ///< Maximum number of iterations per start.
  std::uint64_t seed = 0;   ///< Seed of the random starts.
  int folds = 0;            ///< Number of cross-validation folds over groups; 0: none.
  double tolerance = 1e-6;  ///< Relative change of the cost at which the search ends.
};

/// Candidate measurement for `--design`.
struct FitCandidate {
  std::string name;
  std::vector<FitResidual> residuals;
};

/// Consistency check of measured forces (docs/theory/identification.md, eq. F.15a). For loaded
/// bodies that are supported only by members with measured forces, these forces must balance the
/// load.
struct FitCarried {
  std::string name;
  std::vector<std::string> bodies;  ///< Patterns of body names.
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
  std::vector<std::string> files;  ///< All files read; the fit file is first.
};

/// Reads a fit file and its experiments, but not the data. On an error, returns nothing and adds
/// diagnostics.
std::optional<FitSpec> LoadFit(const std::string& path, const Overrides& overrides,
                               Diagnostics& out);

/// Returns the settings of a fit as text, one per line, without the contents of its experiments.
/// Fits with equal texts, experiments and data have equal results.
std::string FitText(const FitSpec& fit);

}  // namespace taut
