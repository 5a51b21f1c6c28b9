/// Commands from clients: JSON messages, validated against web/protocol/messages.json.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "taut/types.h"

namespace taut::viewer {

/// Longest message that a client may send.
inline constexpr std::size_t kMaxMessageBytes = 64 * 1024;

/// Maximum number of runs to compare with: the number of distinct colors.
inline constexpr int kMaxComparedRuns = 7;

/// A message from a client. `type` determines which fields are used.
struct Command {
  std::string type;  ///< A key of "client" in messages.json.
  std::string name;  ///< Field node, name, cable or channel.
  std::string gain;
  std::string mode;       ///< Field `mode` of robot_mode, `as` of start.
  Vec3 vector;            ///< Field target_m or force_n.
  double value = 0;       ///< Field value, factor, time_s or duration_s.
  double t0 = 0, t1 = 0;  ///< Time span of want_series [s].
  int id = 0, source = 0, points = 0, count = 1;
  bool on = false;  ///< Field `on` of the message record.
};

/// Parses a message. Returns nothing if it violates the protocol; then `error` has the reason.
std::optional<Command> ParseCommand(std::string_view text, std::string& error);

}  // namespace taut::viewer
