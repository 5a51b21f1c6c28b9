/// The keys of a study file.
#pragma once

#include <cmath>

#include "description/experiment/experiment_keys.h"
#include "description/experiment/objective_keys.h"
#include "taut/study.h"

namespace taut::description {

inline const Choices<bool> kScales{{"linear", false}, {"log", true}};
inline const Choices<bool> kJudges{{"mean", false}, {"worst", true}};
/// `NloptAlgorithms`, each for itself.
const Choices<std::string>& NloptChoices();
enum class Method { kMonteCarlo, kHillClimbing, kNlopt, kCmaEs };
inline const Choices<Method> kMethods{{"monte_carlo", Method::kMonteCarlo},
                                      {"hill_climbing", Method::kHillClimbing},
                                      {"nlopt", Method::kNlopt},
                                      {"cma_es", Method::kCmaEs}};

/// An entry of `vary:`.
struct VaryText {
  SourceRef at;
  std::string name;
  Raw<PatternsForm> each, all;
  double low = NAN, high = NAN;
  bool log = false;
  SourceRef low_at, name_at, pattern_at;  ///< Of keys.
};
template <class Io>
void Keys(Io& io, Like<VaryText> auto& v) {
  io.Map("vary", "vary", "Numbers of the experiment, by name, `*` for any letters.");
  io("name", v.name, kName,
     "Name of the parameter, for tables and the log; with `each`, a prefix. That of the number "
     "itself if absent.");
  io.OneOf({"each", "all"});
  io("each", v.each, "A parameter for each number that fits.",
     Example{R"("impedance.inner_*.tension_offset_n")"});
  io("all", v.all, "One parameter for all that fit together: a symmetric group.",
     Example{R"(["impedance.outer_left*.tension_offset_n", )"
             R"("impedance.outer_right*.tension_offset_n"])"});
  io("low", v.low, kNeeded, "Lower bound, in the number's unit.");
  io("high", v.high, kNeeded, "Upper bound, in the number's unit.");
  io("scale", v.log, kScales, "Whether even steps are even differences or even ratios.");
}
void Check(const MapReader& map, VaryText& vary);

struct ObjectiveText : ObjectiveSpec {
  SourceRef from_at, measure_at;  ///< Of the keys.
};
template <class Io>
void Keys(Io& io, Like<ObjectiveText> auto& o) {
  io.Map("objective", "objective",
         "The score of a world; more is better. Measured along the way, without a trace.");
  io("measure", o.measure, kMeasures, kNeeded,
     "`distance`: how far the centre of mass gets from where it was, horizontally [m]. `heading`: "
     "the part of that along `direction`. `distance_per_energy`: distance by the motors' work, "
     "tension times winding in [m/J]. `nearer`: how much nearer to the experiment's goal the body "
     "that it watches is, horizontally [m]. `tracking`: minus the root mean square of the cables' "
     "tensions less their set points [N].");
  ObjectiveKeys(io, o);
}
void Check(const MapReader& map, ObjectiveText& objective);

template <class Io>
void Keys(Io& io, Like<PerturbationSpec> auto& w) {
  io.Map("worlds", "worlds",
         "The worlds that judge each candidate, so that what is learned is no fluke of one. The "
         "first is as the experiment says; the others have factors and starts drawn evenly.");
  io("count", w.worlds, kNeeded, Bound{.least = 1, .most = 1000}, "How many.");
  VariationKeys(io, w);
  io("redraw", w.redraw, "Whether each candidate meets worlds of its own; else all meet the same.");
  io("score", w.worst, kJudges, "How the worlds' scores become one.");
}

/// An entry of `search:`, with the keys of all methods.
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
  io.Map("search", "search", "One way of searching, docs/learning.md.");
  io("method", s.method, kMethods, kNeeded,
     "`monte_carlo`: points all over the bounds. `hill_climbing`: Gauss steps around the best. "
     "`nlopt`: a local method of the library NLopt, from many starts side by side. `cma_es`: Gauss "
     "steps whose directions and lengths adapt.");
  io("evaluations", s.evaluations, kNeeded, Bound{.least = 1, .most = 1'000'000'000},
     "How many candidates to try. That of the last search may be raised later.");
  io("batch", s.batch, Bound{.least = 1, .most = 100'000},
     "Candidates side by side before the search looks at scores; for `cma_es` the population, at "
     "least 4. Results depend on it.");
  io("deviation", s.deviation,
     Bound{.least = 0.0, .most = 10.0, .above_least = true, .hint = "in widths of the bounds"},
     "For `hill_climbing` (0.1 if absent) and `cma_es` (0.3): standard deviation of the first "
     "steps, in widths of the bounds.");
  io("adapt", s.adapt,
     "For `hill_climbing`: steps grow after success and shrink after failure; else they keep their "
     "deviation, as NTRT's.");
  io("algorithm", s.algorithm, NloptChoices(), "For `nlopt`: which of its methods.");
  io("starts", s.starts, Bound{.least = 1, .most = 1000},
     "For `nlopt`: how many runs side by side. The first starts from the best so far, the others "
     "anywhere; one that has converged starts again elsewhere.");
  io("initial_step", s.initial_step,
     Bound{.least = 0.0, .most = 0.5, .above_least = true, .hint = "half the bounds"},
     "For `nlopt`: the first step, in widths of the bounds.");
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
         "A search: which numbers of an experiment to vary, what for, in which worlds, and how.");
  HeadKeys(io, s,
           {"Name of the study, and of its folder under runs/. Needed unless `base` has it.",
            "What the study is for, in a sentence or two.",
            "Another study file, seen from this file's folder. This file then holds only what "
            "differs: each of its keys replaces the base's as a whole, except that `parameters` "
            "and `set` are merged by name.",
            R"("sidewinder3.yaml")",
            "Named numbers for expressions in this file. They may refer to each other, in any "
            "order; `--set name=value` on the command line replaces them.",
            R"({"fastest_hz": "2"})"});
  io("experiment", s.experiment, kNeeded,
     "The experiment file that is run, seen from this file's folder. Needed unless `base` has it.",
     Example{R"("../experiments/push_20n.yaml")"});
  io("set", s.set,
     "Parameters of the experiment or its model whose value this study changes; `--set` on the "
     "command line wins over them.",
     Example{R"({"segments": 12})"});
  io("seed", s.seed, Bound{.least = 0, .most = 2'147'483'647},
     "Seed of everything random in the search. The first world of every candidate keeps the "
     "experiment's own seed.");
  io("vary", s.vary, kNeeded,
     "The numbers to search. `taut learn --parameters EXPERIMENT` lists all that there are.");
  io("objective", s.objective, kNeeded);
  io("worlds", s.worlds);
  io("search", s.search, kNeeded,
     "What is done, one after the other, each from the best so far. The first starts from what the "
     "experiment says.");
}

}  // namespace taut::description
