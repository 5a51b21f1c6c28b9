/// A server on a separate thread, for the duration of a test
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <thread>
#include <utility>

#include "apps/viewer/live_session.h"
#include "apps/viewer/server.h"
#include "tests/viewer/client.h"

namespace taut::test {

inline const std::string kHang = TAUT_SOURCE_DIR "/share/experiments/hang.yaml";
inline const std::string kPush = TAUT_SOURCE_DIR "/share/experiments/push_20n.yaml";

class Serving {
 public:
  explicit Serving(std::unique_ptr<viewer::Session> session, viewer::ServerOptions options = {},
                   viewer::WebFiles files = {{"/index.html", "<p>the page"}, {"/assets/a.js", "1"}})
      : session_(std::move(session)) {
    if (options.port == 8080) options.port = 0;
    options.drive_token = kDriveToken;
    options.watch_token = kWatchToken;
    server_ = std::make_unique<viewer::Server>(*session_, std::move(files), options);
    std::string error;
    EXPECT_TRUE(server_->Listen(error)) << error;
    port_ = server_->port();
    thread_ = std::thread([this] { server_->Run(); });
  }
  ~Serving() {
    server_->Stop();
    thread_.join();
  }

  std::uint16_t port() const { return port_; }

 private:
  std::unique_ptr<viewer::Session> session_;
  std::unique_ptr<viewer::Server> server_;
  std::uint16_t port_ = 0;
  std::thread thread_;
};

/// Returns a live run of a shipped experiment.
inline std::unique_ptr<viewer::Session> Live(const std::string& path,
                                             viewer::LiveOptions options = {}) {
  Diagnostics found;
  const auto experiment = LoadExperiment(path, options.inputs.overrides, found);
  EXPECT_TRUE(experiment) << found.Format();
  options.inputs.path = path;
  auto session = viewer::LiveSession::Create("live", *experiment, options, found);
  EXPECT_TRUE(session) << found.Format();
  return session;
}

inline std::unique_ptr<viewer::Session> PausedLive(const std::string& path) {
  viewer::LiveOptions options;
  options.paused = true;
  return Live(path, options);
}

}  // namespace taut::test
