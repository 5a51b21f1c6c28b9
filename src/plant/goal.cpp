#include "plant/goal.h"

#include <cmath>

#include "math/elementary.h"
#include "math/random.h"
#include "math/vec.h"
#include "plant/random_streams.h"

namespace taut::plant {
namespace {

struct Horizontal {
  double x = 0, y = 0;
};

/// Returns the unit vector of (x, y); (0, 0) if its length is almost 0.
Horizontal Direction(double x, double y) {
  const double length = std::sqrt(x * x + y * y);
  return length > 1e-9 ? Horizontal{x / length, y / length} : Horizontal{};
}

}  // namespace

Vec3 PlaceOf(const StartNoise& noise, std::uint64_t seed) {
  if (!(noise.place_m > 0)) return {};
  math::Random random(seed, kStartPlace, 0);
  const double x_m = random.Uniform(-noise.place_m, noise.place_m);
  return {x_m, random.Uniform(-noise.place_m, noise.place_m), 0};
}

Vec3 GoalOf(const GoalSpec& goal, const StartNoise& noise, std::uint64_t seed) {
  const Vec3 moved = PlaceOf(noise, seed);
  if (!(noise.goal_rad > 0)) return goal.at_m + moved;
  math::Random random(seed, kGoal, 0);
  const double turn_rad = random.Uniform(-noise.goal_rad, noise.goal_rad);
  const double c = math::Cos(turn_rad), s = math::Sin(turn_rad);
  const Vec3 turned{c * goal.at_m.x - s * goal.at_m.y, s * goal.at_m.x + c * goal.at_m.y,
                    goal.at_m.z};
  return turned + moved;
}

double DistanceToGoal(const Vec3& goal_m, const Vec3& body_m) {
  const double x = goal_m.x - body_m.x, y = goal_m.y - body_m.y;
  return std::sqrt(x * x + y * y);
}

GoalSensor::GoalSensor(const ControlSetup& setup) : goal_(*setup.experiment.goal) {
  for (const RolloutWorld* lane : setup.lanes) {
    at_m_.push_back(GoalOf(goal_, lane->start_noise, lane->seed));
  }
  rows_.resize(2 * at_m_.size());
}

void GoalSensor::Restart(int lane, const RolloutWorld& world) {
  at_m_[static_cast<std::size_t>(lane)] = GoalOf(goal_, world.start_noise, world.seed);
}

/// Samples the direction of the goal (docs/theory/sensors.md, S.8 and S.9).
void GoalSensor::Sample(const Tick& tick, const Observation& exact) {
  shown_ = exact;
  if (exact.goal != nullptr) return;
  shown_.goal = rows_.data();
  const std::size_t lanes = at_m_.size();
  for (std::size_t j = 0; j < lanes; ++j) {
    if (!Has(tick.due, static_cast<int>(j)) || exact.bodies == nullptr) continue;
    const BodyState body = exact.bodies->Body(static_cast<int>(j), goal_.body);
    const Horizontal there =
        Direction(at_m_[j].x - body.position_m.x, at_m_[j].y - body.position_m.y);
    Horizontal ahead{1, 0};
    if (goal_.frame == GoalFrame::kOfBody) {
      const Vec3 looks = Rotate(body.orientation, goal_.ahead);
      ahead = Direction(looks.x, looks.y);
    }
    rows_[j] = ahead.x * there.x + ahead.y * there.y;
    rows_[lanes + j] = ahead.x * there.y - ahead.y * there.x;
  }
}

}  // namespace taut::plant
