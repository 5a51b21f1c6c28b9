#include "rollout/scorer.h"

#include <cmath>
#include <limits>

#include "math/elementary.h"
#include "math/vec.h"
#include "plant/center_of_mass.h"
#include "plant/goal.h"
#include "plant/set_points.h"
#include "rollout/termination.h"

namespace taut::rollout {
namespace {

using plant::kTimeToleranceS;

constexpr double kLookPeriodS = 0.1;

std::string Seconds(double time_s) {
  const std::string text = std::to_string(time_s);
  return text.substr(0, text.find('.') + 4);
}

}  // namespace

Scorer::Scorer(const ControlSetup& setup, const ObjectiveSpec& objective, const plant::Loop& loop,
               std::unique_ptr<Score> own)
    : experiment_(setup.experiment),
      objective_(objective),
      loop_(loop),
      world_(*loop.plant().world()),
      own_(std::move(own)),
      kernel_(plant::LaneKernelOf(loop.lanes())),
      cos_max_tilt_(objective.fall ? math::Cos(objective.fall->max_tilt_rad) : -1.0) {
  const auto lanes = static_cast<std::size_t>(loop.lanes());
  const ModelDef& def = experiment_.robot.def;
  for (const CableDef& cable : def.cables) {
    motor_.push_back(cable.actuator.kind == ActuatorDef::Kind::kNone ? 0.0 : 1.0);
  }
  driven_ = plant::CablesWithSetPoints(experiment_.controllers);
  wound_j_.resize(lanes);
  max_tension_n_.resize(lanes);
  error_n2_s_.resize(lanes);
  start_m_.resize(lanes);
  fell_s_.resize(lanes);
  failed_.resize(lanes);
  states_.resize(def.bodies.size());
  const double* rest = loop.exact().cables.rest_length_m;
  rest_before_m_.assign(rest, rest + def.cables.size() * lanes);
  if (experiment_.goal) {
    for (const RolloutWorld* lane : setup.lanes) {
      goal_m_.push_back(plant::GoalOf(*experiment_.goal, lane->start_noise, lane->seed));
    }
    goal_start_m_.resize(lanes);
  }
  if (objective_.from_s <= 0) NoteStart();
  if (own_) own_->Take(loop.exact(), loop.commands(), world_, loop.step_s());
}

void Scorer::Take() {
  kernel_.measure(
      loop_.exact().cables, static_cast<int>(motor_.size()), motor_.data(),
      loop_.commands().set_point_n, driven_.data(), static_cast<int>(driven_.size()),
      loop_.step_s(),
      {rest_before_m_.data(), wound_j_.data(), max_tension_n_.data(), error_n2_s_.data()});
  if (own_) own_->Take(loop_.exact(), loop_.commands(), world_, loop_.step_s());
  const double time_s = loop_.time_s();
  if (!start_m_[0] && time_s >= objective_.from_s - kTimeToleranceS) {
    NoteStart();
  }
  if (time_s >= static_cast<double>(looks_) * kLookPeriodS - kTimeToleranceS) {
    ++looks_;
    LookAround();
  }
}

void Scorer::NoteStart() {
  for (int j = 0; j < loop_.lanes(); ++j) {
    const auto lane = static_cast<std::size_t>(j);
    start_m_[lane] = CenterOfMass(j);
    if (experiment_.goal) goal_start_m_[lane] = DistanceToGoal(j);
  }
}

void Scorer::LookAround() {
  const auto& bodies = experiment_.robot.def.bodies;
  for (int j = 0; j < loop_.lanes(); ++j) {
    const auto lane = static_cast<std::size_t>(j);
    if (!failed_[lane].empty()) continue;
    const WorldStatus status = world_.Status(j);
    if (status.bits & kStatusNonFinite) {
      failed_[lane] =
          "the state is no longer finite, first at t = " + Seconds(status.first_time_s) + " s";
      if (status.body != kWorld) {
        failed_[lane] += ", body " + bodies[static_cast<std::size_t>(status.body)].name;
      }
      continue;
    }
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      states_[b] = world_.Body(j, static_cast<int>(b));
    }
    const int fast = TooFast(states_, objective_.max_speed_m_per_s);
    if (fast != kWorld) {
      failed_[lane] = "body " + bodies[static_cast<std::size_t>(fast)].name + " is faster than " +
                      std::to_string(static_cast<int>(objective_.max_speed_m_per_s)) +
                      " m/s at t = " + Seconds(loop_.time_s()) + " s";
    }
    if (!objective_.fall || fell_s_[lane]) continue;
    const FallSpec& fall = *objective_.fall;
    const double height = fall.min_height_m || fall.max_height_m ? CenterOfMass(j).z : 0.0;
    if (AnyTilted(states_, cos_max_tilt_) || BeyondHeights(fall, height)) {
      fell_s_[lane] = loop_.time_s();
    }
  }
}

bool Scorer::AnyAlive(int count) const {
  for (int j = 0; j < count; ++j) {
    if (failed_[static_cast<std::size_t>(j)].empty()) return true;
  }
  return false;
}

Vec3 Scorer::CenterOfMass(int lane) const {
  return plant::CenterOfMass(world_, lane, experiment_.robot.def.bodies.size());
}

double Scorer::DistanceToGoal(int lane) const {
  return plant::DistanceToGoal(goal_m_[static_cast<std::size_t>(lane)],
                               world_.Body(lane, experiment_.goal->body).position_m);
}

RolloutResult Scorer::Result(int j) const {
  const auto lane = static_cast<std::size_t>(j);
  RolloutResult out;
  out.done = true;
  out.failed = failed_[lane];
  if (!out.failed.empty()) {  // the time of its end depends on other lanes, so do not report it
    out.score = std::numeric_limits<double>::quiet_NaN();
    return out;
  }
  out.state_hash = world_.Hash(j);
  out.energy_j = wound_j_[lane];
  out.max_tension_n = max_tension_n_[lane];
  out.fell_s = fell_s_[lane];
  const double time_s = loop_.time_s();
  out.tracking_n = time_s > 0 ? std::sqrt(error_n2_s_[lane] / time_s) : 0.0;
  const Vec3 way = start_m_[lane] ? CenterOfMass(j) - *start_m_[lane] : Vec3{};
  out.distance_m = DistanceOf(way);
  out.along_m = Dot(way, objective_.direction);
  switch (objective_.measure) {
    case Measure::kDistance:
      out.score = out.distance_m;
      break;
    case Measure::kHeading:
      out.score = out.along_m;
      break;
    case Measure::kDistancePerEnergy:
      out.score = out.distance_m / out.energy_j;
      break;
    case Measure::kNearer:
      out.score = start_m_[lane] ? goal_start_m_[lane] - DistanceToGoal(j) : 0.0;
      break;
    case Measure::kTracking:
      out.score = -out.tracking_n;
      break;
    case Measure::kNone:
      out.score = 0.0;
      break;
  }
  if (own_) out.score = own_->Result(j);
  if (objective_.tension_limit) {
    out.score -= TensionPenalty(*objective_.tension_limit, out.max_tension_n);
  }
  if (objective_.fall && out.fell_s) out.score -= objective_.fall->penalty;
  if (!std::isfinite(out.score)) {
    out.failed = own_ ? "the score is not a finite number" : "the objective is not a finite number";
    if (!own_ && objective_.measure == Measure::kDistancePerEnergy && out.energy_j == 0) {
      out.failed += ": the motors did no work";
    }
    out.score = std::numeric_limits<double>::quiet_NaN();
  }
  return out;
}

}  // namespace taut::rollout
