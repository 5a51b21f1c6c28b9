/// Groups of channels that are recorded on request only (docs/formats/trace.md): nobody gets them
/// who asks for none, but all who look for a channel's name know them.
#pragma once

#include "plant/recorder.h"

namespace taut::plant {

void AddNodeChannels(const ExperimentSpec& experiment, Recorder& recorder);
/// The axial forces of struts, and what holds anchored bodies.
void AddLoadChannels(const ExperimentSpec& experiment, Recorder& recorder);
/// Of cables with friction or wheels: their spans, what friction took, angles about wheels.
void AddSpanChannels(const ExperimentSpec& experiment, Recorder& recorder);
/// What joints carry, and where they are.
void AddJointChannels(const ExperimentSpec& experiment, Recorder& recorder);
void AddMotionChannels(const ExperimentSpec& experiment, Recorder& recorder);
void AddContactChannels(const ExperimentSpec& experiment, Recorder& recorder);

/// Writes a vector's components behind each other.
inline void Put(const Vec3& v, double* out) {
  out[0] = v.x;
  out[1] = v.y;
  out[2] = v.z;
}

}  // namespace taut::plant
