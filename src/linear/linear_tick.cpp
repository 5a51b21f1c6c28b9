#include "linear/linear_tick.h"

namespace taut::linear {
namespace {

constexpr double kSlackHairM = 1e-12;

}  // namespace

template <class Num>
CableReadings<Num> Tick<Num>::Read(const World<Num>& world, int cable) {
  const sim::Layout& l = world.layout();
  CableReadings<Num> read;
  read.rest_length_m = world.Get(l.rest + cable);
  read.length_m = world.Get(l.sense_length + cable);
  read.rate_m_per_s = world.Get(l.sense_rate + cable);
  read.tension_n = world.Get(l.sense_tension + cable);
  read.elastic_n = world.Get(l.sense_elastic + cable);
  read.stiffness_n_per_m = world.Get(l.stiffness + cable);
  return read;
}

namespace {

template <class Num>
control::Impedance<Num> GainsOf(const ImpedanceGains& gains) {
  return {Num::Splat(gains.tension_offset_n), Num::Splat(gains.length_offset_m),
          Num::Splat(gains.position_gain_n_per_m), Num::Splat(gains.velocity_gain_n_s_per_m)};
}

}  // namespace

// In equilibrium, a PID controller that integrates has zero error, and its integral is zero.
template <class Num>
TickMemory<Num> Tick<Num>::MemoryAtRest(const World<Num>& world) const {
  TickMemory<Num> memory;
  const Num zero = Num::Splat(0.0);
  for (const DrivenCable& d : driven_) {
    const CableReadings<Num> seen = Read(world, d.cable);
    const Num wish =
        control::ImpedanceTension(GainsOf<Num>(d.gains), seen.length_m, seen.rate_m_per_s,
                                  Num::Splat(d.gains.velocity_offset_m_per_s));
    memory.push_back(
        {{Num::Splat((wish - seen.tension_n)[0]), zero}, {Num::Splat(seen.length_m[0])}});
  }
  return memory;
}

template <class Num>
TickInputs<Num> Tick<Num>::NoInputs(const World<Num>& world) const {
  const Num zero = Num::Splat(0.0);
  return {std::vector<Num>(world.def().cables.size(), zero),
          std::vector<Num>(driven_.size(), zero)};
}

template <class Num>
void Tick<Num>::Run(World<Num>& world, TickMemory<Num>& memory,
                    const TickInputs<Num>& inputs) const {
  const int target = world.layout().target;
  for (std::size_t i = 0; i < driven_.size(); ++i) {
    const DrivenCable& d = driven_[i];
    const control::ImpedanceCommand<Num> command = control::StepImpedance(
        d.law, GainsOf<Num>(d.gains),
        Num::Splat(d.gains.velocity_offset_m_per_s) + inputs.velocity_input[i],
        Read(world, d.cable), memory[i]);
    world.Set(target + d.cable, command.target_m);
  }
  for (std::size_t c = 0; c < inputs.target.size(); ++c) {
    const int row = target + static_cast<int>(c);
    Num to = world.Get(row) + inputs.target[c];
    // A limited actuator at its target has no direction of motion. So evaluate the effect of a
    // change slightly off the target.
    if (to[0] == world.Get(world.layout().rest + static_cast<int>(c))[0]) {
      to += Num::Splat(kSlackHairM);
    }
    world.Set(row, to);
  }
  for (const double step_s : step_s_) world.Step(step_s);
}

template class Tick<Plain>;
template class Tick<Dual>;

}  // namespace taut::linear
