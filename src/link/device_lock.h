/// Which process has locked a device, and the name by which all programs of a machine know the
/// device, whatever link or user they come by.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>

namespace taut::link {

/// The process that holds a flock on the device; nothing if there is none or it cannot be seen.
std::optional<pid_t> DriverOf(const std::string& device);

/// "166:0", the device's number, or that of the file where it is none; empty if there is neither.
std::string DeviceKey(const std::string& device);

}  // namespace taut::link
