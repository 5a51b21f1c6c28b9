// Randomized placement of the robot on a large terrain, a new place for each episode
#include <algorithm>
#include <cmath>
#include <limits>

#include "env/env_fixture.h"
#include "math/vec.h"
#include "sim/batch/ground_height.h"
#include "taut/run.h"

namespace taut::test {
namespace {

std::shared_ptr<const Model> Compiled(const ModelDef& def) {
  Diagnostics out;
  auto model = Model::Compile(def, out);
  EXPECT_TRUE(model) << out.Format();
  return model;
}

/// A robot without ground planes
ModelDef Bare() {
  ModelDef def = LoadFrom("drop_six_strut").robot.def;
  def.planes.clear();
  return def;
}

TEST(GroundHeight, IsThatOfTheHighestPart) {
  ModelDef def = Bare();
  constexpr double kNone = -std::numeric_limits<double>::infinity();
  EXPECT_EQ(sim::GroundHeight(*Compiled(def), 1, 2), kNone);
  const double slope = 0.3, c = std::cos(slope), s = std::sin(slope);
  def.planes.push_back({"slope", {-s, 0, c}, {0, 0, 0.1}, {}});
  EXPECT_NEAR(sim::GroundHeight(*Compiled(def), 1, 2), 0.1 + std::tan(slope), 1e-15);
  // A cube of edge 2, rotated by pi/4 about y: its edge is sqrt(2) above its center.
  const double eighth = std::acos(-1) / 8;
  def.terrain_boxes.push_back(
      {"wall", {1, 2, 3}, {std::cos(eighth), 0, std::sin(eighth), 0}, {1, 1, 1}, {}});
  EXPECT_NEAR(sim::GroundHeight(*Compiled(def), 1, 2.9), 3 + std::sqrt(2), 1e-14);
  EXPECT_NEAR(sim::GroundHeight(*Compiled(def), 1.5, 2), 3 + std::sqrt(2) - 0.5, 1e-14);
  EXPECT_NEAR(sim::GroundHeight(*Compiled(def), 1, 3.1), 0.1 + std::tan(slope), 1e-14);
}

TEST(GroundHeight, OfFieldsAndMeshesIsThatOfTheirTriangles) {
  ModelDef def = Bare();
  HeightFieldDef field;
  field.name = "field", field.columns = 5, field.rows = 4, field.cell_m = 0.5;
  field.origin_m = {2, -1, 0.25};
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 5; ++i) field.height_m.push_back(0.1 * i - 0.3 * j);  // one plane
  }
  def.height_fields.push_back(field);
  const auto model = Compiled(def);
  for (const double x : {1.0, 1.13, 2.5, 2.999}) {
    for (const double y : {-1.75, -1.2, -0.31}) {
      EXPECT_NEAR(sim::GroundHeight(*model, x, y), 0.25 + 0.2 * (x - 1) - 0.6 * (y + 1.75), 1e-14);
    }
  }
  EXPECT_LT(sim::GroundHeight(*model, 3.1, -1), -1e300);
  def.terrain_meshes.push_back({.name = "roof",
                                .corners_m = {{1, -1.5, 5}, {3, -1.5, 7}, {1, 0.5, 9}},
                                .triangles = {{0, 1, 2}},
                                .solid = false,
                                .material = {}});
  const auto roofed = Compiled(def);
  EXPECT_NEAR(sim::GroundHeight(*roofed, 1.5, -1), 5 + 0.5 + 1, 1e-14);
  EXPECT_NEAR(sim::GroundHeight(*roofed, 2.9, -0.3), 0.25 + 0.2 * 1.9 - 0.6 * 1.45, 1e-14);
}

ExperimentSpec Placed(const std::string& name, double place_m) {
  ExperimentSpec experiment = LoadFrom(name, 0.1);
  EnvironmentSpec& spec = experiment.environment.emplace();
  spec.period_s = 0.02;
  spec.observations = {"body/*/position_*"};
  spec.randomise.start.place_m = place_m;
  return experiment;
}

TEST(EnvGround, OnAPlaneTheRobotIsElsewhereAndElseTheSame) {
  const ExperimentSpec experiment = Placed("drop_six_strut", 2);
  const auto env = MakeEnv(experiment, {.worlds = 40});
  const auto still = MakeEnv(experiment, {.worlds = 1, .randomise = false});
  double least[2] = {0, 0}, most[2] = {0, 0};
  for (int w = 0; w < env->worlds(); ++w) {
    const Vec3 by = env->Body(w, 0).position_m - still->Body(0, 0).position_m;
    const double moved[] = {by.x, by.y};
    for (int k = 0; k < 2; ++k) {
      EXPECT_LE(std::fabs(moved[k]), 2 + 1e-12);
      least[k] = std::min(least[k], moved[k]), most[k] = std::max(most[k], moved[k]);
    }
    for (int b = 0; b < 6; ++b) {
      const Vec3 own = env->Body(w, b).position_m - still->Body(0, b).position_m;
      EXPECT_NEAR(own.x, by.x, 1e-15);
      EXPECT_EQ(own.z, 0);
    }
  }
  for (int k = 0; k < 2; ++k) {  // 40 uniform draws miss an outer quarter once in 1e5
    EXPECT_LT(least[k], -1);
    EXPECT_GT(most[k], 1);
  }
}

TEST(EnvGround, OnHillsNoPointComesNearerToTheGroundAndOneStaysAsItIs) {
  const ExperimentSpec experiment = Placed("hills", 1);
  const auto env = MakeEnv(experiment, {.worlds = 8});
  const auto still = MakeEnv(experiment, {.worlds = 1, .randomise = false});
  const auto model = Compiled(experiment.robot.def);
  const auto height = [&](const Vec3& p) { return p.z - sim::GroundHeight(*model, p.x, p.y); };
  double highest = -1, lowest = 1;
  for (int w = 0; w < env->worlds(); ++w) {
    double least = 1;
    const Vec3 by = env->Body(w, 0).position_m - still->Body(0, 0).position_m;
    for (const CapsuleDef& rod : experiment.robot.def.capsules) {
      const Vec3 along = rod.to_m - rod.from_m;
      for (const double part : {0.0, 0.25, 0.5, 0.75, 1.0}) {
        const Vec3 p = rod.from_m + part * along;
        // The ground is sampled at distances of the rod's thickness. Between samples, hills of
        // slope 1/2 may rise by a quarter of this distance.
        const double nearer = height(p + by) - height(p);
        EXPECT_GE(nearer, -0.5 * rod.radius_m);
        least = std::min(least, nearer);
      }
    }
    EXPECT_LE(least, 0.02);  // close to the ground, within the height of the hills
    highest = std::max(highest, by.z), lowest = std::min(lowest, by.z);
    Diagnostics out;
    const auto run = RunExperiment(env->Experiment(w), {}, out);
    ASSERT_TRUE(run) << out.Format();
  }
  EXPECT_GT(highest - lowest, 0.001);
}

TEST(EnvGround, AnEpisodeIsTheRunOfItsExperimentAndTheGoalGoesAlong) {
  ExperimentSpec experiment = Placed("goal_flat", 0.5);
  experiment.environment->reward.measure = Measure::kNearer;
  const auto env = MakeEnv(experiment, {.worlds = 3, .autoreset = Autoreset::kDisabled});
  ExperimentSpec still = experiment;
  still.environment->randomise = {};
  const auto same = MakeEnv(still, {.worlds = 1, .autoreset = Autoreset::kDisabled});
  Arrays<> arrays(*env), others(*same);
  for (std::int64_t i = 0; i < env->episode_steps(); ++i) {
    arrays.Step(*env);
    others.Step(*same);
  }
  for (int w = 0; w < 3; ++w) {
    Diagnostics out;
    const auto run = RunExperiment(env->Experiment(w), {}, out);
    ASSERT_TRUE(run) << out.Format();
    EXPECT_EQ(env->Hash(w), run->state_hash);
    // the same path to the same goal, up to rounding of sums at other places
    EXPECT_NEAR(env->Episode(w).reward, same->Episode(0).reward, 1e-6);
  }
}

TEST(EnvGround, BeyondTheTerrainThereIsNoStart) {
  const ExperimentSpec experiment = Placed("hills", 400);
  Diagnostics out;
  EXPECT_FALSE(Env::Create(experiment, {.worlds = 2}, out));
  EXPECT_NE(out.Format().find("moves the robot off its terrain"), std::string::npos)
      << out.Format();
}

}  // namespace
}  // namespace taut::test
