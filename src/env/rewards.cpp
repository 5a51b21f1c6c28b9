#include "env/rewards.h"

#include "math/elementary.h"
#include "math/vec.h"
#include "plant/center_of_mass.h"
#include "plant/goal.h"
#include "rollout/termination.h"

namespace taut::env {

RewardAndTermination::RewardAndTermination(const Plan& plan, const plant::Loop& loop,
                                           const LaneBodies& bodies)
    : plan_(plan),
      reward_(plan.spec.reward),
      loop_(loop),
      bodies_(bodies),
      world_(*loop.plant().world()),
      kernel_(plant::LaneKernelOf(plan.lanes)),
      measures_(reward_.tension_limit || reward_.work_penalty_per_j > 0 || plan.spec.max_tension_n),
      needs_center_(reward_.measure == Measure::kDistance || reward_.measure == Measure::kHeading ||
                    (reward_.fall && (reward_.fall->min_height_m || reward_.fall->max_height_m))),
      cos_max_tilt_(reward_.fall ? math::Cos(reward_.fall->max_tilt_rad) : -1.0),
      totals_(static_cast<std::size_t>(plan.lanes)) {
  const auto lanes = static_cast<std::size_t>(plan.lanes);
  for (const CableDef& cable : plan.experiment.robot.def.cables) {
    motor_.push_back(cable.actuator.kind == ActuatorDef::Kind::kNone ? 0.0 : 1.0);
  }
  rest_before_m_.resize(motor_.size() * lanes);
  for (std::vector<double>* row : {&wound_j_, &max_tension_n_, &unused_}) row->resize(lanes);
  mass_kg_.resize(plan.body_count() * lanes);
}

void RewardAndTermination::Begin(int lane, const RolloutWorld& world) {
  const auto j = static_cast<std::size_t>(lane), lanes = totals_.size();
  wound_j_[j] = max_tension_n_[j] = 0;
  const double* const rest_m = loop_.exact().cables.rest_length_m;
  for (std::size_t c = 0; c < motor_.size(); ++c) {
    rest_before_m_[c * lanes + j] = rest_m[c * lanes + j];
  }
  for (std::size_t b = 0; b < bodies_.count(); ++b) {
    mass_kg_[j * bodies_.count() + b] = world_.BodyMass(lane, static_cast<int>(b));
  }
  RewardTotals& own = totals_[j];
  own = {};
  if (plan_.experiment.goal) {
    own.goal_m = plant::GoalOf(*plan_.experiment.goal, world.start_noise, world.seed);
  }
  own.started = reward_.from_s <= 0;
  own.start_m = Center(j);
  if (reward_.measure == Measure::kNearer) own.start_to_goal_m = -Progress(j, own.start_m);
}

void RewardAndTermination::Serialize(plant::LaneState& state) {
  for (std::vector<double>* row : {&rest_before_m_, &wound_j_, &max_tension_n_}) state.Row(*row);
  RewardTotals& own = totals_[static_cast<std::size_t>(state.lane())];
  state.Values(own.started, own.start_m, own.goal_m, own.start_to_goal_m, own.progress_m,
               own.tension_penalty, own.work_j);
}

void RewardAndTermination::Measure() {
  kernel_.measure(loop_.exact().cables, static_cast<int>(motor_.size()), motor_.data(), nullptr,
                  nullptr, 0, loop_.step_s(),
                  {rest_before_m_.data(), wound_j_.data(), max_tension_n_.data(), unused_.data()});
}

Vec3 RewardAndTermination::Center(std::size_t lane) const {
  return plant::CenterOfMass(
      bodies_.count(), [&](std::size_t b) { return mass_kg_[lane * bodies_.count() + b]; },
      [&](std::size_t b) { return bodies_.position_m(lane, b); });
}

double RewardAndTermination::Progress(std::size_t lane, const Vec3& center_m) const {
  const RewardTotals& own = totals_[lane];
  const Vec3 way = center_m - own.start_m;
  switch (reward_.measure) {
    case Measure::kDistance:
      return rollout::DistanceOf(way);
    case Measure::kHeading:
      return Dot(way, reward_.direction);
    case Measure::kNearer: {
      const auto watched = static_cast<std::size_t>(plan_.experiment.goal->body);
      return own.start_to_goal_m -
             plant::DistanceToGoal(own.goal_m, bodies_.position_m(lane, watched));
    }
    default:
      return 0;
  }
}

EpisodeEnd RewardAndTermination::EndOf(std::size_t lane, std::int64_t number, bool good_action,
                                       const Vec3& center_m) const {
  const std::uint32_t bits = world_.Status(static_cast<int>(lane)).bits;
  if ((bits & kStatusNonFinite) != 0) return EpisodeEnd::kNotFinite;
  if ((bits & kStatusFellOff) != 0) return EpisodeEnd::kFellOff;
  const auto velocity = [&](std::size_t b) { return bodies_.velocity_m_per_s(lane, b); };
  if (rollout::TooFast(bodies_.count(), velocity, reward_.max_speed_m_per_s) != kWorld) {
    return EpisodeEnd::kTooFast;
  }
  if (plan_.spec.max_tension_n && max_tension_n_[lane] > *plan_.spec.max_tension_n) {
    return EpisodeEnd::kTooTense;
  }
  if (!good_action) return EpisodeEnd::kWrongAction;
  const auto orientation = [&](std::size_t b) { return bodies_.orientation(lane, b); };
  if (reward_.fall && (rollout::AnyTilted(bodies_.count(), orientation, cos_max_tilt_) ||
                       rollout::BeyondHeights(*reward_.fall, center_m.z))) {
    return EpisodeEnd::kFell;
  }
  return number >= plan_.episode_steps ? EpisodeEnd::kTime : EpisodeEnd::kNone;
}

RewardAndTermination::Verdict RewardAndTermination::Evaluate(int lane, std::int64_t number,
                                                             bool good_action) {
  const auto j = static_cast<std::size_t>(lane);
  const Vec3 center_m = needs_center_ ? Center(j) : Vec3{};
  Verdict verdict;
  verdict.end = EndOf(j, number, good_action, center_m);
  if (Failed(verdict.end)) {  // ignore the distance of a failed simulation
    verdict.reward = -reward_.failure_penalty;
    return verdict;
  }
  RewardTotals& own = totals_[j];
  const double time_s = static_cast<double>(number) * plan_.spec.period_s;
  if (own.started) {
    const double progress_m = Progress(j, center_m);
    verdict.reward = progress_m - own.progress_m;
    own.progress_m = progress_m;
  } else if (time_s >= reward_.from_s - plant::kTimeToleranceS) {
    own.started = true;
    own.start_m = center_m;
    own.start_to_goal_m = 0;
    if (reward_.measure == Measure::kNearer) {
      own.start_to_goal_m = -Progress(j, center_m);
    }
  }
  if (reward_.tension_limit) {
    const double penalty = rollout::TensionPenalty(*reward_.tension_limit, max_tension_n_[j]);
    verdict.reward -= penalty - own.tension_penalty;
    own.tension_penalty = penalty;
  }
  if (reward_.work_penalty_per_j > 0) {
    verdict.reward -= reward_.work_penalty_per_j * (wound_j_[j] - own.work_j);
    own.work_j = wound_j_[j];
  }
  verdict.reward += reward_.alive_per_s * plan_.spec.period_s;
  if (verdict.end == EpisodeEnd::kFell) verdict.reward -= reward_.fall->penalty;
  return verdict;
}

}  // namespace taut::env
