/// Robots at rest as test cases of the linear system.
#pragma once

#include "taut/state_space.h"
#include "tests/physics/standing.h"
#include "tests/scenes/prism3.h"

namespace taut::test {

/// Returns the model as an experiment that starts settled; unnamed elements get names.
inline ExperimentSpec ExperimentOf(ModelDef def) {
  ExperimentSpec e;
  const auto name = [](auto& list, const char* kind) {
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (list[i].name.empty()) list[i].name = kind + std::to_string(i + 1);
    }
  };
  name(def.bodies, "body_"), name(def.cables, "cable_"), name(def.nodes, "node_");
  e.name = "linear";
  e.robot.def = std::move(def);
  e.step_s = 0.001;
  e.duration_s = 1.0;
  e.start = StartKind::kSettled;
  return e;
}

/// Returns the experiment with impedance control of all cables that keeps its rest.
inline ExperimentSpec UnderImpedance(ExperimentSpec e, double position_gain, double velocity_gain) {
  for (CableDef& cable : e.robot.def.cables) {
    if (cable.actuator.kind == ActuatorDef::Kind::kNone) {
      cable.actuator.kind = ActuatorDef::Kind::kIdeal;
    }
  }
  Diagnostics out;
  const auto rest = FindSettledStart(e, out);
  const auto model = Model::Compile(e.robot.def, out);
  WorldBatch batch(model, {});
  for (std::size_t b = 0; b < rest->pose.bodies.size(); ++b) {
    batch.SetBodyState(0, static_cast<int>(b), rest->pose.bodies[b]);
  }
  ControllerSpec controller;
  controller.name = "impedance";
  controller.clock.period_s = 0.001;
  controller.impedance.emplace();
  for (std::size_t c = 0; c < e.robot.def.cables.size(); ++c) {
    batch.SetRestLength(0, static_cast<int>(c), rest->pose.rest_lengths_m[c]);
    const CableState cable = batch.Cable(0, static_cast<int>(c));
    ImpedanceGains gains;
    gains.cable = static_cast<int>(c);
    gains.tension_offset_n = cable.elastic_n;
    gains.length_offset_m = cable.length_m;
    gains.position_gain_n_per_m = position_gain;
    gains.velocity_gain_n_s_per_m = velocity_gain;
    controller.impedance->cables.push_back(gains);
  }
  e.controllers.push_back(controller);
  return e;
}

}  // namespace taut::test
