#include <algorithm>
#include <cstdint>

#include "plant/controller_kinds.h"
#include "taut/control/position.h"
#include "taut/lane_state.h"

namespace taut::plant {
namespace {

/// Position control: rest lengths follow a program in time, a gait's signal, or the sum of both.
class PositionController final : public Controller {
 public:
  PositionController(const ControlSetup& setup, std::size_t index, const std::vector<int>& of_gait)
      : index_(index), clock_(setup.lanes[0]->controllers[index].clock) {
    for (const PositionProgram& program : setup.lanes[0]->controllers[index].position) {
      cables_.push_back(program.cable);
    }
    for (const int cable : of_gait) {
      if (std::find(cables_.begin(), cables_.end(), cable) == cables_.end()) {
        cables_.push_back(cable);
      }
    }
    moved_ = !of_gait.empty();
    lanes_.resize(setup.lanes.size());
    for (std::size_t j = 0; j < lanes_.size(); ++j) {
      Restart(static_cast<int>(j), *setup.lanes[j]);
    }
  }

  ClockSpec clock() const override { return clock_; }

  void Restart(int lane, const RolloutWorld& world) override {
    Lane& own = lanes_[static_cast<std::size_t>(lane)];
    own.programs.clear();
    own.start_m.assign(cables_.size(), 0.0);
    own.held_m.assign(cables_.size(), 0.0);
    own.is_held.assign(cables_.size(), 0);
    for (const PositionProgram& program : world.controllers[index_].position) {
      std::vector<control::ProgramPoint<double>> points;
      for (const auto& [time_s, length_m] : program.rest_length_m) {
        points.push_back({time_s, length_m});
      }
      own.programs.push_back(std::move(points));
    }
  }

  void Act(const Tick& tick, const Observation& seen, Commands& commands) override {
    for (std::size_t j = 0; j < lanes_.size(); ++j) {
      if (Has(tick.due, static_cast<int>(j))) ActIn(j, tick.number[j] == 0, seen, commands);
    }
  }

  void Serialize(LaneState& state) override {
    Lane& own = lanes_[static_cast<std::size_t>(state.lane())];
    for (std::vector<double>* row : {&own.start_m, &own.held_m}) {
      for (double& length_m : *row) state.Value(length_m);
    }
    for (std::uint8_t& held : own.is_held) state.Value(held);
  }

  bool Hold(int lane, int cable, double rest_length_m) override {
    Lane& own = lanes_[static_cast<std::size_t>(lane)];
    const auto found = std::find(cables_.begin(), cables_.end(), cable);
    if (found == cables_.end()) return false;
    const auto i = static_cast<std::size_t>(found - cables_.begin());
    own.held_m[i] = rest_length_m;
    own.is_held[i] = 1;
    return true;
  }

 private:
  struct Lane {
    /// Programs of the first cables in `cables_`.
    std::vector<std::vector<control::ProgramPoint<double>>> programs;
    std::vector<double> start_m;  ///< Rest lengths of all other cables at their first tick.
    std::vector<double> held_m;   ///< Set by `Hold`; overrides the program.
    std::vector<std::uint8_t> is_held;
  };

  void ActIn(std::size_t j, bool first, const Observation& seen, Commands& commands) {
    Lane& own = lanes_[j];
    for (std::size_t i = 0; i < cables_.size(); ++i) {
      const std::size_t at = static_cast<std::size_t>(cables_[i]) * lanes_.size() + j;
      double length_m = own.start_m[i];
      if (i < own.programs.size()) {
        const auto& points = own.programs[i];
        length_m = control::RestLengthAt(points.data(), points.size(), seen.time_s[j]);
      } else if (first) {
        length_m = own.start_m[i] = commands.rest_length_m[at];
      }
      if (own.is_held[i] != 0) length_m = own.held_m[i];
      if (moved_) length_m = control::Max(length_m + commands.signal[at], 0.0);
      commands.rest_length_m[at] = length_m;
    }
  }

  std::size_t index_;
  ClockSpec clock_;
  /// First the cables with a program, then cables that only a gait drives.
  std::vector<int> cables_;
  bool moved_ = false;  ///< Whether a gait drives the cables.
  std::vector<Lane> lanes_;
};

}  // namespace

std::unique_ptr<Controller> MakePosition(const ControlSetup& setup, std::size_t index) {
  const ControllerSpec& spec = setup.lanes[0]->controllers[index];
  if (spec.impedance || (spec.position.empty() && !spec.rest_length_input)) return nullptr;
  std::vector<int> of_gait;
  if (spec.rest_length_input) {
    Diagnostics heard_before;
    auto gait = ResolveGait(spec.rest_length_input->gait, setup.experiment.robot, heard_before);
    if (gait) of_gait = std::move(gait->cables);
  }
  return std::make_unique<PositionController>(setup, index, of_gait);
}

}  // namespace taut::plant
