/// One tick: what is sensed, what controllers make of it, the steps up to the next. The laws are
/// those of include/taut/control/, in the numbers of the world.
#pragma once

#include <string>
#include <vector>

#include "linear/world.h"
#include "taut/control/impedance_tick.h"
#include "taut/spec.h"

namespace taut::linear {

/// A cable that an impedance law drives.
struct DrivenCable {
  int cable = 0;
  control::ImpedanceLaw law;
  ImpedanceGains gains;
  std::string controller;
};

/// What controllers remember, per driven cable.
template <class Num>
using TickMemory = std::vector<control::ImpedanceMemory<Num>>;

/// Commands and their changes.
template <class Num>
struct TickInputs {
  std::vector<Num> target;          ///< Per cable: added to the rest length commanded.
  std::vector<Num> velocity_input;  ///< Per driven cable: added to V0.
};

template <class Num>
class Tick {
 public:
  Tick(std::vector<DrivenCable> driven, std::vector<double> step_s)
      : driven_(std::move(driven)), step_s_(std::move(step_s)) {}

  const std::vector<DrivenCable>& driven() const noexcept { return driven_; }
  const std::vector<double>& step_s() const noexcept { return step_s_; }

  /// What controllers remember at an equilibrium; the world has been sensed.
  TickMemory<Num> MemoryAtRest(const World<Num>& world) const;
  TickInputs<Num> NoInputs(const World<Num>& world) const;

  /// The world has been sensed.
  void Run(World<Num>& world, TickMemory<Num>& memory, const TickInputs<Num>& inputs) const;

 private:
  static CableReadings<Num> Read(const World<Num>& world, int cable);
  std::vector<DrivenCable> driven_;
  std::vector<double> step_s_;  ///< Of a tick's steps.
};

extern template class Tick<Plain>;
extern template class Tick<Dual>;

}  // namespace taut::linear
