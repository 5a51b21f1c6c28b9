// docs/formats/trace.md lists every channel of the shipped experiments, with its unit
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "taut/run.h"
#include "taut/spec.h"
#include "taut/trace.h"

namespace taut {
namespace {

std::vector<std::string> SplitAt(const std::string& text, const std::string& separator) {
  std::vector<std::string> parts;
  std::size_t from = 0;
  for (std::size_t at; (at = text.find(separator, from)) != std::string::npos;) {
    parts.push_back(text.substr(from, at - from));
    from = at + separator.size();
  }
  parts.push_back(text.substr(from));
  return parts;
}

/// Row of the page: "cable/<name>/length_m" as a regular expression, and its unit.
struct PageChannel {
  std::regex name;
  std::string unit;
  std::string text;
};

/// `body/<name>/position_{x,y,z}_m` becomes body/[^/]+/position_(x|y|z)_m.
std::string PatternOf(std::string text) {
  text = std::regex_replace(text, std::regex("<[^>]*>"), "[^/]+");
  std::string pattern;
  bool in_braces = false;
  for (const char c : text) {
    in_braces = c == '{' || (in_braces && c != '}');
    pattern += c == '{' ? '(' : c == '}' ? ')' : c == ',' && in_braces ? '|' : c;
  }
  return pattern;
}

std::vector<PageChannel> PageChannels() {
  std::vector<PageChannel> channels;
  std::ifstream page(TAUT_SOURCE_DIR "/docs/formats/trace.md");
  const std::regex code("`([^`]*)`");
  for (std::string line; std::getline(page, line);) {
    if (line.rfind("| `", 0) != 0) continue;
    const std::vector<std::string> cells = SplitAt(line, " | ");
    const std::vector<std::string> units = SplitAt(cells.at(1), ", ");
    std::string folder;
    std::size_t i = 0;
    for (std::sregex_iterator it(cells[0].begin(), cells[0].end(), code), end; it != end; ++it) {
      std::string name = (*it)[1];
      const std::size_t slash = name.rfind('/');
      if (slash == std::string::npos) {
        name = folder + name;
      } else {
        folder = name.substr(0, slash + 1);
      }
      const std::string& unit = units.size() == 1 ? units[0] : units.at(i);
      channels.push_back({std::regex(PatternOf(name)), unit, name});
      ++i;
    }
  }
  return channels;
}

TEST(TraceChannelsPage, HasEveryChannelOfShippedExperiments) {
  const std::vector<PageChannel> page = PageChannels();
  ASSERT_GT(page.size(), 40u);
  std::set<std::string> seen;
  for (const auto& file :
       std::filesystem::directory_iterator(TAUT_SOURCE_DIR "/share/experiments")) {
    if (file.path().extension() != ".yaml") continue;
    Diagnostics out;
    auto experiment = LoadExperiment(file.path().string(), {}, out);
    ASSERT_TRUE(experiment) << out.Format();
    experiment->record.channels = {"*"};
    experiment->record.contacts = 2;
    for (const ChannelInfo& channel : RunChannels(*experiment)) {
      bool found = false;
      for (const PageChannel& row : page) {
        if (!std::regex_match(channel.name, row.name)) continue;
        found = true;
        seen.insert(row.text);
        EXPECT_EQ(channel.unit, row.unit) << channel.name;
        break;
      }
      ASSERT_TRUE(found) << channel.name << " of " << file.path() << " is not on the page";
    }
  }
  EXPECT_GT(seen.size(), 40u);
}

}  // namespace
}  // namespace taut
