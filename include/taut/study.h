/// Studies as files describe them: what to vary in an experiment, what for, and how to search.
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

/// A number of an experiment that a study may vary.
struct Tunable {
  std::string name;  ///< "hold.inner_top_1.tension_offset_n", "model.friction".
  std::string unit;
  double* value = nullptr;
  double min = 0, max = 0;  ///< Beyond these it makes no sense; may be infinite.
  bool at_start = false;    ///< Of a gait: it says where that begins, and nothing later.
};

/// Factors on the model that studies may vary, all 1: friction, and masses, stiffnesses and
/// dampings, together and one by one.
std::vector<ScaleSpec> TunableScales(const RobotSpec& robot);

/// Everything that can be varied. `scales` as from TunableScales. Pointers go into the arguments.
std::vector<Tunable> FindTunables(std::vector<ControllerSpec>& controllers,
                                  std::vector<ScaleSpec>& scales, const RobotSpec& robot);

/// One dimension of the search.
struct StudyParameter {
  std::string name;
  std::string unit;
  std::vector<std::string> targets;  ///< Names of FindTunables: all get this value.
  double low = 0, high = 0;
  bool log = false;  ///< Even steps are even ratios.
};

/// How worlds differ that judge one candidate. The first is never perturbed.
struct PerturbationSpec : VariationSpec {
  int worlds = 1;
  bool redraw = false;  ///< Other worlds for each candidate; else all meet the same.
  bool worst = false;   ///< The score is that of the worst world; else their mean.
};

struct MonteCarloSpec {};
struct HillClimbingSpec {
  double deviation = 0.1;  ///< Of the Gauss steps, in widths of the bounds.
  bool adapt = true;       ///< Longer steps after success, shorter after failure.
};
struct NloptSpec {
  std::string algorithm = "nelder_mead";
  int starts = 8;             ///< Side by side; the first from the best so far.
  double initial_step = 0.1;  ///< In widths of the bounds.
};
struct CmaEsSpec {
  double deviation = 0.3;  ///< Initial, in widths of the bounds.
};

/// One way of searching, for a number of evaluations; starts from the best of those before it.
struct SearchSpec {
  std::variant<MonteCarloSpec, HillClimbingSpec, NloptSpec, CmaEsSpec> method;
  int evaluations = 0;
  int batch = 16;  ///< Candidates side by side. Results depend on it, not on the machine.
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
  std::vector<std::string> files;  ///< That were read, the study first.
};

/// The optimisers of NLopt that a study may name, none of which needs a derivative.
const std::vector<std::string>& NloptAlgorithms();

/// Reads a study and its experiment. Returns nothing if there was any error.
std::optional<StudySpec> LoadStudy(const std::string& path, const Overrides& overrides,
                                   Diagnostics& out);

/// Reads an objective alone, written as a study has it under `objective` (YAML or JSON), and checks
/// it against the experiment that it is for. `name` is what complaints call the text.
std::optional<ObjectiveSpec> ReadObjective(const std::string& text, const std::string& name,
                                           const ExperimentSpec& experiment, Diagnostics& out);

/// The study in numbers, a line each fact, without the experiment and without budgets: two studies
/// with the same text and the same resolved experiment find the same.
std::string StudyText(const StudySpec& study);

}  // namespace taut
