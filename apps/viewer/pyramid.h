/// Minimum-maximum pyramid of a channel, so that the cost of a plot depends on its number of points
/// only, not on the time span.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

namespace taut::viewer {

/// Blocks of `level` rows each; see SeriesData in web/protocol/messages.json.
struct Series {
  std::size_t level = 1;
  std::vector<double> time_s, first;  ///< Times and values of the blocks' first rows.
  std::vector<double> min, max;
};

/// Minima and maxima of blocks of 4, 16, 64, ... rows of a column. Does not copy the column. Rows
/// that are NaN do not count; a block of such rows is NaN.
class Pyramid {
 public:
  explicit Pyramid(const std::vector<double>& column);

  /// Returns the rows with times within t0 to t1 and one beyond each end, in blocks that begin at
  /// multiples of their size: at most `points` + 2 blocks. `time_s` and `column` must be the
  /// trace's columns.
  Series Get(const std::vector<double>& time_s, const std::vector<double>& column, double t0,
             double t1, std::size_t points) const;

 private:
  struct Block {
    double min = std::numeric_limits<double>::infinity(), max = -min;  ///< Initial values for an
                                                                       ///< empty block.
    void Take(const Block& other);
  };
  static Block Row(double value);
  /// Returns the block of rows first to last - 1.
  Block Range(const std::vector<double>& column, std::size_t first, std::size_t last) const;

  std::vector<std::vector<Block>> levels_;
};

}  // namespace taut::viewer
