/// Limit of the number of values in all tables of one input. It is a common limit, since several
/// files below a limit per file could exceed the memory.
#pragma once

#include <string>

#include "base/brief.h"
#include "trace/unpack_limit.h"

namespace taut::trace {

class TableBudget {
 public:
  /// `most`: limit of the number of values in all tables.
  explicit TableBudget(double most) : most_(most) {}

  double most() const noexcept { return most_; }
  double left() const noexcept { return most_ - count_; }
  /// Returns the end of an error message about a table that exceeds `left`: ", more than 1e+08".
  std::string MoreThan() const {
    return (count_ > 0 ? " and the other height fields " + base::Brief(count_) + ", together"
                       : std::string(",")) +
           " more than " + base::Brief(most_);
  }

  /// Returns whether the budget permits a packed file to unpack to this many bytes.
  bool Unpacks(double bytes, double file_bytes) const noexcept {
    return unpacked_bytes_ + bytes <= MostUnpackedBytes(file_bytes_ + file_bytes);
  }
  /// Returns the end of an error message about a file for which `Unpacks` returns false.
  std::string UnpackedMoreThan() const {
    return kUnpackLimit + std::string(unpacked_bytes_ > 0 ? ", with the other files" : "");
  }

  void Add(double count) noexcept { count_ += count; }
  void AddPacked(double count, double file_bytes) noexcept {
    Add(count);
    unpacked_bytes_ += sizeof(double) * count;
    file_bytes_ += file_bytes;
  }

 private:
  double most_, count_ = 0;
  double file_bytes_ = 0, unpacked_bytes_ = 0;  ///< Sizes of packed files.
};

}  // namespace taut::trace
