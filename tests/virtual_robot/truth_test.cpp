// True states of the virtual robot on a socket, and the command as a child process of a program
// that reads them. No test depends on time, because test machines are slow and busy.
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <memory>
#include <utility>

#include "apps/virtual_robot/truth_server.h"
#include "taut/spec.h"
#include "tests/virtual_robot/command_fixture.h"

namespace taut::virtual_robot {
namespace {

constexpr int kPatience_s = 20;

const char* const kHeader = R"({"format":"taut_truth","version":1,"name":"tetraspine3",)"
                            R"("bodies":["segment_0","segment_1","segment_2"],)"
                            R"("cables":["outer_right_1","outer_left_1","outer_top_1",)"
                            R"("inner_right_1","inner_left_1","inner_top_1",)"
                            R"("outer_right_2","outer_left_2","outer_top_2",)"
                            R"("inner_right_2","inner_left_2","inner_top_2"]})";

/// A client of the socket
class Watcher {
 public:
  explicit Watcher(const std::string& path) : socket_(socket(AF_UNIX, SOCK_STREAM, 0)) {
    const sockaddr_un address = Address(path);
    const timeval patience{kPatience_s, 0};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    good_ = connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  }
  ~Watcher() { close(socket_); }
  Watcher(const Watcher&) = delete;
  Watcher& operator=(const Watcher&) = delete;
  bool good() const { return good_; }

  static sockaddr_un Address(const std::string& path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, path.c_str(), sizeof address.sun_path - 1);
    return address;
  }
  /// Returns the next line, or nothing if the stream ends or the time limit is reached.
  std::string Line() {
    std::size_t end = 0;
    while ((end = come_.find('\n')) == std::string::npos) {
      char more[4096];
      const ssize_t got = read(socket_, more, sizeof more);
      if (got <= 0) return "";
      come_.append(more, static_cast<std::size_t>(got));
    }
    const std::string line = come_.substr(0, end);
    come_.erase(0, end + 1);
    return line;
  }

 private:
  int socket_;
  bool good_ = false;
  std::string come_;
};

/// Creates a socket file without a listener.
void LeaveASocket(const std::string& path) {
  const int left = socket(AF_UNIX, SOCK_STREAM, 0);
  const sockaddr_un address = Watcher::Address(path);
  EXPECT_EQ(bind(left, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  close(left);
  EXPECT_TRUE(fs::is_socket(path));
}

/// Returns the text of a key's value.
std::string Of(const std::string& frame, const std::string& key) {
  const std::string wanted = "\"" + key + "\":";
  const std::size_t at = frame.find(wanted);
  if (at == std::string::npos) return "";
  const std::size_t begin = at + wanted.size();
  return frame.substr(begin, std::min(frame.find(",\"", begin), frame.find('}', begin)) - begin);
}

std::ptrdiff_t Count(const std::string& text, char wanted) {
  return std::count(text.begin(), text.end(), wanted);
}

class Truth : public VirtualRobot {
 protected:
  Truth() {
    Diagnostics found;
    const auto robot = LoadRobot(folder_ / "robot.yaml", {}, found);
    plant_ = robot ? MotorPlant::Make(*robot, found) : nullptr;
    EXPECT_TRUE(plant_) << found.Format();
  }
  std::string path() const { return folder_ / "truth"; }
  std::unique_ptr<MotorPlant> plant_;
  Diagnostics found_;
};

TEST_F(Truth, IsAHeaderAndAFrameEvery20Milliseconds) {
  const auto server = TruthServer::Open(path(), *plant_, found_);
  ASSERT_TRUE(server) << found_.Format();
  Watcher watcher(path());
  ASSERT_TRUE(watcher.good());
  for (Time now = 100 * kMicrosecond; now <= 50 * kMillisecond; now += 100 * kMicrosecond) {
    server->Step(now);
  }
  plant_->SetHeld(true);
  server->Step(60 * kMillisecond);
  EXPECT_EQ(watcher.Line(), kHeader);
  for (const char* time : {"0.02", "0.04", "0.06"}) {
    const std::string frame = watcher.Line();
    EXPECT_EQ(Of(frame, "time_s"), time);
    EXPECT_EQ(Of(frame, "held"), std::string(time) == "0.06" ? "true" : "false");
    EXPECT_EQ(Count(Of(frame, "bodies"), '['), 1 + 3) << frame;
    EXPECT_EQ(Count(Of(frame, "bodies"), ','), 3 * 7 - 1);
    for (const char* key : {"tension_n", "length_m", "rest_length_m"}) {
      EXPECT_EQ(Count(Of(frame, key), ','), 12 - 1) << frame;
    }
  }
  const BodyState body = plant_->batch().Body(0, 0);
  const std::string poses = Of(TruthFrame(*plant_, 0), "bodies");
  double x = 0, y = 0, z = 0, w = 0;
  ASSERT_EQ(std::sscanf(poses.c_str(), "[[%lf,%lf,%lf,%lf", &x, &y, &z, &w), 4) << poses;
  EXPECT_EQ(x, body.position_m.x);
  EXPECT_EQ(y, body.position_m.y);
  EXPECT_EQ(z, body.position_m.z);
  EXPECT_EQ(w, body.orientation.w);
}

TEST_F(Truth, NobodyWaitsForAClientThatDoesNotRead) {
  const auto server = TruthServer::Open(path(), *plant_, found_);
  ASSERT_TRUE(server) << found_.Format();
  const Watcher idle(path());
  Watcher watcher(path());
  {
    const Watcher gone(path());
    server->Step(TruthServer::kPeriod);
    EXPECT_EQ(server->client_count(), 3U);
  }
  EXPECT_EQ(watcher.Line(), kHeader);
  int frames = 2;
  for (; server->client_count() > 1 && frames < 100'000; ++frames) {
    server->Step(frames * TruthServer::kPeriod);
    if (frames == 2) {
      EXPECT_EQ(server->client_count(), 2U) << "one has gone of its own accord";
    }
    EXPECT_NE(watcher.Line(), "");
  }
  EXPECT_EQ(server->client_count(), 1U);
  server->Step(frames * TruthServer::kPeriod);
  EXPECT_NE(watcher.Line(), "") << "the one that reads still hears";
}

TEST_F(Truth, OnlyASocketThatNobodyListensAtIsReplaced) {
  LeaveASocket(path());
  {
    const auto server = TruthServer::Open(path(), *plant_, found_);
    ASSERT_TRUE(server) << found_.Format();
    EXPECT_TRUE(Watcher(path()).good());
    EXPECT_FALSE(TruthServer::Open(path(), *plant_, found_));
    EXPECT_NE(found_.Format().find("another program listens"), std::string::npos);
    EXPECT_TRUE(Watcher(path()).good());
  }
  EXPECT_FALSE(fs::exists(fs::symlink_status(path())));
  for (const std::string& place : {path() + "/deeper", std::string(200, 'a'), std::string()}) {
    EXPECT_FALSE(TruthServer::Open(place, *plant_, found_)) << place;
  }
}

/// The command as a child process: its id, and its first output
class Child {
 public:
  Child(const fs::path& folder, const std::string& arguments)
      : pipe_(
            popen(("cd " + folder.string() + "; echo $$; exec " TAUT_VIRTUAL_ROBOT " " + arguments)
                      .c_str(),
                  "r")) {
    pid_ = std::atoi(Line().c_str());
    EXPECT_GT(pid_, 0);
    path_ = Line();
  }
  ~Child() {
    if (pipe_) End(SIGKILL);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  const std::string& path() const { return path_; }
  int End(int signal) {
    kill(pid_, signal);
    const int status = pclose(std::exchange(pipe_, nullptr));
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  std::string Line() {
    char line[256] = {};
    return std::fgets(line, sizeof line, pipe_) ? line : "";
  }

  std::FILE* pipe_;
  pid_t pid_ = 0;
  std::string path_;
};

TEST_F(Truth, AChildOnAStandCanBeWatchedFromItsFirstLineOn) {
  LeaveASocket(path());
  for (const int signal : {SIGINT, SIGTERM}) {
    Child child(folder_, "--model robot.yaml --link robot --truth truth --stand");
    EXPECT_TRUE(child.path().starts_with("/dev/pts/")) << child.path();
    EXPECT_TRUE(child.path().ends_with(" (robot)\n")) << child.path();
    EXPECT_TRUE(fs::is_character_file(folder_ / "robot"));
    Watcher watcher(path()), other(path());
    ASSERT_TRUE(watcher.good());
    EXPECT_EQ(watcher.Line(), kHeader);
    EXPECT_EQ(other.Line(), kHeader);
    double before_s = -1;
    for (int i = 0; i < 10; ++i) {
      const std::string frame = watcher.Line();
      const double time_s = std::atof(Of(frame, "time_s").c_str());
      EXPECT_GT(time_s, before_s);
      before_s = time_s;
      EXPECT_EQ(Of(frame, "held"), "true") << "nobody has told the boards to do anything";
      EXPECT_EQ(Count(Of(frame, "bodies"), '['), 1 + 3) << frame;
    }
    EXPECT_EQ(child.End(signal), 0);
    EXPECT_FALSE(fs::exists(fs::symlink_status(path())));
    EXPECT_FALSE(fs::exists(fs::symlink_status(folder_ / "robot")));
  }
}

TEST_F(Truth, AFileInItsWayIsLeftAlone) {
  std::ofstream(path()) << "data";
  const Done done = Ask("--model robot.yaml --truth truth");
  EXPECT_EQ(done.status, 1);
  EXPECT_TRUE(Says(done, "the path exists and is not a socket")) << done.said;
  EXPECT_FALSE(Says(done, "/dev/pts")) << done.said;
  EXPECT_EQ(Text(path()), "data");
}

TEST_F(Truth, TheChildEndsWithItsParent) {
  const std::string shell =
      "--version; sh -c '" TAUT_VIRTUAL_ROBOT
      " --model robot.yaml --link robot --truth truth --with_parent & echo $! > pid; "
      "for i in $(seq 200); do [ -L robot ] && break; sleep 0.1; done; [ -S truth ] && echo "
      "began'; "
      "for i in $(seq 200); do [ -L robot ] || break; sleep 0.1; done; "
      "[ -L robot ] && echo link left behind; [ -e truth ] && echo socket left behind; "
      "kill -KILL $(cat pid)";
  const Done done = Ask(shell);
  EXPECT_TRUE(Says(done, "began")) << done.said;
  EXPECT_FALSE(Says(done, "left behind")) << done.said;
}

}  // namespace
}  // namespace taut::virtual_robot
