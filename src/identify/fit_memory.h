/// Persistent cache of computed points of a fit (SQLite), to resume a fit after the process was
/// killed.
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

/// Cache of points. Not thread-safe. Without a file, it is in memory only.
class PointMemory {
 public:
  PointMemory() = default;
  /// Opens the file. `facts` identify the fit. Returns null with errors if the file has other
  /// facts, has points without facts, or cannot be read or written. Points that were computed under
  /// other facts count as damaged.
  static std::unique_ptr<PointMemory> Open(const std::string& path,
                                           const std::map<std::string, std::string>& facts,
                                           Diagnostics& out);

  /// Returns the key of a point: the problem's name and the binary values.
  static std::string Key(const std::string& problem, const std::vector<double>& values);

  const Residuals* Find(const std::string& key) const;
  /// Adds points to the file in one transaction. Returns false if writing fails; see `error`.
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
  std::string facts_sum_;  ///< Checksum of the facts, which is part of every point's checksum.
  std::string error_;
  std::int64_t remembered_ = 0, damaged_ = 0;
};

}  // namespace taut::identify
