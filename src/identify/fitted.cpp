// Writer of experiment files with fitted parameters, and of run folders with static equilibria.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "description/yaml/reader.h"
#include "identify/computed.h"
#include "taut/identify.h"
#include "taut/run.h"
#include "taut/run_folder.h"
#include "taut/summary.h"
#include "taut/trace.h"

namespace taut {

std::string FittedExperimentYaml(const Identification& fit, std::size_t experiment,
                                 const std::vector<double>& values, const std::string& folder) {
  const FitExperiment& one = fit.spec().experiments[experiment];
  std::map<std::string, std::string> own, of_model;
  const auto put = [&](const std::string& name, const std::string& value) {
    (one.experiment.parameters.count(name) ? own : of_model)[name] = value;
  };
  for (const auto& [name, value] : one.set) put(name, value);
  for (std::size_t i = 0; i < fit.estimates().size(); ++i) {
    const FitEstimate& e = fit.spec().estimates[fit.estimates()[i]];
    const bool acts =
        std::find(e.experiments.begin(), e.experiments.end(), experiment) != e.experiments.end();
    if (acts && e.kind == FitEstimate::Kind::kParameter) {
      put(e.parameter, description::Shown(values[i]));
    }
  }
  std::error_code ignored;
  const auto base = std::filesystem::relative(one.experiment_file, folder, ignored);
  std::string out = "# " + one.name + " with the values found by the fit " + fit.spec().name + "\n";
  out += "taut: 1\nkind: experiment\nname: " + fit.spec().name + "_" + one.name + "\n";
  out += "base: " + (base.empty() ? one.experiment_file : base.string()) + "\n";
  for (const auto& [key, numbers] : {std::pair("parameters", &own), {"set", &of_model}}) {
    if (numbers->empty()) continue;
    out += std::string(key) + ":\n";
    for (const auto& [name, value] : *numbers) out += "  " + name + ": " + value + "\n";
  }
  return out;
}

bool WriteRests(const Identification& fit, std::size_t experiment, const ExperimentSpec& with,
                const std::string& folder, Diagnostics& out) {
  const FitExperiment& one = fit.spec().experiments[experiment];
  const std::vector<ChannelInfo> channels = identify::RestChannels(with);
  std::vector<std::string> names;
  for (const ChannelInfo& channel : channels) names.push_back(channel.name);
  const identify::Computed rests =
      identify::Rest(with, one.forward, fit.moments_s(experiment), names, nullptr);
  if (!rests.failed.empty()) {
    out.Error("fit.no_rest", {one.experiment_file}, one.name + ": " + rests.failed);
    return false;
  }
  ExperimentSpec shown = with;
  shown.duration_s = rests.time_s.empty() ? 0 : rests.time_s.back();
  shown.compare_with.reset();
  const auto run = RunFolder::Open(folder, {}, out);
  if (!run) return false;
  TraceMetadata metadata = RunMetadata(shown);
  metadata.emplace_back(kRunIdKey, run->id());
  metadata.emplace_back("forward", one.forward == FitForward::kStatic ? "static" : "load_cases");
  auto trace = CreateHdf5Trace(run->Path("trace.h5"), channels, metadata, out);
  if (!trace || !run->Prepare(ResolvedYaml(shown), out)) return false;
  trace = run->BeginWith(std::move(trace), {"trace.h5"});
  bool good = true;
  for (std::size_t row = 0; good && row < rests.time_s.size(); ++row) {
    std::vector<double> values;
    for (const auto& channel : rests.values) values.push_back(channel[row]);
    good = trace->Append(rests.time_s[row], values.data());
  }
  if (!good || !trace->Finish()) {
    out.Error("trace.not_written", {}, trace->error());
    return false;
  }
  RunSummary summary;
  summary.experiment = shown.name;
  summary.run = run->id();
  summary.simulated_s = shown.duration_s;
  for (const CableDef& cable : shown.robot.def.cables) {
    CableSummary& row = summary.cables.emplace_back();
    row.name = cable.name;
    const auto at = std::find(names.begin(), names.end(), "cable/" + cable.name + "/tension_n");
    for (const double tension_n : rests.values[static_cast<std::size_t>(at - names.begin())]) {
      row.tension.max_n = row.elastic.max_n = std::max(row.tension.max_n, tension_n);
    }
    if (row.tension.max_n <= summary.system_max_tension_n) continue;
    summary.system_max_tension_n = summary.system_max_elastic_n = row.tension.max_n;
    summary.system_max_tension_cable = cable.name;
  }
  return run->Finish(SummaryJson(summary), out);
}

}  // namespace taut
