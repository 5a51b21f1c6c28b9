// A page of a program, and a browser client
#pragma once

#include <filesystem>
#include <fstream>

#include "taut/page.h"
#include "taut/spec.h"
#include "tests/viewer/client.h"

namespace taut::test {

/// Returns a prism above a plane.
inline ModelDef Prism() {
  Diagnostics found;
  auto robot = LoadRobot(TAUT_SOURCE_DIR "/share/models/prism3.yaml", {}, found);
  EXPECT_TRUE(robot) << found.Format();
  robot->def.planes.emplace_back().name = "ground";
  return robot->def;
}

class PageTest : public testing::Test {
 protected:
  PageTest() {
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ + "/index.html") << "<p>the page";
    options_.web_folder = folder_;
    options_.speed = 0;
  }

  std::unique_ptr<Page> Open() {
    Diagnostics out;
    auto page = Page::Open(options_, out);
    EXPECT_TRUE(page) << out.Format();
    return page;
  }

  static std::uint16_t Port(const Page& page) {
    const std::size_t colon = page.url().rfind(':');
    return static_cast<std::uint16_t>(std::stoi(page.url().substr(colon + 1)));
  }
  /// Connects a browser client to an address.
  static Client Browser(const Page& page, const std::string& url) {
    return Client(Port(page), "/ws?token=" + url.substr(url.rfind('=') + 1));
  }

  const std::string folder_ = testing::TempDir() + "taut_page_test";
  PageOptions options_;
};

inline bool HasTime(const ReceivedFrame& frame, double time_s) {
  return frame[viewer::FrameHeader::kFrameTimeS] == time_s &&
         frame[viewer::FrameHeader::kFrameRun] > 0;
}

inline std::vector<std::string> Names(const Json& list) {
  std::vector<std::string> names;
  for (const Json& part : list) names.push_back(part["name"]);
  return names;
}

}  // namespace taut::test
