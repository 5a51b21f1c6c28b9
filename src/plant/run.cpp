#include "taut/run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "plant/find_start.h"
#include "plant/loop.h"
#include "plant/recorder.h"
#include "plant/statistics.h"

namespace taut {
namespace {

using Clock = std::chrono::steady_clock;

std::string DescribeStatus(const ModelDef& def, const WorldStatus& status) {
  const auto body_name = [&] { return def.bodies[static_cast<std::size_t>(status.body)].name; };
  const std::string when = std::to_string(status.first_time_s) + " s";
  if (status.bits == kStatusFellOff) {
    const auto ground = static_cast<std::size_t>(status.ground), fields = def.height_fields.size();
    return "body " + body_name() + " left the " +
           (ground < fields ? "height field " + def.height_fields[ground].name
                            : "mesh " + def.terrain_meshes[ground - fields].name) +
           " and is below all of the terrain at t = " + when;
  }
  std::string out;
  const auto add = [&](const char* text) { out += (out.empty() ? "" : "; ") + std::string(text); };
  if (status.bits & kStatusNonFinite) add("the state is no longer finite");
  if (status.bits & kStatusNotConverged) add("a contact solve did not converge");
  if (status.bits & kStatusStepTooLong) {
    add(status.cable >= 0
            ? "the step is too long for the tension of a cable"
            : "the step is too long for the joint forces of a body, or for its rotation about a "
              "hinge away from its center of mass");
  }
  if (status.bits & kStatusContactOverflow) {
    add(status.cable >= 0 ? "a cable touches more edges and rods than it can bend around"
                          : "there are more contacts than the contact buffer holds");
  }
  if (status.bits & kStatusFellOff) add("a body is below all of the terrain");
  if (out.empty()) return out;
  if (status.body != kWorld) out += ", body " + body_name();
  if (status.cable >= 0)
    out += ", cable " + def.cables[static_cast<std::size_t>(status.cable)].name;
  return out + ", first at t = " + when;
}

/// State of one run of an experiment.
class Runner {
 public:
  Runner(const ExperimentSpec& experiment, const RunOptions& options, Plant& plant)
      : experiment_(experiment),
        options_(options),
        loop_(experiment, plant, options.extensions),
        recorder_(experiment, &plant),
        statistics_(experiment) {}

  RunSummary Run(Diagnostics& out) {
    auto start = Clock::now();
    auto last_progress = start;
    RunSummary summary;
    summary.experiment = experiment_.name;
    TakeStatistics(0.0, 0.0);
    std::int64_t rows = 0;
    bool good = true;
    while (good && loop_.time_s() < experiment_.duration_s && !summary.interrupted) {
      loop_.Prepare();
      if (rows == 0) {
        if (!Record(rows, out)) break;
        start = Clock::now();  // the wall time excludes the creation of files
      }
      loop_.Step();
      const double time_s = loop_.time_s();
      TakeStatistics(time_s, loop_.step_s()[0]);
      if (good && RowIsDue(time_s, rows)) good = Record(rows, out);
      if ((++steps_done_ & 63) == 0) {
        const auto now = Clock::now();
        if (now - last_progress > std::chrono::milliseconds(200)) {
          last_progress = now;
          for (TraceWriter* trace : options_.traces)
            good = good && Wrote(trace->FlushOld(), *trace, out);
          summary.interrupted =
              options_.progress &&
              !options_.progress({time_s, experiment_.duration_s,
                                  std::chrono::duration<double>(now - start).count()});
        }
      }
      if (!loop_.IsRunning()) good = false;
    }
    if (rows == 0) {
      loop_.Prepare();
      Record(rows, out);
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
      summary.status_text = DescribeStatus(experiment_.robot.def, summary.status);
      summary.state_hash = world->Hash(0);
    }
    AddOverloads(summary);
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

  /// Recording selects steps; it must not change their lengths.
  bool RowIsDue(double time_s, std::int64_t rows) const {
    const double rate_hz = experiment_.record.rate_hz;
    return rate_hz <= 0 || time_s >= static_cast<double>(rows) / rate_hz - 1e-9 ||
           time_s >= experiment_.duration_s;
  }

  bool Record(std::int64_t& rows, Diagnostics& out) {
    const std::vector<double>& row =
        recorder_.Row({&loop_.exact(), &loop_.seen(), &loop_.commands(), loop_.plant().world(),
                       &loop_.timeline()});
    ++rows;
    if (const World* const world = loop_.plant().world()) {
      statistics_.TakeLoads(loop_.exact(), *world);
    }
    for (TraceWriter* trace : options_.traces) {
      if (!Wrote(trace->Append(loop_.time_s(), row.data()), *trace, out)) return false;
    }
    return true;
  }

  static bool Wrote(bool good, const TraceWriter& trace, Diagnostics& out) {
    if (!good) out.Error("trace.not_written", {}, trace.error());
    return good;
  }

  const ExperimentSpec& experiment_;
  const RunOptions& options_;
  plant::Loop loop_;
  plant::Recorder recorder_;
  plant::Statistics statistics_;
  std::uint64_t steps_done_ = 0;
};

}  // namespace

std::optional<RunSummary> RunExperiment(const ExperimentSpec& experiment, const RunOptions& options,
                                        Diagnostics& out) {
  if (!CheckRecord(experiment, out)) return std::nullopt;
  if (options.plant != nullptr) {
    if (options.begin && !options.begin(out)) return std::nullopt;
    return Runner(experiment, options, *options.plant).Run(out);
  }
  const auto model = Model::Compile(experiment.robot.def, out);
  if (!model) return std::nullopt;
  BatchOptions batch_options;
  batch_options.threads = options.threads;
  batch_options.simd = options.simd;
  batch_options.friction = options.friction;
  Batch batch(model, batch_options);
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
