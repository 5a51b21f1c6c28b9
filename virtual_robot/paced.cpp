#include "virtual_robot/paced.h"

#include <algorithm>
#include <chrono>
#include <optional>

#include "virtual_robot/pty.h"

namespace taut::virtual_robot {
namespace {

using Clock = std::chrono::steady_clock;

// Replies leave between two slices of time, so that they are late by a slice at most.
constexpr Time kSlice = 250 * kMicrosecond;
constexpr double kLongestWait_s = 0.001, kGiveUp_s = 1.0;

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
  const auto due_s = [&] { return std::chrono::duration<double>(Clock::now() - start).count(); };
  double warned_at_s = -1.0;
  while (!stop) {
    // A frame comes at the time at which it is read, and the robot catches up to it first.
    const double now_s = due_s();
    while (!stop && ToSeconds(robot.now() - begun) < now_s) {
      const Time end = begun + FromSeconds(now_s);
      robot.AdvanceTo(std::min(end, robot.now() + kSlice));
      if (const auto reply = robot.HostReads(); reply && pty) pty->Write(*reply);
      const double late_s = due_s() - ToSeconds(robot.now() - begun);
      if (late_s > options.late_s && due_s() > warned_at_s + 1.0) {
        warned_at_s = due_s();
        if (options.on_late) options.on_late(late_s);
      }
      if (late_s > kGiveUp_s) start += std::chrono::duration_cast<Clock::duration>(
                                  std::chrono::duration<double>(late_s));
    }
    // An adapter that was pulled out takes its device with it.
    if (!robot.usb_connected()) {
      pty.reset();
    } else if (!pty && !open()) {
      return false;
    }
    if (!pty) {
      struct timespec rest{0, static_cast<long>(kLongestWait_s * 1e9)};
      nanosleep(&rest, nullptr);
    } else if (pty->Wait(kLongestWait_s)) {
      const Bytes burst = pty->Read();
      robot.AdvanceTo(std::max(robot.now(), begun + FromSeconds(due_s())));
      if (const auto reply = robot.HostReads()) pty->Write(*reply);
      robot.HostWrites(burst);
    }
  }
  return true;
}

}  // namespace taut::virtual_robot
