/// A pseudo-terminal in place of the adapter's serial port.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "taut/diagnostics.h"

namespace taut::virtual_robot {

/// One thread calls it.
class Pty {
 public:
  /// Opens one and, if `link` is not empty, makes a symbolic link to it: a name that stays the
  /// same. A link that is there is replaced, anything else is not. Nothing and a complaint if that
  /// fails.
  static std::optional<Pty> Open(const std::string& link, Diagnostics& out);
  ~Pty();
  Pty(Pty&& other) noexcept;
  Pty& operator=(Pty&&) = delete;
  Pty(const Pty&) = delete;
  Pty& operator=(const Pty&) = delete;

  const std::string& path() const { return path_; }  ///< "/dev/pts/7".

  /// Waits for bytes, at most so long; they are left for `Read`. True: there are some.
  bool Wait(double seconds) const;
  /// What there is, in one piece: what the other side wrote at one go, if it is not long.
  std::vector<std::uint8_t> Read() const;
  /// Bytes for which the other side leaves no room are lost.
  void Write(std::span<const std::uint8_t> bytes) const;

 private:
  Pty(int master, int slave, std::string path, std::string link);

  int master_, slave_;  ///< The other end is kept open, so that clients may come and go.
  std::string path_, link_;
};

}  // namespace taut::virtual_robot
