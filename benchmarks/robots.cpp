#include "benchmarks/robots.h"

#include <cmath>
#include <stdexcept>

#include "scenes/many_rows.h"
#include "scenes/tetraspine3.h"
#include "taut/spec.h"

namespace taut::bench {
namespace {

constexpr int kPeriodTicks = 100;  // a second
constexpr double kPi = 3.14159265358979323846;

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

}  // namespace

ModelDef OnGround(const std::string& robot) {
  Diagnostics complaints;
  const auto spec = LoadRobot(TAUT_MODELS "/" + robot + ".yaml", {}, complaints);
  if (!spec) throw std::runtime_error(complaints.Format());
  ModelDef def = spec->def;
  def.planes = {Ground()};
  return def;
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

Motion::Motion(const ModelDef& def) {
  for (const CableDef& cable : def.cables) rest_m_.push_back(cable.rest_length_m);
  for (int i = 0; i < kPeriodTicks; ++i) {
    factor_.push_back(1 + 0.02 * std::sin(2 * kPi * i / kPeriodTicks));
  }
}

double Motion::RestLength(int world, int cable, int tick) const {
  const int at = (tick + 37 * cable + 61 * world) % kPeriodTicks;
  return rest_m_[static_cast<std::size_t>(cable)] * factor_[static_cast<std::size_t>(at)];
}

TautRunner::TautRunner(const ModelDef& def, const BatchOptions& options, int control_steps)
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
