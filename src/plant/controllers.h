/// The controllers of an experiment at work: each on its own clock, observation in, command out.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "plant/gait_player.h"
#include "plant/impedance_step.h"
#include "taut/batch.h"
#include "taut/control/clock.h"
#include "taut/control/position.h"
#include "taut/spec.h"

namespace taut::plant {

/// What controllers tell the robot, per cable.
struct CableCommands {
  std::vector<double> target_m;     ///< Rest lengths.
  std::vector<double> set_point_n;  ///< Under impedance control; else 0, and not recorded.
  std::vector<double> velocity_input_m_per_s;  ///< V0 of the impedance law, gait included.
};

/// Of a controller with impedance control.
ImpedanceLaw LawOf(const ImpedanceSpec& spec, const ClockSpec& clock);

/// One controller with its clock and memory.
class Controller {
 public:
  /// The robot is where the gait's cables are; the gait fits it (LoadExperiment sees to that).
  Controller(const ControllerSpec& spec, const RobotSpec& robot);

  /// Of its own clock or of its gait's, whichever is next.
  double next_tick_s() const noexcept;

  /// The gains of a cable, to be changed while it runs; nothing if it does not drive the cable so.
  ImpedanceGains* FindGains(int cable) noexcept;
  const ImpedanceGains* FindGains(int cable) const noexcept;
  /// Holds a cable at a rest length from the next tick on, whatever its program said. False if it
  /// does not drive the cable by a program.
  bool Hold(int cable, double rest_length_m);
  bool HasProgram(int cable) const noexcept;

  /// Acts if a tick is due at `time_s`, the gait before the law that it feeds. Reads
  /// `readings[cable]`, writes the commands of its cables.
  void Act(double time_s, const std::vector<CableState>& readings, CableCommands& commands);

 private:
  void ActGait(double time_s, const std::vector<CableState>& readings);
  void ActImpedance(std::size_t i, const CableState& reading, CableCommands& commands);

  ControllerSpec spec_;
  control::Clock<double> clock_;
  std::int64_t tick_ = 0;
  ImpedanceLaw law_;
  std::vector<ImpedanceMemory<double>> memory_;  ///< Per cable under impedance control.
  std::vector<std::vector<control::ProgramPoint<double>>> programs_;
  std::optional<GaitPlayer> gait_;
  std::vector<std::size_t> gait_to_gains_;     ///< Per output of the gait: the cable's gains.
  std::vector<double> gait_velocity_m_per_s_;  ///< Per cable of the impedance control.
};

}  // namespace taut::plant
