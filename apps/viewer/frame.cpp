#include "frame.h"

#include <bit>
#include <cstring>

#include "protocol_messages.h"

namespace taut::viewer {

static_assert(std::endian::native == std::endian::little, "frames are sent as they are in memory");

std::vector<double> FrameNumbers(const Frame& frame) {
  std::vector<double> out(kFrameHeaderSize);
  out[kFrameTimeS] = frame.time_s;
  out[kFrameNowS] = frame.now_s;
  out[kFrameRealTimeFactor] = frame.real_time_factor;
  out[kFrameSpeed] = frame.speed;
  out[kFramePaused] = frame.paused ? 1 : 0;
  out[kFrameDriver] = frame.driver;
  out[kFrameKineticJ] = frame.energy.kinetic_j;
  out[kFrameGravityJ] = frame.energy.gravity_j;
  out[kFrameElasticJ] = frame.energy.elastic_j;
  out[kFrameRun] = frame.run;
  out[kFrameBodyCount] = static_cast<double>(frame.bodies.size());
  out[kFrameCableCount] = static_cast<double>(frame.cables.size());
  out[kFrameContactCount] = frame.contact_count;
  out[kFrameContactRows] = static_cast<double>(frame.contacts.size());
  out[kFramePushCount] = static_cast<double>(frame.pushes.size());
  out[kFrameValueCount] = static_cast<double>(frame.values.size());
  out[kFrameGhostCount] = static_cast<double>(frame.ghosts.size());
  out[kFrameBendCount] = static_cast<double>(frame.bends.size());
  out[kFrameSpanCount] = static_cast<double>(frame.spans.size());
  out.reserve(out.size() + frame.bodies.size() * kFrameBodiesValues +
              frame.cables.size() * kFrameCablesValues +
              frame.contacts.size() * kFrameContactsValues +
              frame.pushes.size() * kFramePushesValues + frame.values.size() +
              frame.ghosts.size() * kFrameGhostsValues + frame.bends.size() * kFrameBendsValues +
              frame.spans.size() * kFrameSpansValues);
  const auto put = [&](const Vec3& v) { out.insert(out.end(), {v.x, v.y, v.z}); };
  const auto put_bodies = [&](const std::vector<Frame::Body>& bodies) {
    for (const Frame::Body& body : bodies) {
      put(body.position_m);
      const Quat& q = body.orientation;
      out.insert(out.end(), {q.w, q.x, q.y, q.z});
    }
  };
  put_bodies(frame.bodies);
  for (const Frame::Cable& cable : frame.cables) {
    out.insert(out.end(), {cable.tension_n, cable.length_m, cable.rest_length_m, cable.setpoint_n});
  }
  for (const Frame::Contact& contact : frame.contacts) {
    put(contact.point_m);
    put(contact.force_n);
  }
  for (const ExternalForce& push : frame.pushes) {
    out.push_back(push.node);
    put(push.force_n);
  }
  out.insert(out.end(), frame.values.begin(), frame.values.end());
  put_bodies(frame.ghosts);
  for (const Frame::Bend& bend : frame.bends) {
    out.push_back(bend.cable);
    put(bend.point_m);
  }
  for (const Frame::Span& span : frame.spans) {
    out.insert(out.end(), {static_cast<double>(span.cable), span.tension_n});
  }
  return out;
}

std::string FrameMessage(const Frame& frame) {
  const std::vector<double> numbers = FrameNumbers(frame);
  std::string bytes(numbers.size() * sizeof(double), '\0');
  std::memcpy(bytes.data(), numbers.data(), bytes.size());
  return bytes;
}

}  // namespace taut::viewer
