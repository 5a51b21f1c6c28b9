// The pseudo-terminal, from the side of a program that uses it as a serial port. No test depends on
// time, because test machines are slow and busy.
#include "apps/virtual_robot/pty.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <thread>

#include "apps/virtual_robot/paced.h"
#include "tests/virtual_robot/probe_fixture.h"

namespace taut::virtual_robot {
namespace {

namespace fs = std::filesystem;

constexpr int kPatience_ms = 20'000;

/// Client side of a port
class Client {
 public:
  explicit Client(const std::string& path) : port_(open(path.c_str(), O_RDWR | O_NOCTTY)) {}
  ~Client() {
    if (port_ >= 0) close(port_);
  }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;
  bool good() const { return port_ >= 0; }
  void Write(const Bytes& bytes) const {
    const ssize_t written = write(port_, bytes.data(), bytes.size());
    EXPECT_TRUE(written == static_cast<ssize_t>(bytes.size()) || (written < 0 && errno == EIO))
        << "a port that is gone may refuse";
  }
  /// Reads `count` bytes; fewer if the port is gone or the time limit is reached.
  Bytes Read(std::size_t count) const {
    Bytes bytes;
    pollfd wanted{port_, POLLIN, 0};
    while (bytes.size() < count && poll(&wanted, 1, kPatience_ms) > 0) {
      std::uint8_t more[64];
      const ssize_t got = read(port_, more, std::min(sizeof more, count - bytes.size()));
      if (got <= 0) break;
      bytes.insert(bytes.end(), more, more + got);
    }
    return bytes;
  }

 private:
  int port_;
};

class Folder {
 public:
  Folder() {
    std::string name = (fs::temp_directory_path() / "taut_pty_XXXXXX").string();
    EXPECT_NE(mkdtemp(name.data()), nullptr);
    path = name;
  }
  ~Folder() { fs::remove_all(path); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  fs::path path;
};

/// A robot in real time on a separate thread
class Running {
 public:
  Running(Plant& plant, const RobotOptions& options, const std::string& link)
      : thread_([this, &plant, options, link] {
          Robot robot(plant, options);
          PacedOptions paced;
          paced.link = link;
          paced.on_path = [this](const std::string&) { ++opened; };
          Diagnostics found;
          EXPECT_TRUE(RunPaced(robot, paced, stop_, found)) << found.Format();
        }) {}
  ~Running() {
    stop_ = true;
    thread_.join();
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;
  std::atomic<int> opened{0};

 private:
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// Waits for an effect of another thread.
template <class F>
bool Comes(F&& that) {
  for (int ms = 0; ms < kPatience_ms; ++ms) {
    if (that()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

TEST(Pty, CarriesAllBytesBothWays) {
  Diagnostics found;
  const auto pty = Pty::Open("", found);
  ASSERT_TRUE(pty) << found.Format();
  Client client(pty->path());
  ASSERT_TRUE(client.good());
  Bytes all;
  for (int i = 0; i < 256; ++i) all.push_back(static_cast<std::uint8_t>(i));
  client.Write(all);
  ASSERT_TRUE(pty->Wait(0.9));
  EXPECT_EQ(pty->Read(), all) << "no byte means anything to the terminal";
  pty->Write(all);
  EXPECT_EQ(client.Read(256), all);
  EXPECT_FALSE(pty->Wait(0.0));
  EXPECT_TRUE(pty->Read().empty());
}

TEST(Pty, ALinkLeadsToItWhileItIsThere) {
  const Folder folder;
  const std::string link = folder.path / "robot";
  fs::create_symlink("/nowhere", link);
  Diagnostics found;
  {
    const auto pty = Pty::Open(link, found);
    ASSERT_TRUE(pty) << found.Format();
    EXPECT_EQ(fs::read_symlink(link), pty->path());
  }
  EXPECT_FALSE(fs::exists(fs::symlink_status(link)));
}

TEST(Pty, NothingButALinkIsReplaced) {
  const Folder folder;
  const std::string place = folder.path / "precious";
  std::ofstream(place) << "data";
  Diagnostics found;
  EXPECT_FALSE(Pty::Open(place, found));
  EXPECT_NE(found.Format().find("the path exists and is not a symbolic link"), std::string::npos);
  EXPECT_EQ(fs::file_size(place), 4U);
  EXPECT_FALSE(Pty::Open(folder.path / "no" / "such" / "folder", found));
}

// Exchanges frames before and after the adapter is disconnected at `loss_s`. Returns false if the
// disconnection came too early for a client on a busy machine.
bool TalksUntil(double loss_s) {
  const Folder folder;
  const std::string link = folder.path / "robot";
  SpringPlant plant(2);
  RobotOptions options;
  options.program = ProbeProgram();
  options.faults = {{.kind = FaultKind::kUsbLoss, .at_s = loss_s, .for_s = 0.05}};
  auto running = std::make_unique<Running>(plant, options, link);
  EXPECT_TRUE(Comes([&] { return running->opened >= 1; }));
  const auto ask = [&](const Client& client, const Bytes& frame, std::size_t count) {
    client.Write(frame);
    return client.Read(count);
  };
  {
    Client client(link);
    if (!client.good()) return false;
    const Bytes version = ask(client, {0x5A, 0x01}, 3),
                mode = ask(client, {0x5A, 0x02, 0x70, 0x04}, 2),
                board = ask(client, {0x58, 0x20}, 1);
    if (running->opened > 1 || board.empty()) return false;
    EXPECT_EQ(version, (Bytes{0x07, 8, 0x40}));
    EXPECT_EQ(mode, (Bytes{0xFF, 0x00}));
    EXPECT_EQ(board, Bytes{0xFF}) << "board 0 is there";
    EXPECT_EQ(client.Read(1), Bytes{}) << "the port is gone";
  }
  EXPECT_TRUE(Comes([&] { return running->opened == 2; }));
  {
    Client client(link);
    EXPECT_TRUE(client.good());
    EXPECT_EQ(ask(client, {0x5A, 0x01}, 3), (Bytes{0x07, 8, 0x40})) << "it has forgotten its mode";
  }
  running.reset();
  EXPECT_FALSE(fs::exists(fs::symlink_status(link)));
  return true;
}

TEST(Paced, AClientTalksToTheAdapterAndIsCutOffWithIt) {
  EXPECT_TRUE(TalksUntil(0.5) || TalksUntil(2) || TalksUntil(8) || TalksUntil(30));
}

}  // namespace
}  // namespace taut::virtual_robot
