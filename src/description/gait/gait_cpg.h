/// Keys of central pattern generators (CPG) in gait files. The coupling graph is in
/// gait_couplings.cpp.
#pragma once

#include "description/gait/gait_parts.h"
#include "description/yaml/keys.h"

namespace taut::description {

inline const Choices<CpgSymmetry> kSymmetries{{"segments", CpgSymmetry::kSegments},
                                              {"index", CpgSymmetry::kIndex},
                                              {"none", CpgSymmetry::kNone}};

template <class Io>
void Keys(Io& io, Like<CouplingGroup> auto& g) {
  io.Map("groups", "cpg.groups", "Group of couplings with a common weight and phase.",
         R"({"name": "same.outer_top.inner_top", "weight_per_m": 20, "phase_rad": "pi"})");
  io("name", g.name, kNeeded,
     "Name in the list of `taut check --couplings`. behind.outer_top.inner_left couples each "
     "outer_top to the inner_left of the joint behind, and each inner_left to the outer_top of the "
     "joint behind.");
  io(Driven("weight_per_m", "weight_per_m_s"), g.weight, kNeeded,
     "Weight w of the coupling. Multiplied by the neighbor's amplitude, it is a rate in rad/s.");
  io("phase_rad", g.phase_rad, kNeeded,
     "Phase phi of the coupling: the neighbor's phase lead at equilibrium.");
}
template <class Io>
void Keys(Io& io, Like<CpgFeedback> auto& f) {
  io.Map("", "cpg.feedback",
         "Feedback of a cable's tension on the phase of its oscillator: gain (T - reference) cos "
         "theta is added to theta'. Default: none.",
         R"({"gain_rad_per_n_s": 0.1, "reference_n": 15})");
  io("gain_rad_per_n_s", f.gain_rad_per_n_s, kNeeded, "Feedback gain.");
  io("reference_n", f.reference_n, "Reference tension, at which the feedback is zero.");
}
template <class Io>
void Keys(Io& io, Like<CpgGait> auto& c) {
  io.Map("cpg", "cpg",
         "Central pattern generator (eq. 4-6 of Mirletz et al. 2015): one oscillator per cable, "
         "coupled to all "
         "oscillators whose cables share a rigid body with this cable. `taut check MODEL "
         "--couplings` lists the network; `taut gait create MODEL` writes a file with all groups.");
  io("frequency_hz", c.frequency_hz, kNeeded, "Frequency of each oscillator without coupling.");
  io(Driven("amplitude_m_per_s", "amplitude_m"), c.amplitude, kNeeded, Bound::kNonNegative,
     "Amplitude R to which each oscillator converges.");
  io("convergence_per_s", c.convergence_per_s, Bound::kPositive,
     "Convergence rate a of the critically damped amplitude.");
  io("integrator_step_s", c.integrator_step_s, kFixed, Bound::kPositive,
     "Longest step of the network's integrator; the gait's period is divided into equal steps. "
     "Independent of the simulation step.");
  io("symmetry", c.symmetry, kSymmetries,
     "Rule for groups of couplings with common weight and phase. `segments`: a group contains the "
     "couplings between two roles (names of cables without their number) with one relative "
     "position of the neighbor: at the same joint, one joint ahead, or one joint behind. "
     "`index`: NTRT's rule, computed from the positions in `order`. `none`: every coupling has "
     "separate "
     "values.");
  io("order", c.order,
     "Names of the cables with an oscillator. Default: all cables with an actuator, in the model's "
     "order.");
  io("inverted", c.inverted,
     "Cables with an inverted signal: the negative of the oscillator's signal.");
  io("feedback", c.feedback);
  io("groups", c.groups,
     "Weight and phase of every group of couplings. All groups of the robot are required.");
}
void Check(const MapReader& map, CpgGait& cpg);
void CheckNumbers(const CpgGait& cpg, const SourceRef& at, Diagnostics& out);
void Resolve(const CpgGait& cpg, const RobotSpec& robot, ResolvedGait& resolved, Diagnostics& out);

}  // namespace taut::description
