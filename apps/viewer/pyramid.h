/// A channel at many resolutions, so that a plot of any span costs what its points cost.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

namespace taut::viewer {

/// Blocks of `level` rows each; see SeriesData in web/protocol/messages.json.
struct Series {
  std::size_t level = 1;
  std::vector<double> time_s, first;  ///< Of each block's first row.
  std::vector<double> min, max;
};

/// Least and greatest of blocks of 4, 16, 64, ... rows of one column. The column itself stays where
/// it is. Rows that are not numbers do not count; a block of such rows is NaN.
class Pyramid {
 public:
  explicit Pyramid(const std::vector<double>& column);

  /// The rows with times within t0 .. t1 and one beyond each end, in blocks that begin at
  /// multiples of their size: at most `points` + 2 of them. `time_s` and `column` are those of the
  /// trace.
  Series Get(const std::vector<double>& time_s, const std::vector<double>& column, double t0,
             double t1, std::size_t points) const;

 private:
  struct Block {
    double min = std::numeric_limits<double>::infinity(), max = -min;  ///< Of nothing.
    void Take(const Block& other);
  };
  static Block Row(double value);
  /// Rows first .. last - 1.
  Block Range(const std::vector<double>& column, std::size_t first, std::size_t last) const;

  std::vector<std::vector<Block>> levels_;
};

}  // namespace taut::viewer
