/// Pseudo-terminal in place of the adapter's serial port.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "taut/diagnostics.h"

namespace taut::virtual_robot {

/// Pseudo-terminal with a symbolic link. Not thread-safe.
class Pty {
 public:
  /// Opens a pseudo-terminal and, if `link` is not empty, creates a symbolic link to it as a
  /// constant name. An existing link is replaced, other files are not. Returns nothing, with an
  /// error, on failure.
  static std::optional<Pty> Open(const std::string& link, Diagnostics& out);
  ~Pty();
  Pty(Pty&& other) noexcept;
  Pty& operator=(Pty&&) = delete;
  Pty(const Pty&) = delete;
  Pty& operator=(const Pty&) = delete;

  const std::string& path() const { return path_; }  ///< Example: "/dev/pts/7".

  /// Waits for bytes, at most `seconds`; leaves them for `Read`. Returns true if there are any.
  bool Wait(double seconds) const;
  /// Returns the available bytes in one piece: a short write of the other side arrives whole.
  std::vector<std::uint8_t> Read() const;
  /// Writes bytes; drops those for which the other side has no space.
  void Write(std::span<const std::uint8_t> bytes) const;

 private:
  Pty(int master, int slave, std::string path, std::string link);

  int master_, slave_;  ///< The slave side is kept open, so that clients may come and go.
  std::string path_, link_;
};

}  // namespace taut::virtual_robot
