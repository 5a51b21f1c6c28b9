/// Reader of the virtual robot's true pose (docs/formats/truth.md). Never blocks; reconnects after
/// the connection is lost. Not thread-safe.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "frame.h"

namespace taut::viewer {

class TruthReader {
 public:
  /// `path`: path of the socket. `bodies`: number of bodies of the model.
  TruthReader(std::string path, std::size_t bodies);
  ~TruthReader();
  TruthReader(const TruthReader&) = delete;
  TruthReader& operator=(const TruthReader&) = delete;

  /// Returns the bodies of the last complete line; null before the first, and after the connection
  /// is lost.
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
