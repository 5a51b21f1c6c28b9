/// Lock owner and unique key of a serial device. The key is the same for all users and symbolic
/// links of a machine.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>

namespace taut::link {

/// Returns the process that holds a flock on the device; nothing without a visible one.
std::optional<pid_t> DriverOf(const std::string& device);

/// Returns the device number ("166:0"), else device and inode of the file; empty without one.
std::string DeviceKey(const std::string& device);

}  // namespace taut::link
