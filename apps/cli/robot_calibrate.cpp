// `taut robot calibrate`: scales of load cells and encoders, from weights hung on a cable or
// lengths measured by hand.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <iostream>
#include <utility>

#include "interrupt.h"
#include "output.h"
#include "overrides.h"
#include "robot_console.h"
#include "taut/files.h"

namespace taut::cli {
namespace {

/// Number of readings of a measurement, at 100 per second.
constexpr int kReadings = 100;
/// Timeout; a hundred readings take 1 s.
constexpr double kPatience_s = 5;

struct CalibrateArguments : RobotArguments {
  std::string cable, out = "calibration.yaml";
  std::vector<double> forces_n;
  double way_m = 0;
};

struct Mean {
  double value = 0, deviation = 0;
};

/// Waits for a line from the user. Returns false at the end of input or after Ctrl-C.
bool WaitForPerson(const std::string& text) {
  fmt::print("{} Then press Enter. ", text);
  std::fflush(stdout);
  std::string line;
  return static_cast<bool>(std::getline(std::cin, line)) && !interrupt_asked;
}

/// Reads the load cell [counts]. Returns false after an interrupt or if the board does not answer.
bool ReadLoadCell(RobotConsole& desk, int motor, Mean& out) {
  const link::MotorFigures& figures = desk.driver().figures(motor);
  std::vector<double> counts;
  const double until_s = desk.driver().port().now_s() + kPatience_s;
  std::int64_t read = 0;
  desk.RunWhile([&] {
    const link::State& state = desk.driver().state();
    if (state.link.cycles > read) {
      read = state.link.cycles;
      counts.push_back(state.motors[static_cast<std::size_t>(motor)].tension_n /
                           figures.n_per_count +
                       figures.counts_at_zero);
    }
    return static_cast<int>(counts.size()) < kReadings && desk.driver().port().now_s() < until_s;
  });
  if (!desk.stop_asked() && static_cast<int>(counts.size()) < kReadings) {
    fmt::print(stderr,
               "error: only {} of {} readings arrived within {:g} s: the adapter does not answer\n",
               counts.size(), kReadings, kPatience_s);
    return false;
  }
  const auto count = static_cast<double>(counts.size());
  for (const double c : counts) out.value += c / count;
  for (const double c : counts) {
    out.deviation += (c - out.value) * (c - out.value) / count;
  }
  out.deviation = std::sqrt(out.deviation);
  const auto board = static_cast<std::size_t>(motor / board::kMotors);
  return !desk.stop_asked() && desk.driver().state().boards[board].there;
}

std::string Today() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  localtime_r(&now, &parts);
  char text[16];
  return {text, std::strftime(text, sizeof text, "%Y-%m-%d", &parts)};
}

/// Merges the measurement into the calibration file; values of other cables, and other values of
/// this cable, are kept.
int Keep(const CalibrateArguments& args, const RobotConsole& desk,
         const CableCalibration& measured) {
  Diagnostics found;
  Calibration all;
  if (std::filesystem::exists(args.out)) {
    auto before = LoadCalibration(args.out, desk.cables(), found);
    if (!before) return Fail(found, kBadInput);
    all = std::move(*before);
  } else {
    all.name = std::filesystem::path(args.out).stem().string();
    if (!CheckName(all.name).empty()) all.name = "calibration";
  }
  auto at = std::find_if(all.cables.begin(), all.cables.end(),
                         [&](const CableCalibration& one) { return one.cable == measured.cable; });
  if (at == all.cables.end()) at = all.cables.insert(at, CableCalibration{measured.cable, {}, {}});
  at->measured = measured.measured;
  at->how = at->how.empty() ? measured.how : at->how + " " + measured.how;
  const auto take = [](std::optional<double>& to, const std::optional<double>& from) {
    if (from) to = from;
  };
  take(at->load_cell_n_per_count, measured.load_cell_n_per_count);
  take(at->load_cell_counts_at_zero, measured.load_cell_counts_at_zero);
  take(at->encoder_m_per_count, measured.encoder_m_per_count);
  if (!WriteWholeFile(args.out, CalibrationYaml(all), found)) return Fail(found, kFailed);
  fmt::print("{}: `--calibration {}` sets it on the boards\n", args.out, args.out);
  return kOk;
}

std::optional<int> FindMotor(const RobotConsole& desk, const std::string& cable) {
  Diagnostics found;
  const auto motor = desk.MotorOf(cable, found);
  fmt::print(stderr, "{}", found.Format());
  return motor;
}

int LoadCell(const CalibrateArguments& args) {
  std::vector<double> distinct = args.forces_n;
  std::sort(distinct.begin(), distinct.end());
  if (std::unique(distinct.begin(), distinct.end()) - distinct.begin() < 2) {
    fmt::print(stderr, "error: two different forces are needed for a straight line\n");
    return kUsage;
  }
  int exit = kOk;
  const auto desk = RobotConsole::Open(args, nullptr, exit);
  if (!desk) return exit;
  const auto motor = FindMotor(*desk, args.cable);
  if (!motor) return kBadInput;
  // Sums for the least-squares line: force = gain (counts - zero).
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  std::vector<std::pair<double, double>> points;
  for (const double force_n : args.forces_n) {
    if (!WaitForPerson(fmt::format("Load cable {} with {:g} N.", args.cable, force_n))) {
      return desk->stop_asked() || interrupt_asked ? kInterrupted : kFailed;
    }
    Mean counts;
    if (!ReadLoadCell(*desk, *motor, counts))
      return desk->stop_asked() ? desk->stop_exit() : kFailed;
    fmt::print("{:g} N: {:.2f} counts, +- {:.2f}\n", force_n, counts.value, counts.deviation);
    n += 1;
    x += counts.value;
    y += force_n;
    xx += counts.value * counts.value;
    xy += counts.value * force_n;
    points.emplace_back(counts.value, force_n);
  }
  const double spread = n * xx - x * x;
  const double gain = (n * xy - x * y) / spread;
  if (!(spread > 1.0) || !(gain > 0)) {
    fmt::print(stderr,
               "error: the readings do not rise with the force (check the polarity of the load "
               "cell, and that it belongs to this cable)\n");
    return kFailed;
  }
  const double zero = (x - y / gain) / n;
  double worst_n = 0;
  for (const auto& [counts, force_n] : points) {
    worst_n = std::max(worst_n, std::abs(gain * (counts - zero) - force_n));
  }
  fmt::print("{:.5g} N per count, {:.2f} counts at zero; largest deviation {:.2f} N\n", gain, zero,
             worst_n);
  CableCalibration measured{
      args.cable, Today(),
      fmt::format("Load cell: {} forces, largest deviation {:.2f} N.", points.size(), worst_n)};
  measured.load_cell_n_per_count = gain;
  measured.load_cell_counts_at_zero = zero;
  return Keep(args, *desk, measured);
}

int Encoder(const CalibrateArguments& args) {
  int exit = kOk;
  const auto desk = RobotConsole::Open(args, nullptr, exit);
  if (!desk) return exit;
  const auto motor = FindMotor(*desk, args.cable);
  if (!motor) return kBadInput;
  const auto counts = [&] {
    desk->driver().Cycle(3);
    return desk->driver().state().motors[static_cast<std::size_t>(*motor)].encoder_counts;
  };
  if (!WaitForPerson(fmt::format("Mark cable {} at its inlet.", args.cable))) return kFailed;
  const auto before = counts();
  // The board counts in 16 bits: the driver must follow the count to unwrap it.
  if (!WaitForPerson(fmt::format("Wind in {:g} m by hand, at most 32 767 counts.", args.way_m))) {
    return kFailed;
  }
  const auto wound = counts() - before;
  if (wound <= 10) {
    fmt::print(stderr,
               "error: winding in changed the encoder by {} counts, expected more than 10 (check "
               "the order of A and B)\n",
               wound);
    return kFailed;
  }
  CableCalibration measured{args.cable, Today(),
                            fmt::format("Encoder: {} counts over {:g} m.", wound, args.way_m)};
  measured.encoder_m_per_count = args.way_m / static_cast<double>(wound);
  fmt::print("{} counts: {:.4g} m per count\n", wound, *measured.encoder_m_per_count);
  return Keep(args, *desk, measured);
}

void AddCommon(CLI::App& command, CalibrateArguments& args) {
  command.add_option("cable", args.cable, "Name of the cable")->required();
  AddPort(command, args);
  AddModel(command, args);
  command
      .add_option("--out", args.out,
                  "Calibration file to write or extend (default: calibration.yaml)")
      ->option_text("FILE");
}

}  // namespace

void AddRobotCalibrate(CLI::App& robot, int& exit_code) {
  CLI::App* calibrate = robot.add_subcommand("calibrate", "Calibrate load cells and encoders.");
  calibrate->require_subcommand(1);
  auto cell_args = std::make_shared<CalibrateArguments>();
  CLI::App* cell = calibrate->add_subcommand(
      "load_cell", "Calibrate a load cell with two or more forces that you hang on the cable.");
  AddCommon(*cell, *cell_args);
  cell->add_option("--force_n", cell_args->forces_n, "Forces [N], in the order of the prompts")
      ->required()
      ->option_text("N ...")
      ->check(NumberWithin(0.0, 150.0));
  cell->footer(
      "Examples:\n"
      "  taut robot calibrate load_cell outer_top_1 --force_n 0 9.81 19.62\n"
      "Motors are off. The command prompts for each force, reads for 1 s, fits a line and writes "
      "the file.");
  cell->callback([cell_args, &exit_code] { exit_code = LoadCell(*cell_args); });
  auto encoder_args = std::make_shared<CalibrateArguments>();
  CLI::App* encoder = calibrate->add_subcommand(
      "encoder", "Calibrate an encoder with a length of cable that you wind in.");
  AddCommon(*encoder, *encoder_args);
  encoder->add_option("--way_m", encoder_args->way_m, "Length to wind in [m]")
      ->required()
      ->option_text("M")
      ->check(NumberWithin(1e-4, 10.0));
  encoder->footer("Examples:\n  taut robot calibrate encoder outer_top_1 --way_m 0.1");
  encoder->callback([encoder_args, &exit_code] { exit_code = Encoder(*encoder_args); });
  calibrate->footer(
      "Examples:\n  taut robot calibrate load_cell outer_top_1 --force_n 0 9.81 19.62\n"
      "  taut robot calibrate encoder outer_top_1 --way_m 0.1");
}

}  // namespace taut::cli
