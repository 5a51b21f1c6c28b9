/// Pending restarts of a live run: resets and changes of file parameters, merged into one restart.
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

  /// Inputs of a start: the file and its changes.
  struct Inputs {
    std::string path;                ///< Path of the experiment.
    Overrides overrides;             ///< Overrides of its parameters; later changes are added.
    double step_s = 0;               ///< Replaces the experiment's step; 0: no change.
    std::optional<StartKind> start;  ///< Replaces the experiment's start.
  };
  /// A change that the files do not allow, with the reason.
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
  /// Returns the inputs of the present run.
  const Inputs& inputs() const { return inputs_; }
  bool pending() const { return !asked_.empty() || !groups_.empty(); }

  /// Computes the start that results from all pending changes; the last value of a parameter
  /// counts. An invalid change is refused and leaves the earlier value. The deadline limits the
  /// number of changes per call; the computation of a single start ends early only if `go_on`
  /// returns false. Returns a start once nothing is pending.
  std::optional<Start> Make(const ExperimentSpec& present, Clock::time_point deadline,
                            const std::function<bool()>& go_on);
  std::vector<Refusal> TakeRefusals() { return std::exchange(refused_, {}); }

 private:
  struct Change {
    int client = 0;
    std::string parameter;  ///< Name of the parameter; empty: a reset.
    double value = 0;
  };
  using Group = std::vector<Change>;

  void Try(Group group, const ExperimentSpec& present, const std::function<bool()>& go_on);

  Inputs inputs_;
  Group asked_;
  std::deque<Group> groups_;  ///< Tried group by group; a group that fails is split in halves.
  std::optional<Start> found_;
  std::vector<Refusal> refused_;
};

}  // namespace taut::viewer
