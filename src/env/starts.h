/// Cache of episode starts, filled on demand.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "env/episode.h"
#include "plant/start_finder.h"

namespace taut::env {

/// Workspace of a thread to prepare starts: one world and its experiment.
class Workplace {
 public:
  explicit Workplace(const Plan& plan);
  /// Returns the snapshot of a start. Returns nothing and sets `failed` if there is no such start.
  std::shared_ptr<const std::vector<std::uint8_t>> Prepare(const Episode& episode,
                                                           std::string& failed);

 private:
  plant::StartFinder finder_;
  ExperimentSpec experiment_;
};

/// Snapshots of starts. They are cached if seeds recur (`EnvironmentVariation::starts`) or if
/// starts do not depend on the seed. Thread-safe if each thread has its workspace.
class Starts {
 public:
  explicit Starts(const Plan& plan) : plan_(plan) {}

  /// `place`: workspace of the thread, created on demand.
  std::shared_ptr<const std::vector<std::uint8_t>> Of(const Episode& episode,
                                                      std::unique_ptr<Workplace>& place,
                                                      std::string& failed);

 private:
  const Plan& plan_;
  std::mutex mutex_;  ///< Guards `kept_`.
  std::map<std::uint64_t, std::shared_ptr<const std::vector<std::uint8_t>>> kept_;
};

}  // namespace taut::env
