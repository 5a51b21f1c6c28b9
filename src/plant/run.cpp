#include "taut/run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "plant/find_start.h"
#include "plant/loop.h"
#include "plant/recording.h"
#include "plant/statistics.h"
#include "plant/status_text.h"

namespace taut {
namespace {

using Clock = std::chrono::steady_clock;

/// State of one run of an experiment.
class Runner {
 public:
  Runner(const ExperimentSpec& experiment, const RunOptions& options, Plant& plant)
      : experiment_(experiment),
        options_(options),
        loop_(experiment, plant, options.extensions),
        recorder_(experiment, &plant),
        recording_(experiment, options.traces),
        statistics_(experiment) {}

  RunSummary Run(Diagnostics& out) {
    auto start = Clock::now();
    auto last_progress = start;
    RunSummary summary;
    summary.experiment = experiment_.name;
    TakeStatistics(0.0, 0.0);
    bool good = true;
    while (good && loop_.time_s() < experiment_.duration_s && !summary.interrupted) {
      loop_.Prepare();
      if (recording_.rows() == 0) {
        if (!Record(out)) break;
        start = Clock::now();  // exclude the creation of files from the wall-clock time
      }
      loop_.Step();
      const double time_s = loop_.time_s();
      TakeStatistics(time_s, loop_.step_s()[0]);
      if (good && recording_.IsDue(time_s)) good = Record(out);
      if ((++steps_done_ & 63) == 0) {
        const auto now = Clock::now();
        if (now - last_progress > std::chrono::milliseconds(200)) {
          last_progress = now;
          good = good && Wrote(recording_.FlushOld(), out);
          summary.interrupted =
              options_.progress &&
              !options_.progress({time_s, experiment_.duration_s,
                                  std::chrono::duration<double>(now - start).count()});
        }
      }
      if (!loop_.IsRunning()) good = false;
    }
    if (recording_.rows() == 0) {
      loop_.Prepare();
      Record(out);
    }
    summary.wall_s = std::chrono::duration<double>(Clock::now() - start).count();
    for (TraceWriter* trace : options_.traces) {
      if (!trace->Finish() && out.ok()) out.Error("trace.not_written", {}, trace->error());
    }
    summary.simulated_s = loop_.time_s();
    statistics_.Fill(summary);
    summary.left_out = recorder_.left_out();
    if (const World* const world = loop_.plant().world()) {
      summary.status = world->Status(0);
      summary.status_text = plant::StatusText(experiment_.robot.def, summary.status);
      summary.state_hash = world->Hash(0);
    }
    AddOverloads(summary);
    const std::string faults = loop_.Faults();
    if (!faults.empty()) summary.status_text += (summary.status_text.empty() ? "" : "; ") + faults;
    if (!loop_.refused().empty()) {
      out.Error("run.not_finite", {}, "the run ended early: " + loop_.refused());
      summary.status_text += (summary.status_text.empty() ? "" : "; ") + loop_.refused();
    }
    return summary;
  }

 private:
  static void AddOverloads(RunSummary& summary) {
    if (summary.overloads.empty()) return;
    double first_s = summary.overloads[0].first_time_s;
    for (const Overload& one : summary.overloads) first_s = std::min(first_s, one.first_time_s);
    WorldStatus& status = summary.status;
    status.first_time_s =
        status.bits == kStatusOk ? first_s : std::min(first_s, status.first_time_s);
    status.bits |= kStatusOverloaded;
    summary.status_text += (summary.status_text.empty() ? "" : "; ") + Describe(summary.overloads);
  }

  void TakeStatistics(double time_s, double step_s) {
    statistics_.Take(time_s, step_s, loop_.exact(), loop_.timeline().drag_n(),
                     loop_.plant().world());
  }

  bool Record(Diagnostics& out) {
    const std::vector<double>& row = recorder_.Row(plant::SourceOf(loop_));
    if (const World* const world = loop_.plant().world()) {
      statistics_.TakeLoads(loop_.exact(), *world);
    }
    return Wrote(recording_.Append(loop_.time_s(), row), out);
  }

  static bool Wrote(const TraceWriter* failed, Diagnostics& out) {
    if (failed != nullptr) out.Error("trace.not_written", {}, failed->error());
    return failed == nullptr;
  }

  const ExperimentSpec& experiment_;
  const RunOptions& options_;
  plant::Loop loop_;
  plant::Recorder recorder_;
  plant::Recording recording_;
  plant::Statistics statistics_;
  std::uint64_t steps_done_ = 0;
};

}  // namespace

std::optional<RunSummary> RunExperiment(const ExperimentSpec& experiment, const RunOptions& options,
                                        Diagnostics& out) {
  if (!CheckRecord(experiment, out) || !plant::CheckTimes(experiment, out)) return std::nullopt;
  if (options.plant != nullptr) {
    if (options.begin && !options.begin(out)) return std::nullopt;
    return Runner(experiment, options, *options.plant).Run(out);
  }
  const auto model = Model::CompileForExperiment(experiment.robot.def, out);
  if (!model) return std::nullopt;
  WorldBatchOptions batch_options;
  batch_options.threads = options.threads;
  batch_options.simd = options.simd;
  batch_options.friction = options.friction;
  WorldBatch batch(model, batch_options);
  std::optional<SettledStart> settled;
  if (!plant::PrepareStart(experiment, batch, out, {}, &settled)) return std::nullopt;
  if (settled) WarnOfStart(settled->change, out);
  if (options.begin && !options.begin(out)) return std::nullopt;
  const auto plant = PlantOf(batch);
  RunSummary summary = Runner(experiment, options, *plant).Run(out);
  if (settled) summary.start = std::move(settled->change);
  summary.end = plant::PoseOf(batch);
  return summary;
}

}  // namespace taut
