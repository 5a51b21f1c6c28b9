/// A USB-ISS adapter on a pseudo-terminal with six boards, whose firmware runs natively in real
/// time while frames arrive. The adapter can turn hostile while motors have power. Commands of
/// `taut robot` drive it like a real robot; no emulator is needed.
#pragma once

#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "link/fake_board.h"

namespace taut::link {

/// Behavior of the adapter after the attack.
enum class Hostility {
  kNone,
  kSilent,    ///< Reads frames, executes none and answers none.
  kGarbage,   ///< Executes frames and answers with random bytes.
  kHalf,      ///< Executes frames and sends only half of each answer.
  kFlood,     ///< Executes no frames and sends bytes without end.
  kUnread,    ///< Does not read frames from the line.
  kUnplugged  ///< The line is closed.
};

class HostileAdapter {
 public:
  /// `winds_m_per_s`: the first motor is turned by hand at this speed, for calibrations.
  explicit HostileAdapter(Hostility hostility, double winds_m_per_s = 0)
      : hostility_(hostility), winds_m_per_s_(winds_m_per_s) {
    char name[128] = {};
    EXPECT_EQ(openpty(&line_, &far_end_, name, nullptr, nullptr), 0);
    device_ = name;
    termios how{};
    tcgetattr(far_end_, &how);
    cfmakeraw(&how);
    tcsetattr(far_end_, TCSANOW, &how);
    fcntl(line_, F_SETFL, O_NONBLOCK);
    fcntl(line_, F_SETFD, FD_CLOEXEC);
    fcntl(far_end_, F_SETFD, FD_CLOEXEC);
    for (int b = 0; b < board::kBoards; ++b) boards_.push_back(std::make_unique<FakeBoard>(b));
    thread_ = std::thread([this] { Run(); });
  }
  ~HostileAdapter() {
    ended_ = true;
    thread_.join();
    Unplug();
    close(far_end_);
  }
  HostileAdapter(const HostileAdapter&) = delete;
  HostileAdapter& operator=(const HostileAdapter&) = delete;

  const std::string& device() const { return device_; }
  /// Turns the adapter hostile. Returns when it is, with or without power on the motors.
  void Attack() {
    attacks_ = true;
    while (!hostile_) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  /// Turns the adapter hostile as soon as this number of frames has arrived while motors have
  /// power. Call it before the command starts.
  void AttackAfterFramesWithPower(int frames) { frames_until_attack_ = frames; }
  /// Whether the adapter is hostile and motors had power when it became so.
  bool HasAttackedPower() const { return attacked_power_; }
  /// Number of times that a busy machine delayed the adapter or the command so long that the
  /// command may rightly report a silent adapter or unconfirmed boards.
  int delays() const { return delays_; }
  /// Number of frames that have arrived.
  int frames() const { return frames_; }
  /// Whether a motor has power. Up to date when the command gets a reply.
  bool AnyPower() const { return any_power_; }
  /// Whether a motor has had power, even if too briefly for a test on a busy machine to see it.
  bool HadPower() const { return had_power_; }

 private:
  using Bytes = std::vector<std::uint8_t>;
  using Clock = std::chrono::steady_clock;

  void Run() {
    auto ticked = Clock::now();
    auto looked = ticked;
    framed_ = ticked;
    std::mt19937 random(1);
    while (!ended_) {
      pollfd ready{line_, POLLIN, 0};
      if (line_ >= 0) {
        poll(&ready, 1, 1);
      } else {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
      // On a busy machine, neither a late adapter nor a late command may make a board time out:
      // boards catch up only a few ticks, and their time stands still while no frame arrives.
      const auto now = Clock::now();
      if (now - looked > kLateReply) ++delays_;
      looked = now;
      ticked = std::max(ticked, now - std::chrono::milliseconds(10));
      for (; ticked < now; ticked += std::chrono::milliseconds(1)) {
        if (ticks_left_ == 0) continue;
        --ticks_left_;
        for (const auto& board : boards_) board->Tick();
        boards_[0]->motors[0].wound_m += 1e-3 * winds_m_per_s_;
      }
      NotePower();
      if (line_ >= 0) Serve(random);
    }
  }
  void NotePower() {
    any_power_ = std::any_of(boards_.begin(), boards_.end(),
                             [](const auto& board) { return board->IsPowered(); });
    if (any_power_) had_power_ = true;
  }
  /// Counts a frame of the command, and the time since the one before.
  void NoteFrame() {
    const auto now = Clock::now();
    ++frames_;
    if (any_power_ && now - framed_ > kLateFrame) ++delays_;
    framed_ = now;
    ticks_left_ = kTicksPerFrame;
    if (any_power_ && frames_until_attack_ > 0 && --frames_until_attack_ == 0) {
      attacked_power_ = attacks_ = true;
    }
  }
  void Serve(std::mt19937& random) {
    const bool attacks = attacks_;
    const Hostility now = attacks ? hostility_ : Hostility::kNone;
    if (now == Hostility::kUnplugged) Unplug();
    hostile_ = attacks;
    if (line_ < 0 || now == Hostility::kUnread) return;
    if (now == Hostility::kFlood) {
      Bytes noise(4096);
      for (auto& byte : noise) byte = static_cast<std::uint8_t>(random());
      Send(noise);
    }
    std::uint8_t chunk[4096];
    const ssize_t size = read(line_, chunk, sizeof chunk);
    if (size > 0) NoteFrame();
    if (size <= 0 || now == Hostility::kSilent || now == Hostility::kFlood) return;
    Bytes reply = ReplyTo({chunk, chunk + size});
    NotePower();
    if (now == Hostility::kGarbage) {
      reply.resize(1 + random() % 64);
      for (auto& byte : reply) byte = static_cast<std::uint8_t>(random());
    } else if (now == Hostility::kHalf) {
      reply.resize(reply.size() / 2);
    }
    Send(reply);
  }
  void Send(const Bytes& bytes) const {
    if (!bytes.empty() && write(line_, bytes.data(), bytes.size()) < 0) {
      // The line is full because the command does not read.
    }
  }
  /// Closes the adapter's end of the line. The far end stays open. Otherwise the adapter of another
  /// test could get the same device name, and a command that drove this one would connect to it.
  void Unplug() {
    if (line_ < 0) return;
    close(line_);
    line_ = -1;
  }
  FakeBoard* At(int address) {
    const auto b = static_cast<std::size_t>(address - 0x10);
    return b < boards_.size() ? boards_[b].get() : nullptr;
  }
  Bytes ReplyTo(const Bytes& frame) {
    if (frame.size() > 1 && frame[0] == 0x5a) {
      if (frame[1] == 1) return {7, 8, mode_};
      if (frame[1] == 3) return {'0', '0', '0', '4', '2', '1', '0', '7'};
      if (frame[1] == 2 && frame.size() > 2) {
        mode_ = frame[2];
        return {0xff, 0};
      }
    }
    if (mode_ != 0x70 || frame.size() < 2) return {};
    if (frame[0] == 0x58) return {static_cast<std::uint8_t>(At(frame[1] >> 1) ? 0xff : 0)};
    if (frame[0] == 0x54 && frame.size() > 2) return Transfer(frame);
    if (frame[0] != 0x57) return {};
    Bytes reply{0xff, 0};
    for (std::size_t at = 1; at + 6 < frame.size(); at += 7) {
      FakeBoard* const board = At(frame[at + 2] >> 1);
      const auto said = board != nullptr ? board->Say() : std::nullopt;
      if (!said) return {0, 1};
      reply.insert(reply.end(), said->begin(), said->end());
      reply[1] = static_cast<std::uint8_t>(reply.size() - 2);
    }
    return reply;
  }
  Bytes Transfer(const Bytes& frame) {
    const int address = frame[1] >> 1;
    FakeBoard* const board = At(address);
    if ((frame[1] & 1) != 0) {
      Bytes said = (board != nullptr ? board->Say() : std::nullopt).value_or(Bytes());
      said.resize(frame[2], 0xff);
      return said;
    }
    const Bytes bytes(frame.begin() + 3, frame.end());
    bool acknowledged = false;
    if (address == board::kBroadcastAddress) {
      for (const auto& one : boards_) acknowledged = one->Hear(bytes, true) || acknowledged;
    } else if (board != nullptr) {
      acknowledged = board->Hear(bytes, false);
    }
    return {static_cast<std::uint8_t>(acknowledged ? 0xff : 0)};
  }

  /// Half of the time that a driver waits for a reply; half of the time after which boards of a
  /// robot hold because no broadcast arrives.
  static constexpr std::chrono::milliseconds kLateReply{20}, kLateFrame{50};
  static constexpr int kTicksPerFrame = board::kTimeoutTicks / 2;

  Hostility hostility_;
  double winds_m_per_s_;
  std::string device_;
  int line_ = -1, far_end_ = -1;
  std::uint8_t mode_ = 0x40;
  int ticks_left_ = kTicksPerFrame;  ///< Until the next frame.
  Clock::time_point framed_;         ///< Arrival of the last frame.
  std::vector<std::unique_ptr<FakeBoard>> boards_;
  std::atomic<bool> attacks_{false}, hostile_{false}, ended_{false}, any_power_{false},
      had_power_{false}, attacked_power_{false};
  std::atomic<int> delays_{0}, frames_{0}, frames_until_attack_{0};
  std::thread thread_;
};

}  // namespace taut::link
