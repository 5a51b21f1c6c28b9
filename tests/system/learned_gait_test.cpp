// Shipped learned gaits: minimum travel
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "taut/rollout.h"

namespace taut {
namespace {

/// Returns the least distance in 20 s over worlds with varied friction, mass and stiffness.
double LeastDistance(const std::string& name) {
  Diagnostics out;
  auto experiment = LoadExperiment(
      std::string(TAUT_SOURCE_DIR) + "/share/experiments/" + name + ".yaml", {}, out);
  if (!experiment) throw std::runtime_error(out.Format());
  experiment->duration_s = 20;
  std::vector<RolloutWorld> worlds(8, WorldOf(*experiment));
  using Quantity = ScaleSpec::Quantity;
  std::size_t i = 0;
  for (const Quantity quantity : {Quantity::kFriction, Quantity::kMass, Quantity::kStiffness}) {
    for (const double factor : {0.9, 1.1}) worlds[++i].scales.push_back({quantity, {}, factor});
  }
  double least = 1e9;
  for (const RolloutResult& r : Rollouts::Create(*experiment, {}, {}, out)->Run(worlds)) {
    EXPECT_EQ(r.failed, "");
    least = std::min(least, r.distance_m);
  }
  return least;
}

// NTRT's learned gait travels 0.20 m in 20 s on three segments.
TEST(LearnedGait, ThreeSegmentsTravelThreeTimesAsFarAsNtrts) {
  EXPECT_GT(LeastDistance("sidewinder3"), 0.5);
}

TEST(LearnedGait, TwelveSegmentsTravelMoreThanAMetre) {
  EXPECT_GT(LeastDistance("sidewinder12"), 1.0);
}

// The study's target was 5 m in 60 s; docs/validation/rolling.md counts the turns.
TEST(LearnedGait, ASixStrutRobotRollsFiveMetres) {
  EXPECT_GT(LeastDistance("roll_six_strut"), 5.0);
}

/// Least distance of the robot's center of mass from the goal during a run
class Nearest final : public Score {
 public:
  explicit Nearest(const ControlSetup& setup)
      : goal_m_(setup.experiment.goal->at_m),
        bodies_(setup.experiment.robot.def.bodies.size()),
        least_m_(setup.lanes.size(), 1e9) {}
  void Take(const Observation&, const Commands&, const World& world, const double*) override {
    for (std::size_t j = 0; j < least_m_.size(); ++j) {
      double x = 0, y = 0;  // all bodies have the same mass
      for (std::size_t b = 0; b < bodies_; ++b) {
        const Vec3 at = world.Body(static_cast<int>(j), static_cast<int>(b)).position_m;
        x += at.x / static_cast<double>(bodies_), y += at.y / static_cast<double>(bodies_);
      }
      least_m_[j] = std::min(least_m_[j], std::hypot(x - goal_m_.x, y - goal_m_.y));
    }
  }
  double Result(int lane) const override { return -least_m_[static_cast<std::size_t>(lane)]; }

 private:
  Vec3 goal_m_;
  std::size_t bodies_;
  std::vector<double> least_m_;
};

/// Returns the number of eight random start poses from which the robot comes within 0.5 m of the
/// goal in 30 s.
int Arrivals(const std::string& name) {
  Diagnostics out;
  auto experiment = LoadExperiment(
      std::string(TAUT_SOURCE_DIR) + "/share/experiments/" + name + ".yaml", {}, out);
  if (!experiment) throw std::runtime_error(out.Format());
  experiment->duration_s = 30;
  std::vector<RolloutWorld> worlds(8, WorldOf(*experiment));
  for (std::size_t i = 0; i < worlds.size(); ++i) worlds[i].seed = 1000 + i;
  RolloutOptions options;
  options.score = [](const ControlSetup& setup) { return std::make_unique<Nearest>(setup); };
  int arrived = 0;
  for (const RolloutResult& r : Rollouts::Create(*experiment, {}, options, out)->Run(worlds)) {
    EXPECT_EQ(r.failed, "");
    arrived += -r.score <= 0.5;
  }
  return arrived;
}

// docs/validation/roll_to_goal.md: nearly all of fifty arrive on each terrain.
TEST(LearnedGait, ASixStrutRobotRollsToAGoal) {
  EXPECT_GE(Arrivals("roll_to_goal"), 7);
  EXPECT_GE(Arrivals("roll_to_goal_hills"), 7);
}

}  // namespace
}  // namespace taut
