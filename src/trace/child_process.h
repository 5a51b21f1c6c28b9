/// Forked child process that isolates a library that may crash and sends its result through a pipe.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <functional>
#include <string>

namespace taut::trace {

/// Limit of processor time for a child that reads an HDF5 file.
inline constexpr std::chrono::seconds kChildPatience{30};

/// The child's end of the pipe. Ends the child when the parent has ended.
class ChildOutput {
 public:
  explicit ChildOutput(int descriptor) : descriptor_(descriptor) {}
  void Write(const void* data, std::size_t size) const;

 private:
  int descriptor_;
};

/// The parent survives any failure of the child: a crash, a hang, unbounded memory.
class ChildProcess {
 public:
  /// Forks and runs `work` in the child, which ends with it. `more_memory_bytes`: memory limit of
  /// the child beyond the parent's size. `patience`: limit of CPU time, and of sleep, after which
  /// `Read` gives up without bytes. Time spent waiting for a CPU does not count, so that a busy
  /// machine does not look like a damaged file.
  ChildProcess(const std::function<void(const ChildOutput&)>& work, std::size_t more_memory_bytes,
               std::chrono::milliseconds patience);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Receives exactly `size` bytes. Returns false if they do not arrive.
  bool Read(void* to, std::size_t size);

  /// Ends the child if it still runs. Returns an empty string if it exited normally, else the
  /// failure: "crashed (Segmentation fault)", "used 30 s of processor time without a result", "did
  /// not respond for 30 s".
  std::string End();

 private:
  pid_t pid_ = -1;
  int descriptor_ = -1;
  std::chrono::milliseconds patience_;
  bool stream_ended_ = false;
  std::string trouble_;
};

}  // namespace taut::trace
