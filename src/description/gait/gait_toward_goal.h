/// Keys of gaits that roll toward a goal.
#pragma once

#include "description/gait/gait_parts.h"
#include "description/yaml/keys.h"

namespace taut::description {

template <class Io>
void Keys(Io& io, Like<TowardGoalGait> auto& t) {
  io.Map("toward_goal", "toward_goal",
         "Gait of a robot that rolls toward the `goal` of the experiment; `frame` of the goal must "
         "be `world`. A cable's "
         "signal is a polynomial in the position of its middle relative to the robot's center: "
         "`ahead`, toward the goal, and `up`, both in radii of the robot. These positions change "
         "while the robot "
         "rolls; the gait computes them from the directions of the robot's struts and of the goal.",
         R"({"cables": "cable", "offset_m": 0.05, "ahead_m": -0.2, "up_m": 0.1})");
  io("cables", t.cables, kNeeded,
     "Cables: by name, by tag, by a list of tags, or by a list of such lists.");
  io(Driven("offset_m_per_s", "offset_m"), t.offset, "Constant offset.");
  io(Driven("ahead_m_per_s", "ahead_m"), t.ahead, "Coefficient of `ahead`.");
  io(Driven("up_m_per_s", "up_m"), t.up, "Coefficient of `up`.");
  io(Driven("ahead2_m_per_s", "ahead2_m"), t.ahead2, "Coefficient of `ahead` squared.");
  io(Driven("ahead_up_m_per_s", "ahead_up_m"), t.ahead_up, "Coefficient of `ahead` times `up`.");
  io(Driven("up2_m_per_s", "up2_m"), t.up2, "Coefficient of `up` squared.");
  io(Driven("ahead3_m_per_s", "ahead3_m"), t.ahead3, "Coefficient of `ahead` cubed.");
  io(Driven("ahead2_up_m_per_s", "ahead2_up_m"), t.ahead2_up,
     "Coefficient of `ahead` squared times `up`.");
  io(Driven("ahead_up2_m_per_s", "ahead_up2_m"), t.ahead_up2,
     "Coefficient of `ahead` times `up` squared.");
  io(Driven("up3_m_per_s", "up3_m"), t.up3, "Coefficient of `up` cubed.");
  io("beat", t.beat,
     "Amplitude of a modulation: all terms except the constant offset are multiplied by 1 + `beat` "
     "cos(2 pi "
     "`beat_hz` t). The modulation frees a robot that has come to rest.");
  io("beat_hz", t.beat_hz, Bound::kNonNegative, "Frequency of the modulation.");
}
void Check(const MapReader& map, TowardGoalGait& gait);
void CheckNumbers(const TowardGoalGait& gait, const SourceRef& at, Diagnostics& out);
void Resolve(const TowardGoalGait& gait, const RobotSpec& robot, ResolvedGait& resolved,
             Diagnostics& out);

}  // namespace taut::description
