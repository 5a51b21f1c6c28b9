/// A central pattern generator as a gait file has it. Its network: gait_couplings.cpp.
#pragma once

#include "description/gait/gait_parts.h"
#include "description/yaml/keys.h"

namespace taut::description {

inline const Choices<CpgSymmetry> kSymmetries{{"segments", CpgSymmetry::kSegments},
                                              {"index", CpgSymmetry::kIndex},
                                              {"none", CpgSymmetry::kNone}};

template <class Io>
void Keys(Io& io, Like<CouplingGroup> auto& g) {
  io.Map("groups", "cpg.groups", "One group of couplings.",
         R"({"name": "same.outer_top.inner_top", "weight_per_m": 20, "phase_rad": "pi"})");
  io("name", g.name, kNeeded,
     "As `taut check --couplings` names it, such as behind.outer_top.inner_left: an outer_top is "
     "pulled by an inner_left of the joint behind, and the other way round by roles.");
  io(Driven("weight_per_m", "weight_per_m_s"), g.weight, kNeeded,
     "w: times the neighbour's amplitude it is a rate in rad/s.");
  io("phase_rad", g.phase_rad, kNeeded,
     "phi: how far the neighbour's phase is pulled ahead of the oscillator's own.");
}
template <class Io>
void Keys(Io& io, Like<CpgFeedback> auto& f) {
  io.Map("", "cpg.feedback",
         "A cable's tension acts on the phase of its oscillator: theta' gets gain (T - reference) "
         "cos theta. None if absent.",
         R"({"gain_rad_per_n_s": 0.1, "reference_n": 15})");
  io("gain_rad_per_n_s", f.gain_rad_per_n_s, kNeeded, "Gain.");
  io("reference_n", f.reference_n, "The tension that changes nothing.");
}
template <class Io>
void Keys(Io& io, Like<CpgGait> auto& c) {
  io.Map("cpg", "cpg",
         "A central pattern generator (paper eq. 4-6): an oscillator a cable, coupled to every "
         "other whose cable shares a rigid body with its own. `taut check MODEL --couplings` shows "
         "the network, `taut gait create MODEL` writes a file with all its groups.");
  io("frequency_hz", c.frequency_hz, kNeeded, "Frequency of each oscillator left to itself.");
  io(Driven("amplitude_m_per_s", "amplitude_m"), c.amplitude, kNeeded, Bound::kNonNegative,
     "Amplitude R that each oscillator grows to.");
  io("convergence_per_s", c.convergence_per_s, Bound::kPositive,
     "How fast it does so: a of the critically damped amplitude.");
  io("integrator_step_s", c.integrator_step_s, kFixed, Bound::kPositive,
     "Longest step of the network's integrator; the gait's period is divided into equal steps. It "
     "has nothing to do with the step of the simulation.");
  io("symmetry", c.symmetry, kSymmetries,
     "Which couplings share a weight and a phase. `segments`: those between the same two roles "
     "(the cable's name without its number) with the same one in front. `index`: by NTRT's rule, "
     "from positions in `order`. `none`: each has its own.");
  io("order", c.order,
     "The cables with an oscillator, by name. All cables that have an actuator, in the model's "
     "order, if absent.");
  io("inverted", c.inverted, "Cables whose signal is the negative of their oscillator's.");
  io("feedback", c.feedback);
  io("groups", c.groups,
     "Weight and phase of every group of couplings. None that the robot needs may be missing.");
}
void Check(const MapReader& map, CpgGait& cpg);
void CheckNumbers(const CpgGait& cpg, const SourceRef& at, Diagnostics& out);
void Resolve(const CpgGait& cpg, const RobotSpec& robot, ResolvedGait& resolved, Diagnostics& out);

}  // namespace taut::description
