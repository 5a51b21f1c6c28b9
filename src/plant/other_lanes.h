/// Backup of lanes that are not due: kernels change rows of all lanes at once, and `OtherLanes`
/// restores the lanes that must not change.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "taut/plant.h"

namespace taut::plant {

/// Preallocated memory for the backup, so that controllers allocate nothing while they act.
class KeptRows {
 public:
  /// Reserves space for `rows` rows with `numbers` numbers in total, in all lanes.
  void Reserve(std::size_t rows, std::size_t numbers) {
    rows_.reserve(rows);
    was_.reserve(numbers);
  }

 private:
  friend class OtherLanes;
  struct Row {
    double* at;
    std::size_t size;
  };
  std::vector<Row> rows_;
  std::vector<double> was_;  ///< All rows, one after the other.
};

class OtherLanes {
 public:
  /// Keeps nothing if all lanes are due. Only one object at a time may use a `memory`, which must
  /// outlive it.
  OtherLanes(Lanes due, int lanes, KeptRows& memory)
      : due_(due), lanes_(lanes), all_(due == AllLanes(lanes)), kept_(memory) {
    kept_.rows_.clear();
    kept_.was_.clear();
  }

  /// Returns true if there is nothing to keep.
  bool none() const noexcept { return all_; }

  /// Keeps `count` elements of a row.
  void Keep(double* row, std::size_t count) {
    if (all_) return;
    const std::size_t size = count * static_cast<std::size_t>(lanes_);
    kept_.rows_.push_back({row, size});
    kept_.was_.insert(kept_.was_.end(), row, row + size);
  }

  void PutBack() const {
    const auto lanes = static_cast<std::size_t>(lanes_);
    const double* was = kept_.was_.data();
    for (const KeptRows::Row& row : kept_.rows_) {
      for (std::size_t i = 0; i < row.size; ++i) {
        if (!Has(due_, static_cast<int>(i % lanes))) row.at[i] = was[i];
      }
      was += row.size;
    }
  }

 private:
  Lanes due_;
  int lanes_;
  bool all_;
  KeptRows& kept_;
};

}  // namespace taut::plant
