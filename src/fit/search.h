/// Searches in lockstep: the points of all of them are computed in one call.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "fit/damped_step.h"
#include "fit/differences.h"

namespace taut::fit {

/// Another start for job `job` whose start could not be computed, the `attempt`-th time; nothing:
/// no more.
using Again = std::function<std::optional<std::vector<double>>(std::size_t job, int attempt)>;

/// The searches of one call. Its state changes at the end of an iteration only, so that one that
/// was stopped goes on as if it had not been.
class Search {
 public:
  Search(const FitProblem& problem, std::span<const FitJob> jobs, const FitOptions& options,
         const FitState& from, Again again);

  FitState Run();

 private:
  /// What can be had again from a track's values.
  struct Work {
    std::vector<double> residual;
    std::vector<std::vector<double>> slopes;  ///< One a parameter; empty where it is held.
    std::vector<double> nearby;  ///< The best point of the differences, if better than the track's;
    std::vector<double> nearby_residual;
    double nearby_cost = 0;
  };
  /// A trial point of a track.
  struct Trial {
    std::size_t track = 0;
    double damping = 0, predicted = 0, length = 0;
    Residuals answer;
    double cost = 0;  ///< Infinite if it failed: the penalty.
  };

  bool Begin();   ///< Residuals of all starts. False: stopped.
  bool Derive();  ///< Slopes of those that moved. False: stopped.
  /// Before a search ends at differences that were not checked: has them checked, if they were not.
  bool CheckFirst(std::size_t track);
  /// Counts points of differences and keeps the best of each track.
  void TakeNearby(std::size_t track, const std::vector<double>& point, const Residuals& answer);
  bool Try();  ///< An iteration. False: stopped.

  FitState Stopped();  ///< What was kept, with those that still run marked.
  bool Compute(const std::vector<std::vector<double>>& points, std::vector<Residuals>& answers);
  double CostAt(std::size_t track, const std::vector<double>& values,
                const std::vector<double>& residual) const;
  bool Held(std::size_t track, std::size_t parameter) const;
  void Propose(std::size_t track, std::vector<Trial>& trials,
               std::vector<std::vector<double>>& points);
  void Choose(std::size_t track, std::span<Trial> trials,
              std::span<const std::vector<double>> points);
  void MoveTo(std::size_t track, const std::vector<double>& values, double cost);
  /// To the best point of the differences, if it is better by more than nothing to speak of.
  bool Jump(std::size_t track);
  void End(std::size_t track, FitEnd end, const std::string& why);
  void CountFailure(std::size_t track, const std::string& why);
  bool Running(std::size_t track) const { return state_.tracks[track].end == FitEnd::kRunning; }
  bool AnyRunning() const;
  StepBox BoxOf(std::size_t track, const Vector& gradient) const;

  const FitProblem& problem_;
  std::span<const FitJob> jobs_;
  const FitOptions& options_;
  Again again_;
  FitState state_, kept_;
  std::vector<Work> work_;
  bool resumed_ = false;
};

}  // namespace taut::fit
