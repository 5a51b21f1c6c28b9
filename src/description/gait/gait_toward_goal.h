/// A gait that rolls towards a goal as a gait file has it.
#pragma once

#include "description/gait/gait_parts.h"
#include "description/yaml/keys.h"

namespace taut::description {

template <class Io>
void Keys(Io& io, Like<TowardGoalGait> auto& t) {
  io.Map(
      "toward_goal", "toward_goal",
      "Rolls towards the goal of the experiment, whose `frame` must be `world`. A cable's signal "
      "is a polynomial in where its middle is from the centre of the robot now: `ahead`, "
      "towards the goal, and `up`, both in radii of the robot. Rolling brings cables "
      "to other places. Sensed are the directions of the robot's struts and of the goal.",
      R"({"cables": "cable", "offset_m": 0.05, "ahead_m": -0.2, "up_m": 0.1})");
  io("cables", t.cables, kNeeded,
     "Which cables: by name, by tag, by a list of tags, or by a list of such lists.");
  io(Driven("offset_m_per_s", "offset_m"), t.offset, "Constant part.");
  io(Driven("ahead_m_per_s", "ahead_m"), t.ahead, "Times `ahead`.");
  io(Driven("up_m_per_s", "up_m"), t.up, "Times `up`.");
  io(Driven("ahead2_m_per_s", "ahead2_m"), t.ahead2, "Times the square of `ahead`.");
  io(Driven("ahead_up_m_per_s", "ahead_up_m"), t.ahead_up, "Times `ahead` times `up`.");
  io(Driven("up2_m_per_s", "up2_m"), t.up2, "Times the square of `up`.");
  io(Driven("ahead3_m_per_s", "ahead3_m"), t.ahead3, "Times the cube of `ahead`.");
  io(Driven("ahead2_up_m_per_s", "ahead2_up_m"), t.ahead2_up,
     "Times the square of `ahead` times `up`.");
  io(Driven("ahead_up2_m_per_s", "ahead_up2_m"), t.ahead_up2,
     "Times `ahead` times the square of `up`.");
  io(Driven("up3_m_per_s", "up3_m"), t.up3, "Times the cube of `up`.");
  io("beat", t.beat,
     "All but the constant part is multiplied by 1 + `beat` cos(2 pi `beat_hz` t): who has come to "
     "rest comes away.");
  io("beat_hz", t.beat_hz, Bound::kNonNegative, "Frequency of that.");
}
void Check(const MapReader& map, TowardGoalGait& gait);
void CheckNumbers(const TowardGoalGait& gait, const SourceRef& at, Diagnostics& out);
void Resolve(const TowardGoalGait& gait, const RobotSpec& robot, ResolvedGait& resolved,
             Diagnostics& out);

}  // namespace taut::description
