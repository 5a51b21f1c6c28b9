#include "taut/link/power.h"

#include <fmt/format.h>

#include <algorithm>

#include "taut/link/names.h"

namespace taut::link {
namespace {

using board::Mode;

bool IsOff(Mode mode) { return mode == Mode::kOff || mode == Mode::kStopped; }

PowerReport PowerSince(const State& state, double commanded_s, double now_s) {
  PowerReport report;
  report.adapter_answers = state.link.connected;
  report.waited_s = now_s - commanded_s;
  for (const BoardView& board : state.boards) {
    BoardPower power;
    power.mode = board.status.mode;
    if (board.heard_s >= 0) power.age_s = now_s - board.heard_s;
    if (board.heard_s > commanded_s) {
      power.is = IsOff(board.status.mode) ? BoardPower::Is::kOff : BoardPower::Is::kOn;
    }
    report.boards.push_back(power);
  }
  return report;
}

}  // namespace

int PowerReport::off_count() const {
  return static_cast<int>(std::count_if(boards.begin(), boards.end(), [](const BoardPower& board) {
    return board.is == BoardPower::Is::kOff;
  }));
}

bool PowerReport::all_off() const {
  return !boards.empty() && off_count() == static_cast<int>(boards.size());
}

PowerReport TurnOff(Driver& driver, double patience_s) {
  const double commanded_s = driver.port().now_s(), until_s = commanded_s + patience_s;
  driver.Off();
  for (;;) {
    const double now_s = driver.port().now_s();
    PowerReport report = PowerSince(driver.state(), commanded_s, now_s);
    if (report.all_off() || now_s >= until_s) return report;
    driver.CycleBy(until_s);
  }
}

std::string DescribeConfirmation(const PowerReport& report) {
  return fmt::format("confirmed by {} of {} boards within {:.0f} ms", report.off_count(),
                     report.boards.size(), report.waited_s * 1e3);
}

void ReportPower(const PowerReport& report, Diagnostics& out) {
  if (report.all_off()) return;
  for (std::size_t b = 0; b < report.boards.size(); ++b) {
    const BoardPower& board = report.boards[b];
    if (board.is == BoardPower::Is::kOff) continue;
    if (board.is == BoardPower::Is::kOn) {
      out.Error("power.not_off", {},
                fmt::format("board {} has not turned its motors off: its last status, {:.0f} ms "
                            "old, has mode {}",
                            b, board.age_s * 1e3, ModeName(board.mode)));
    } else if (board.age_s < 0) {
      out.Error("power.not_confirmed", {},
                fmt::format("board {} has not confirmed that its motors are off: no status "
                            "was ever received from it",
                            b));
    } else {
      out.Error("power.not_confirmed", {},
                fmt::format("board {} has not confirmed that its motors are off: its last "
                            "status, {:.1f} s old, has mode {}",
                            b, board.age_s, ModeName(board.mode)));
    }
  }
  out.Error("power.summary", {},
            fmt::format("{} of {} boards confirmed that their motors are off{}", report.off_count(),
                        report.boards.size(),
                        report.adapter_answers ? "" : "; the adapter does not answer"),
            "a board that receives no broadcast for 0.1 s holds its motors with power; cut the "
            "motors' supply, or run `taut robot release` when the adapter answers again");
}

}  // namespace taut::link
