/// The starts of episodes, prepared when they are first needed.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "env/episode.h"

namespace taut::env {

/// Where a thread prepares starts: one world, and the experiment that is prepared.
class Workplace {
 public:
  explicit Workplace(const Plan& plan);
  /// Nothing, and why, if there is no such start.
  std::shared_ptr<const std::vector<std::uint8_t>> Prepare(const Episode& episode,
                                                           std::string& failed);

 private:
  Batch alone_;
  std::vector<std::uint8_t> fresh_;
  ExperimentSpec experiment_;
};

/// Snapshots of starts, kept where seeds come again (`EnvironmentVariation::starts`, or a start
/// that no seed changes). Threads: any number at once, each with a workplace of its own.
class Starts {
 public:
  explicit Starts(const Plan& plan) : plan_(plan) {}

  /// `place`: the thread's, made when it is first needed.
  std::shared_ptr<const std::vector<std::uint8_t>> Of(const Episode& episode,
                                                      std::unique_ptr<Workplace>& place,
                                                      std::string& failed);

 private:
  const Plan& plan_;
  std::mutex mutex_;  ///< Guards `kept_`.
  std::map<std::uint64_t, std::shared_ptr<const std::vector<std::uint8_t>>> kept_;
};

}  // namespace taut::env
