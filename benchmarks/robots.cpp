#include "benchmarks/robots.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "taut/spec.h"
#include "tests/scenes/ball.h"
#include "tests/scenes/many_rows.h"
#include "tests/scenes/rod_chain.h"
#include "tests/scenes/rough_ground.h"
#include "tests/scenes/six_strut.h"
#include "tests/scenes/tetraspine3.h"

namespace taut::bench {
namespace {

constexpr int kPeriodTicks = 100;  // one second

PlaneDef Ground() {
  PlaneDef ground;
  ground.name = "ground";
  ground.material = {0.5, 0.5, 0.0};
  return ground;
}

std::shared_ptr<const Model> Compiled(const ModelDef& def) {
  Diagnostics complaints;
  auto model = Model::Compile(def, complaints);
  if (model == nullptr) throw std::runtime_error(complaints.Format());
  return model;
}

ModelDef Loaded(const std::string& robot) {
  Diagnostics complaints;
  const auto spec = LoadRobot(TAUT_MODELS "/" + robot + ".yaml", {}, complaints);
  if (!spec) throw std::runtime_error(complaints.Format());
  return spec->def;
}

/// Returns a small robot whose cables are too stiff for explicit forces at 1 ms.
ModelDef StiffSixStrut() {
  scenes::SixStrut robot;
  robot.length_m = 0.4;
  robot.rod_mass_kg = 0.05;
  robot.rod_radius_m = 0.005;
  robot.damping_n_s_per_m = 3;
  robot.center_m.z = 0.22;
  robot.orientation = scenes::Turn({0.6, 0.0, 0.8}, 0.3);
  return robot.Def();
}

}  // namespace

ModelDef OnGround(const std::string& robot) {
  ModelDef def = Loaded(robot);
  def.planes = {Ground()};
  return def;
}

ModelDef OnHills(const std::string& robot, int corners) {
  ModelDef def = robot == "six_strut_stiff" ? StiffSixStrut() : Loaded(robot);
  constexpr double kBelow_m = 0.03;
  if (corners > 0) {
    def.height_fields = {scenes::Hills(corners, corners, Ground().material)};
    // The only division that all engines support.
    def.height_fields[0].split = HeightFieldDef::Split::kSame;
    def.height_fields[0].origin_m.z = -kBelow_m;
  } else {
    def.planes = {Ground()};
    def.planes[0].point_m.z = -kBelow_m;
  }
  return def;
}

ModelDef BallOnTriangles() {
  constexpr double kRadius_m = 0.05;
  const Material material = Ground().material;
  ModelDef def;
  def.name = "ball";
  scenes::AddBall(def, "ball", 0.3, kRadius_m, {-5.5, 0.013, kRadius_m}, material);
  def.bodies[0].velocity_m_per_s = {1, 0, 0};
  def.bodies[0].angular_velocity_rad_per_s = {0, 1 / kRadius_m, 0};
  def.height_fields = {scenes::Field(300, 40, 0.04, material, [](double, double) { return 0.0; })};
  def.height_fields[0].split = HeightFieldDef::Split::kSame;
  return def;
}

void SpreadOut(WorldBatch& batch) {
  for (int world = 0; world < batch.worlds(); ++world) {
    for (int body = 0; body < static_cast<int>(batch.model().def().bodies.size()); ++body) {
      BodyState state = batch.Body(world, body);
      state.position_m.x += 0.13 * world;
      state.position_m.y += 0.07 * world;
      batch.SetBodyState(world, body, state);
    }
  }
}

ModelDef Spine(int segments) {
  scenes::Tetraspine spine;
  spine.segments = segments;
  return spine.Def();
}

ModelDef Footed(int contacts) {
  scenes::FootedDisc disc;
  disc.feet = contacts;
  return disc.Def();
}

ModelDef SwingingChain(int rods, double friction_n_m) {
  constexpr double kFromThePlumb_rad = 0.5;
  ModelDef def = scenes::RodChain(
      rods, {0.1 * std::sin(kFromThePlumb_rad), 0, -0.1 * std::cos(kFromThePlumb_rad)}, 1.0);
  for (JointDef& joint : def.joints) joint.friction = friction_n_m;
  return def;
}

Motion::Motion(const ModelDef& def) {
  for (const CableDef& cable : def.cables) rest_m_.push_back(cable.rest_length_m);
  for (int i = 0; i < kPeriodTicks; ++i) {
    factor_.push_back(1 + 0.02 * std::sin(2 * std::numbers::pi * i / kPeriodTicks));
  }
}

double Motion::RestLength(int world, int cable, int tick) const {
  const int at = (tick + 37 * cable + 61 * world) % kPeriodTicks;
  return rest_m_[static_cast<std::size_t>(cable)] * factor_[static_cast<std::size_t>(at)];
}

TautRunner::TautRunner(const ModelDef& def, const WorldBatchOptions& options, int control_steps)
    : motion_(def), batch_(Compiled(def), options), control_steps_(control_steps) {}

void TautRunner::Run(int control_periods) {
  for (int i = 0; i < control_periods; ++i, ++tick_) {
    targets_m_.clear();
    for (int w = 0; w < batch_.worlds(); ++w) {
      for (int c = 0; c < motion_.cables(); ++c) {
        targets_m_.push_back(motion_.RestLength(w, c, tick_));
      }
    }
    batch_.Step(kStepS, control_steps_, targets_m_);
    linear_solves_ += batch_.Status(0).linear_solves;
  }
  for (int w = 0; w < batch_.worlds(); ++w) {
    const std::uint32_t bits = batch_.Status(w).bits;
    if ((bits & ~kStatusNotConverged) != 0) {
      throw std::runtime_error("world " + std::to_string(w) + " has status " +
                               std::to_string(bits));
    }
    if (bits != kStatusOk) converged_ = false;
  }
}

double Deepest(const ModelDef& def, const Runner& runner) {
  WorldBatch geometry(Compiled(def), {});
  for (int body = 0; body < static_cast<int>(def.bodies.size()); ++body) {
    geometry.SetBodyState(0, body, runner.Body(body));
  }
  double deepest_m = 0;
  for (const Overlap& overlap : geometry.Overlaps(0)) {
    if (overlap.body_b == kWorld) deepest_m = std::max(deepest_m, overlap.depth_m);
  }
  return deepest_m;
}

PeerRunner::PeerRunner(peers::Engine engine, const ModelDef& def, const peers::Options& options)
    : motion_(def), world_(peers::MakeWorld(engine, def, options)) {}

void PeerRunner::Run(int control_periods) {
  for (int i = 0; i < control_periods; ++i, ++tick_) {
    for (int c = 0; c < motion_.cables(); ++c) {
      world_->SetRestLength(c, motion_.RestLength(0, c, tick_));
    }
    world_->Step(kStepS, kControlSteps);
  }
}

}  // namespace taut::bench
