/// Restarts of a live run that were asked for and are still to be made: resets, and parameters of
/// the files. However many there are, one restart does for all of them.
#pragma once

#include <chrono>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "taut/live.h"

namespace taut::viewer {

class Restarts {
 public:
  using Clock = std::chrono::steady_clock;

  /// What the files are read with.
  struct Inputs {
    std::string path;                ///< Of the experiment.
    Overrides overrides;             ///< Of its parameters; those that are set join them.
    double step_s = 0;               ///< Instead of the experiment's; 0: as that says.
    std::optional<StartKind> start;  ///< Instead of the experiment's.
  };
  /// A change that cannot be: the files say why.
  struct Refusal {
    int client = 0;
    std::string why;
  };
  struct Start {
    std::unique_ptr<LiveRun> run;
    ExperimentSpec experiment;
    std::vector<Diagnostic> warnings;
  };

  explicit Restarts(Inputs inputs) : inputs_(std::move(inputs)) {}

  void Reset(int client) { asked_.push_back({client, "", 0}); }
  void Set(int client, const std::string& parameter, double value) {
    asked_.push_back({client, parameter, value});
  }
  /// What the present run's files are read with.
  const Inputs& inputs() const { return inputs_; }
  bool pending() const { return !asked_.empty() || !groups_.empty(); }

  /// Finds the start that all of them ask for; of two values of a parameter the later one counts. A
  /// change that cannot be is refused, and what was set before it stays. The deadline is for those
  /// who make many such changes; a start by itself takes as long as it takes, or until `go_on` says
  /// no. A start comes only once nothing is pending.
  std::optional<Start> Make(const ExperimentSpec& present, Clock::time_point deadline,
                            const std::function<bool()>& go_on);
  std::vector<Refusal> TakeRefusals() { return std::exchange(refused_, {}); }

 private:
  struct Change {
    int client = 0;
    std::string parameter;  ///< Empty: a reset.
    double value = 0;
  };
  using Group = std::vector<Change>;

  void Try(Group group, const ExperimentSpec& present, const std::function<bool()>& go_on);

  Inputs inputs_;
  Group asked_;
  std::deque<Group> groups_;  ///< To be tried, each as one; a group that fails is tried in halves.
  std::optional<Start> found_;
  std::vector<Refusal> refused_;
};

}  // namespace taut::viewer
