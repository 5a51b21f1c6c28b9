/// Groups of channels whose names differ only in the middle, for compact tables.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "taut/compare.h"

namespace taut::compare {

struct Group {
  std::string heading;
  std::vector<std::pair<std::string, const ChannelComparison*>> rows;
  std::size_t name_width = 8;
};

/// Splits a name into heading and row. Examples: "cable/a/tension_n" is row "a" under the heading
/// "cable/*/tension_n"; "system/com_x_m" is row "com_x_m" under "system/*".
std::pair<std::string, std::string> HeadingAndRow(const std::string& name);

/// Groups channels by heading, in the order of the channels.
std::vector<Group> GroupsOf(const std::vector<ChannelComparison>& channels);

/// Returns the heading. Includes the unit if all channels have the same one.
std::string GroupTitle(const Group& group);

/// Merges names that differ only in the middle and appends their number: "cable/*/damping_n (12)".
std::vector<std::string> Abridged(const std::vector<std::string>& names);

/// Warning about angles of one trace that jump by a full turn, with its fix.
struct WrapWarning {
  std::string title, remedy;
  std::vector<std::string> channels;
};
std::vector<WrapWarning> WrapWarnings(const std::vector<WrappedAngle>& angles);

/// Returns a value with four significant digits; "-" if it is not finite.
std::string FourDigits(double value);

/// Rounds a value to zero if it prints as zero with this many decimals, to avoid "-0.000".
double Shown(double value, int decimals);

}  // namespace taut::compare
