#include "plant/start.h"

#include "taut/run.h"

namespace taut::plant {

bool PrepareStart(const ExperimentSpec& experiment, Batch& batch, Diagnostics& out) {
  if (experiment.start == StartKind::kAsDescribed) return true;
  const std::string hint = "a mechanism or a slope may have no equilibrium; try as_described";
  if (experiment.start == StartKind::kSettled) {
    if (Settle(batch, kTheWorld, experiment.step_s)) return true;
    out.Error({}, "the robot does not settle to an equilibrium on its ground", hint);
    return false;
  }
  ModelDef floating = experiment.robot.def;
  floating.gravity_m_per_s2 = {};
  floating.planes.clear();
  floating.terrain_boxes.clear();
  const auto model = Model::Compile(floating, out);
  if (!model) return false;
  Batch alone(model, {});
  if (!Settle(alone, kTheWorld, experiment.step_s)) {
    out.Error({}, "the robot does not settle to an equilibrium of its cables", hint);
    return false;
  }
  for (std::size_t b = 0; b < floating.bodies.size(); ++b) {
    batch.SetBodyState(kTheWorld, static_cast<int>(b), alone.Body(kTheWorld, static_cast<int>(b)));
  }
  return true;
}

}  // namespace taut::plant
