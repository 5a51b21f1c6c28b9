/// Cache of episode starts, prepared when they are first needed.
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

/// Workspace of a thread for preparing starts: one world, and its experiment.
class Workplace {
 public:
  explicit Workplace(const Plan& plan);
  /// Returns the snapshot of a start; nothing, with the reason in `failed`, if it does not exist.
  std::shared_ptr<const std::vector<std::uint8_t>> Prepare(const Episode& episode,
                                                           std::string& failed);

 private:
  plant::StartFinder finder_;
  ExperimentSpec experiment_;
};

/// Snapshots of starts, kept if seeds recur (`EnvironmentVariation::starts`, or starts independent
/// of the seed). Thread-safe, with one workspace per thread.
class Starts {
 public:
  explicit Starts(const Plan& plan) : plan_(plan) {}

  /// `place`: the thread's workspace, created when needed.
  std::shared_ptr<const std::vector<std::uint8_t>> Of(const Episode& episode,
                                                      std::unique_ptr<Workplace>& place,
                                                      std::string& failed);

 private:
  const Plan& plan_;
  std::mutex mutex_;  ///< Guards `kept_`.
  std::map<std::uint64_t, std::shared_ptr<const std::vector<std::uint8_t>>> kept_;
};

}  // namespace taut::env
