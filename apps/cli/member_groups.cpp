#include "member_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>

#include "table.h"
#include "taut/diagnostics.h"

namespace taut::cli {
namespace {

/// Returns whether a tag only distinguishes copies of a part: first, middle, last or a number.
bool IsPosition(const std::string& tag) {
  return tag == "first" || tag == "middle" || tag == "last" ||
         std::all_of(tag.begin(), tag.end(), [](char c) { return c >= '0' && c <= '9'; });
}

class Grouping {
 public:
  explicit Grouping(const RobotSpec& robot) : robot_(robot) {
    for (const Tags& tags : robot.cable_tags) {
      for (const std::string& tag : tags) ++uses_[tag];
    }
  }

  /// Groups cables that have the same first `most` tags in common.
  std::vector<CableGroup> ByTags(std::size_t most) const {
    std::vector<CableGroup> groups;
    std::map<Tags, std::size_t> places;
    for (std::size_t c = 0; c < robot_.def.cables.size(); ++c) {
      const auto [place, fresh] = places.emplace(SharedTags(c, most), groups.size());
      if (fresh) groups.emplace_back();
      groups[place->second].cables.push_back(c);
    }
    for (const auto& [tags, place] : places) NameGroup(tags, groups[place]);
    return groups;
  }

 private:
  Tags SharedTags(std::size_t cable, std::size_t most) const {
    Tags shared;
    if (cable >= robot_.cable_tags.size()) return shared;
    for (const std::string& tag : robot_.cable_tags[cable]) {
      if (shared.size() < most && uses_.at(tag) > 1 && !IsPosition(tag)) shared.push_back(tag);
    }
    return shared;
  }

  /// Names a group by one tag if only its cables have it, else by all their common tags.
  void NameGroup(const Tags& tags, CableGroup& group) const {
    const std::size_t count = group.cables.size();
    if (count == 1) {
      group.name = "cable " + Printable(robot_.def.cables[group.cables.front()].name);
      return;
    }
    const auto own = std::find_if(tags.begin(), tags.end(),
                                  [&](const std::string& tag) { return uses_.at(tag) == count; });
    group.name = fmt::format("{} cables", count);
    if (own != tags.end()) {
      group.name += " " + Printable(*own);
    } else if (!tags.empty()) {
      group.name += " " + Printable(fmt::format("{}", fmt::join(tags, " ")));
    }
  }

  const RobotSpec& robot_;
  std::map<std::string, std::size_t> uses_;
};

}  // namespace

std::vector<CableGroup> GroupCables(const RobotSpec& robot, std::size_t most) {
  const Grouping grouping(robot);
  constexpr std::size_t kAllTags = std::numeric_limits<std::size_t>::max();
  for (const std::size_t tags : {kAllTags, std::size_t{1}}) {
    auto groups = grouping.ByTags(tags);
    if (groups.size() <= most) return groups;
  }
  return grouping.ByTags(0);
}

std::string Range::Text(int digits, const std::string& unit) const {
  const std::string from = Fixed(low, digits), to = Fixed(high, digits);
  return from == to ? from + " " + unit : from + " to " + to + " " + unit;
}

std::string Counted(long long count, const std::string& one) {
  if (count == 1) return "1 " + one;
  if (one.ends_with("dy")) return fmt::format("{} {}ies", count, one.substr(0, one.size() - 1));
  return fmt::format("{} {}{}", count, one, one.ends_with("sh") || one.ends_with("x") ? "es" : "s");
}

void CappedLines::Add(const std::string& line) {
  if (!line.empty()) lines_.push_back(line);
}

std::string CappedLines::Text(const std::string& verdict) const {
  const std::size_t shown = lines_.size() <= most_ ? lines_.size() : most_ - 1;
  std::string text = Printable(verdict) + "\n";
  for (std::size_t i = 0; i < shown; ++i) text += "  " + Printable(lines_[i]) + "\n";
  if (shown < lines_.size()) {
    text +=
        fmt::format("  ... and {} more lines; --tables lists everything\n", lines_.size() - shown);
  }
  return text;
}

}  // namespace taut::cli
