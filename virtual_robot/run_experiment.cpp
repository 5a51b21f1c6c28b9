#include "virtual_robot/run_experiment.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <limits>

#include "taut/board/parameters.h"
#include "taut/files.h"
#include "taut/run.h"
#include "taut/run_folder.h"
#include "taut/summary.h"

namespace taut::virtual_robot {
namespace {

enum Exit : int { kGood = 0, kFailed = 1, kBadInput = 3, kInterrupted = 130 };

/// What the PC hears, a row a cycle: host.h5 beside the trace.
class HostTrace {
 public:
  HostTrace(const MotorPlant& motors, const LoadCellOptions& cell) : cell_(cell) {
    for (const std::string& name : motors.cable_names()) {
      const std::string cable = "cable/" + name + "/";
      channels_.push_back({cable + "tension_n", "N"});
      channels_.push_back({cable + "setpoint_n", "N"});
      channels_.push_back({cable + "encoder_counts", "1"});
      channels_.push_back({cable + "duty", "1"});
    }
    for (int b = 0; b < (motors.motor_count() + 1) / board::kMotors; ++b) {
      const std::string board = fmt::format("board/{}/", b);
      channels_.push_back({board + "mode", "1"});
      channels_.push_back({board + "state", "1"});
      channels_.push_back({board + "faults_0", "1"});
      channels_.push_back({board + "faults_1", "1"});
      channels_.push_back({board + "faults_board", "1"});
      channels_.push_back({board + "age_s", "s"});
    }
    counts_.resize(static_cast<std::size_t>(motors.motor_count()));
    row_.resize(channels_.size());
  }
  const std::vector<ChannelInfo>& channels() const { return channels_; }

  void Append(double time_s, const BoardsPlant& plant, Time now, TraceWriter& writer) {
    double* at = row_.data();
    const std::vector<Heard>& heard = plant.heard();
    for (std::size_t motor = 0; motor < counts_.size(); ++motor) {
      const Heard& board = heard[motor / board::kMotors];
      const board::MotorStatus& status = board.status.motors[motor % board::kMotors];
      const auto newtons = [this](std::uint16_t quarters) {
        return cell_.n_per_count * (quarters / 4.0 - cell_.zero_counts);
      };
      const bool has_target = board.status.mode == board::Mode::kImpedance;
      // the counter's 16 bits, unwrapped: it never moves by half of them in a cycle
      counts_[motor] += static_cast<std::int16_t>(status.encoder_counts -
                                                  static_cast<std::uint16_t>(counts_[motor]));
      *at++ = newtons(status.tension_quarters);
      *at++ = has_target ? newtons(status.set_point_quarters)
                         : std::numeric_limits<double>::quiet_NaN();
      *at++ = static_cast<double>(counts_[motor]);
      *at++ = status.duty / 127.0;
    }
    for (const Heard& board : heard) {
      *at++ = static_cast<double>(board.status.mode);
      *at++ = (board.status.referenced ? 1 : 0) + (board.status.faulty ? 2 : 0) +
              (board.status.timeout ? 4 : 0) + (board.status.overrun ? 8 : 0) +
              (board.status.was_reset ? 16 : 0);
      for (const board::More which :
           {board::More::kFaults0, board::More::kFaults1, board::More::kBoardFaults}) {
        *at++ = board.more[static_cast<std::size_t>(which)];
      }
      *at++ = ToSeconds(now - board.at);
    }
    writer.Append(time_s, row_.data());
  }

 private:
  LoadCellOptions cell_;
  std::vector<ChannelInfo> channels_;
  std::vector<std::int64_t> counts_;
  std::vector<double> row_;
};

/// How long the ticks of all boards take, once they are in impedance control.
class TickTimes {
 public:
  explicit TickTimes(Robot& robot) : begun_(static_cast<std::size_t>(robot.board_count())) {
    for (int b = 0; b < robot.board_count(); ++b) {
      robot.board(b).on_marker = [this, b](std::uint64_t cycle, std::uint8_t mark) {
        std::uint64_t& begun = begun_[static_cast<std::size_t>(b)];
        if ((mark & 0xf0) == 0x10) begun = cycle;
        if (mark != (0x20 | static_cast<int>(board::Mode::kImpedance))) return;
        const double us = static_cast<double>(cycle - begun) / 16.0;
        sum_us_ += us;
        longest_us_ = std::max(longest_us_, us);
        ++ticks_;
      };
    }
  }
  double mean_us() const { return ticks_ > 0 ? sum_us_ / static_cast<double>(ticks_) : 0; }
  double longest_us() const { return longest_us_; }

 private:
  std::vector<std::uint64_t> begun_;
  double sum_us_ = 0, longest_us_ = 0;
  std::int64_t ticks_ = 0;
};

/// boards.json: what a run says of boards and bus.
bool WriteFigures(const std::string& path, BoardsPlant& plant, const TickTimes& times,
                  Diagnostics& out) {
  const int overruns = plant.LateTicks();
  int deepest = 0, memory = 0;
  for (std::size_t b = 0; b < plant.heard().size(); ++b) {
    deepest = std::max(deepest, plant.robot().board(static_cast<int>(b)).DeepestStack());
    memory = plant.robot().board(static_cast<int>(b)).StaticMemory();
  }
  return WriteWholeFile(
      path,
      fmt::format("{{\"format_version\": 1, \"tick_mean_us\": {:.1f}, \"tick_longest_us\": {:.1f}, "
                  "\"late_ticks\": {}, \"cycle_mean_ms\": {:.3f}, \"cycle_longest_ms\": {:.3f}, "
                  "\"late_cycles\": {}, \"bad_frames\": {}, \"static_memory_bytes\": {}, "
                  "\"deepest_stack_bytes\": {}}}\n",
                  times.mean_us(), times.longest_us(), overruns, plant.mean_cycle_s() * 1e3,
                  plant.longest_cycle_s() * 1e3, plant.late_cycles(), plant.bad_frames(), memory,
                  deepest),
      out);
}

void ShowProgress(const RunProgress& progress) {
  fmt::print(stderr, "\r{:.1f} of {:.0f} s, {:.2f} x real time ", progress.time_s,
             progress.duration_s, progress.wall_s > 0 ? progress.time_s / progress.wall_s : 0.0);
}

int Fail(const Diagnostics& found, int status) {
  fmt::print(stderr, "{}", found.Format());
  return status;
}

}  // namespace

std::optional<BoardSetting> ReadSetting(const std::string& text, Diagnostics& out) {
  const std::size_t equals = text.find('=');
  const std::string name = text.substr(0, equals);
  char* end = nullptr;
  const double value =
      equals == std::string::npos ? 0 : std::strtod(text.c_str() + equals + 1, &end);
  if (equals == std::string::npos || end == text.c_str() + equals + 1 || *end != '\0') {
    out.Error({}, "--board " + text + ": not of the form name=number");
    return std::nullopt;
  }
  const std::pair<const char*, std::uint8_t> all[] = {
#define TAUT_NAME(parameter, key, value, least, greatest) {key, board::parameter},
      TAUT_MOTOR_PARAMETERS(TAUT_NAME)
#undef TAUT_NAME
  };
  for (const auto& [key, number] : all) {
    if (name != key) continue;
    const board::Range range = board::MotorRange(number);
    if (board::IsWithin(range, static_cast<float>(value)))
      return BoardSetting{number, static_cast<float>(value)};
    out.Error(
        {}, fmt::format("--board {}: not within {:g} .. {:g}", text, range.least, range.greatest));
    return std::nullopt;
  }
  out.Error({}, "--board " + text + ": a motor has no parameter " + name,
            "docs/hardware/parameters.md lists them");
  return std::nullopt;
}

int RunOnBoards(const ExperimentSpec& experiment, const BoardsOptions& options,
                const ExperimentRun& run, const std::atomic<bool>& stop, Diagnostics& out) {
  const auto motors = MotorPlant::Make(experiment.robot, out);
  CheckRecord(experiment, out);
  if (!motors || !out.ok()) return Fail(out, kBadInput);
  BoardsPlant plant(experiment, *motors, options);
  const std::string path = run.out.empty() ? "runs/" + experiment.name + "_on_boards" : run.out;
  const auto folder = RunFolder::Open(path, {"host.h5", "boards.json"}, out);
  if (!folder || !plant.Prepare(out)) return Fail(out, kFailed);

  TraceMetadata metadata = RunMetadata(experiment);
  metadata.emplace_back(kRunIdKey, folder->id());
  metadata.emplace_back("plant", "emulated boards");
  const auto trace =
      CreateHdf5Trace(folder->Path("trace.h5"), RunChannels(experiment, &plant), metadata, out);
  HostTrace host(*motors, options.robot.load_cell);
  const auto host_trace = CreateHdf5Trace(folder->Path("host.h5"), host.channels(), metadata, out);
  folder->Prepare(ResolvedYaml(experiment), out);
  if (!out.ok()) return Fail(out, kFailed);
  plant.on_cycle = [&](double time_s) {
    host.Append(time_s, plant, plant.robot().now(), *host_trace);
  };

  TickTimes times(plant.robot());
  RunOptions how;
  how.plant = &plant;
  how.traces = {trace.get()};
  how.begin = [&](Diagnostics& found) { return folder->Begin(found); };
  const bool shown = !run.quiet && ::isatty(STDERR_FILENO) == 1;
  how.progress = [&](const RunProgress& progress) {
    if (shown) ShowProgress(progress);
    return !stop;
  };
  auto summary = RunExperiment(experiment, how, out);
  if (shown) fmt::print(stderr, "\n");
  if (!host_trace->Finish()) out.Error({}, host_trace->error());
  if (!summary) return Fail(out, kFailed);
  summary->run = folder->id();
  if (out.ok()) WriteFigures(folder->Path("boards.json"), plant, times, out);
  if (out.ok()) folder->Finish(SummaryJson(*summary), out);
  if (!out.ok()) return Fail(out, kFailed);
  if (!run.quiet) {
    fmt::print("{}\n", SummaryTable(*summary));
    fmt::print("boards: a tick took {:.0f} us, at most {:.0f} us\n", times.mean_us(),
               times.longest_us());
    fmt::print("bus: a cycle took {:.2f} ms, at most {:.2f} ms; {} late, {} frames bad\n",
               plant.mean_cycle_s() * 1e3, plant.longest_cycle_s() * 1e3, plant.late_cycles(),
               plant.bad_frames());
    for (std::size_t b = 0; b < plant.heard().size(); ++b) {
      const Heard& heard = plant.heard()[b];
      const board::Status& status = heard.status;
      if (status.mode == board::Mode::kImpedance && !status.faulty && !status.timeout) continue;
      fmt::print(
          "warning: board {} ends in mode {}{}; faults {}, {} of its motors, {} of the board\n", b,
          static_cast<int>(status.mode), status.timeout ? ", timed out" : "", heard.more[0],
          heard.more[1], heard.more[2]);
    }
    fmt::print("Trace, what the PC heard (host.h5), inputs and summary: {}\n", path);
  }
  return summary->interrupted ? kInterrupted : kGood;
}

}  // namespace taut::virtual_robot
