/// Keys of kinematic bodies, in experiments and in resolved experiments.
#pragma once

#include "description/yaml/keys.h"
#include "taut/model_def.h"

namespace taut::description {

struct SlideText {
  Vec3 direction{0.0, 0.0, 1.0};
  TimeLaw law;
};
struct TurnText {
  Vec3 axis{0.0, 0.0, 1.0}, center_m;
  TimeLaw law;
};
struct MotionText {
  std::string name;
  SourceRef at;
  Placed of;
  std::optional<SlideText> slide;
  std::optional<TurnText> turn;
};

/// Keys of a motion over time. `speed` and `amplitude`: names of these keys, with units.
template <class Io, class Law>
void TimeLawKeys(Io& io, Law& law, const char* speed, const char* amplitude) {
  io(speed, law.speed,
     "Speed over time as points [[time_s, speed], ...], linearly interpolated; the first and last "
     "speed are held. A single point defines a constant speed.");
  io(amplitude, law.amplitude,
     "Amplitude of a sine that is added to the displacement or angle: amplitude (sin(2 pi "
     "frequency_hz t + phase_rad) - "
     "sin(phase_rad)).");
  io("frequency_hz", law.frequency_hz, Bound::kNonNegative, "Frequency of the sine.");
  io("phase_rad", law.phase_rad,
     "Phase of the sine. With -pi / 2, the sine starts at rest, from its lowest point.");
}

template <class Io>
void Keys(Io& io, Like<TimeLaw> auto& law) {  // in resolved experiments
  io("speed", law.speed);
  io("amplitude", law.amplitude);
  io("frequency_hz", law.frequency_hz);
  io("phase_rad", law.phase_rad);
}
template <class Io>
void Keys(Io& io, Like<MotionDef> auto& m) {
  io("name", m.name);
  io("body", m.body);
  io("direction", m.direction);
  io("slide", m.slide);
  io("axis", m.axis);
  io("center_m", m.center_m);
  io("turn", m.turn);
}

template <class Io>
void Keys(Io& io, Like<SlideText> auto& s) {
  io.Map("slide", "motion.slide", "Translation along a direction.",
         R"({"direction": [1, 0, 0], "speed_m_per_s": [[0, 0], [1, 0.5]]})");
  io("direction", s.direction, kNeeded, kDirection,
     "Direction of the translation, in the world frame.");
  TimeLawKeys(io, s.law, "speed_m_per_s", "amplitude_m");
}
template <class Io>
void Keys(Io& io, Like<TurnText> auto& t) {
  io.Map("turn", "motion.turn", "Rotation about an axis; the axis moves with the `slide`.",
         R"({"axis": [0, 0, 1], "speed_rad_per_s": [[0, 2]]})");
  io("axis", t.axis, kNeeded, kDirection, "Direction of the axis in the world frame.");
  io("center_m", t.center_m, "Point of the axis at t = 0, in the world frame.");
  TimeLawKeys(io, t.law, "speed_rad_per_s", "amplitude_rad");
}
template <class Io>
void Keys(Io& io, Like<MotionText> auto& m) {
  io.Map("motion", "motion",
         "Kinematic body with prescribed motion, independent of forces: a turntable, a shaker, a "
         "platform (docs/theory/motion.md). The motion starts at t = 0; while a robot settles, the "
         "body is at rest.",
         R"({"name": "shaker", "of": "plate", "slide": )"
         R"({"direction": [1, 0, 0], "amplitude_m": 0.01, "frequency_hz": 2}})");
  io("name", m.name, kNeeded, kName, "Name in the channels `motion/NAME/...`.");
  io("of", m.of, kNeeded,
     "Moving body: either a body of the robot, which then no longer responds to forces, or a box "
     "of the "
     "terrain.");
  io("slide", m.slide);
  io("turn", m.turn);
}
void Check(const MapReader& map, SlideText& slide);
void Check(const MapReader& map, TurnText& turn);
void Check(const MapReader& map, MotionText& motion);

}  // namespace taut::description
