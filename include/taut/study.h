/// Study files: parameters of an experiment to vary, objective, and search methods.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "taut/diagnostics.h"
#include "taut/objective.h"
#include "taut/spec.h"

namespace taut {

/// Parameter of an experiment that a study can vary.
struct Tunable {
  std::string name;  ///< For example "hold.inner_top_1.tension_offset_n", "model.friction".
  std::string unit;
  double* value = nullptr;
  double min = 0, max = 0;  ///< Useful range; may be infinite.
  bool at_start = false;    ///< Affects only the start of a gait.
};

/// Returns the factors on the model that studies can vary: friction, masses, stiffnesses and
/// dampings, for all elements together and for each element. All factors are 1.
std::vector<ScaleSpec> TunableScales(const RobotSpec& robot);

/// Returns all parameters that can be varied. `scales`: see TunableScales. The result contains
/// pointers into the arguments.
std::vector<Tunable> FindTunables(std::vector<ControllerSpec>& controllers,
                                  std::vector<ScaleSpec>& scales, const RobotSpec& robot);

/// Search dimension.
struct StudyParameter {
  std::string name;
  std::string unit;
  std::vector<std::string> targets;  ///< Names of the tunables (FindTunables) with this value.
  double low = 0, high = 0;
  bool log = false;  ///< Logarithmic scale.
};

/// Domain randomization for the evaluation of a candidate in several worlds. The first world has no
/// perturbation.
struct PerturbationSpec : VariationSpec {
  int worlds = 1;
  bool redraw = false;  ///< New worlds for each candidate; false: the same worlds for all.
  bool worst = false;   ///< The score is the lowest of all worlds; false: the mean.
};

struct MonteCarloSpec {};
struct HillClimbingSpec {
  double deviation = 0.1;  ///< Standard deviation of steps, relative to the range of the bounds.
  bool adapt = true;       ///< Increases steps after success, decreases them after failure.
};
struct NloptSpec {
  std::string algorithm = "nelder_mead";
  /// Number of concurrent searches. The first one starts from the best candidate so far.
  int starts = 8;
  double initial_step = 0.1;  ///< Relative to the range of the bounds.
};
struct CmaEsSpec {
  double deviation = 0.3;  ///< Initial standard deviation, relative to the range of the bounds.
};

/// Search method with its number of evaluations. The search starts from the best candidate of
/// earlier searches.
struct SearchSpec {
  std::variant<MonteCarloSpec, HillClimbingSpec, NloptSpec, CmaEsSpec> method;
  int evaluations = 0;
  /// Number of concurrent candidates. The results depend on this number but not on the machine.
  int batch = 16;
};

struct StudySpec {
  std::string name;
  std::string description;
  ExperimentSpec experiment;
  std::string experiment_file;
  std::uint64_t seed = 0;
  std::vector<StudyParameter> parameters;
  ObjectiveSpec objective;
  PerturbationSpec perturbation;
  std::vector<SearchSpec> searches;
  std::vector<std::string> files;  ///< All files read; the study file is first.
};

/// Returns the NLopt algorithms that a study can select. All are derivative-free.
const std::vector<std::string>& NloptAlgorithms();

/// Reads a study and its experiment. On an error, returns nothing and adds diagnostics.
std::optional<StudySpec> LoadStudy(const std::string& path, const Overrides& overrides,
                                   Diagnostics& out);

/// Reads an objective in the syntax of `objective` in a study (YAML or JSON) and checks it against
/// its experiment. `name`: name of the text in diagnostics.
std::optional<ObjectiveSpec> ReadObjective(const std::string& text, const std::string& name,
                                           const ExperimentSpec& experiment, Diagnostics& out);

/// Returns the study as text, one fact per line, without experiment and budgets. Studies with equal
/// texts and equal resolved experiments have equal results.
std::string StudyText(const StudySpec& study);

}  // namespace taut
