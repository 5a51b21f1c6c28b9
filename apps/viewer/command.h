/// What a client asks for: one JSON text, checked against web/protocol/messages.json.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "taut/types.h"

namespace taut::viewer {

/// Longest message that a client may send.
inline constexpr std::size_t kMaxMessageBytes = 64 * 1024;

/// Runs that one is compared with at most: as many as have a colour of their own.
inline constexpr int kMaxComparedRuns = 7;

/// One message of a client. Which fields count follows from `type`.
struct Command {
  std::string type;  ///< A key of "client" in messages.json.
  std::string name;  ///< node, name, cable or channel.
  std::string gain;
  std::string mode;       ///< Of robot_mode.
  Vec3 vector;            ///< target_m or force_n.
  double value = 0;       ///< value, factor, time_s, duration_s.
  double t0 = 0, t1 = 0;  ///< Of want_series [s].
  int id = 0, source = 0, points = 0, count = 1;
  bool on = false;  ///< Of record.
};

/// Nothing if the text is not a message of the protocol; `error` says why.
std::optional<Command> ParseCommand(std::string_view text, std::string& error);

}  // namespace taut::viewer
