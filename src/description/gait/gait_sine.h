/// Keys of sine waves in gait files.
#pragma once

#include "description/gait/gait_parts.h"
#include "description/yaml/keys.h"

namespace taut::description {

template <class Io>
void Keys(Io& io, Like<SineWave> auto& w) {
  io.Map("waves", "sine.waves", "Wave of the selected cables.",
         R"({"name": "front_top", "cables": ["outer", "top"], "amplitude_m_per_s": 0.06, )"
         R"("offset_m_per_s": -0.06, "phase_per_segment_rad": "pi / 3"})");
  io("name", w.name, kNeeded, kName,
     "Name of the wave, part of the names of its parameters, such as sine.front_top.phase_rad.");
  io("cables", w.cables, kNeeded,
     "Cables as in an experiment: by name, by tag, by a list of tags, or by a list of such lists.");
  io(Driven("amplitude_m_per_s", "amplitude_m"), w.amplitude, kNeeded,
     "Amplitude; negative inverts the wave.");
  io("phase_rad", w.phase_rad, "Phase at t = 0.");
  io(Driven("offset_m_per_s", "offset_m"), w.offset, "Constant offset.");
  io("phase_per_segment_rad", w.phase_per_segment_rad,
     "Phase added per segment toward the rear: not added for cables whose names end in _1, added "
     "once for _2, twice for _3. This phase lag makes a traveling wave on a spine of any length.");
  io("frequency_hz", w.frequency_hz, Bound::kNonNegative,
     "Frequency of this wave. Default: `frequency_hz` of `sine`.");
}
template <class Io>
void Keys(Io& io, Like<SineGait> auto& s) {
  io.Map("sine", "sine",
         "Sine waves: signal = offset + amplitude cos(2 pi f t + phase). One of `sine`, `cpg`, "
         "`table`, `feedback_cpg` and `toward_goal` is required.");
  io("frequency_hz", s.frequency_hz, kNeeded, Bound::kNonNegative,
     "Frequency f of all waves that have no `frequency_hz`.");
  io("waves", s.waves, kNeeded,
     "Waves, at most one per cable. Cables without a wave have a signal of 0.");
}
void Check(const MapReader& map, SineGait& sine);
void CheckNumbers(const SineGait& sine, const SourceRef& at, Diagnostics& out);
void Resolve(const SineGait& sine, const RobotSpec& robot, ResolvedGait& resolved,
             Diagnostics& out);

}  // namespace taut::description
