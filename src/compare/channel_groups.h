/// Channels whose names differ only in the middle, as one group of a comparison's text.
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

/// Splits a name: "cable/a/tension_n" is row "a" under heading "cable/*/tension_n";
/// "system/com_x_m" has no middle and is row "com_x_m" under "system/*".
std::pair<std::string, std::string> HeadingAndRow(const std::string& name);

/// Groups channels by heading, in the order of the channels.
std::vector<Group> GroupsOf(const std::vector<ChannelComparison>& channels);

/// Returns the heading, with the unit if all channels have the same.
std::string GroupTitle(const Group& group);

/// Merges names that differ in the middle only, with their number: "cable/*/damping_n (12)".
std::vector<std::string> Abridged(const std::vector<std::string>& names);

/// Angles of one trace that jump by a turn: a warning about `channels`, and its remedy.
struct WrapWarning {
  std::string title, remedy;
  std::vector<std::string> channels;
};
std::vector<WrapWarning> WrapWarnings(const std::vector<WrappedAngle>& angles);

/// Returns the value, without a sign if that many decimals show a zero: no "-0.000".
double Shown(double value, int decimals);

}  // namespace taut::compare
