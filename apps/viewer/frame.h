/// The present as a client gets it: the binary message of web/protocol/messages.json.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "taut/batch.h"
#include "taut/live.h"

namespace taut::viewer {

/// What a frame shows. What is not known is NaN.
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
    int cable = -1;  ///< Ghosts' are behind the scene's.
    Vec3 point_m{kUnknown, kUnknown, kUnknown};
  };

  struct Span {
    int cable = -1;
    double tension_n = kUnknown;
  };

  double time_s = 0;
  double now_s = 0;  ///< Of the run; later than `time_s` while its past is looked at.
  double real_time_factor = 0, speed = 1;
  bool paused = false;
  int driver = 0;
  Energy energy{kUnknown, kUnknown, kUnknown};
  int run = 0;
  double contact_count = 0;  ///< May be known where the contacts are not.
  std::vector<Body> bodies;
  std::vector<Cable> cables;
  std::vector<Contact> contacts;
  std::vector<OutsideForce> pushes;
  std::vector<double> values;  ///< Of channels of a program's own (taut/page.h).
  std::vector<Body> ghosts;    ///< Of compared runs; NaN while a run has no row.
  std::vector<Bend> bends;     ///< Of cables that lie against what they come to, along each.
  std::vector<Span> spans;     ///< Of cables with friction, along each; not of ghosts.
};

/// Every number of the frame in the order of the definition.
std::vector<double> FrameNumbers(const Frame& frame);

/// The binary message: those numbers as Float64, little endian.
std::string FrameMessage(const Frame& frame);

}  // namespace taut::viewer
