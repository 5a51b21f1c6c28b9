// Profile likelihood of a parameter and its confidence interval (docs/theory/identification.md,
// section 5).
#include <algorithm>
#include <cmath>
#include <set>

#include "fit/format.h"
#include "fit/problem.h"
#include "taut/fit_verdict.h"

namespace taut {
namespace {

/// Limit of extensions of a side that does not reach the level. Each one doubles the spacing.
constexpr int kExtensions = 4;
constexpr double kLower = 1e-6;   ///< Smaller differences are within the tolerance of searches.
constexpr double kBetter = 0.01;  ///< Decrease of chi-square that indicates a better fit.

/// Profile likelihood in progress. `points` are added on both sides of the fit.
class Profile {
 public:
  Profile(const FitProblem& problem, std::size_t parameter, const ProfileOptions& options)
      : problem_(problem), options_(options), parameter_(parameter) {
    held_.assign(problem.parameters.size(), false);
    held_[parameter] = true;
  }

  /// Computes the central point. Returns false if stopped or if the fit cannot be computed.
  bool Centre(const std::vector<double>& values) {
    std::vector<bool> all(values.size(), true);
    const std::vector<FitJob> jobs = {{values, all, {}}};
    FitOptions none = options_.fit;
    none.most_iterations = 1;
    const FitState state = RunFitJobs(problem_, jobs, none);
    if (state.tracks.empty() || state.tracks[0].end == FitEnd::kFailed) {
      why_ = state.tracks.empty() ? "stopped" : state.tracks[0].why;
      return false;
    }
    cost_ = state.tracks[0].cost;
    points_ = {{values[parameter_], 0, values, ""}};
    return true;
  }

  /// Adds points with spacing `step` on the selected sides. Their searches start from the outermost
  /// point of each side.
  bool Extend(bool down, bool up, double step) {
    std::vector<FitJob> jobs;
    if (down) AddSide(Computed(true), -step, jobs);
    if (up) AddSide(Computed(false), step, jobs);
    return Run(jobs);
  }

  /// Repeats each search from the results of both neighbors, until no point improves. A better
  /// minimum, which a kink may hide, thus propagates from point to point.
  bool Again() {
    for (const ProfilePoint& point : points_) lowered_.insert(point.value);
    for (std::size_t pass = 0; pass < points_.size() && !lowered_.empty(); ++pass) {
      std::vector<FitJob> jobs;
      for (std::size_t k = 0; k < points_.size(); ++k) {
        for (const std::size_t other : {k - 1, k + 1}) {  // k - 1 overflows if k = 0
          if (other >= points_.size() || lowered_.count(points_[other].value) == 0) continue;
          if (!points_[other].failed.empty()) continue;
          jobs.push_back({points_[other].values, held_, {}});
          jobs.back().start[parameter_] = points_[k].value;
        }
      }
      lowered_.clear();
      if (!Run(jobs)) return false;
    }
    return true;
  }

  bool AtBound(bool low) const {
    const FitParameter& p = problem_.parameters[parameter_];
    return low ? points_.front().value <= p.low : points_.back().value >= p.high;
  }
  bool Reaches(bool low, double level) const {
    return (low ? points_.front() : points_.back()).rise >= Lowest() + level;
  }
  double Lowest() const {
    double lowest = 0;
    for (const ProfilePoint& point : points_) lowest = std::min(lowest, point.rise);
    return lowest;
  }
  const std::vector<ProfilePoint>& points() const { return points_; }
  const std::string& why() const { return why_; }

 private:
  /// Returns the outermost computable point of a side.
  const ProfilePoint& Computed(bool low) const {
    std::size_t k = low ? 0 : points_.size() - 1;
    while (!points_[k].failed.empty()) low ? ++k : --k;
    return points_[k];
  }

  /// Adds points on one side, at most up to the bound.
  void AddSide(const ProfilePoint& from, double step, std::vector<FitJob>& jobs) const {
    const FitParameter& p = problem_.parameters[parameter_];
    double before = from.value;
    for (int k = 1; k <= options_.points; ++k) {
      const double value = std::clamp(from.value + step * k, p.low, p.high);
      if (value == before) return;
      jobs.push_back({from.values, held_, {}});
      jobs.back().start[parameter_] = before = value;
    }
  }

  bool Run(const std::vector<FitJob>& jobs) {
    if (jobs.empty()) return true;
    const FitState state = RunFitJobs(problem_, jobs, options_.fit);
    if (state.tracks.empty()) {
      why_ = "stopped";
      return false;
    }
    for (const FitTrack& track : state.tracks) {
      if (track.end == FitEnd::kInterrupted) {
        why_ = "stopped";
        return false;
      }
      Put(track);
    }
    return true;
  }

  /// Inserts a point by its value. If the value exists, keeps the point with the lower cost.
  void Put(const FitTrack& track) {
    ProfilePoint point;
    point.value = track.start[parameter_];
    point.values = track.values;
    const bool failed = track.end == FitEnd::kFailed;
    point.rise = failed ? fit::kInfinite : 2 * (track.cost - cost_);
    if (failed) point.failed = track.why;
    const auto at =
        std::lower_bound(points_.begin(), points_.end(), point.value,
                         [](const ProfilePoint& p, double value) { return p.value < value; });
    if (at == points_.end() || at->value != point.value) {
      points_.insert(at, std::move(point));
    } else if (point.rise < at->rise - kLower) {
      lowered_.insert(point.value);
      *at = std::move(point);
    }
  }

  const FitProblem& problem_;
  const ProfileOptions& options_;
  std::size_t parameter_;
  std::vector<bool> held_;
  double cost_ = 0;
  std::set<double> lowered_;  ///< Values of the points that the last run improved.
  std::vector<ProfilePoint> points_;
  std::string why_;
};

/// Returns the parameter value between two points at which the rise crosses the level. Interpolates
/// the square root of the rise linearly, which is exact for a parabola with its minimum at the fit.
double Crossing(const ProfilePoint& below, const ProfilePoint& above, double lowest, double level) {
  if (std::isinf(above.rise)) return below.value;  // points beyond cannot be computed
  const double a = std::sqrt(std::max(below.rise - lowest, 0.0));
  const double b = std::sqrt(above.rise - lowest);
  return below.value + (above.value - below.value) * (std::sqrt(level) - a) / (b - a);
}

void FindInterval(const FitParameter& p, double lowest, FitProfile& profile) {
  const auto& points = profile.points;
  std::size_t first = points.size(), last = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (points[k].rise >= lowest + profile.level) continue;
    first = std::min(first, k);
    last = k;
  }
  profile.low_open = first == 0;
  profile.high_open = last + 1 == points.size();
  profile.low =
      profile.low_open ? p.low : Crossing(points[first], points[first - 1], lowest, profile.level);
  profile.high =
      profile.high_open ? p.high : Crossing(points[last], points[last + 1], lowest, profile.level);
}

std::string Sentence(const FitParameter& p, const FitProfile& profile, double confidence) {
  std::string text = p.name + ": " + fit::Brief(100 * confidence) + " % interval " +
                     fit::Brief(profile.low) + " to " + fit::Brief(profile.high, p.unit);
  if (profile.low_open || profile.high_open) {
    text += std::string("; open ") +
            (profile.low_open && profile.high_open ? "on both sides"
             : profile.low_open                    ? "below"
                                                   : "above") +
            ": the data do not bound it there";
  }
  if (profile.better)
    text += "; the profile has a lower point than the fit: start the fit from there";
  return text;
}

}  // namespace

FitProfile ProfileParameter(const FitProblem& problem, const std::vector<double>& values,
                            std::size_t parameter, double se, const ProfileOptions& options) {
  const FitParameter& p = problem.parameters[parameter];
  FitProfile result;
  result.parameter = parameter;
  result.level = ChiSquareQuantile(1 - options.confidence, 1);
  Profile profile(problem, parameter, options);
  const double reach = options.reach * (std::isfinite(se) && se > 0 ? se : FitScale(p));
  double step = reach / options.points;
  bool good = profile.Centre(values);
  bool down = true, up = true;
  for (int k = 0; good && k <= kExtensions && (down || up); ++k) {
    good = profile.Extend(down, up, step);
    down = !profile.AtBound(true) && !profile.Reaches(true, result.level);
    up = !profile.AtBound(false) && !profile.Reaches(false, result.level);
    step *= 2;
  }
  good = good && profile.Again();
  if (!good) {
    result.why = profile.why();
    return result;
  }
  result.points = profile.points();
  const double lowest = profile.Lowest();
  FindInterval(p, lowest, result);
  for (const ProfilePoint& point : result.points) {
    if (point.rise < -kBetter && point.rise == lowest) result.better = point.values;
  }
  result.sentence = Sentence(p, result, options.confidence);
  return result;
}

}  // namespace taut
