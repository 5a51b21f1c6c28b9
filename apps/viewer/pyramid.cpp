#include "pyramid.h"

#include <algorithm>
#include <cmath>

namespace taut::viewer {

namespace {

constexpr std::size_t kFan = 4;

}  // namespace

void Pyramid::Block::Take(const Block& other) {
  min = std::min(min, other.min);
  max = std::max(max, other.max);
}

Pyramid::Block Pyramid::Row(double value) {
  if (!std::isfinite(value)) return {};
  return {value, value};
}

Pyramid::Pyramid(const std::vector<double>& column) {
  for (std::size_t size = column.size() / kFan; size > 0; size /= kFan) {
    std::vector<Block> level(size);
    for (std::size_t i = 0; i < size; ++i) {
      for (std::size_t k = i * kFan; k < (i + 1) * kFan; ++k) {
        level[i].Take(levels_.empty() ? Row(column[k]) : levels_.back()[k]);
      }
    }
    levels_.push_back(std::move(level));
  }
}

Pyramid::Block Pyramid::Range(const std::vector<double>& column, std::size_t first,
                              std::size_t last) const {
  Block range;
  while (first < last) {
    // the largest stored block that begins here and ends within the range
    std::size_t size = 1, level = 0;
    while (level < levels_.size() && first % (size * kFan) == 0 && first + size * kFan <= last) {
      size *= kFan;
      ++level;
    }
    range.Take(level == 0 ? Row(column[first]) : levels_[level - 1][first / size]);
    first += size;
  }
  return range;
}

Series Pyramid::Get(const std::vector<double>& time_s, const std::vector<double>& column, double t0,
                    double t1, std::size_t points) const {
  Series series;
  auto first =
      static_cast<std::size_t>(std::lower_bound(time_s.begin(), time_s.end(), t0) - time_s.begin());
  auto last =
      static_cast<std::size_t>(std::upper_bound(time_s.begin(), time_s.end(), t1) - time_s.begin());
  if (first > 0) --first;
  if (last < time_s.size()) ++last;
  if (first >= last) return series;
  while ((last - first + series.level - 1) / series.level > std::max<std::size_t>(points, 1)) {
    series.level *= 2;
  }
  first -= first % series.level;
  for (; first < last; first += series.level) {
    const Block block = Range(column, first, std::min(first + series.level, time_s.size()));
    const bool known = block.min <= block.max;
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    series.time_s.push_back(time_s[first]);
    series.first.push_back(column[first]);
    series.min.push_back(known ? block.min : unknown);
    series.max.push_back(known ? block.max : unknown);
  }
  return series;
}

}  // namespace taut::viewer
