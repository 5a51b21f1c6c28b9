// `taut analyze --linear` and `--response`: linearization about the rest state, frequency
// responses.
#include "analyze_linear.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>

#include "output.h"
#include "standard_streams.h"

namespace taut::cli {
namespace {

std::vector<std::string> NamesOf(const std::vector<LinearSignal>& signals) {
  std::vector<std::string> names;
  for (const LinearSignal& signal : signals) names.push_back(signal.name);
  return names;
}

/// Returns the index of a signal; nothing, and an error in `out`, if the system has no signal of
/// this name.
std::optional<int> Find(const std::vector<LinearSignal>& signals, const std::string& name,
                        const char* kind, const std::string& file, Diagnostics& out) {
  const std::optional<int> found = FindSignal(signals, name);
  if (!found) {
    const std::vector<std::string> names = NamesOf(signals);
    const std::string_view closest = ClosestMatch(name, names);
    out.Error("linear.unknown_name", {file, 0, 0}, fmt::format("there is no {} \"{}\"", kind, name),
              closest.empty() && !names.empty()
                  ? fmt::format("expected one of {} names, such as \"{}\"; --json lists all",
                                names.size(), names.front())
                  : DidYouMean(name, names));
  }
  return found;
}

/// Returns frequencies evenly spaced on a logarithmic scale [Hz].
std::vector<double> Frequencies(double from_hz, double to_hz, int points) {
  std::vector<double> all_hz;
  for (int i = 0; i < points; ++i) {
    const double share = points == 1 ? 0 : static_cast<double>(i) / (points - 1);
    all_hz.push_back(i == 0            ? from_hz
                     : i + 1 == points ? to_hz
                                       : from_hz * std::pow(to_hz / from_hz, share));
  }
  return all_hz;
}

/// Computes the responses of all requested pairs of signals. Returns false, with errors in `out`,
/// if a name is unknown.
bool Respond(const LinearArguments& args, double to_hz, LinearResult& result, Diagnostics& out) {
  const StateSpace& system = result.system;
  const std::vector<double> all_hz = Frequencies(args.from_hz, to_hz, args.points);
  for (const auto& [input, output] : args.responses) {
    const auto in = Find(system.inputs, input, "input", result.file, out);
    const auto seen = Find(system.outputs, output, "output", result.file, out);
    if (!in || !seen) continue;
    const std::string& over = system.inputs[static_cast<std::size_t>(*in)].unit;
    const std::string& unit = system.outputs[static_cast<std::size_t>(*seen)].unit;
    result.responses.push_back({input, output, unit == over ? "1" : unit + " / (" + over + ")",
                                ResponseOf(system, *in, *seen, all_hz)});
  }
  return out.ok();
}

/// Returns the suggested next command: a response after the linear system, or the complete table
/// after a response.
std::vector<std::string> NextOf(const LinearResult& result, const LinearArguments& args) {
  std::vector<std::string> next = args.again;
  const StateSpace& system = result.system;
  if (!args.responses.empty()) {
    for (const auto& [input, output] : args.responses) {
      next.insert(next.end(), {"--response", input, output});
    }
    next.push_back(args.tables ? "--csv" : "--tables");
  } else if (!system.inputs.empty() && !system.outputs.empty()) {
    next.insert(next.end(),
                {"--response", system.inputs.front().name, system.outputs.front().name});
  } else {
    next.insert(next.end(), {"--linear", args.file, "--tables"});
  }
  return next;
}

}  // namespace

int Linear(const std::string& file, const ExperimentSpec& experiment,
           const std::optional<Pose>& from, const std::vector<std::string>& notes, int most_modes,
           const LinearArguments& args) {
  Diagnostics found;
  LinearResult result;
  result.file = file, result.model = experiment.robot.def.name, result.notes = notes;
  LinearOptions options;
  options.at = from;
  result.system = FindStateSpace(experiment, options, found);
  if (!found.ok()) return Fail(found, kBadInput);
  const StateSpace& system = result.system;
  if (!system.found) {
    fmt::print(stderr, "error: there is no linear system: {}{}\n", system.why,
               system.hint.empty() ? "" : " (" + system.hint + ")");
    return kFailed;
  }
  const double half_hz = 0.5 / system.period_s, to_hz = args.to_hz.value_or(half_hz);
  if (!args.responses.empty() && (to_hz > half_hz * (1 + 1e-9) || args.from_hz > to_hz)) {
    fmt::print(stderr,
               "error: --from_hz {:g}, --to_hz {:g}: expected increasing frequencies up to half "
               "the tick rate, {:g} Hz\n",
               args.from_hz, to_hz, half_hz);
    return kUsage;
  }
  if (!Respond(args, to_hz, result, found)) return Fail(found, kBadInput);
  result.modes = ModesOf(system);
  if (!args.file.empty() && !WriteStateSpace(system, args.file, found)) return Fail(found, kFailed);
  if (args.json) {
    fmt::print("{}\n", LinearJson(result));
  } else if (args.csv) {
    fmt::print("{}", ResponsesCsv(result));
  } else {
    fmt::print("{}", LinearSummary(result));
    if (args.tables) fmt::print("\n{}\n", LinearTables(result, most_modes));
    if (!args.file.empty()) fmt::print("Linear system: {}\n", args.file);
    SayNext(NextOf(result, args));
  }
  return kOk;
}

}  // namespace taut::cli
