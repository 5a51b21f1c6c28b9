// Experiments on emulated boards in virtual time (`taut_virtual_robot --run`).
#include "apps/virtual_robot/run_experiment.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "taut/files.h"
#include "taut/link/log.h"
#include "taut/run.h"
#include "taut/run_folder.h"
#include "taut/summary.h"

namespace taut::virtual_robot {
namespace {

enum Exit : int { kGood = 0, kFailed = 1, kBadInput = 3, kInterrupted = 130 };

/// Statistics of the boards' tick durations in impedance control.
class TickTimes {
 public:
  explicit TickTimes(Robot& robot)
      : robot_(robot), begun_(static_cast<std::size_t>(robot.board_count())) {
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
  ~TickTimes() {
    for (int b = 0; b < robot_.board_count(); ++b) robot_.board(b).on_marker = {};
  }
  TickTimes(const TickTimes&) = delete;
  TickTimes& operator=(const TickTimes&) = delete;
  double mean_us() const { return ticks_ > 0 ? sum_us_ / static_cast<double>(ticks_) : 0; }
  double longest_us() const { return longest_us_; }

 private:
  Robot& robot_;
  std::vector<std::uint64_t> begun_;
  double sum_us_ = 0, longest_us_ = 0;
  std::int64_t ticks_ = 0;
};

/// Events of the PC, from its driver, and of boards and bus, from the emulation.
class Events {
 public:
  void Add(double at_s, std::string_view who, std::string_view what) {
    all_.push_back({at_s, std::string(who), std::string(what)});
  }
  /// Writes events.jsonl in chronological order. `started_s`: the experiment's time 0.
  bool Write(const std::string& path, double started_s, Diagnostics& out) {
    std::stable_sort(all_.begin(), all_.end(),
                     [](const Event& a, const Event& b) { return a.at_s < b.at_s; });
    std::string text;
    for (const Event& event : all_) {
      text += link::EventLine(event.at_s - started_s, event.who, event.what);
    }
    return WriteWholeFile(path, text, out);
  }

 private:
  struct Event {
    double at_s;
    std::string who, what;
  };
  std::vector<Event> all_;
};

/// Adds all log lines, except USB frames, to the events as well.
BoardsOptions WithLogInto(Events& events, BoardsOptions options) {
  options.robot.log = [&events, log = options.robot.log](Time at, std::string_view who,
                                                         std::string_view what) {
    if (log) log(at, who, what);
    if (who != "usb") events.Add(ToSeconds(at), who, what);
  };
  return options;
}

using Writers = std::vector<std::unique_ptr<TraceWriter>>;

/// Creates the traces in a run's folder: NAME.h5 and, on request, NAME.csv.
Writers CreateTraces(const std::string& path, bool csv, const std::vector<ChannelInfo>& channels,
                     const TraceMetadata& metadata, Diagnostics& out) {
  Writers all;
  all.push_back(CreateHdf5Trace(path + ".h5", channels, metadata, out));
  if (csv) all.push_back(CreateCsvTrace(path + ".csv", channels, out));
  return all;
}

/// Writes boards.json: statistics of boards and bus.
bool WriteFigures(const std::string& path, BoardsPlant& plant, const TickTimes& times,
                  Diagnostics& out) {
  const int overruns = plant.LateTicks();
  int deepest = 0, memory = 0;
  for (int b = 0; b < plant.robot().board_count(); ++b) {
    deepest = std::max(deepest, plant.robot().board(b).DeepestStack());
    memory = plant.robot().board(b).StaticMemory();
  }
  return WriteWholeFile(
      path,
      fmt::format(
          "{{\"format_version\": 1, \"tick_mean_us\": {:.1f}, \"tick_longest_us\": {:.1f}, "
          "\"late_ticks\": {}, \"cycle_mean_ms\": {:.3f}, \"cycle_longest_ms\": {:.3f}, "
          "\"late_cycles\": {}, \"bad_frames\": {}, \"static_memory_bytes\": {}, "
          "\"deepest_stack_bytes\": {}, \"started_s\": {:.6f}, \"largest_tension_n\": {:.3f}, "
          "\"recovered\": {}}}\n",
          times.mean_us(), times.longest_us(), overruns, plant.heard().link.mean_cycle_s * 1e3,
          plant.heard().link.longest_cycle_s * 1e3, plant.heard().link.late_cycles,
          plant.bad_frames(), memory, deepest, plant.started_s(), plant.most_n(),
          plant.recovered()),
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

int RunOnBoards(const ExperimentSpec& experiment, const BoardsOptions& options,
                const ExperimentRun& run, const std::atomic<bool>& stop, Diagnostics& out) {
  const auto motors = MotorPlant::Make(experiment.robot, out);
  CheckRecord(experiment, out);
  if (!motors || !out.ok()) return Fail(out, kBadInput);
  Events events;
  BoardsPlant plant(experiment, *motors, WithLogInto(events, options));
  plant.driver().on_event = [&](double time_s, const std::string& text) {
    events.Add(time_s, "pc", text);
  };
  const std::string path = run.out.empty() ? "runs/" + experiment.name + "_on_boards" : run.out;
  const auto folder =
      RunFolder::Open(path, {"host.h5", "host.csv", "boards.json", "events.jsonl"}, out);
  if (!folder || !plant.Prepare(out)) return Fail(out, kFailed);

  TraceMetadata metadata = RunMetadata(experiment);
  metadata.emplace_back(kRunIdKey, folder->id());
  metadata.emplace_back("plant", "emulated boards");
  const Writers traces =
      CreateTraces(folder->Path("trace"), run.csv, RunChannels(experiment, &plant), metadata, out);
  link::RobotLog host(motors->cable_names());
  const Writers host_traces =
      CreateTraces(folder->Path("host"), run.csv, host.channels(), metadata, out);
  folder->Prepare(ResolvedYaml(experiment), out);
  if (!out.ok()) return Fail(out, kFailed);
  plant.driver().on_cycle = [&](const link::State& state) {
    const double* const row = host.Row(state);
    for (const auto& trace : host_traces) trace->Append(state.time_s - plant.started_s(), row);
  };

  TickTimes times(plant.robot());
  RunOptions how;
  how.plant = &plant;
  for (const auto& trace : traces) how.traces.push_back(trace.get());
  how.begin = [&](Diagnostics& found) { return folder->Begin(found); };
  const bool shown = !run.quiet && ::isatty(STDERR_FILENO) == 1;
  how.progress = [&](const RunProgress& progress) {
    if (shown) ShowProgress(progress);
    return !stop;
  };
  auto summary = RunExperiment(experiment, how, out);
  if (shown) fmt::print(stderr, "\n");
  plant.driver().on_cycle = {};  // the following cycles no longer belong to the run
  plant.driver().on_event = {};
  fmt::print(stderr, "{}", plant.recovery().Format());  // warnings only; the run is valid
  if (out.ok()) events.Write(folder->Path("events.jsonl"), plant.started_s(), out);
  for (const auto& trace : host_traces) {
    if (!trace->Finish()) out.Error("trace.not_written", {}, trace->error());
  }
  if (!summary) return Fail(out, kFailed);
  summary->run = folder->id();
  if (out.ok()) WriteFigures(folder->Path("boards.json"), plant, times, out);
  if (out.ok()) folder->Finish(SummaryJson(*summary), out);
  if (!out.ok()) return Fail(out, kFailed);
  if (!run.quiet) {
    fmt::print("{}\n", SummaryTable(*summary));
    fmt::print("boards: tick mean {:.0f} us, longest {:.0f} us\n", times.mean_us(),
               times.longest_us());
    fmt::print("bus: cycle mean {:.2f} ms, longest {:.2f} ms; {} late cycles, {} bad frames\n",
               plant.heard().link.mean_cycle_s * 1e3, plant.heard().link.longest_cycle_s * 1e3,
               plant.heard().link.late_cycles, plant.bad_frames());
    for (std::size_t b = 0; b < plant.heard().boards.size(); ++b) {
      const link::BoardView& board = plant.heard().boards[b];
      if (board.status.mode == board::Mode::kImpedance && !board.status.faulty &&
          !board.status.timeout) {
        continue;
      }
      fmt::print("warning: board {} ends in mode {}{}; {}\n", b, link::ModeName(board.status.mode),
                 board.status.timeout ? ", timed out" : "",
                 link::FaultText(plant.heard(), static_cast<int>(b), motors->cable_names()));
    }
    fmt::print("Trace, PC log (host.h5), inputs and summary: {}\n", path);
  }
  return summary->interrupted ? kInterrupted : kGood;
}

}  // namespace taut::virtual_robot
