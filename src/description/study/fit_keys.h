/// Keys of fit files.
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "description/experiment/experiment_keys.h"
#include "taut/fit_spec.h"

namespace taut::description {

inline const Choices<bool> kUses{{"train", true}, {"test", false}};
inline const Choices<FitForward> kForwards{{"dynamic", FitForward::kDynamic},
                                           {"static", FitForward::kStatic},
                                           {"load_cases", FitForward::kLoadCases}};
inline const Choices<FitStatistic> kFitStatistics{{"mean", FitStatistic::kMean},
                                                  {"max", FitStatistic::kMax},
                                                  {"min", FitStatistic::kMin},
                                                  {"rows", FitStatistic::kRows}};
inline const Choices<RobustLoss> kLosses{{"squares", RobustLoss::kSquares},
                                         {"huber", RobustLoss::kHuber},
                                         {"cauchy", RobustLoss::kCauchy}};
inline const Choices<FitGroups> kGroupings{{"experiment", FitGroups::kExperiment},
                                           {"channel", FitGroups::kChannel},
                                           {"window", FitGroups::kWindow}};
inline const Choices<bool> kSharing{{"experiment", true}, {"all", false}};
/// nullopt stands for all statistics.
using ReferenceChoice = std::optional<ReferenceSpec::Statistic>;
inline const Choices<ReferenceChoice> kFitReferences{{"maxima", ReferenceSpec::Statistic::kMax},
                                                     {"means", ReferenceSpec::Statistic::kMean},
                                                     {"minima", ReferenceSpec::Statistic::kMin},
                                                     {"all", std::nullopt}};

/// Entry of `experiments:`.
struct FitExperimentText {
  SourceRef at;
  std::string name;
  Raw<FileForm> experiment, data, map, setpoints;
  bool train = true;
  FitForward forward = FitForward::kDynamic;
  Raw<ParametersForm> set;
  SourceRef name_at, data_at, setpoints_at;  ///< Positions of the keys.
};
template <class Io>
void Keys(Io& io, Like<FitExperimentText> auto& e) {
  io.Map(
      "experiment", "experiments",
      "Measurement: an experiment file that describes the test, and a data file with its results.",
      R"({"name": "t0", "experiment": "best_2d.yaml", "data": "test0.csv", "use": "train"})");
  io("name", e.name, kNeeded, kName, "Name of the measurement in tables.");
  io("experiment", e.experiment, kNeeded, "Experiment file, relative to this file's folder.",
     Example{R"("../experiments/push_20n.yaml")"});
  io("data", e.data,
     "Measured trace (`.h5`, `.csv`, `.csv.gz`). Default: none; only the reference values of the "
     "experiment are compared.",
     Example{R"("measured.csv")"});
  io("map", e.map,
     "Mapping file with the taut names and units of the data (docs/formats/mapping.md).",
     Example{R"("map.json")"});
  io("setpoints", e.setpoints,
     "Trace with one row per set point, at the time on the data's clock at which the set point was "
     "commanded. The optional column `experiment_s` of the trace contains the corresponding times "
     "on the "
     "experiment's clock. Default of trace and column: the times of the set points in the "
     "experiment.",
     Example{R"("test0_setpoints.csv")"});
  io("use", e.train, kUses,
     "Use of the measurement. `train`: used to estimate the parameters. `test`: held out for "
     "validation.");
  io("forward", e.forward, kForwards,
     "Forward model. `dynamic`: simulation of the experiment. `static`: equilibrium at each set "
     "point of its "
     "position programs and pushes, each computed from the previous equilibrium. `load_cases`: "
     "equilibrium under "
     "each of its `load_cases`; row i of the data belongs to case i.");
  io("set", e.set, "Parameters of the experiment or its model that this measurement overrides.",
     Example{R"({"push_n": 20})"});
}
void Check(const MapReader& map, FitExperimentText& experiment);

/// Prior of a parameter: normal distribution.
struct FitPriorText {
  std::optional<double> mean;
  double sd = NAN;
};
template <class Io>
void Keys(Io& io, Like<FitPriorText> auto& p) {
  io.Map("", "prior", "Prior of the parameter: a normal distribution.", R"({"sd": 42})");
  io("mean", p.mean,
     "Mean. Default: the experiment's value; 0 for offsets and delays, 1 for gains.");
  io("sd", p.sd, kNeeded, Bound::kPositive, "Standard deviation of the prior.");
}
/// Offset, gain or delay of a channel or clock. Bounds and prior are in the same map.
struct FitNuisanceText {
  std::optional<double> low, high, start, mean, sd, scale;
};
template <class Io>
void Keys(Io& io, Like<FitNuisanceText> auto& n) {
  io.Map("", "nuisance",
         "Nuisance parameter of the measurement, not of the robot. The unit is the unit of the "
         "channel for an `offset`, 1 for a `gain`, and s for `delay_s`.",
         R"({"sd": 0.002})");
  io("low", n.low, "Lower bound of the nuisance parameter.");
  io("high", n.high, "Upper bound of the nuisance parameter.");
  io("start", n.start, "Start value of the search.");
  io("mean", n.mean, "Mean of the prior. Default: 0; for a gain, 1.");
  io("sd", n.sd, Bound::kPositive, "Standard deviation of the prior. Default: no prior.");
  io("scale", n.scale, Bound::kPositive,
     "Typical change, used as the unit of search steps. Default: `sd`.");
}

enum class FitClock { kData };
inline const Choices<FitClock> kClocks{{"data", FitClock::kData}};

/// Entry of `estimate:`.
struct FitEstimateText {
  SourceRef at;
  Placed parameter, channel;
  FitClock clock = FitClock::kData;
  bool has_clock = false;
  std::optional<double> low, high, start, scale;
  std::optional<FitPriorText> prior;
  std::optional<FitNuisanceText> offset, gain, delay_s;
  bool each = false;
  std::vector<Placed> experiments;
};
template <class Io>
void Keys(Io& io, Like<FitEstimateText> auto& e) {
  io.Map("estimate", "estimate",
         "Estimated parameter, of experiments or models, or of the measurement.",
         R"({"parameter": "k12_n_per_m", "low": 700, "high": 1000, "prior": {"sd": 42}})");
  io.OneOf({"parameter", "channel", "clock"});
  io("parameter", e.parameter, "Named parameter of the experiments or of their models.");
  io("channel", e.channel, "Pattern of channels for which an `offset` or a `gain` is estimated.",
     Example{R"("body/v/position_z_m")"});
  io("clock", e.clock, kClocks,
     "Clock whose delay, `delay_s`, is estimated: the clock of the data.");
  io("low", e.low, "Lower bound of a parameter, in its unit.");
  io("high", e.high, "Upper bound of a parameter.");
  io("start", e.start, "Start value of the search. Default: the experiment's value.");
  io("scale", e.scale, Bound::kPositive,
     "Typical change of a parameter, used as the unit of search steps. Default: the prior's `sd`, "
     "else a quarter "
     "of the distance between the bounds, else a twentieth of the start value.");
  io("prior", e.prior);
  io("offset", e.offset, "Offset added to the computed channels.");
  io("gain", e.gain, "Factor on the computed channels, before the offset.");
  io("delay_s", e.delay_s, "Delay of the data's clock relative to the clock of the run.");
  io("each", e.each, kSharing,
     "Sharing of the value. `experiment`: each measurement has a separate value. `all`: all "
     "measurements share one value.");
  io("experiments", e.experiments,
     "Names of the measurements to which the estimate applies. Default: all.");
}
void Check(const MapReader& map, FitEstimateText& estimate);

struct FitWindowText {
  Placed phase;
  std::optional<double> from_s, to_s;
  std::optional<std::pair<double, double>> after_setpoint_s;
};
template <class Io>
void Keys(Io& io, Like<FitWindowText> auto& w) {
  io.Map("", "window", "Time window of a channel.", R"({"after_setpoint_s": [2.1, 3.4]})");
  io("phase", w.phase, "Phase of the experiment's timeline.");
  io("from_s", w.from_s, "Start on the experiment's clock, with `to_s`.");
  io("to_s", w.to_s, "End on the experiment's clock.");
  io("after_setpoint_s", w.after_setpoint_s,
     "Window after each set point. For the data, times are on the data's clock; for the "
     "simulation, on the clock of the run.");
}
void Check(const MapReader& map, FitWindowText& window);

/// Entry of `residuals:`.
struct FitResidualText {
  SourceRef at;
  Placed channel;
  ReferenceChoice reference;
  bool has_reference = false;
  double sd = NAN, relative_sd = 0.0;
  std::optional<FitWindowText> window;
  FitStatistic statistic = FitStatistic::kMean;
  RobustLoss loss = RobustLoss::kSquares;
  std::optional<double> loss_sd;
  std::vector<Placed> experiments;
};
template <class Io>
void Keys(Io& io, Like<FitResidualText> auto& r) {
  io.Map("residual", "residuals",
         "Residual: computed minus measured value, in standard deviations.",
         R"({"channel": "body/v/position_*_m", "sd": 0.0008, )"
         R"("window": {"after_setpoint_s": [2.1, 3.4]}})");
  io.OneOf({"channel", "reference"});
  io("channel", r.channel, "Pattern of channels of the data.");
  io("reference", r.reference, kFitReferences,
     "Compared statistics of the experiments' reference values.");
  io("sd", r.sd, kNeeded, Bound::kPositive,
     "Standard deviation of the difference between computed and measured value, from errors of "
     "both, in the channel's unit.");
  io("relative_sd", r.relative_sd, Bound::kNonNegative,
     "Standard deviation relative to the measured value. The larger of this deviation and `sd` is "
     "used.");
  io("window", r.window, "Time window. Default: all time that experiment and data share.");
  io("statistic", r.statistic, kFitStatistics,
     "Compared statistic of a window, at the times of its data. `mean`: mean over time. `rows`: "
     "the value of every "
     "row.");
  io("loss", r.loss, kLosses,
     "Loss function. `squares`: least squares. `huber`, `cauchy`: residuals beyond `loss_sd` have "
     "a smaller weight.");
  io("loss_sd", r.loss_sd, Bound::kPositive,
     "Threshold of `huber` (default 1.345) and `cauchy` (default 2.385), in standard deviations.");
  io("experiments", r.experiments,
     "Names of the measurements to which the residual applies. Default: all.");
}
void Check(const MapReader& map, FitResidualText& residual);

struct FitSearchText {
  FitSearch values;
};
template <class Io>
void Keys(Io& io, Like<FitSearchText> auto& s) {
  io.Map("search", "search", "Settings of the search for the best fit.",
         R"({"starts": 8, "step": 0.1})");
  io("starts", s.values.starts, Bound{.least = 1, .most = 1000},
     "Number of starts: the first start is at the experiments' values, the other starts are drawn "
     "from the priors.");
  io("step", s.values.step, Bound{.least = 0.0, .most = 1.0, .above_least = true},
     "Longest finite difference step, in units of `scale`; taut shortens the step if half the step "
     "gives another derivative.");
  io("iterations", s.values.iterations, Bound{.least = 1, .most = 10'000},
     "Largest number of iterations per start.");
  io("tolerance", s.values.tolerance, Bound{.least = 0.0, .most = 0.1, .above_least = true},
     "Relative decrease of the cost below which a search ends.");
  io("folds", s.values.folds, Bound{.least = 0, .most = 100},
     "Number of folds of cross-validation over the groups; 0: none.");
  io("seed", s.values.seed, Bound{.least = 0, .most = 2'147'483'647}, "Seed of the start values.");
}

/// Entry of `design:`.
struct FitCandidateText {
  SourceRef at;
  std::string name;
  std::vector<FitResidualText> residuals;
};
template <class Io>
void Keys(Io& io, Like<FitCandidateText> auto& d) {
  io.Map(
      "design", "design",
      "Candidate measurement; `taut fit --design` computes its information about the parameters.");
  io("name", d.name, kNeeded, kName, "Name in the table of candidates.");
  io("residuals", d.residuals, kNeeded,
     "Residuals that the measurement would have. No data is needed.");
}

/// Entry of `carried:`.
struct FitCarriedText {
  SourceRef at;
  std::string name;
  std::vector<Placed> bodies;
  Vec3 direction{0, 0, -1};
  std::vector<Placed> experiments;
};
template <class Io>
void Keys(Io& io, Like<FitCarriedText> auto& c) {
  io.Map("carried", "carried",
         "Check of the data without the model: whether the measured forces balance the applied "
         "load. Only for bodies that cables and bars alone hold.",
         R"({"name": "top", "bodies": ["n3", "n4", "n5"], "direction": [0, 0, -1]})");
  io("name", c.name, kNeeded, kName, "Name in the table of checks.");
  io("bodies", c.bodies, kNeeded,
     "Patterns of the loaded bodies. The forces of all cables and bars between these bodies and "
     "other bodies must be "
     "compared in `residuals`.",
     Example{R"(["n3", "n4", "n5"])"});
  io("direction", c.direction,
     "Direction of the compared load component, in the world's axes, of any length.");
  io("experiments", c.experiments,
     "Names of the checked measurements, whose `forward` must not be `dynamic`. Default: all such "
     "measurements.");
}

struct FitForm {
  static constexpr const char* kSchema = R"("const": "fit")";
};
struct FitFileText {
  Head<FitForm> head;
  std::string name, description;
  std::vector<FitExperimentText> experiments;
  std::vector<FitEstimateText> estimate;
  std::vector<FitResidualText> residuals;
  std::vector<FitCandidateText> design;
  std::vector<FitCarriedText> carried;
  FitGroups groups = FitGroups::kExperiment;
  std::optional<FitSearchText> search;
};
template <class Io>
void Keys(Io& io, Like<FitFileText> auto& f) {
  io.Map(
      "", "Fit file",
      "A fit file defines a system identification: parameters of experiments and models that are "
      "estimated from measurements, and their identifiability.");
  HeadKeys(
      io, f,
      {"Name of the fit, and of its folder under runs/. Required unless the `base` file has it.",
       "Description of the estimated parameters and the data, in a sentence or two.",
       "Another fit file to inherit from, relative to this file's folder. Each key of this file "
       "replaces the whole key of the base, except that `parameters` are merged by name.",
       R"("camera.yaml")",
       "Named numbers for expressions in this file. Parameters may refer to each other, in any "
       "order; "
       "`--set name=value` on the command line overrides them and parameters of the experiments.",
       R"({"pose_sd_m": "0.0008"})"});
  io("experiments", f.experiments, kNeeded,
     "Measurements, all explained by one vector of estimated parameters.");
  io("estimate", f.estimate, kNeeded, "Estimated parameters.");
  io("residuals", f.residuals, kNeeded,
     "Residuals: compared values of simulation and measurement.");
  io("groups", f.groups, kGroupings,
     "Groups of residuals with correlated errors. Standard errors and cross-validation leave out "
     "whole groups.");
  io("search", f.search);
  io("design", f.design, "Candidate measurements for `taut fit --design`.");
  io("carried", f.carried, "Checks whether the measured forces balance the applied loads.");
}

}  // namespace taut::description
