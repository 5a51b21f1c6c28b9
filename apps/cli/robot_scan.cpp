// `taut robot scan`, `status`: devices on the bus and their state, without motion.
#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "output.h"
#include "robot_console.h"

namespace taut::cli {
namespace {

using Json = nlohmann::ordered_json;

struct Found {
  int address = 0;
  std::optional<board::Info> info;  ///< Set if the device answers as a board.
};

Json InfoJson(const board::Info& info) {
  return {{"board", info.board},
          {"firmware", fmt::format("{}.{}", info.firmware_major, info.firmware_minor)},
          {"protocol_min", info.protocol_min},
          {"protocol_max", info.protocol_max},
          {"parameters_version", info.parameters_version},
          {"boots", info.nonce}};
}

/// Prints the adapter and all addresses that acknowledge.
int Scan(const RobotArguments& args) {
  Diagnostics found;
  const auto line = RobotLine::Open(args, {"--model", ModelPath(args)}, found);
  if (!line) return Fail(found, kFailed);
  const std::string& device = line->device;
  link::UsbIss adapter(*line->port);
  const auto info = adapter.Identify();
  if (!info || !adapter.SetMode()) {
    found.Error("adapter.no_answer", {device}, "no USB-ISS adapter answers");
    return Fail(found, kFailed);
  }
  link::Requests requests(adapter);
  std::vector<Found> all;
  // Skip addresses that the I2C specification reserves.
  for (int address = 0x08; address <= 0x77; ++address) {
    if (!adapter.Test(static_cast<std::uint8_t>(address))) continue;
    Found one{address, std::nullopt};
    const int board = address - board::BoardAddress(0);
    Diagnostics silent;
    if (board >= 0 && board < board::kBoards) one.info = requests.Info(board, silent);
    all.push_back(one);
  }
  int boards = 0;
  for (const Found& one : all) boards += one.info ? 1 : 0;
  if (args.json) {
    Json list = Json::array();
    for (const Found& one : all) {
      Json item{{"address", one.address}};
      if (one.info) item.update(InfoJson(*one.info));
      list.push_back(item);
    }
    fmt::print("{}\n", Json{{"port", device},
                            {"adapter",
                             {{"module_id", info->module_id},
                              {"firmware_version", info->firmware_version},
                              {"serial_number", info->serial_number}}},
                            {"found", list}}
                           .dump(2));
    return boards > 0 ? kOk : kFailed;
  }
  fmt::print("{}: USB-ISS {}, firmware version {}\n", device, info->serial_number,
             info->firmware_version);
  if (info->firmware_version < 8) {
    fmt::print(
        stderr,
        "warning: with firmware before version 8 a board that does not answer blocks the bus\n");
  }
  for (const Found& one : all) {
    if (one.info) {
      fmt::print("0x{:02x}  board {}, firmware {}.{}, boot {}\n", one.address, one.info->board,
                 one.info->firmware_major, one.info->firmware_minor, one.info->nonce);
    } else {
      fmt::print("0x{:02x}  unknown device\n", one.address);
    }
  }
  if (boards == 0) fmt::print(stderr, "error: no board answers (check their power supply)\n");
  return boards > 0 ? kOk : kFailed;
}

Json StatusJson(const RobotConsole& desk, const link::State& state,
                const std::vector<link::CounterReport>& counters) {
  Json boards = Json::array(), motors = Json::array();
  for (std::size_t b = 0; b < state.boards.size(); ++b) {
    const link::BoardView& board = state.boards[b];
    boards.push_back({{"board", b},
                      {"there", board.there},
                      {"mode", link::ModeName(board.status.mode)},
                      {"referenced", board.status.referenced},
                      {"timeout", board.status.timeout},
                      {"was_reset", board.status.was_reset},
                      {"faults", link::BoardFaultNames(board.faults)},
                      {"reset_cause", link::ResetCauseNames(board.reset_cause)},
                      {"bad_messages", counters[b].bad_messages},
                      {"late_ticks", counters[b].late_ticks},
                      {"missed_broadcasts", counters[b].missed_broadcasts},
                      {"bus_recoveries", counters[b].bus_recoveries}});
  }
  for (std::size_t m = 0; m < state.motors.size(); ++m) {
    const link::MotorView& motor = state.motors[m];
    motors.push_back({{"cable", desk.cables()[m]},
                      {"tension_n", motor.tension_n},
                      {"rest_length_m", motor.rest_length_m},
                      {"encoder_counts", motor.encoder_counts},
                      {"duty", motor.duty},
                      {"winding_temperature_c", motor.temperature_c},
                      {"faults", link::MotorFaultNames(motor.faults)}});
  }
  return {{"boards", boards}, {"motors", motors}};
}

int Status(const RobotArguments& args) {
  int exit = kOk;
  const auto desk = RobotConsole::Open(args, nullptr, exit);
  if (!desk) return exit;
  link::Driver& driver = desk->driver();
  // The status byte is multiplexed: faults and temperatures are sent in every sixteenth cycle.
  driver.Cycle(board::kMores + 2);
  const link::State state = driver.state();
  Diagnostics found;
  std::vector<link::CounterReport> counters(state.boards.size());
  for (std::size_t b = 0; b < counters.size(); ++b) {
    if (const auto said = driver.requests().Counters(static_cast<int>(b), found)) {
      counters[b] = *said;
    }
  }
  bool well = found.ok();
  for (const link::BoardView& board : state.boards) {
    well = well && board.there && !board.status.faulty && !board.status.timeout;
  }
  if (args.json) {
    fmt::print("{}\n", StatusJson(*desk, state, counters).dump(2));
  } else {
    fmt::print("{:<7}{:<11}{:<6}{:>8}{:>8}{:>8}{:>8}  {}\n", "board", "mode", "ref.", "bad", "late",
               "missed", "bus", "faults");
    for (std::size_t b = 0; b < state.boards.size(); ++b) {
      const link::BoardView& board = state.boards[b];
      const link::CounterReport& count = counters[b];
      fmt::print("{:<7}{:<11}{:<6}{:>8}{:>8}{:>8}{:>8}  {}{}{}\n", b,
                 board.there ? link::ModeName(board.status.mode) : "absent",
                 board.status.referenced ? "yes" : "no", count.bad_messages, count.late_ticks,
                 count.missed_broadcasts, count.bus_recoveries,
                 link::FaultText(state, static_cast<int>(b), desk->cables()),
                 board.status.timeout ? "; timed out" : "",
                 board.status.was_reset
                     ? "; restarted (" + link::ResetCauseNames(board.reset_cause) + ")"
                     : "");
    }
    fmt::print("\n{:<20}{:>13}{:>17}{:>10}{:>7}{:>16}\n", "cable", "tension [N]", "rest length [m]",
               "encoder", "duty", "winding [degC]");
    for (std::size_t m = 0; m < state.motors.size(); ++m) {
      const link::MotorView& motor = state.motors[m];
      fmt::print("{:<20}{:>13.2f}{:>17.4f}{:>10}{:>7.2f}{:>16}\n", desk->cables()[m],
                 motor.tension_n, motor.rest_length_m, motor.encoder_counts, motor.duty,
                 motor.temperature_c);
    }
    fmt::print("\nmean cycle time: {:.1f} ms\n", state.link.mean_cycle_s * 1e3);
  }
  if (!found.ok()) return Fail(found, kFailed);
  return well ? kOk : kFailed;
}

}  // namespace

void AddRobotScan(CLI::App& robot, int& exit_code) {
  auto args = std::make_shared<RobotArguments>();
  CLI::App* scan = robot.add_subcommand("scan", "Find the adapter and all boards on its bus.");
  AddPort(*scan, *args);
  AddJson(*scan, *args);
  scan->footer(
      "Examples:\n"
      "  taut robot scan\n"
      "  taut robot scan --port virtual --json\n"
      "Exit status: 0 if a board answers, else 1.");
  scan->callback([args, &exit_code] { exit_code = Scan(*args); });
}

void AddRobotStatus(CLI::App& robot, int& exit_code) {
  auto args = std::make_shared<RobotArguments>();
  CLI::App* status =
      robot.add_subcommand("status", "Show the state of boards and motors, without changing it.");
  AddPort(*status, *args);
  AddModel(*status, *args);
  AddJson(*status, *args);
  status->footer(
      "Examples:\n"
      "  taut robot status\n"
      "  taut robot status --port virtual --json\n"
      "Exit status: 0 if all boards answer without faults, else 1.");
  status->callback([args, &exit_code] { exit_code = Status(*args); });
}

}  // namespace taut::cli
