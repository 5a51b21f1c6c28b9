/// The keys of a fit file.
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
/// nullopt: all of them.
using ReferenceChoice = std::optional<ReferenceSpec::Statistic>;
inline const Choices<ReferenceChoice> kFitReferences{{"maxima", ReferenceSpec::Statistic::kMax},
                                                     {"means", ReferenceSpec::Statistic::kMean},
                                                     {"minima", ReferenceSpec::Statistic::kMin},
                                                     {"all", std::nullopt}};

/// An entry of `experiments:`.
struct FitExperimentText {
  SourceRef at;
  std::string name;
  Raw<FileForm> experiment, data, map, setpoints;
  bool train = true;
  FitForward forward = FitForward::kDynamic;
  Raw<ParametersForm> set;
  SourceRef name_at, data_at, setpoints_at;  ///< Of keys.
};
template <class Io>
void Keys(Io& io, Like<FitExperimentText> auto& e) {
  io.Map("experiment", "experiments",
         "A measurement: an experiment that says what was done, and a file that says what came of "
         "it.",
         R"({"name": "t0", "experiment": "best_2d.yaml", "data": "test0.csv", "use": "train"})");
  io("name", e.name, kNeeded, kName, "Name of the measurement, for tables.");
  io("experiment", e.experiment, kNeeded, "The experiment file, seen from this file's folder.",
     Example{R"("../experiments/push_20n.yaml")"});
  io("data", e.data,
     "What was measured: a trace (`.h5`, `.csv`, `.csv.gz`). Without it only the experiment's "
     "`references` are there to be compared.",
     Example{R"("measured.csv")"});
  io("map", e.map,
     "A mapping file that gives the data the names and units of taut (docs/formats/mapping.md).",
     Example{R"("map.json")"});
  io("setpoints", e.setpoints,
     "A trace whose times, on the data's clock, are those at which the experiment's set points "
     "were commanded, one after the other. Without it they are those of the experiment. A column "
     "`experiment_s` says which of the experiment's moments they are; else these are its set "
     "points.",
     Example{R"("test0_setpoints.csv")"});
  io("use", e.train, kUses, "Whether numbers are found from it, or it is held out to judge them.");
  io("forward", e.forward, kForwards,
     "`dynamic`: the experiment is run. `static`: the rest that the robot comes to at each set "
     "point of its position programs and pushes, from one to the next. `load_cases`: the rest "
     "under each of the experiment's `load_cases`; row i of the data is that of case i.");
  io("set", e.set, "Parameters of the experiment or its model that this measurement changes.",
     Example{R"({"push_n": 20})"});
}
void Check(const MapReader& map, FitExperimentText& experiment);

/// What is known of a number beforehand.
struct FitPriorText {
  std::optional<double> mean;
  double sd = NAN;
};
template <class Io>
void Keys(Io& io, Like<FitPriorText> auto& p) {
  io.Map("", "prior", "What is known of the number without the data: a normal distribution.",
         R"({"sd": 42})");
  io("mean", p.mean,
     "Its middle. That of the experiment if absent; of offsets and delays 0, of gains 1.");
  io("sd", p.sd, kNeeded, Bound::kPositive, "Its standard deviation.");
}
/// The number of a channel or a clock, whose prior stands among its bounds.
struct FitNuisanceText {
  std::optional<double> low, high, start, mean, sd, scale;
};
template <class Io>
void Keys(Io& io, Like<FitNuisanceText> auto& n) {
  io.Map("", "nuisance",
         "A number of the measurement, not of the robot. In the channel's unit, or a factor, or "
         "seconds.",
         R"({"sd": 0.002})");
  io("low", n.low, "Lower bound.");
  io("high", n.high, "Upper bound.");
  io("start", n.start, "Where the search begins.");
  io("mean", n.mean, "Middle of what is known of it: 0, of a gain 1.");
  io("sd", n.sd, Bound::kPositive, "Standard deviation of that; nothing is known if absent.");
  io("scale", n.scale, Bound::kPositive, "About how far it moves; `sd` if absent.");
}

enum class FitClock { kData };
inline const Choices<FitClock> kClocks{{"data", FitClock::kData}};

/// An entry of `estimate:`.
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
         "A number that is found: a parameter of experiments or models, or one of the measurement.",
         R"({"parameter": "k12_n_per_m", "low": 700, "high": 1000, "prior": {"sd": 42}})");
  io.OneOf({"parameter", "channel", "clock"});
  io("parameter", e.parameter, "A named number of the experiments or of their models.");
  io("channel", e.channel, "Pattern of channels that have an `offset` or a `gain`.",
     Example{R"("body/v/position_z_m")"});
  io("clock", e.clock, kClocks, "The data's clock, which has a `delay_s`.");
  io("low", e.low, "Lower bound of a parameter, in its unit.");
  io("high", e.high, "Upper bound of a parameter.");
  io("start", e.start, "Where the search begins; where the experiment is if absent.");
  io("scale", e.scale, Bound::kPositive,
     "About how far a parameter moves: the unit of steps. If absent the prior's `sd`, else a "
     "quarter of the way between the bounds, else a twentieth of where it starts.");
  io("prior", e.prior);
  io("offset", e.offset, "What is added to what is computed of the channels.");
  io("gain", e.gain, "A factor on what is computed of the channels, before the offset.");
  io("delay_s", e.delay_s, "By how much the data's clock says later what happened.");
  io("each", e.each, kSharing, "Whether each measurement has one of its own, or all share it.");
  io("experiments", e.experiments, "Names of the measurements that it acts on; all if absent.");
}
void Check(const MapReader& map, FitEstimateText& estimate);

struct FitWindowText {
  Placed phase;
  std::optional<double> from_s, to_s;
  std::optional<std::pair<double, double>> after_setpoint_s;
};
template <class Io>
void Keys(Io& io, Like<FitWindowText> auto& w) {
  io.Map("", "window", "When a channel is looked at.", R"({"after_setpoint_s": [2.1, 3.4]})");
  io("phase", w.phase, "A phase of the experiment's timeline.");
  io("from_s", w.from_s, "On the experiment's clock, with `to_s`.");
  io("to_s", w.to_s, "Its end.");
  io("after_setpoint_s", w.after_setpoint_s,
     "From when to when after each set point: a window each, on the data's clock.");
}
void Check(const MapReader& map, FitWindowText& window);

/// An entry of `residuals:`.
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
         "What is compared: computed less measured, in standard deviations.",
         R"({"channel": "body/v/position_*_m", "sd": 0.0008, )"
         R"("window": {"after_setpoint_s": [2.1, 3.4]}})");
  io.OneOf({"channel", "reference"});
  io("channel", r.channel, "Pattern of channels of the data.");
  io("reference", r.reference, kFitReferences,
     "The `references` of the experiments: which of their statistics.");
  io("sd", r.sd, kNeeded, Bound::kPositive,
     "What is computed may differ by that much from what is measured, in the channel's unit: "
     "errors of both.");
  io("relative_sd", r.relative_sd, Bound::kNonNegative,
     "The same as a share of what is measured; the larger of the two counts.");
  io("window", r.window, "When. If absent, all of the time that experiment and data share.");
  io("statistic", r.statistic, kFitStatistics,
     "Compared statistic of a window at the times of its data; `mean`: over time; `rows`: every "
     "row.");
  io("loss", r.loss, kLosses,
     "`squares`: least squares. `huber`, `cauchy`: large residuals count less, from `loss_sd` on.");
  io("loss_sd", r.loss_sd, Bound::kPositive,
     "For `huber` (1.345 if absent) and `cauchy` (2.385), in standard deviations.");
  io("experiments", r.experiments, "Names of the measurements it is about; all if absent.");
}
void Check(const MapReader& map, FitResidualText& residual);

struct FitSearchText {
  FitSearch values;
};
template <class Io>
void Keys(Io& io, Like<FitSearchText> auto& s) {
  io.Map("search", "search", "How the numbers are found.", R"({"starts": 8, "step": 0.1})");
  io("starts", s.values.starts, Bound{.least = 1, .most = 1000},
     "From how many places: the first is where the experiments are, the others are drawn from the "
     "priors.");
  io("step", s.values.step, Bound{.least = 0.0, .most = 1.0, .above_least = true},
     "Longest difference step, in scales; shortened if halving it changes the derivative.");
  io("iterations", s.values.iterations, Bound{.least = 1, .most = 10'000}, "At most, a start.");
  io("tolerance", s.values.tolerance, Bound{.least = 0.0, .most = 0.1, .above_least = true},
     "A search ends when its cost falls by less than this share.");
  io("folds", s.values.folds, Bound{.least = 0, .most = 100},
     "Of cross-validation over the groups; 0: none.");
  io("seed", s.values.seed, Bound{.least = 0, .most = 2'147'483'647},
     "Of the places that searches start from.");
}

/// An entry of `design:`.
struct FitCandidateText {
  SourceRef at;
  std::string name;
  std::vector<FitResidualText> residuals;
};
template <class Io>
void Keys(Io& io, Like<FitCandidateText> auto& d) {
  io.Map("design", "design",
         "Something that might be measured: `taut fit --design` says what that would tell.");
  io("name", d.name, kNeeded, kName, "Name of it, for the table.");
  io("residuals", d.residuals, kNeeded, "What would be measured, and how well. No data is needed.");
}

/// An entry of `carried:`.
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
         "A question to the data alone: do measured forces carry the load that was applied? Asked "
         "of bodies that nothing holds but cables and bars whose forces are compared.",
         R"({"name": "top", "bodies": ["n3", "n4", "n5"], "direction": [0, 0, -1]})");
  io("name", c.name, kNeeded, kName, "Name of it, for the table.");
  io("bodies", c.bodies, kNeeded,
     "Patterns of the bodies to which the load is applied. All cables and bars between them and "
     "the "
     "rest have to be compared in `residuals`.",
     Example{R"(["n3", "n4", "n5"])"});
  io("direction", c.direction,
     "In which direction the load is looked at, in the world's axes, of any length.");
  io("experiments", c.experiments,
     "Names of the measurements it is asked of, none of which is `dynamic`; all at rest if "
     "absent.");
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
  io.Map("", "Fit file",
         "Numbers of experiments and models, found from measurements, and what these can tell.");
  HeadKeys(io, f,
           {"Name of the fit, and of its folder under runs/. Needed unless `base` has it.",
            "What is fitted to what, in a sentence or two.",
            "Another fit file, seen from this file's folder. This file then holds only what "
            "differs: each of its keys replaces the base's as a whole, except that `parameters` "
            "are merged by name.",
            R"("camera.yaml")",
            "Named numbers for expressions in this file. They may refer to each other, in any "
            "order; `--set name=value` on the command line replaces them, or parameters of the "
            "experiments.",
            R"({"pose_sd_m": "0.0008"})"});
  io("experiments", f.experiments, kNeeded, "The measurements: one vector of numbers for all.");
  io("estimate", f.estimate, kNeeded, "The numbers to find.");
  io("residuals", f.residuals, kNeeded, "What is compared.");
  io("groups", f.groups, kGroupings,
     "What is left out together for standard errors and cross-validation: errors within a group "
     "hang together.");
  io("search", f.search);
  io("design", f.design, "What might be measured next, for `taut fit --design`.");
  io("carried", f.carried, "Which measured forces ought to carry which load.");
}

}  // namespace taut::description
