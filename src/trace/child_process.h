/// Forked child process for a library that may crash. The child sends its result through a pipe.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <functional>
#include <string>

namespace taut::trace {

/// Limit of CPU time for a child that reads an HDF5 file.
inline constexpr std::chrono::seconds kChildPatience{30};

/// The child's end of the pipe. Ends the child if the parent has ended.
class ChildOutput {
 public:
  explicit ChildOutput(int descriptor) : descriptor_(descriptor) {}
  void Write(const void* data, std::size_t size) const;

 private:
  int descriptor_;
};

/// Child process whose failures do not affect the parent: crashes, hangs, excessive memory.
class ChildProcess {
 public:
  /// Forks and runs `work` in the child. `more_memory_bytes`: memory limit of the child in addition
  /// to the parent's size. `patience`: limit of CPU time, and of time asleep. When it is exceeded,
  /// `Read` returns false. Waiting for a CPU does not count, so that a file does not seem damaged
  /// on a busy machine.
  ChildProcess(const std::function<void(const ChildOutput&)>& work, std::size_t more_memory_bytes,
               std::chrono::milliseconds patience);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Receives exactly `size` bytes. Returns false if fewer arrive.
  bool Read(void* to, std::size_t size);

  /// Ends the child if it still runs. Returns an empty text if it exited normally, otherwise the
  /// failure, such as "crashed (Segmentation fault)" or "did not respond for 30 s".
  std::string End();

 private:
  pid_t pid_ = -1;
  int descriptor_ = -1;
  std::chrono::milliseconds patience_;
  bool stream_ended_ = false;
  std::string trouble_;
};

}  // namespace taut::trace
