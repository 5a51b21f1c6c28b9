/// Oscillators with sensory feedback as a gait file has them.
#pragma once

#include "description/gait/gait_cpg.h"
#include "description/gait/gait_parts.h"
#include "description/yaml/keys.h"

namespace taut::description {

template <class Io>
void Keys(Io& io, Like<Neuron> auto& n) {
  io.Map("neuron", "feedback_cpg.neuron", "A neuron of a network.",
         R"({"name": "h1", "weights": [0.3, -1.2, 0], "bias": 0.1})");
  io("name", n.name, kNeeded, kName, "Its name; an output's says what it is for.");
  io("weights", n.weights, kNeeded, kVaried,
     "A factor for each neuron of the layer before it: the inputs, or the hidden neurons.");
  io("bias", n.bias, "What is added.");
}
template <class Io>
void Keys(Io& io, Like<NetworkSpec> auto& n) {
  io.Map("network", "feedback_cpg.network",
         "A feed-forward network with one hidden layer, sigmoid(sum of weight times input + bias). "
         "Outputs are scaled to -1..1.",
         R"({"hidden": [{"name": "h1", "weights": [1, -1]}], )"
         R"("outputs": [{"name": "phase", "weights": [0.5], "bias": -0.25}]})");
  io("hidden", n.hidden, kNeeded, "The hidden neurons, at most 32.");
  io("outputs", n.outputs, kNeeded, "The outputs, by their names. What is not listed is 0.");
}
template <class Io>
void Keys(Io& io, Like<FeedbackOscillator> auto& o) {
  io.Map("oscillators", "feedback_cpg.oscillators", "The oscillators of some cables.",
         R"({"name": "outer_top", "cables": ["outer", "top"], "amplitude_m": 0.03})");
  io("name", o.name, kNeeded, kName, "Their name; numbers and outputs are called after it.");
  io("cables", o.cables, kNeeded,
     "Which cables, each with an oscillator: by name, by tag, by a list of tags, or by a list of "
     "such lists.");
  io(Driven("amplitude_m_per_s", "amplitude_m"), o.amplitude, kNeeded, Bound::kNonNegative,
     "Amplitude R of an oscillator that nothing acts on.");
  io("phase_rad", o.phase_rad, kAtStart, "Phase at the start.");
  io(Driven("offset_m_per_s", "offset_m"), o.offset, "Constant part of the signal.");
}
template <class Io>
void Keys(Io& io, Like<FeedbackCpgGait> auto& c) {
  io.Map(
      "feedback_cpg", "feedback_cpg",
      "Oscillators that sensors act on. What a network hears of a cable, and what another hears "
      "of the goal of the experiment, changes their frequency, their amplitude and their phase.");
  io("frequency_hz", c.frequency_hz, kNeeded, kAtStart,
     "Frequency of each oscillator at the start.");
  io("convergence_per_s", c.convergence_per_s, Bound::kPositive,
     "How fast amplitudes go where they tend to: a.");
  io("frequency_gain_hz_per_s", c.frequency_gain_hz_per_s,
     "What a feedback of 1 to the frequency does: its rate is this times the sine of the phase.");
  io("amplitude_gain", c.amplitude_gain, Bound::kNonNegative,
     "What a feedback of 1 to the amplitude does: its square becomes 1 + this times R squared.");
  io("phase_gain_rad_per_s", c.phase_gain_rad_per_s,
     "What a feedback of 1 to the phase does: it turns faster by this.");
  io("integrator_step_s", c.integrator_step_s, kFixed, Bound::kPositive,
     "Longest step of the oscillators' integrator; the gait's period is divided into equal steps.");
  io("oscillators", c.oscillators, kNeeded, "Which cables have oscillators. A cable has one.");
  io("symmetry", c.symmetry, kSymmetries,
     "Which couplings share a weight and a phase, as in `cpg`.");
  io("groups", c.groups,
     "Weight and phase of groups of couplings, as in `cpg`. Groups that are not listed couple "
     "nothing.");
  io("cable_network", c.cable_network,
     "Shared by all cables with an oscillator. Two inputs: stretch, (l - l0) / l0 with l0 the "
     "length at the first tick; tension, (T - T_max / 2) / T_max with T_max what the actuator can "
     "pull with. Outputs: frequency, amplitude, phase.");
  io("goal_network", c.goal_network,
     "Shared by all joints: cables whose names end in the same number are of one joint. Two or "
     "three inputs: goal_x and goal_y, the unit vector towards the goal as the experiment's `goal` "
     "has it sensed; place, from 1 at the front joint to -1 at the rear one. Outputs are called "
     "after the oscillators: outer_top_frequency, outer_top_amplitude, outer_top_phase.");
}
void Check(const MapReader& map, NetworkSpec& network);
void Check(const MapReader& map, FeedbackCpgGait& cpg);
void CheckNumbers(const FeedbackCpgGait& cpg, const SourceRef& at, Diagnostics& out);
void Resolve(const FeedbackCpgGait& cpg, const RobotSpec& robot, ResolvedGait& resolved,
             Diagnostics& out);

}  // namespace taut::description
