/// Groups of equal members in summaries: cables with the same tags share one line.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "taut/spec.h"

namespace taut::cli {

/// Cables that share a line of a summary.
struct CableGroup {
  std::string name;                 ///< "3 cables side", or "cable lower_1" for a single one.
  std::vector<std::size_t> cables;  ///< Indices of the cables, ascending.
};

/// Groups the cables by their tags, except tags that are names of single cables. More than `most`
/// groups are replaced by groups of equal first tags, or else by one group. Groups are in the order
/// of the cables.
std::vector<CableGroup> GroupCables(const RobotSpec& robot, std::size_t most);

/// Range of a quantity over a group.
struct Range {
  double low = INFINITY, high = -INFINITY;

  void Add(double value) { low = std::min(low, value), high = std::max(high, value); }
  bool empty() const { return low > high; }
  /// Returns "20.000 N" if both ends are printed alike, else "10.000 to 20.000 N".
  std::string Text(int digits, const std::string& unit) const;
};

/// Returns the range of `quantity(index)` over the cables of a group.
template <class Quantity>
Range RangeOver(const CableGroup& group, const Quantity& quantity) {
  Range range;
  for (const std::size_t cable : group.cables) range.Add(quantity(cable));
  return range;
}

/// Returns "1 cable", "3 cables", "2 boxes", "2 bodies".
std::string Counted(long long count, const std::string& one);

/// Lines of a summary: at most ten with the verdict; further lines are only counted.
class CappedLines {
 public:
  static constexpr std::size_t kMost = 9, kAll = std::numeric_limits<std::size_t>::max();

  /// `most`: number of lines besides the verdict.
  explicit CappedLines(std::size_t most = kMost) : most_(most) {}
  /// Takes all lines but the first, which is the verdict.
  explicit CappedLines(const std::vector<std::string>& all) : lines_(all.begin() + 1, all.end()) {}

  /// Adds an indented line; an empty text adds none.
  void Add(const std::string& line);
  /// Returns the verdict and the lines, as printable text with line ends.
  std::string Text(const std::string& verdict) const;

 private:
  std::vector<std::string> lines_;
  std::size_t most_ = kMost;
};

}  // namespace taut::cli
