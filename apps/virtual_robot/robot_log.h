/// Log of the emulation, one line per event in chronological order.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "apps/virtual_robot/emulated_time.h"

namespace taut::virtual_robot {

/// `who`: "board 3", "usb", "fault", "plant".
using LogSink = std::function<void(Time at, std::string_view who, std::string_view what)>;

/// Formats `0.012345678 board 3: reset by the watchdog`, with a line feed.
std::string LogLine(Time at, std::string_view who, std::string_view what);

/// Formats two digits per byte, separated by spaces.
std::string Hex(const unsigned char* bytes, std::size_t count);

}  // namespace taut::virtual_robot
