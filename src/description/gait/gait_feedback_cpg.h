/// Keys of CPGs with sensory feedback (oscillators and neural networks) in gait files.
#pragma once

#include "description/gait/gait_cpg.h"
#include "description/gait/gait_parts.h"
#include "description/yaml/keys.h"

namespace taut::description {

template <class Io>
void Keys(Io& io, Like<Neuron> auto& n) {
  io.Map("neuron", "feedback_cpg.neuron", "Neuron of a network.",
         R"({"name": "h1", "weights": [0.3, -1.2, 0], "bias": 0.1})");
  io("name", n.name, kNeeded, kName,
     "Name of the neuron; for an output, the name of the quantity that it changes.");
  io("weights", n.weights, kNeeded, kVaried,
     "Weights, one per neuron of the previous layer: the inputs, or the hidden neurons.");
  io("bias", n.bias, "Bias.");
}
template <class Io>
void Keys(Io& io, Like<NetworkSpec> auto& n) {
  io.Map("network", "feedback_cpg.network",
         "Feed-forward network with one hidden layer, sigmoid(sum of weight times input + bias). "
         "Outputs are scaled to -1..1.",
         R"({"hidden": [{"name": "h1", "weights": [1, -1]}], )"
         R"("outputs": [{"name": "phase", "weights": [0.5], "bias": -0.25}]})");
  io("hidden", n.hidden, kNeeded, "Hidden neurons, at most 32.");
  io("outputs", n.outputs, kNeeded, "Outputs by name. Missing outputs are 0.");
}
template <class Io>
void Keys(Io& io, Like<FeedbackOscillator> auto& o) {
  io.Map("oscillators", "feedback_cpg.oscillators", "Oscillators of the selected cables.",
         R"({"name": "outer_top", "cables": ["outer", "top"], "amplitude_m": 0.03})");
  io("name", o.name, kNeeded, kName,
     "Name of the oscillators, used in the names of parameters and outputs.");
  io("cables", o.cables, kNeeded,
     "Cables with one oscillator each: by name, by tag, by a list of tags, or by a list of such "
     "lists.");
  io(Driven("amplitude_m_per_s", "amplitude_m"), o.amplitude, kNeeded, Bound::kNonNegative,
     "Amplitude R without feedback.");
  io("phase_rad", o.phase_rad, kAtStart, "Initial phase.");
  io(Driven("offset_m_per_s", "offset_m"), o.offset, "Constant offset of the signal.");
}
template <class Io>
void Keys(Io& io, Like<FeedbackCpgGait> auto& c) {
  io.Map("feedback_cpg", "feedback_cpg",
         "Oscillators with sensory feedback. One neural network computes feedback from each cable, "
         "another network from the direction of the experiment's goal. The feedback changes the "
         "frequency, "
         "amplitude and phase of each oscillator.");
  io("frequency_hz", c.frequency_hz, kNeeded, kAtStart, "Initial frequency of each oscillator.");
  io("convergence_per_s", c.convergence_per_s, Bound::kPositive,
     "Convergence rate a of the amplitudes.");
  io("frequency_gain_hz_per_s", c.frequency_gain_hz_per_s,
     "Gain of frequency feedback: at a feedback of 1 the frequency changes at this rate times the "
     "sine of the phase.");
  io("amplitude_gain", c.amplitude_gain, Bound::kNonNegative,
     "Gain of amplitude feedback: at a feedback of 1 the square of the amplitude converges to (1 + "
     "gain) R^2.");
  io("phase_gain_rad_per_s", c.phase_gain_rad_per_s,
     "Gain of phase feedback: at a feedback of 1 the phase rate increases by this value.");
  io("integrator_step_s", c.integrator_step_s, kFixed, Bound::kPositive,
     "Longest step of the oscillators' integrator; the gait's period is divided into equal steps.");
  io("oscillators", c.oscillators, kNeeded, "Oscillators by cable, one per cable.");
  io("symmetry", c.symmetry, kSymmetries, "Couplings with common weight and phase, as in `cpg`.");
  io("groups", c.groups,
     "Weight and phase of groups of couplings, as in `cpg`. Groups that are not listed have no "
     "coupling.");
  io("cable_network", c.cable_network,
     "Neural network shared by all cables with an oscillator. Inputs: stretch, (l - l0) / l0, "
     "where l0 is the "
     "length at the first tick; tension, (T - T_max / 2) / T_max, where T_max is the actuator's "
     "largest "
     "tension. Outputs: frequency, amplitude, phase.");
  io("goal_network", c.goal_network,
     "Network shared by all joints; cables whose names end in the same number form one joint. "
     "Inputs: goal_x and goal_y, the sensed unit vector toward the experiment's `goal`; optionally "
     "place, from 1 at the front joint to -1 at the rear one. Outputs are named after the "
     "oscillators: outer_top_frequency, outer_top_amplitude, outer_top_phase.");
}
void Check(const MapReader& map, NetworkSpec& network);
void Check(const MapReader& map, FeedbackCpgGait& cpg);
void CheckNumbers(const FeedbackCpgGait& cpg, const SourceRef& at, Diagnostics& out);
void Resolve(const FeedbackCpgGait& cpg, const RobotSpec& robot, ResolvedGait& resolved,
             Diagnostics& out);

}  // namespace taut::description
