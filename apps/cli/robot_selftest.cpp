// `taut robot selftest`: checks of boards, sensors and, on request, motors.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "output.h"
#include "overrides.h"
#include "robot_console.h"

namespace taut::cli {
namespace {

struct SelftestArguments : RobotArguments {
  bool move = false;
  double duty = 0.5, time_s = 0.1;
};

// Converter readings of an amplifier at the limits of its range.
constexpr double kLeast_counts = 3, kMost_counts = 734;
constexpr int kLeastMove_counts = 5;

struct Finding {
  std::string who, what;
  bool good;
};

void LookAtBoards(RobotConsole& desk, std::vector<Finding>& findings) {
  link::Driver& driver = desk.driver();
  driver.Cycle(board::kMores + 2);
  const link::State& state = driver.state();
  for (std::size_t b = 0; b < state.boards.size(); ++b) {
    const link::BoardView& board = state.boards[b];
    const std::string who = fmt::format("board {}", b);
    const bool well = board.there && !board.status.faulty && !board.status.timeout;
    findings.push_back({who,
                        !board.there ? "does not answer"
                                     : link::FaultText(state, static_cast<int>(b), desk.cables()) +
                                           (board.status.timeout ? "; timed out" : ""),
                        well});
    findings.push_back(
        {who, fmt::format("{} bad frames in {} cycles", board.bad_frames, state.link.cycles),
         board.bad_frames == 0});
    if (board.loop_time_s > 0) {
      findings.push_back({who, fmt::format("a tick takes {:.2f} ms", board.loop_time_s * 1e3),
                          board.loop_time_s < 0.001});
    }
  }
}

void LookAtSensors(RobotConsole& desk, std::vector<Finding>& findings) {
  const link::State& state = desk.driver().state();
  for (std::size_t m = 0; m < state.motors.size(); ++m) {
    const link::MotorFigures& figures = desk.driver().figures(static_cast<int>(m));
    const double counts = state.motors[m].tension_n / figures.n_per_count + figures.counts_at_zero;
    findings.push_back(
        {desk.cables()[m],
         fmt::format("load cell at {:.1f} counts, {:.2f} N", counts, state.motors[m].tension_n),
         counts >= kLeast_counts && counts <= kMost_counts});
  }
}

/// Winds one motor after another in for a moment, and back; all others brake.
bool MoveMotors(RobotConsole& desk, const SelftestArguments& args, std::vector<Finding>& findings,
                Diagnostics& found) {
  link::Driver& driver = desk.driver();
  if (!driver.Enable(board::Mode::kHold, false, found)) return false;
  for (int m = 0; m < static_cast<int>(desk.cables().size()); ++m) driver.SetValue(m, 0.0);
  if (!driver.Go(board::Mode::kDuty)) return false;
  const auto counts = [&](int motor) {
    return driver.state().motors[static_cast<std::size_t>(motor)].encoder_counts;
  };
  const auto drive = [&](int motor, double duty) {
    driver.SetValue(motor, duty);
    const double until_s = driver.port().now_s() + args.time_s;
    desk.RunWhile([&] { return driver.port().now_s() < until_s && !driver.state().stopping; });
    driver.SetValue(motor, 0.0);
    driver.Cycle(3);
  };
  for (int m = 0; m < static_cast<int>(desk.cables().size()) && !desk.stop_asked(); ++m) {
    const auto begin = counts(m);
    const double before_n = driver.state().motors[static_cast<std::size_t>(m)].tension_n;
    drive(m, args.duty);
    const auto in = counts(m) - begin;
    const double after_n = driver.state().motors[static_cast<std::size_t>(m)].tension_n;
    drive(m, -args.duty);
    const auto out = counts(m) - begin - in;
    findings.push_back(
        {desk.cables()[static_cast<std::size_t>(m)],
         fmt::format("wound in {} counts, {:+.2f} N; out {} counts", in, after_n - before_n, -out),
         in >= kLeastMove_counts && out <= -kLeastMove_counts});
    if (driver.state().stage != link::Stage::kActive) {
      found.Error(
          "robot.stopped", {},
          "the robot stopped while " + desk.cables()[static_cast<std::size_t>(m)] + " was moved");
      return false;
    }
  }
  return !desk.stop_asked();
}

int Selftest(const SelftestArguments& args) {
  if (args.dry_run) {
    fmt::print("would test all boards and sensors of {}{}\n", args.port,
               args.move ? fmt::format(", and drive each motor with duty {:g} for {:g} s, in and "
                                       "out",
                                       args.duty, args.time_s)
                         : "");
    return kOk;
  }
  int exit = kOk;
  const auto desk = RobotConsole::Open(args, nullptr, exit);
  if (!desk) return exit;
  std::vector<Finding> findings;
  Diagnostics found;
  LookAtBoards(*desk, findings);
  LookAtSensors(*desk, findings);
  if (args.move) MoveMotors(*desk, args, findings, found);
  const bool off = desk->End();
  bool good = off && found.ok() && !desk->stop_asked();
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Finding& one : findings) {
    good = good && one.good;
    if (args.json) {
      list.push_back({{"who", one.who}, {"what", one.what}, {"good", one.good}});
    } else {
      fmt::print("{}  {:<20}{}\n", one.good ? "good" : "BAD ", one.who, one.what);
    }
  }
  if (args.json) fmt::print("{}\n", list.dump(2));
  if (!found.ok()) return Fail(found, kFailed);
  if (off && desk->stop_asked()) return desk->stop_exit();
  return good ? kOk : kFailed;
}

}  // namespace

void AddRobotSelftest(CLI::App& robot, int& exit_code) {
  auto args = std::make_shared<SelftestArguments>();
  CLI::App* selftest =
      robot.add_subcommand("selftest", "Test boards, sensors and, with --move, motors.");
  AddPort(*selftest, *args);
  AddModel(*selftest, *args);
  AddDriving(*selftest, *args);
  selftest->add_flag("--move", args->move,
                     "Wind one motor after another in briefly and back (put the robot on a stand)");
  selftest->add_option("--duty", args->duty, "With --move: duty cycle, 0.05 to 1 (default: 0.5)")
      ->option_text("X")
      ->check(NumberWithin(0.05, 1.0));
  selftest
      ->add_option("--time_s", args->time_s, "With --move: duration per motor [s] (default: 0.1)")
      ->option_text("S")
      ->check(NumberWithin(0.02, 1.0));
  AddJson(*selftest, *args);
  selftest->footer(
      "Examples:\n"
      "  taut robot selftest\n"
      "  taut robot selftest --move --duty 0.3\n"
      "Exit status: 0 if all tests pass, else 1.");
  selftest->callback([args, &exit_code] { exit_code = Selftest(*args); });
}

}  // namespace taut::cli
