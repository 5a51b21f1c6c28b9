#include <utility>

#include "plant/controller_kinds.h"
#include "sim/batch/check_index.h"

namespace taut {
namespace {

/// Controller of the library, with parameters from a specification instead of the worlds' variants.
class LibraryController final : public Controller {
 public:
  LibraryController(const ControlSetup& setup, ControllerSpec spec, plant::MakeController make)
      : spec_(std::move(spec)) {
    const int cables = static_cast<int>(setup.experiment.robot.def.cables.size());
    const auto check = [cables](int cable) {
      sim::CheckIndex("ControllersOf", "cable", cable, cables);
    };
    if (spec_.impedance) {
      for (const ImpedanceGains& gains : spec_.impedance->cables) check(gains.cable);
    }
    for (const PositionProgram& program : spec_.position) check(program.cable);
    std::vector<RolloutWorld> own;
    for (const RolloutWorld* lane : setup.lanes) own.push_back(Own(*lane));
    std::vector<const RolloutWorld*> lanes;
    for (const RolloutWorld& lane : own) lanes.push_back(&lane);
    controller_ = make({setup.experiment, lanes, setup.first_world, setup.worlds}, 0);
  }

  ClockSpec clock() const override { return controller_->clock(); }
  void Act(const Tick& tick, const Observation& seen, Commands& commands) override {
    controller_->Act(tick, seen, commands);
  }
  void Restart(int lane, const RolloutWorld& world) override {
    controller_->Restart(lane, Own(world));
  }
  void Serialize(plant::LaneState& state) override { controller_->Serialize(state); }
  std::optional<ImpedanceGains> Gains(int lane, int cable) const override {
    return controller_->Gains(lane, cable);
  }
  bool SetGains(int lane, const ImpedanceGains& gains) override {
    return controller_->SetGains(lane, gains);
  }
  bool Hold(int lane, int cable, double rest_length_m) override {
    return controller_->Hold(lane, cable, rest_length_m);
  }

 private:
  RolloutWorld Own(RolloutWorld world) const {
    world.controllers = {spec_};
    return world;
  }

  const ControllerSpec spec_;
  std::unique_ptr<Controller> controller_;
};

}  // namespace

std::vector<ControllerFactory> ControllersOf(const ControllerSpec& spec) {
  std::vector<plant::MakeController> kinds;
  if (GaitInputOf(spec) != nullptr) kinds.push_back(plant::MakeGait);
  kinds.push_back(spec.impedance ? plant::MakeImpedance : plant::MakePosition);
  std::vector<ControllerFactory> factories;
  for (const plant::MakeController make : kinds) {
    factories.push_back([spec, make](const ControlSetup& setup) {
      return std::make_unique<LibraryController>(setup, spec, make);
    });
  }
  return factories;
}

}  // namespace taut
