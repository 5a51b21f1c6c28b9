/// Where the virtual robot says that it is (docs/formats/truth.md). Never waits: what has come is
/// read, and a reader that lost its robot tries again.
///
/// Threads: belongs to one at a time.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "frame.h"

namespace taut::viewer {

class TruthReader {
 public:
  /// `path`: of the socket. `bodies`: as many as the model has.
  TruthReader(std::string path, std::size_t bodies);
  ~TruthReader();
  TruthReader(const TruthReader&) = delete;
  TruthReader& operator=(const TruthReader&) = delete;

  /// The bodies of the last whole line; nothing before the first, and once nobody speaks.
  const std::vector<Frame::Body>* Read();

 private:
  using Clock = std::chrono::steady_clock;
  void Connect();
  void Leave();
  void TakeLine(const std::string& line);

  std::string path_, rest_;
  std::size_t bodies_;
  int socket_ = -1;
  Clock::time_point retry_;
  std::optional<std::vector<Frame::Body>> pose_;
};

}  // namespace taut::viewer
