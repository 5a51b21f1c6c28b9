/// Keys of study files.
#pragma once

#include <cmath>

#include "description/experiment/experiment_keys.h"
#include "description/experiment/objective_keys.h"
#include "taut/study.h"

namespace taut::description {

inline const Choices<bool> kScales{{"linear", false}, {"log", true}};
inline const Choices<bool> kJudges{{"mean", false}, {"worst", true}};
/// Returns `NloptAlgorithms` as choices of a key.
const Choices<std::string>& NloptChoices();
enum class Method { kMonteCarlo, kHillClimbing, kNlopt, kCmaEs };
inline const Choices<Method> kMethods{{"monte_carlo", Method::kMonteCarlo},
                                      {"hill_climbing", Method::kHillClimbing},
                                      {"nlopt", Method::kNlopt},
                                      {"cma_es", Method::kCmaEs}};

/// Entry of `vary:`.
struct VaryText {
  SourceRef at;
  std::string name;
  Raw<PatternsForm> each, all;
  double low = NAN, high = NAN;
  bool log = false;
  SourceRef low_at, name_at, pattern_at;  ///< Positions of the keys.
};
template <class Io>
void Keys(Io& io, Like<VaryText> auto& v) {
  io.Map("vary", "vary", "Varied parameters of the experiment, by name; `*` stands for any text.");
  io("name", v.name, kName,
     "Name of the parameter in tables and the log; with `each`, the prefix of the names. Default: "
     "the parameter's "
     "name in the experiment.");
  io.OneOf({"each", "all"});
  io("each", v.each, "Pattern: one parameter per match.",
     Example{R"("impedance.inner_*.tension_offset_n")"});
  io("all", v.all, "Pattern: one common parameter for all matches, a symmetric group.",
     Example{R"(["impedance.outer_left*.tension_offset_n", )"
             R"("impedance.outer_right*.tension_offset_n"])"});
  io("low", v.low, kNeeded, "Lower bound, in the parameter's unit.");
  io("high", v.high, kNeeded, "Upper bound, in the parameter's unit.");
  io("scale", v.log, kScales,
     "Scale of the search steps. `linear`: equal steps are equal differences. `log`: equal steps "
     "are equal ratios.");
}
void Check(const MapReader& map, VaryText& vary);

struct ObjectiveText : ObjectiveSpec {
  SourceRef from_at, measure_at;  ///< Positions of the keys.
};
template <class Io>
void Keys(Io& io, Like<ObjectiveText> auto& o) {
  io.Map("objective", "objective",
         "Score of a world; a higher score is better. The score is computed during the run, "
         "without a trace.");
  io("measure", o.measure, kMeasures, kNeeded,
     "`distance`: horizontal displacement of the center of mass [m]. `heading`: its component "
     "along `direction`. `distance_per_energy`: distance divided by the motors' work, tension "
     "times wound-in length [m/J]. `nearer`: decrease of the horizontal distance between the "
     "tracked body and the experiment's goal [m]. `tracking`: negative root mean square of the "
     "cables' tensions minus their set points [N].");
  ObjectiveKeys(io, o);
}
void Check(const MapReader& map, ObjectiveText& objective);

template <class Io>
void Keys(Io& io, Like<PerturbationSpec> auto& w) {
  io.Map("worlds", "worlds",
         "Domain randomization: worlds that score each candidate. The first world is the "
         "unmodified experiment; the other worlds have uniformly distributed factors and starts.");
  io("count", w.worlds, kNeeded, Bound{.least = 1, .most = 1000}, "Number of worlds.");
  VariationKeys(io, w);
  io("redraw", w.redraw,
     "Whether each candidate has new worlds. Otherwise all candidates have the same worlds.");
  io("score", w.worst, kJudges, "Combination of the worlds' scores.");
}

/// Entry of `search:`, with the keys of all search methods.
struct SearchText {
  SourceRef at, algorithm_at;
  Method method = Method::kMonteCarlo;
  int evaluations = 1;
  int batch = SearchSpec{}.batch;
  std::optional<double> deviation;
  bool adapt = HillClimbingSpec{}.adapt;
  std::string algorithm = NloptSpec{}.algorithm;
  int starts = NloptSpec{}.starts;
  double initial_step = NloptSpec{}.initial_step;
};
template <class Io>
void Keys(Io& io, Like<SearchText> auto& s) {
  io.Map("search", "search", "Search method (docs/learning.md).");
  io("method", s.method, kMethods, kNeeded,
     "`monte_carlo`: random points within the bounds. `hill_climbing`: Gaussian steps around the "
     "best candidate. `nlopt`: a local method of the library NLopt, from many starts in parallel. "
     "`cma_es`: Gaussian steps whose directions and lengths adapt.");
  io("evaluations", s.evaluations, kNeeded, Bound{.least = 1, .most = 1'000'000'000},
     "Number of candidates. You can later increase the number of the last search.");
  io("batch", s.batch, Bound{.least = 1, .most = 100'000},
     "Number of candidates evaluated in parallel before the search uses their scores; for `cma_es` "
     "the population, at least 4. Results depend on this number.");
  io("deviation", s.deviation,
     Bound{.least = 0.0, .most = 10.0, .above_least = true, .hint = "in widths of the bounds"},
     "Standard deviation of the first steps for `hill_climbing` (default 0.1) and `cma_es` "
     "(default 0.3), as a fraction of the distance between the bounds.");
  io("adapt", s.adapt,
     "For `hill_climbing`: whether steps grow after success and shrink after failure. Otherwise "
     "the deviation is constant, as in NTRT.");
  io("algorithm", s.algorithm, NloptChoices(), "Algorithm for `nlopt`.");
  io("starts", s.starts, Bound{.least = 1, .most = 1000},
     "Number of parallel runs for `nlopt`. The first run starts from the best candidate, the other "
     "runs at random points; a converged run restarts at another random point.");
  io("initial_step", s.initial_step,
     Bound{.least = 0.0, .most = 0.5, .above_least = true, .hint = "half the bounds"},
     "First step for `nlopt`, as a fraction of the distance between the bounds.");
}
void Check(const MapReader& map, SearchText& search);

struct StudyForm {
  static constexpr const char* kSchema = R"("const": "study")";
};
struct StudyFileText {
  Head<StudyForm> head;
  std::string name, description;
  Raw<FileForm> experiment;
  Raw<ParametersForm> set;
  std::uint64_t seed = 0;
  std::vector<VaryText> vary;
  ObjectiveText objective;
  std::optional<PerturbationSpec> worlds;
  std::vector<SearchText> search;
};
template <class Io>
void Keys(Io& io, Like<StudyFileText> auto& s) {
  io.Map("", "Study file",
         "A study file defines a search: the parameters to vary, the objective, the worlds and the "
         "search "
         "methods.");
  HeadKeys(
      io, s,
      {"Name of the study, and of its folder under runs/. Required unless the `base` file has it.",
       "Purpose of the study, in a sentence or two.",
       "Another study file to inherit from, relative to this file's folder. Each key of this file "
       "replaces the whole key of the base, except that `parameters` and `set` are merged by name.",
       R"("sidewinder3.yaml")",
       "Named numbers for expressions in this file. Parameters may refer to each other, in any "
       "order; `--set name=value` on the command line overrides them.",
       R"({"fastest_hz": "2"})"});
  io("experiment", s.experiment, kNeeded,
     "Experiment file, relative to this file's folder. Required unless the `base` file has it.",
     Example{R"("../experiments/push_20n.yaml")"});
  io("set", s.set,
     "Parameters of the experiment or its model that this study overrides; `--set` on the command "
     "line takes precedence.",
     Example{R"({"segments": 12})"});
  io("seed", s.seed, Bound{.least = 0, .most = 2'147'483'647},
     "Seed of all random numbers of the search. The first world of every candidate keeps the "
     "experiment's seed.");
  io("vary", s.vary, kNeeded,
     "Varied parameters. `taut learn --parameters EXPERIMENT` lists all parameters.");
  io("objective", s.objective, kNeeded);
  io("worlds", s.worlds);
  io("search", s.search, kNeeded,
     "Searches, one after the other, each from the best candidate so far. The first starts from "
     "the experiment's values.");
}

}  // namespace taut::description
