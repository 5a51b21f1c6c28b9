// Simulation of an experiment for system identification. Its channels stay in memory.
#include <algorithm>
#include <optional>

#include "compare/orientation.h"
#include "identify/computed.h"
#include "report/reference.h"
#include "taut/run.h"

namespace taut::identify {
namespace {

constexpr const char* kTurns[] = {"rotation_x_rad", "rotation_y_rad", "rotation_z_rad"};
constexpr const char* kQuaternion[] = {"orientation_w", "orientation_x", "orientation_y",
                                       "orientation_z"};

/// Parses a channel such as body/<name>/rotation_y_rad. Returns the axis (here 1) and the text
/// before the last slash.
std::optional<std::pair<int, std::string>> TurnAxis(const std::string& channel) {
  const std::size_t slash = channel.rfind('/');
  if (!channel.starts_with("body/") || slash == channel.npos) return std::nullopt;
  for (int axis = 0; axis < 3; ++axis) {
    if (channel.substr(slash + 1) == kTurns[axis]) {
      return std::pair(axis, channel.substr(0, slash + 1));
    }
  }
  return std::nullopt;
}

class Memory : public TraceWriter {
 public:
  explicit Memory(std::size_t channels) { trace.values.resize(channels); }
  bool Append(double time_s, const double* values) override {
    trace.time_s.push_back(time_s);
    for (std::size_t i = 0; i < trace.values.size(); ++i) trace.values[i].push_back(values[i]);
    return true;
  }
  bool FlushOld() override { return true; }
  bool Finish() override { return true; }
  const std::string& error() const override { return error_; }
  Trace trace;

 private:
  std::string error_;
};

std::vector<double> Turns(const Trace& trace, const std::string& body, int axis) {
  std::size_t at[4];
  for (int i = 0; i < 4; ++i) at[i] = *trace.Find(body + kQuaternion[i]);
  std::vector<double> out;
  for (std::size_t row = 0; row < trace.time_s.size(); ++row) {
    const Vec3 turn = TurnOf({trace.values[at[0]][row], trace.values[at[1]][row],
                              trace.values[at[2]][row], trace.values[at[3]][row]});
    out.push_back(axis == 0 ? turn.x : axis == 1 ? turn.y : turn.z);
  }
  return out;
}

}  // namespace

std::vector<ChannelInfo> DynamicChannels(const ExperimentSpec& experiment) {
  ExperimentSpec all = experiment;
  all.record.channels = {"*"};
  all.record.channel_sources.clear();
  std::vector<ChannelInfo> out = RunChannels(all);
  for (const BodyDef& body : experiment.robot.def.bodies) {
    for (const char* turn : kTurns) {
      const std::string name = "body/" + body.name + "/" + turn;
      const auto has = [&](const ChannelInfo& c) { return c.name == name; };
      if (std::none_of(out.begin(), out.end(), has)) out.push_back({name, "rad"});
    }
  }
  return out;
}

Computed Run(const ExperimentSpec& given, const std::vector<std::string>& channels,
             const std::atomic<bool>* stop) {
  ExperimentSpec experiment = given;
  experiment.record.channels.clear();
  experiment.record.channel_sources.clear();
  for (const std::string& channel : channels) {
    const auto turn = TurnAxis(channel);
    if (!turn) experiment.record.channels.push_back(channel);
    for (int i = 0; turn && i < 4; ++i) {
      experiment.record.channels.push_back(turn->second + kQuaternion[i]);
    }
  }
  if (experiment.record.channels.empty()) {  // rows are recorded only if there is a channel
    experiment.record.channels = {"system/kinetic_j"};
  }
  Computed out;
  const std::vector<ChannelInfo> recorded = RunChannels(experiment);
  Memory memory(recorded.size());
  memory.trace.channels = recorded;
  RunOptions options;
  options.traces = {&memory};
  options.progress = [&](const RunProgress&) { return !stop || !*stop; };
  Diagnostics found;
  const auto summary = RunExperiment(experiment, options, found);
  if (stop && *stop) {
    out.stopped = true;
  } else if (!summary) {
    out.failed = found.items().empty() ? "the run does not start" : found.items()[0].what;
  } else if ((summary->status.bits & ~kStatusOverloaded) != 0) {
    out.failed = summary->status_text;
  }
  if (!out.failed.empty() || out.stopped) return out;
  for (const ReferenceSpec& reference : experiment.references) {
    auto& values = out.references.emplace_back();
    for (const auto& value : reference.values) {
      values.push_back(report::OurValue(*summary, reference, value.cable));
    }
  }
  compare::MakeOrientationsContinuous(memory.trace);  // must precede interpolation between rows
  out.time_s = memory.trace.time_s;
  for (const std::string& channel : channels) {
    const auto at = memory.trace.Find(channel);
    const auto turn = TurnAxis(channel);
    if (!at && !turn) {
      out.failed = "there is no channel " + channel;
      return out;
    }
    out.values.push_back(at ? memory.trace.values[*at]
                            : Turns(memory.trace, turn->second, turn->first));
  }
  return out;
}

}  // namespace taut::identify
