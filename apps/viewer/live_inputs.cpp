#include "live_inputs.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "taut/run.h"
#include "taut/start.h"

namespace taut::viewer {
namespace {

std::optional<ExperimentSpec> ModelAlone(const std::string& path, const Overrides& overrides,
                                         bool settled, Diagnostics& out) {
  auto robot = LoadRobot(path, overrides, out);
  if (!robot) return std::nullopt;
  ExperimentSpec experiment;
  experiment.robot = std::move(*robot);
  experiment.robot.parameters.clear();  // a change of parameters requires reading the file again
  experiment.robot.def.gravity_m_per_s2 = {};
  experiment.name = experiment.robot.def.name;
  experiment.files = experiment.robot.files;
  if (settled) experiment.start = StartKind::kSettledFloating;
  return experiment;
}

/// Lowest and highest point of the robot [m].
struct Heights {
  double low = 0, high = 0;
};

Heights HeightsOf(const ModelDef& def) {
  Heights found{1e300, -1e300};
  const auto add = [&](double z, double radius_m) {
    found.low = std::min(found.low, z - radius_m);
    found.high = std::max(found.high, z + radius_m);
  };
  for (const NodeDef& node : def.nodes) add(node.position_m.z, 0);
  for (const SphereDef& sphere : def.spheres) add(sphere.center_m.z, sphere.radius_m);
  for (const CapsuleDef& rod : def.capsules) {
    add(rod.from_m.z, rod.radius_m), add(rod.to_m.z, rod.radius_m);
  }
  for (const BoxDef& box : def.boxes) {
    const Vec3& half = box.half_extents_m;
    add(box.center_m.z, std::hypot(half.x, half.y, half.z));
  }
  for (const HullDef& hull : def.hulls) {
    for (const Vec3& corner : hull.corners_m) add(corner.z, 0);
  }
  return found.low > found.high ? Heights{} : found;
}

bool HasGround(const ModelDef& def) {
  return !def.planes.empty() || !def.terrain_boxes.empty() || !def.height_fields.empty() ||
         !def.terrain_meshes.empty();
}

}  // namespace

ModelStart StartOfName(const std::string& name) {
  if (name == "dropped") return ModelStart::kDropped;
  return name == "settled" ? ModelStart::kSettled : ModelStart::kDescribed;
}

ExperimentSpec StartModel(const ExperimentSpec& alone, ModelStart start) {
  if (start == ModelStart::kDescribed) return alone;
  ExperimentSpec experiment = alone;
  ModelDef& def = experiment.robot.def;
  def.gravity_m_per_s2 = ModelDef().gravity_m_per_s2;
  experiment.start = start == ModelStart::kSettled ? StartKind::kSettled : StartKind::kAsDescribed;
  if (HasGround(def)) return experiment;
  const Heights robot = HeightsOf(def);
  const double fall_m = start == ModelStart::kDropped ? 0.5 * (robot.high - robot.low) : 0;
  PlaneDef ground;
  ground.name = "ground";
  ground.point_m = {0, 0, robot.low - fall_m};
  def.planes.push_back(std::move(ground));
  return experiment;
}

std::optional<LiveInputs> LoadLiveInputs(const std::string& path, const Overrides& overrides,
                                         bool settled, Diagnostics& out) {
  const auto kind = FileKind(path, out);
  if (!kind) return std::nullopt;
  const bool model = *kind == "model";
  std::optional<ExperimentSpec> experiment =
      model ? ModelAlone(path, overrides, settled, out) : LoadExperiment(path, overrides, out);
  if (!experiment || !CheckStart(experiment->robot, experiment->start, out) ||
      !CheckRecord(*experiment, out)) {
    return std::nullopt;
  }
  WarnOfStep(*experiment, out);
  if (settled && !model) experiment->start = StartKind::kSettled;
  return LiveInputs{std::move(*experiment), model};
}

}  // namespace taut::viewer
