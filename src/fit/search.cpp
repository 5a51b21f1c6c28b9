#include "fit/search.h"

#include <algorithm>
#include <cmath>

#include "fit/problem.h"

namespace taut::fit {
namespace {

constexpr double kLeastDamping = 1e-12, kMostDamping = 1e12;
/// If the actual gain is below this share of the predicted gain, the slopes are checked again.
constexpr double kPoorRatio = 0.25;

/// Returns the cosine of the angle between the residuals and column j.
double Cosine(const Quadratic& quadratic, const Vector& gradient, double residual_norm,
              Eigen::Index j) {
  const double size = quadratic.R.col(j).norm() * residual_norm;
  return size > 0 ? std::fabs(gradient[j]) / size : 0.0;
}

}  // namespace

Search::Search(const FitProblem& problem, std::span<const FitJob> jobs, const FitOptions& options,
               const FitState& from, Again again)
    : problem_(problem),
      jobs_(jobs),
      options_(options),
      again_(std::move(again)),
      state_(from),
      work_(jobs.size()),
      resumed_(!from.tracks.empty()) {
  state_.tracks.resize(jobs.size());
  for (std::size_t t = 0; t < jobs.size(); ++t) {
    FitTrack& track = state_.tracks[t];
    if (resumed_) {
      const bool more =
          track.end == FitEnd::kIterations && track.iterations < options.most_iterations;
      if (track.end == FitEnd::kInterrupted || more) track.end = FitEnd::kRunning;
      continue;
    }
    track.start = jobs[t].start;
    for (std::size_t j = 0; j < track.start.size(); ++j) {
      const FitParameter& p = problem.parameters[j];
      track.start[j] = std::clamp(track.start[j], p.low, p.high);
    }
    track.values = track.start;
    track.damping = options.first_damping;
    track.weight.assign(problem.parameters.size(), 0.0);
    track.step_share.assign(problem.parameters.size(), 1.0);
  }
  kept_ = state_;
}

FitState Search::Run() {
  const bool resumed = resumed_;
  if (!Begin()) return resumed ? Stopped() : FitState{};
  kept_ = state_;
  while (AnyRunning()) {
    if (!Derive() || !Try()) break;
    kept_ = state_;
    const bool stop = options_.stop != nullptr && options_.stop->load();
    if ((options_.progress && !options_.progress(kept_)) || stop) break;
  }
  return Stopped();
}

FitState Search::Stopped() {
  for (FitTrack& track : kept_.tracks) {
    if (track.end != FitEnd::kRunning) continue;
    track.end = FitEnd::kInterrupted;
    track.why = "stopped";
  }
  return kept_;
}

bool Search::AnyRunning() const {
  for (std::size_t t = 0; t < jobs_.size(); ++t) {
    if (Running(t)) return true;
  }
  return false;
}

bool Search::Compute(const std::vector<std::vector<double>>& points,
                     std::vector<Residuals>& answers) {
  if (options_.stop != nullptr && options_.stop->load()) return false;
  auto computed = fit::Compute(problem_, points);
  if (!computed) return false;
  answers = std::move(*computed);
  return true;
}

double Search::CostAt(std::size_t track, const std::vector<double>& values,
                      const std::vector<double>& residual) const {
  return Cost(problem_, Rows(problem_, jobs_[track].left_out), values, residual);
}

bool Search::Held(std::size_t track, std::size_t parameter) const {
  return parameter < jobs_[track].held.size() && jobs_[track].held[parameter];
}

void Search::CountFailure(std::size_t track, const std::string& why) {
  ++state_.tracks[track].failed;
  ++state_.tracks[track].reasons[why];
}

void Search::End(std::size_t track, FitEnd end, const std::string& why) {
  state_.tracks[track].end = end;
  state_.tracks[track].why = why;
}

bool Search::Begin() {
  std::vector<std::size_t> open;
  for (std::size_t t = 0; t < jobs_.size(); ++t) {
    if (Running(t)) open.push_back(t);
  }
  for (int attempt = 1; !open.empty(); ++attempt) {
    std::vector<std::vector<double>> points;
    for (const std::size_t t : open) points.push_back(state_.tracks[t].values);
    std::vector<Residuals> answers;
    if (!Compute(points, answers)) return false;
    if (!resumed_) state_.points += static_cast<std::int64_t>(points.size());
    std::vector<std::size_t> failed;
    for (std::size_t k = 0; k < open.size(); ++k) {
      FitTrack& track = state_.tracks[open[k]];
      if (answers[k].failed.empty()) {
        work_[open[k]].residual = std::move(answers[k].value);
        track.cost = CostAt(open[k], track.values, work_[open[k]].residual);
        continue;
      }
      CountFailure(open[k], answers[k].failed);
      const auto other = again_ ? again_(open[k], attempt) : std::nullopt;
      if (!other) {
        End(open[k], FitEnd::kFailed, "the start could not be computed: " + answers[k].failed);
        continue;
      }
      track.start = track.values = *other;
      failed.push_back(open[k]);
    }
    open = std::move(failed);
  }
  return true;
}

StepBox Search::BoxOf(std::size_t t, const Vector& gradient) const {
  const std::vector<double>& values = state_.tracks[t].values;
  StepBox box;
  box.low.resize(gradient.size());
  box.high.resize(gradient.size());
  for (std::size_t j = 0; j < values.size(); ++j) {
    const FitParameter& p = problem_.parameters[j];
    const auto k = static_cast<Eigen::Index>(j);
    box.low[k] = (p.low - values[j]) / FitScale(p);
    box.high[k] = (p.high - values[j]) / FitScale(p);
    const bool pushed =
        (values[j] <= p.low && gradient[k] > 0) || (values[j] >= p.high && gradient[k] < 0);
    box.held.push_back(Held(t, j) || pushed);
  }
  return box;
}

void Search::MoveTo(std::size_t t, const std::vector<double>& values, double cost) {
  FitTrack& track = state_.tracks[t];
  track.values = values;
  track.cost = cost;
  track.rejected = 0;
  track.check = false;
  work_[t].slopes.clear();
}

bool Search::Jump(std::size_t t) {
  const FitTrack& track = state_.tracks[t];
  if (work_[t].nearby.empty() || !(work_[t].nearby_cost < track.cost * (1.0 - 1e-6) - 1e-12)) {
    return false;
  }
  MoveTo(t, work_[t].nearby, work_[t].nearby_cost);
  work_[t].residual = work_[t].nearby_residual;
  return true;
}

void Search::Propose(std::size_t t, std::vector<Trial>& trials,
                     std::vector<std::vector<double>>& points) {
  FitTrack& track = state_.tracks[t];
  std::vector<const std::vector<double>*> slopes;
  for (const auto& slope : work_[t].slopes) slopes.push_back(&slope);
  const Rows rows(problem_, jobs_[t].left_out);
  const System system = MakeSystem(problem_, rows, track.values, work_[t].residual, slopes);
  const Quadratic quadratic = Reduce(system);
  const Vector gradient = quadratic.gradient();
  const StepBox box = BoxOf(t, gradient);

  // Moré's rule (F.4): D_j is the largest norm of column j so far. It makes the method independent
  // of the parameters' scales.
  Vector weight(gradient.size());
  for (Eigen::Index j = 0; j < weight.size(); ++j) {
    double& kept = track.weight[static_cast<std::size_t>(j)];
    kept = std::max(kept, quadratic.R.col(j).norm());
    weight[j] = kept;
  }
  const double least = weight.maxCoeff() > 0 ? 1e-10 * weight.maxCoeff() : 1.0;
  weight = weight.cwiseMax(least);

  double cosine = 0;
  for (Eigen::Index j = 0; j < gradient.size(); ++j) {
    if (box.held[static_cast<std::size_t>(j)]) continue;
    cosine = std::max(cosine, Cosine(quadratic, gradient, system.residual.norm(), j));
  }
  ++track.iterations;
  if (cosine <= options_.gradient_tolerance) {
    if (!CheckFirst(t) && !Jump(t))
      End(t, FitEnd::kConverged, "the residuals are orthogonal to every column of the Jacobian");
    return;
  }
  double damping = options_.dampings > 1 ? 0.1 * track.damping : track.damping;
  for (int k = 0; k < std::max(options_.dampings, 1); ++k) {
    Trial trial;
    trial.track = t;
    trial.damping = std::clamp(damping, kLeastDamping, kMostDamping);
    damping *= 10.0;
    const Vector step = DampedStep(quadratic, weight, trial.damping, box);
    trial.predicted = quadratic.Reduction(step);
    trial.length = step.norm();
    std::vector<double> point = track.values;
    for (std::size_t j = 0; j < point.size(); ++j) {
      const FitParameter& p = problem_.parameters[j];
      const auto i = static_cast<Eigen::Index>(j);
      point[j] = std::clamp(point[j] + FitScale(p) * step[i], p.low, p.high);
      if (!box.held[j] && step[i] == box.low[i])
        point[j] = p.low;  // set exactly to the bound, despite rounding
      if (!box.held[j] && step[i] == box.high[i]) point[j] = p.high;
    }
    points.push_back(std::move(point));
    trials.push_back(std::move(trial));
  }
}

void Search::Choose(std::size_t t, std::span<Trial> trials,
                    std::span<const std::vector<double>> points) {
  FitTrack& track = state_.tracks[t];
  std::size_t best = 0;
  for (std::size_t k = 0; k < trials.size(); ++k) {
    if (trials[k].cost < trials[best].cost) best = k;
  }
  Trial& trial = trials[best];
  if (trial.cost < track.cost) {
    const double gained = track.cost - trial.cost;
    const double ratio = trial.predicted > 0 ? gained / trial.predicted : 1.0;
    const bool small = gained <= options_.cost_tolerance * track.cost &&
                       trial.predicted <= options_.cost_tolerance * track.cost;
    // Nielsen's rule for the damping (F.5).
    const double turned = 2.0 * ratio - 1.0;
    track.damping = trial.damping * std::max(1.0 / 3.0, 1.0 - turned * turned * turned);
    track.damping = std::clamp(track.damping, kLeastDamping, kMostDamping);
    const bool checked = track.check;
    MoveTo(t, points[best], trial.cost);
    work_[t].residual = std::move(trial.answer.value);
    const bool vanished = trial.length <= options_.step_tolerance;
    if (small && checked) End(t, FitEnd::kConverged, "the cost no longer changes");
    if (vanished && checked) End(t, FitEnd::kConverged, "the step has vanished");
    track.check = ratio < kPoorRatio || small || vanished;
    return;
  }
  // The first trial has the least damping, so it predicts the largest gain.
  const double promised = trials.front().predicted;
  const bool vanished = trials.front().length <= options_.step_tolerance;
  const bool nothing = promised <= options_.cost_tolerance * track.cost;
  if (CheckFirst(t)) return;
  if (vanished || nothing || track.damping >= kMostDamping) {
    if (Jump(t)) return;
    const bool stuck = !vanished && !nothing;
    End(t, stuck ? FitEnd::kStuck : FitEnd::kConverged,
        stuck ? "no step lowers the cost: the finite differences give no descent direction"
              : "no step lowers the cost by more than rounding errors");
    return;
  }
  ++track.rejected;
  for (std::size_t k = 0; k < trials.size(); ++k) track.damping *= 10.0;
  track.damping = std::min(kMostDamping, track.damping);
}

bool Search::Try() {
  std::vector<Trial> trials;
  std::vector<std::vector<double>> points;
  for (std::size_t t = 0; t < jobs_.size(); ++t) {
    if (Running(t)) Propose(t, trials, points);
  }
  std::vector<Residuals> answers;
  if (!Compute(points, answers)) return false;
  state_.points += static_cast<std::int64_t>(points.size());
  for (std::size_t k = 0; k < trials.size(); ++k) {
    trials[k].answer = std::move(answers[k]);
    trials[k].cost = kInfinite;
    if (trials[k].answer.failed.empty()) {
      trials[k].cost = CostAt(trials[k].track, points[k], trials[k].answer.value);
    } else {
      CountFailure(trials[k].track, trials[k].answer.failed);
    }
  }
  for (std::size_t k = 0; k < trials.size();) {
    std::size_t end = k;
    while (end < trials.size() && trials[end].track == trials[k].track) ++end;
    Choose(trials[k].track, std::span(trials).subspan(k, end - k),
           std::span<const std::vector<double>>(points).subspan(k, end - k));
    k = end;
  }
  for (std::size_t t = 0; t < jobs_.size(); ++t) {
    if (Running(t) && state_.tracks[t].iterations >= options_.most_iterations) {
      End(t, FitEnd::kIterations, "the limit of iterations was reached");
    }
  }
  return true;
}

}  // namespace taut::fit
