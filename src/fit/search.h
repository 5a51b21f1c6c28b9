/// Levenberg-Marquardt searches in lockstep. Each iteration computes the points of all searches in
/// one call.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "fit/damped_step.h"
#include "fit/differences.h"

namespace taut::fit {

/// Returns another start if the start of a job could not be computed. `attempt` counts from 1.
/// Returns nothing if no more attempts are permitted.
using Again = std::function<std::optional<std::vector<double>>(std::size_t job, int attempt)>;

/// Searches of all jobs. The state changes only at the end of an iteration, so that a stopped
/// search resumes with identical results.
class Search {
 public:
  Search(const FitProblem& problem, std::span<const FitJob> jobs, const FitOptions& options,
         const FitState& from, Again again);

  FitState Run();

 private:
  /// Data that follow from a track's values and are not part of the state.
  struct Work {
    std::vector<double> residual;
    std::vector<std::vector<double>> slopes;  ///< One per parameter; empty if the parameter is
                                              ///< held.
    /// Best point of the finite differences if it is better than the track's point; otherwise
    /// empty.
    std::vector<double> nearby;
    std::vector<double> nearby_residual;
    double nearby_cost = 0;
  };
  /// Trial point of a track.
  struct Trial {
    std::size_t track = 0;
    double damping = 0, predicted = 0, length = 0;
    Residuals answer;
    double cost = 0;  ///< Infinite if the point could not be computed.
  };

  bool Begin();   ///< Computes the residuals of all starts. Returns false if stopped.
  bool Derive();  ///< Computes the slopes of searches with new values. Returns false if stopped.
  /// Requests a check of unchecked slopes before a search ends. Returns whether a check was needed.
  bool CheckFirst(std::size_t track);
  /// Counts a point of the finite differences and keeps it if it is the track's best.
  void TakeNearby(std::size_t track, const std::vector<double>& point, const Residuals& answer);
  bool Try();  ///< Performs an iteration. Returns false if stopped.

  FitState Stopped();  ///< Returns the state, with running searches marked as interrupted.
  bool Compute(const std::vector<std::vector<double>>& points, std::vector<Residuals>& answers);
  double CostAt(std::size_t track, const std::vector<double>& values,
                const std::vector<double>& residual) const;
  bool Held(std::size_t track, std::size_t parameter) const;
  void Propose(std::size_t track, std::vector<Trial>& trials,
               std::vector<std::vector<double>>& points);
  void Choose(std::size_t track, std::span<Trial> trials,
              std::span<const std::vector<double>> points);
  void MoveTo(std::size_t track, const std::vector<double>& values, double cost);
  /// Moves to the best point of the finite differences if it lowers the cost by more than rounding.
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
