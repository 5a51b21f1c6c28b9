/// Opening of files that may be pipes or devices.
#pragma once

#include <string>

namespace taut::base {

/// Longest wait for another program to open the other end of a pipe.
inline constexpr double kPipePatience_s = 5;

/// Open file. The destructor closes it.
class OpenFile {
 public:
  explicit OpenFile(int descriptor) : descriptor_(descriptor) {}
  OpenFile(OpenFile&& other) noexcept : descriptor_(other.Release()) {}
  OpenFile& operator=(OpenFile&&) = delete;
  ~OpenFile();

  explicit operator bool() const { return descriptor_ >= 0; }
  int get() const { return descriptor_; }
  /// Returns the descriptor, which the caller must close.
  int Release();

 private:
  int descriptor_;
};

/// Opens a file for reading. open(2) would wait forever for a program that writes to a named pipe;
/// this function waits at most `kPipePatience_s`. Reading from a device without data fails, except
/// for terminals. On failure, returns nothing, with the reason in `errno`: ETIMEDOUT if no program
/// writes to the pipe.
OpenFile OpenToRead(const std::string& path);

/// Opens a device or a pipe for writing, with the same limit: ETIMEDOUT if no program reads from
/// the pipe.
OpenFile OpenToAppend(const std::string& path);

/// Returns the text of an error of the functions above.
std::string OpenError(int error);

}  // namespace taut::base
