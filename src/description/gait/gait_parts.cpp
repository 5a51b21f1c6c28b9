#include "description/gait/gait_parts.h"

#include <algorithm>

#include "base/number_text.h"

namespace taut::description {
namespace {

std::string Written(const CableMatch& match) {
  std::string out;
  for (const auto& set : match) {
    std::string one;
    for (const std::string& tag : set) one += (one.empty() ? "" : ", ") + tag;
    out += (out.empty() ? "[" : " or [") + one + "]";
  }
  return out;
}

}  // namespace

bool ToNumber(const std::string& text, double& number) {
  const char* end = text.data() + text.size();
  const auto [stop, status] = base::FromChars(text.data(), end, number);
  return status == std::errc() && stop == end && number - number == 0.0;  // finite
}

const char* UnitOfName(GaitDrives drives) {
  return drives == GaitDrives::kVelocity ? "_m_per_s" : "_m";
}

const char* WhoDrives(GaitDrives drives) {
  return drives == GaitDrives::kVelocity ? "a gait that drives velocities"
                                         : "a gait that drives rest lengths";
}

std::vector<int> FindCables(const CableMatch& match, const std::string& what, const SourceRef& at,
                            const RobotSpec& robot, Diagnostics& out) {
  std::vector<int> cables;
  std::vector<std::string> words;
  for (std::size_t c = 0; c < robot.cable_tags.size(); ++c) {
    const Tags& tags = robot.cable_tags[c];
    if (Matches(match, tags)) cables.push_back(static_cast<int>(c));
    words.insert(words.end(), tags.begin(), tags.end());
  }
  if (!cables.empty()) return cables;
  std::sort(words.begin(), words.end());
  words.erase(std::unique(words.begin(), words.end()), words.end());
  std::string hint = "no cable of " + robot.def.name + " has all of these tags";
  for (const auto& set : match) {
    for (const std::string& word : set) {
      if (std::binary_search(words.begin(), words.end(), word)) continue;
      hint = "no cable of " + robot.def.name + " is called or tagged \"" + word + "\"; " +
             NameHint(word, words);
    }
  }
  out.Error("gait.matches_no_cable", at, what + ": no cable matches " + Written(match), hint);
  return cables;
}

}  // namespace taut::description
