/// Study files: parameters to vary in an experiment, objective, and search methods.
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
  std::string name;  ///< "hold.inner_top_1.tension_offset_n", "model.friction".
  std::string unit;
  double* value = nullptr;
  double min = 0, max = 0;  ///< Meaningful range; may be infinite.
  bool at_start = false;    ///< Affects only the start of a gait.
};

/// Returns the factors on the model that studies can vary, all 1: friction, masses, stiffnesses and
/// dampings, for all elements together and for each one.
std::vector<ScaleSpec> TunableScales(const RobotSpec& robot);

/// Returns all parameters that can be varied. `scales`: as from TunableScales. The result has
/// pointers into the arguments.
std::vector<Tunable> FindTunables(std::vector<ControllerSpec>& controllers,
                                  std::vector<ScaleSpec>& scales, const RobotSpec& robot);

/// One dimension of the search.
struct StudyParameter {
  std::string name;
  std::string unit;
  std::vector<std::string> targets;  ///< Names of tunables (FindTunables) that get this value.
  double low = 0, high = 0;
  bool log = false;  ///< Logarithmic scale.
};

/// Domain randomization of the worlds in which one candidate is evaluated. The first world has no
/// perturbation.
struct PerturbationSpec : VariationSpec {
  int worlds = 1;
  bool redraw = false;  ///< New worlds for each candidate; else the same for all.
  bool worst = false;   ///< The score is the worst world's; else the mean.
};

struct MonteCarloSpec {};
struct HillClimbingSpec {
  double deviation = 0.1;  ///< Standard deviation of steps, relative to the range of the bounds.
  bool adapt = true;       ///< Longer steps after success, shorter after failure.
};
struct NloptSpec {
  std::string algorithm = "nelder_mead";
  int starts = 8;  ///< Concurrent searches; the first starts from the best candidate so far.
  double initial_step = 0.1;  ///< Relative to the range of the bounds.
};
struct CmaEsSpec {
  double deviation = 0.3;  ///< Initial, relative to the range of the bounds.
};

/// Search method with its number of evaluations; starts from the best candidate of earlier
/// searches.
struct SearchSpec {
  std::variant<MonteCarloSpec, HillClimbingSpec, NloptSpec, CmaEsSpec> method;
  int evaluations = 0;
  int batch = 16;  ///< Concurrent candidates. Results depend on it, not on the machine.
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
  std::vector<std::string> files;  ///< All files that were read, the study first.
};

/// Returns the NLopt algorithms that a study can select; none needs derivatives.
const std::vector<std::string>& NloptAlgorithms();

/// Reads a study and its experiment. Returns nothing, with diagnostics, if there was any error.
std::optional<StudySpec> LoadStudy(const std::string& path, const Overrides& overrides,
                                   Diagnostics& out);

/// Reads an objective in the syntax of a study's `objective` (YAML or JSON), and checks it against
/// its experiment. `name`: name of the text in diagnostics.
std::optional<ObjectiveSpec> ReadObjective(const std::string& text, const std::string& name,
                                           const ExperimentSpec& experiment, Diagnostics& out);

/// Returns the study as text in numbers, one fact per line, without the experiment and without
/// budgets: studies with the same text and the same resolved experiment give the same results.
std::string StudyText(const StudySpec& study);

}  // namespace taut
