// Parameter fit by the Levenberg-Marquardt method from several starts.
#include <algorithm>

#include "fit/search.h"

namespace taut {
namespace {

constexpr int kDrawnAgain = 8;

std::string Joined(const std::vector<std::string>& sentences) {
  std::string all;
  for (const std::string& sentence : sentences) all += (all.empty() ? "" : "; ") + sentence;
  return all;
}

/// Returns the track with the lowest cost; the first if several are equal. Returns nothing if all
/// tracks failed.
std::optional<std::size_t> BestTrack(const FitState& state) {
  std::optional<std::size_t> best;
  for (std::size_t t = 0; t < state.tracks.size(); ++t) {
    if (state.tracks[t].end == FitEnd::kFailed) continue;
    if (!best || state.tracks[t].cost < state.tracks[*best].cost) best = t;
  }
  return best;
}

}  // namespace

FitState RunFitJobs(const FitProblem& problem, std::span<const FitJob> jobs,
                    const FitOptions& options, const FitState& from) {
  return fit::Search(problem, jobs, options, from, {}).Run();
}

FitResult Fit(const FitProblem& problem, const FitOptions& options, const FitState& from) {
  FitResult result;
  const std::size_t starts = static_cast<std::size_t>(std::max(options.starts, 1));
  std::vector<std::string> wrong = CheckFitProblem(problem);
  if (!from.tracks.empty() && from.tracks.size() != starts) {
    wrong.emplace_back("the state to resume from has a different number of starts");
  }
  for (const FitTrack& track : from.tracks) {
    if (track.values.size() != problem.parameters.size() ||
        track.weight.size() != problem.parameters.size()) {
      wrong.emplace_back("the state to resume from has different parameters");
      break;
    }
  }
  if (!wrong.empty()) {
    result.why = Joined(wrong);
    return result;
  }
  std::vector<FitJob> jobs(starts);
  for (std::size_t t = 0; t < starts; ++t) jobs[t].start = DrawFitStart(problem, options.seed, t);
  // The first start is given by the user: if it fails, report this instead of drawing another one.
  const fit::Again again = [&](std::size_t job, int attempt) -> std::optional<std::vector<double>> {
    if (job == 0 || attempt > kDrawnAgain) return {};
    return DrawFitStart(problem, options.seed, job + starts * static_cast<std::size_t>(attempt));
  };
  result.state = fit::Search(problem, jobs, options, from, again).Run();
  const auto& tracks = result.state.tracks;
  if (tracks.empty()) {  // stopped before the residuals of the starts were computed
    result.end = FitEnd::kInterrupted;
    result.why = "stopped";
    return result;
  }
  result.best = BestTrack(result.state);
  const bool interrupted = std::any_of(tracks.begin(), tracks.end(), [](const FitTrack& track) {
    return track.end == FitEnd::kInterrupted;
  });
  if (!result.best) {
    result.end = FitEnd::kFailed;
    result.why = tracks.front().why;
    return result;
  }
  const FitTrack& best = tracks[*result.best];
  result.end = interrupted ? FitEnd::kInterrupted : best.end;
  result.why = interrupted ? "stopped" : best.why;
  result.values = best.values;
  result.cost = best.cost;
  return result;
}

}  // namespace taut
