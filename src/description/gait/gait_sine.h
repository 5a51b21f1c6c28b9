/// Sine waves as a gait file has them.
#pragma once

#include "description/gait/gait_parts.h"
#include "description/yaml/keys.h"

namespace taut::description {

template <class Io>
void Keys(Io& io, Like<SineWave> auto& w) {
  io.Map("waves", "sine.waves", "The wave of some cables.",
         R"({"name": "front_top", "cables": ["outer", "top"], "amplitude_m_per_s": 0.06, )"
         R"("offset_m_per_s": -0.06, "phase_per_segment_rad": "pi / 3"})");
  io("name", w.name, kNeeded, kName,
     "Name of the wave; its numbers are called after it, such as sine.front_top.phase_rad.");
  io("cables", w.cables, kNeeded,
     "Which cables, as in an experiment: by name, by tag, by a list of tags, or by a list of such "
     "lists.");
  io(Driven("amplitude_m_per_s", "amplitude_m"), w.amplitude, kNeeded,
     "Amplitude; negative turns the wave round.");
  io("phase_rad", w.phase_rad, "Phase at t = 0.");
  io(Driven("offset_m_per_s", "offset_m"), w.offset, "Constant part.");
  io("phase_per_segment_rad", w.phase_per_segment_rad,
     "Added to the phase once for every segment further back: cables whose names end in _1 get "
     "none, _2 once, _3 twice. A travelling wave on a spine of any length.");
  io("frequency_hz", w.frequency_hz, Bound::kNonNegative, "A frequency of its own.");
}
template <class Io>
void Keys(Io& io, Like<SineGait> auto& s) {
  io.Map("sine", "sine",
         "Sine waves: signal = offset + amplitude cos(2 pi f t + phase). One of `sine`, `cpg`, "
         "`table`, `feedback_cpg` and `toward_goal` must be there.");
  io("frequency_hz", s.frequency_hz, kNeeded, Bound::kNonNegative,
     "f of all waves that have none of their own.");
  io("waves", s.waves, kNeeded,
     "The waves; a cable has one at most. Cables without one have a signal of 0.");
}
void Check(const MapReader& map, SineGait& sine);
void CheckNumbers(const SineGait& sine, const SourceRef& at, Diagnostics& out);
void Resolve(const SineGait& sine, const RobotSpec& robot, ResolvedGait& resolved,
             Diagnostics& out);

}  // namespace taut::description
