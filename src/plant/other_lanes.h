/// Backup of lanes that are not due. Kernels change the rows of all lanes; `OtherLanes` then
/// restores the lanes that must not change.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "taut/plant.h"

namespace taut::plant {

/// Preallocated memory for the backup, so that controllers allocate no memory at ticks.
class KeptRows {
 public:
  /// Reserves memory for `rows` rows with a total of `numbers` values over all lanes.
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
  /// If all lanes are due, stores nothing. Only one object at a time may use `memory`, which must
  /// outlive it.
  OtherLanes(Lanes due, int lanes, KeptRows& memory)
      : due_(due), lanes_(lanes), all_(due == AllLanes(lanes)), kept_(memory) {
    kept_.rows_.clear();
    kept_.was_.clear();
  }

  /// Returns whether there is nothing to store.
  bool none() const noexcept { return all_; }

  /// Stores `count` elements of a row, in all lanes.
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
