/// Persistent cache of the points that a fit has computed (SQLite), so that a killed fit resumes
/// there.
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

/// Cache of points; not thread-safe. Without a file it exists in memory only.
class PointMemory {
 public:
  PointMemory() = default;
  /// Opens the file. `facts` identify the fit: a file with other facts belongs to another fit.
  /// Returns null with errors in that case, or if the file cannot be read or written, or contains
  /// points without facts. Points that were computed under other facts count as damaged.
  static std::unique_ptr<PointMemory> Open(const std::string& path,
                                           const std::map<std::string, std::string>& facts,
                                           Diagnostics& out);

  /// Returns the key of a point: the problem's name and the bits of its values.
  static std::string Key(const std::string& problem, const std::vector<double>& values);

  const Residuals* Find(const std::string& key) const;
  /// Adds all points to the file in one transaction. Returns false if writing fails; see `error`.
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
