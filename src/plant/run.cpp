#include "taut/run.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "plant/controllers.h"
#include "plant/recorder.h"
#include "plant/statistics.h"
#include "plant/timeline.h"

namespace taut {
namespace {

using plant::CableReading;
using plant::Controller;
using Clock = std::chrono::steady_clock;

constexpr int kTheWorld = 0;

std::string DescribeStatus(const ModelDef& def, const WorldStatus& status) {
  std::string out;
  const auto add = [&](const char* text) { out += (out.empty() ? "" : "; ") + std::string(text); };
  if (status.bits & kStatusNonFinite) add("the state is no longer finite");
  if (status.bits & kStatusNotConverged) add("a contact solve did not converge");
  if (status.bits & kStatusStepTooLong) add("the step is too long for the tension of a cable");
  if (status.bits & kStatusContactOverflow) add("more contacts than there is room for");
  if (out.empty()) return out;
  if (status.body != kWorld)
    out += ", body " + def.bodies[static_cast<std::size_t>(status.body)].name;
  if (status.cable >= 0)
    out += ", cable " + def.cables[static_cast<std::size_t>(status.cable)].name;
  return out + ", first at t = " + std::to_string(status.first_time_s) + " s";
}

/// The start that the experiment asks for.
bool PrepareStart(const ExperimentSpec& experiment, Batch& batch, Diagnostics& out) {
  if (experiment.start == StartKind::kAsDescribed) return true;
  const std::string hint = "a mechanism or a slope may have no equilibrium; try as_described";
  if (experiment.start == StartKind::kSettled) {
    if (Settle(batch, kTheWorld, experiment.step_s)) return true;
    out.Error({}, "the robot does not settle to an equilibrium on its ground", hint);
    return false;
  }
  ModelDef floating = experiment.robot.def;
  floating.gravity_m_per_s2 = {};
  floating.planes.clear();
  floating.terrain_boxes.clear();
  const auto model = Model::Compile(floating, out);
  if (!model) return false;
  Batch alone(model, {});
  if (!Settle(alone, kTheWorld, experiment.step_s)) {
    out.Error({}, "the robot does not settle to an equilibrium of its cables", hint);
    return false;
  }
  for (std::size_t b = 0; b < floating.bodies.size(); ++b) {
    batch.SetBodyState(kTheWorld, static_cast<int>(b), alone.Body(kTheWorld, static_cast<int>(b)));
  }
  return true;
}

/// One experiment while it runs.
class Runner {
 public:
  Runner(const ExperimentSpec& experiment, const RunOptions& options, Batch& batch)
      : experiment_(experiment),
        options_(options),
        batch_(batch),
        timeline_(experiment),
        recorder_(experiment),
        statistics_(experiment),
        readings_(experiment.robot.def.cables.size()),
        target_m_(readings_.size()),
        set_point_n_(readings_.size()) {
    for (const ControllerSpec& spec : experiment.controllers) controllers_.emplace_back(spec);
    for (std::size_t c = 0; c < target_m_.size(); ++c) {
      target_m_[c] = batch.RestLengthTarget(kTheWorld, static_cast<int>(c));
    }
  }

  RunSummary Run(Diagnostics& out) {
    const auto start = Clock::now();
    auto last_progress = start;
    RunSummary summary;
    summary.experiment = experiment_.name;
    Observe();
    statistics_.Take(0.0, 0.0, readings_, timeline_.drag_n());
    double time_s = 0.0;
    std::int64_t rows = 0;
    bool good = true;
    while (good && time_s < experiment_.duration_s && !summary.interrupted) {
      Control(time_s);
      if (rows == 0) good = Record(time_s, rows, out);
      const double until = NextBoundary(time_s);
      // Steps land on the boundary: as many as are needed at no more than the step asked for.
      const double span = until - time_s;
      const auto steps = std::max<std::int64_t>(
          1, static_cast<std::int64_t>(std::ceil(span / experiment_.step_s - 1e-6)));
      double step_s = span / static_cast<double>(steps);
      // "n steps" that differ from the step asked for by rounding only are that step.
      if (std::fabs(step_s - experiment_.step_s) < 1e-9 * experiment_.step_s) {
        step_s = experiment_.step_s;
      }
      const double from_s = time_s;
      for (std::int64_t i = 0; i < steps && good && !summary.interrupted; ++i) {
        timeline_.Apply(batch_, kTheWorld, time_s, step_s);
        batch_.Step(step_s);
        time_s = i + 1 == steps ? until : from_s + static_cast<double>(i + 1) * step_s;
        Observe();
        statistics_.Take(time_s, step_s, readings_, timeline_.drag_n());
        if (RowIsDue(time_s, rows)) good = Record(time_s, rows, out);
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
        if (batch_.Status(kTheWorld).bits & kStatusNonFinite) good = false;
      }
    }
    if (rows == 0) {
      Control(time_s);
      Record(time_s, rows, out);
    }
    for (TraceWriter* trace : options_.traces) {
      if (!trace->Finish() && out.ok()) out.Error({}, trace->error());
    }
    summary.simulated_s = time_s;
    summary.wall_s = std::chrono::duration<double>(Clock::now() - start).count();
    statistics_.Fill(summary);
    summary.status = batch_.Status(kTheWorld);
    summary.status_text = DescribeStatus(experiment_.robot.def, summary.status);
    summary.state_hash = batch_.Hash(kTheWorld);
    return summary;
  }

 private:
  void Observe() {
    for (std::size_t c = 0; c < readings_.size(); ++c) {
      const int cable = static_cast<int>(c);
      const CableState s = batch_.Cable(kTheWorld, cable);
      readings_[c] = {
          s.rest_length_m, s.length_m,
          s.rate_m_per_s,  s.tension_n,
          s.elastic_n,     batch_.GetParameter(kTheWorld, Parameter::kCableStiffness, cable)};
    }
  }

  void Control(double time_s) {
    for (Controller& controller : controllers_) {
      controller.Act(time_s, readings_, target_m_, set_point_n_);
    }
    for (std::size_t c = 0; c < target_m_.size(); ++c) {
      batch_.SetRestLengthTarget(kTheWorld, static_cast<int>(c), target_m_[c]);
    }
  }

  /// The next tick, corner of the timeline, or end.
  double NextBoundary(double time_s) const {
    double next = std::min(experiment_.duration_s, timeline_.NextCorner(time_s));
    for (const Controller& controller : controllers_) {
      next = std::min(next, controller.next_tick_s());
    }
    return next > time_s ? next : std::min(experiment_.duration_s, time_s + experiment_.step_s);
  }

  /// Recording takes steps as they come; it must not change them.
  bool RowIsDue(double time_s, std::int64_t rows) const {
    const double rate_hz = experiment_.record.rate_hz;
    return rate_hz <= 0 || time_s >= static_cast<double>(rows) / rate_hz - 1e-9 ||
           time_s >= experiment_.duration_s;
  }

  bool Record(double time_s, std::int64_t& rows, Diagnostics& out) {
    const std::vector<double>& row =
        recorder_.Row({&batch_, kTheWorld, &readings_, &target_m_, &set_point_n_, &timeline_});
    ++rows;
    for (TraceWriter* trace : options_.traces) {
      if (!Wrote(trace->Append(time_s, row.data()), *trace, out)) return false;
    }
    return true;
  }

  static bool Wrote(bool good, const TraceWriter& trace, Diagnostics& out) {
    if (!good) out.Error({}, trace.error());
    return good;
  }

  const ExperimentSpec& experiment_;
  const RunOptions& options_;
  Batch& batch_;
  plant::Timeline timeline_;
  plant::Recorder recorder_;
  plant::Statistics statistics_;
  std::vector<Controller> controllers_;
  std::vector<CableReading> readings_;
  std::vector<double> target_m_, set_point_n_;
  std::uint64_t steps_done_ = 0;
};

}  // namespace

std::optional<RunSummary> RunExperiment(const ExperimentSpec& experiment, const RunOptions& options,
                                        Diagnostics& out) {
  const auto model = Model::Compile(experiment.robot.def, out);
  if (!model || !CheckRecord(experiment, out)) return std::nullopt;
  BatchOptions batch_options;
  batch_options.threads = options.threads;
  batch_options.simd = options.simd;
  Batch batch(model, batch_options);
  if (!PrepareStart(experiment, batch, out)) return std::nullopt;
  return Runner(experiment, options, batch).Run(out);
}

}  // namespace taut
