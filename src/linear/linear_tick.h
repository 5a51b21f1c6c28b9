/// One tick of the controllers: sensing, control laws, and simulation steps up to the next tick.
/// The laws are templates of include/taut/control/, instantiated for the world's number type.
#pragma once

#include <string>
#include <vector>

#include "linear/linear_world.h"
#include "taut/control/impedance_tick.h"
#include "taut/spec.h"

namespace taut::linear {

/// Cable under impedance control.
struct DrivenCable {
  int cable = 0;
  control::ImpedanceLaw law;
  ImpedanceGains gains;
  std::string controller;
};

/// Internal state of the controllers, per driven cable.
template <class Num>
using TickMemory = std::vector<control::ImpedanceMemory<Num>>;

/// Inputs of the linear system: changes of the commands.
template <class Num>
struct TickInputs {
  std::vector<Num> target;          ///< Per cable: change of the commanded rest length.
  std::vector<Num> velocity_input;  ///< Per driven cable: change of the velocity offset V0.
};

template <class Num>
class Tick {
 public:
  Tick(std::vector<DrivenCable> driven, std::vector<double> step_s)
      : driven_(std::move(driven)), step_s_(std::move(step_s)) {}

  const std::vector<DrivenCable>& driven() const noexcept { return driven_; }
  const std::vector<double>& step_s() const noexcept { return step_s_; }

  /// Returns the internal state of the controllers in equilibrium. Call after `Sense`.
  TickMemory<Num> MemoryAtRest(const World<Num>& world) const;
  TickInputs<Num> NoInputs(const World<Num>& world) const;

  /// Performs a tick. Call after `Sense`.
  void Run(World<Num>& world, TickMemory<Num>& memory, const TickInputs<Num>& inputs) const;

 private:
  static CableReadings<Num> Read(const World<Num>& world, int cable);
  std::vector<DrivenCable> driven_;
  std::vector<double> step_s_;  ///< Lengths of the steps in one tick.
};

extern template class Tick<Plain>;
extern template class Tick<Dual>;

}  // namespace taut::linear
