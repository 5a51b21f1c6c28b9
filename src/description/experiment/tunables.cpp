// Tunables: numbers of controllers, gaits and models that studies may change by name.
#include <limits>

#include "description/experiment/control_keys.h"
#include "description/yaml/number_list.h"
#include "taut/study.h"

namespace taut {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

void AddGains(ControllerSpec& controller, const RobotSpec& robot, std::vector<Tunable>& out) {
  if (!controller.impedance) return;
  for (ImpedanceGains& gains : controller.impedance->cables) {
    const std::string name =
        controller.name + "." + robot.def.cables[static_cast<std::size_t>(gains.cable)].name + ".";
    description::NumberList<Tunable> list(name);
    Keys(list, gains);
    out.insert(out.end(), list.numbers.begin(), list.numbers.end());
  }
}

void AddBoards(ControllerSpec& controller, std::vector<Tunable>& out) {
  if (!controller.boards) return;
  description::NumberList<Tunable> list(controller.name + ".");
  Keys(list, *controller.boards);
  out.insert(out.end(), list.numbers.begin(), list.numbers.end());
}

void AddGait(const std::string& prefix, GaitSpec& gait, std::vector<Tunable>& out) {
  for (const GaitValue& value : GaitValues(gait)) {
    out.push_back(
        {prefix + value.name, value.unit, value.value, value.min, value.max, value.at_start});
  }
}

std::string ScaleName(const ScaleSpec& scale, const RobotSpec& robot) {
  switch (scale.quantity) {
    case ScaleSpec::Quantity::kFriction:
      return "model.friction";
    case ScaleSpec::Quantity::kMass:
      return scale.index.empty()
                 ? "model.mass"
                 : "model.mass." + robot.def.bodies[static_cast<std::size_t>(scale.index[0])].name;
    default:
      break;
  }
  const std::string name =
      scale.quantity == ScaleSpec::Quantity::kStiffness ? "model.stiffness" : "model.damping";
  return scale.index.empty()
             ? name
             : name + "." + robot.def.cables[static_cast<std::size_t>(scale.index[0])].name;
}

}  // namespace

std::vector<ScaleSpec> TunableScales(const RobotSpec& robot) {
  using Quantity = ScaleSpec::Quantity;
  std::vector<ScaleSpec> scales{{Quantity::kFriction, {}, 1.0}, {Quantity::kMass, {}, 1.0}};
  const auto each = [&](Quantity quantity, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      scales.push_back({quantity, {static_cast<int>(i)}, 1.0});
    }
  };
  each(Quantity::kMass, robot.def.bodies.size());
  scales.push_back({Quantity::kStiffness, {}, 1.0});
  each(Quantity::kStiffness, robot.def.cables.size());
  scales.push_back({Quantity::kDamping, {}, 1.0});
  each(Quantity::kDamping, robot.def.cables.size());
  return scales;
}

std::vector<Tunable> FindTunables(std::vector<ControllerSpec>& controllers,
                                  std::vector<ScaleSpec>& scales, const RobotSpec& robot) {
  std::vector<Tunable> out;
  for (ControllerSpec& controller : controllers) {
    AddGains(controller, robot, out);
    AddBoards(controller, out);
    GaitInputSpec* input = GaitInputOf(controller);
    if (!input) continue;
    AddGait(controller.name + ".", input->gait, out);
    for (GaitSpec& gait : input->others) {
      AddGait(controller.name + "." + gait.name + ".", gait, out);
    }
  }
  for (ScaleSpec& scale : scales) {
    out.push_back({ScaleName(scale, robot), "1", &scale.factor, 0.0, kInf});
  }
  return out;
}

}  // namespace taut
