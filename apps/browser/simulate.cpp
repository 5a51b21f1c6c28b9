#include "simulate.h"

#include <fmt/format.h>

#include "findings.h"
#include "taut/run.h"

namespace taut::browser {
namespace {

using viewer::Json;

/// Trace writer that appends rows, each with its time, to one list.
class RowList : public TraceWriter {
 public:
  RowList(std::size_t channels, std::vector<double>& rows) : channels_(channels), rows_(rows) {}
  bool Append(double time_s, const double* values) override {
    rows_.push_back(time_s);
    rows_.insert(rows_.end(), values, values + channels_);
    return true;
  }
  bool FlushOld() override { return true; }
  bool Finish() override { return true; }
  const std::string& error() const override { return none_; }

 private:
  std::size_t channels_;
  std::vector<double>& rows_;
  const std::string none_;
};

void AddSummary(const RunSummary& summary, Json& json) {
  json["experiment"] = summary.experiment;
  json["simulated_s"] = summary.simulated_s;
  json["state_hash"] = fmt::format("{:016x}", summary.state_hash);
  json["status"] = summary.status_text;
  Json most = Json::object();
  for (const CableSummary& cable : summary.cables) most[cable.name] = cable.tension.max_n;
  json["max_tension_n"] = std::move(most);
}

/// Runs an experiment; writes its results to `json` and `rows`. Returns false, with errors, if it
/// cannot start.
bool Run(const SimulateInputs& inputs, Json& json, std::vector<double>& rows, Diagnostics& found) {
  auto experiment = LoadExperiment(inputs.path, inputs.overrides, found);
  if (!experiment) return false;
  if (inputs.duration_s) experiment->duration_s = *inputs.duration_s;
  CheckStart(experiment->robot, experiment->start, found);
  CheckRecord(*experiment, found);
  if (!found.ok()) return false;
  WarnOfStep(*experiment, found);
  const std::vector<ChannelInfo> channels = RunChannels(*experiment);
  RowList trace(channels.size(), rows);
  RunOptions options;
  options.traces = {&trace};
  const auto summary = RunExperiment(*experiment, options, found);
  if (!summary) return false;
  AddSummary(*summary, json);
  Json list = Json::array();
  for (const ChannelInfo& each : channels) {
    list.push_back({{"name", each.name}, {"unit", each.unit}});
  }
  json["channels"] = std::move(list);
  json["rows"] = rows.size() / (channels.size() + 1);
  return true;
}

}  // namespace

SimulateResult Simulate(const SimulateInputs& inputs) {
  SimulateResult result;
  Diagnostics found;
  Json json = Json::object();
  const bool ran = Run(inputs, json, result.rows, found);
  json["good"] = ran && found.ok();
  json["found"] = FindingsOf(found);
  result.json = viewer::Dump(json);
  return result;
}

}  // namespace taut::browser
