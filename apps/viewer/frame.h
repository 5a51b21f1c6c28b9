/// Present state for clients: the binary message of web/protocol/messages.json.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "taut/live.h"
#include "taut/world_batch.h"

namespace taut::viewer {

/// Content of a frame. Unknown values are NaN.
struct Frame {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  struct Body {
    Vec3 position_m;
    Quat orientation;
  };
  struct Cable {
    double tension_n = kUnknown, length_m = kUnknown, rest_length_m = kUnknown,
           setpoint_n = kUnknown;
  };
  struct Contact {
    Vec3 point_m, force_n;
  };
  struct Bend {
    int cable = -1;  ///< Index of the cable; cables of ghosts follow those in the scene.
    Vec3 point_m{kUnknown, kUnknown, kUnknown};
  };

  struct Span {
    int cable = -1;
    double tension_n = kUnknown;
  };

  double time_s = 0;
  double now_s =
      0;  ///< Present time of the run; later than `time_s` while a past moment is displayed.
  double real_time_factor = 0, speed = 1;
  bool paused = false;
  int driver = 0;
  Energy energy{kUnknown, kUnknown, kUnknown};
  int run = 0;
  double contact_count = 0;  ///< Number of contacts; may be known although `contacts` is empty.
  std::vector<Body> bodies;
  std::vector<Cable> cables;
  std::vector<Contact> contacts;
  std::vector<ExternalForce> pushes;
  std::vector<double> values;  ///< Channels of a user's program (taut/page.h).
  std::vector<Body> ghosts;    ///< Bodies of compared runs; NaN while a run has no row.
  std::vector<Bend> bends;     ///< Bends of wrapped cables, in order along each cable.
  std::vector<Span>
      spans;  ///< Spans of cables with friction, in order along each cable; not of ghosts.
};

/// Returns all numbers of the frame in the order of the protocol.
std::vector<double> FrameNumbers(const Frame& frame);

/// Returns the binary message: these numbers as Float64, little endian.
std::string FrameMessage(const Frame& frame);

}  // namespace taut::viewer
