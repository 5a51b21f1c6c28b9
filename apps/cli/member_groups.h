/// Groups of equal members in summaries: cables with the same tags share one line.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "taut/spec.h"

namespace taut::cli {

/// Cables that share a line of a summary.
struct CableGroup {
  std::string name;                 ///< "3 cables side", or "cable lower_1" for a single one.
  std::vector<std::size_t> cables;  ///< Indices, ascending.
};

/// Groups the cables by their tags, without tags that are names of single cables. If this gives
/// more than `most` groups, groups them by their first tag, and then all together. In the order of
/// the cables.
std::vector<CableGroup> GroupCables(const RobotSpec& robot, std::size_t most);

/// Formats the range of a quantity: "20.000 N" if both ends are printed alike, else "10.000 to
/// 20.000 N".
std::string RangeText(double min, double max, int digits, const std::string& unit);

/// Returns "1 cable", "3 cables".
std::string Counted(long long count, const std::string& one);

/// Lines of a summary, at most ten including the verdict; further ones are counted.
class CappedLines {
 public:
  /// Adds a line, which is indented. Empty text adds none.
  void Add(const std::string& line);
  std::string Text() const;

 private:
  std::vector<std::string> lines_;
};

}  // namespace taut::cli
