#include "apps/virtual_robot/paced.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <thread>
#include <utility>

#include "apps/virtual_robot/pty.h"

namespace taut::virtual_robot {
namespace {

using Clock = std::chrono::steady_clock;

// Replies are sent between two slices of time, so that they are late by one slice at most.
constexpr Time kSlice = 250 * kMicrosecond;
constexpr double kLongestWait_s = 0.001;

Time Since(Clock::time_point start) {
  const auto passed = std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - start);
  return passed.count() * kNanosecond;
}

}  // namespace

bool RunPaced(Robot& robot, const PacedOptions& options, const std::atomic<bool>& stop,
              Diagnostics& out) {
  std::optional<Pty> pty;
  const auto open = [&] {
    std::optional<Pty> opened = Pty::Open(options.link, out);
    if (!opened) return false;
    pty.emplace(std::move(*opened));
    if (options.on_path) options.on_path(pty->path());
    return true;
  };
  if (!open()) return false;
  Clock::time_point start = Clock::now();
  const Time begun = robot.now();
  const auto due = [&] { return begun + Since(start); };
  Time warned_at = -kSecond, left_out = 0;
  const auto catch_up = [&] {
    const Time end = due();
    while (!stop && robot.now() < end) {
      robot.AdvanceTo(std::min(end, robot.now() + kSlice));
      if (const auto reply = robot.HostReads(); reply && pty) pty->Write(*reply);
      const Time late = due() - robot.now();
      if (late + left_out > FromSeconds(options.late_s) && due() > warned_at + kSecond) {
        warned_at = due();
        if (options.on_late) options.on_late(ToSeconds(late + left_out));
        left_out = 0;
      }
      if (late > FromSeconds(options.slip_s)) {
        start += std::chrono::nanoseconds(late / kNanosecond);
        left_out += late;
        break;
      }
    }
  };
  while (!stop) {
    catch_up();
    // An unplugged adapter removes its device.
    if (!robot.usb_connected()) {
      pty.reset();
    } else if (!pty && !open()) {
      return false;
    }
    if (!pty) {
      std::this_thread::sleep_for(std::chrono::duration<double>(kLongestWait_s));
    } else if (pty->Wait(kLongestWait_s)) {
      // A frame takes effect at the time of its reading; the robot first advances to this time.
      const Bytes burst = pty->Read();
      catch_up();
      robot.HostWrites(burst);
    }
  }
  return true;
}

}  // namespace taut::virtual_robot
