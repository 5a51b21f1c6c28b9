/// Rows are worked on for all lanes at once; lanes that are not due get back what they had.
#pragma once

#include <cstddef>
#include <vector>

#include "taut/plant.h"

namespace taut::plant {

class OtherLanes {
 public:
  /// Nothing is kept while all lanes are due.
  OtherLanes(Lanes due, int lanes) : due_(due), lanes_(lanes), all_(due == AllLanes(lanes)) {}

  /// Whether there is nothing to keep.
  bool none() const noexcept { return all_; }

  /// Keeps `count` elements of a row.
  void Keep(double* row, std::size_t count) {
    if (all_) return;
    const std::size_t size = count * static_cast<std::size_t>(lanes_);
    kept_.push_back({row, std::vector<double>(row, row + size)});
  }

  void PutBack() const {
    const auto lanes = static_cast<std::size_t>(lanes_);
    for (const Row& row : kept_) {
      for (std::size_t i = 0; i < row.was.size(); ++i) {
        if (!Has(due_, static_cast<int>(i % lanes))) row.at[i] = row.was[i];
      }
    }
  }

 private:
  struct Row {
    double* at;
    std::vector<double> was;
  };
  Lanes due_;
  int lanes_;
  bool all_;
  std::vector<Row> kept_;
};

}  // namespace taut::plant
