// Default experiment and load case for a model file without an experiment.
#include "taut/minimal_experiment.h"

#include <utility>

#include "base/fixed.h"

namespace taut {

bool IsHeld(const ModelDef& def) {
  if (!def.planes.empty()) return true;
  const auto fixed = [&](int body) { return base::IsFixed(def, body); };
  for (const JointDef& joint : def.joints) {
    if (fixed(joint.body_a) || fixed(joint.body_b)) return true;
  }
  for (const CableDef& cable : def.cables) {
    for (const AttachmentDef& at : cable.attachments) {
      if (fixed(at.body)) return true;
    }
  }
  return false;
}

LoadCaseSpec OwnWeight(const ModelDef& def) {
  LoadCaseSpec own;
  own.weight = IsHeld(def);
  own.name = own.weight ? "own_weight" : "unloaded";
  return own;
}

ExperimentSpec MinimalExperiment(RobotSpec robot, StartKind start) {
  ExperimentSpec experiment;
  experiment.robot = std::move(robot);
  experiment.name = experiment.robot.def.name;
  experiment.files = experiment.robot.files;
  experiment.start = start;
  return experiment;
}

}  // namespace taut
