/// Optional groups of channels of a trace (docs/formats/trace.md). Each group is recorded only on
/// request. Checks of channel names consider all groups.
#pragma once

#include "plant/recorder.h"

namespace taut::plant {

void AddNodeChannels(const ExperimentSpec& experiment, Recorder& recorder);
/// Adds the axial forces of struts and the reactions of anchored bodies.
void AddLoadChannels(const ExperimentSpec& experiment, Recorder& recorder);
/// Adds channels of routed cables with friction or wheels, and of wrapping cables: span tensions,
/// friction losses, wheel angles, wrap angles and bends.
void AddSpanChannels(const ExperimentSpec& experiment, Recorder& recorder);
/// Adds forces, torques and coordinates of joints.
void AddJointChannels(const ExperimentSpec& experiment, Recorder& recorder);
void AddMotionChannels(const ExperimentSpec& experiment, Recorder& recorder);
void AddContactChannels(const ExperimentSpec& experiment, Recorder& recorder);

/// Writes the components of a vector to `out[0]` to `out[2]`.
inline void Put(const Vec3& v, double* out) {
  out[0] = v.x;
  out[1] = v.y;
  out[2] = v.z;
}

}  // namespace taut::plant
