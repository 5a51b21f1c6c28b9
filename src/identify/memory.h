/// The points that a fit has computed, on the disk: killed at any moment, it goes on from there.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "learn/sqlite.h"
#include "taut/diagnostics.h"
#include "taut/fit.h"

namespace taut::identify {

/// One thread at a time. Without a file it remembers for as long as it lives.
class PointMemory {
 public:
  PointMemory() = default;
  /// `facts`: what makes points the same; a file that says another of them is another fit's. Null
  /// and a complaint if that is so, or if the file cannot be read or written, or holds points
  /// without facts. Points that were computed under other facts count as damaged.
  static std::unique_ptr<PointMemory> Open(const std::string& path,
                                           const std::map<std::string, std::string>& facts,
                                           Diagnostics& out);

  /// The bits of numbers, after what they are of.
  static std::string Key(const std::string& problem, const std::vector<double>& values);

  const Residuals* Find(const std::string& key) const;
  /// Adds all, to the file at once or not at all. False if that cannot be written; see `error`.
  bool Add(const std::vector<std::pair<std::string, Residuals>>& points);

  const std::string& error() const { return error_; }
  std::int64_t remembered() const { return remembered_; }
  std::int64_t damaged() const { return damaged_; }

 private:
  bool Begin(const std::string& path, const std::map<std::string, std::string>& facts,
             Diagnostics& out);
  bool WriteFacts(const std::map<std::string, std::string>& facts);
  bool ReadPoints();

  std::unique_ptr<learn::Database> database_;
  std::map<std::string, Residuals> points_;
  std::string facts_sum_;  ///< Part of the checksum of every point.
  std::string error_;
  std::int64_t remembered_ = 0, damaged_ = 0;
};

}  // namespace taut::identify
