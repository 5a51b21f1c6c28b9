/// Channels of a body's state in a trace, `body/NAME/...`, and their conversion to and from
/// `BodyState`.
#pragma once

#include <array>

#include "plant/channels.h"

namespace taut::plant {

inline const std::vector<ChannelInfo>& BodyChannels() {
  static const std::vector<ChannelInfo> channels{{"position_x_m", "m"},
                                                 {"position_y_m", "m"},
                                                 {"position_z_m", "m"},
                                                 {"orientation_w", "1"},
                                                 {"orientation_x", "1"},
                                                 {"orientation_y", "1"},
                                                 {"orientation_z", "1"},
                                                 {"velocity_x_m_per_s", "m/s"},
                                                 {"velocity_y_m_per_s", "m/s"},
                                                 {"velocity_z_m_per_s", "m/s"},
                                                 {"angular_velocity_x_rad_per_s", "rad/s"},
                                                 {"angular_velocity_y_rad_per_s", "rad/s"},
                                                 {"angular_velocity_z_rad_per_s", "rad/s"}};
  return channels;
}
using BodyNumbers = std::array<double, 13>;  ///< In the order of `BodyChannels`.

inline void PutBody(const BodyState& body, double* out) {
  Put(body.position_m, out);
  const Quat& q = body.orientation;
  out[3] = q.w, out[4] = q.x, out[5] = q.y, out[6] = q.z;
  Put(body.velocity_m_per_s, out + 7);
  Put(body.angular_velocity_rad_per_s, out + 10);
}

inline BodyState BodyFrom(const BodyNumbers& x) {
  return {{x[0], x[1], x[2]}, {x[3], x[4], x[5], x[6]}, {x[7], x[8], x[9]}, {x[10], x[11], x[12]}};
}

}  // namespace taut::plant
