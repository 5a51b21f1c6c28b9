/// Owner of the lock of a serial device, and a unique key of the device. The key is the same for
/// all users and symbolic links of a machine.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>

namespace taut::link {

/// Returns the process that holds a flock on the device. Returns nothing if there is none, or if it
/// is not visible.
std::optional<pid_t> DriverOf(const std::string& device);

/// Returns the device number ("166:0"), or device and inode for a regular file. Returns an empty
/// text if the file does not exist.
std::string DeviceKey(const std::string& device);

}  // namespace taut::link
